#include "relight/hemisphere_rays.hpp"

#include "base/parallel.hpp"
#include "relight/sampling.hpp"

namespace q3rt {

HemisphereRays::HemisphereRays(const LightScene& scene, const std::vector<LightReceiver>& receivers, int rayCount)
    : m_rayCount(static_cast<size_t>(rayCount))
    , m_receiverCount(receivers.size())
    , m_hit(receivers.size() * m_rayCount, kNothing)
    , m_above(m_hit.size(), 0) {
    parallelFor(receivers.size(), [&](size_t i) {
        for (size_t r = 0; r < m_rayCount; ++r) {
            const size_t p = r % LightReceiver::kPoints, at = i * m_rayCount + r;
            const vec3 direction =
                cosineDirection(receivers[i].normal[p], planePoint(static_cast<uint32_t>(r), static_cast<uint32_t>(i)));
            m_above[at] = direction.z > 0 ? 1 : 0;
            OccluderHit hit;
            if (!scene.occluders.closest(receivers[i].position[p], direction, scene.occluders.farQu(), hit)) continue;
            if (scene.occluders.isSky(hit.surface))
                m_hit[at] = -2 - static_cast<int>(hit.surface);
            else if (scene.isFront(hit, direction))
                m_hit[at] = scene.luxels.patchAt(hit.surface, hit.firstIndex, hit.barycentric);
        }
    });
}

std::vector<vec3> HemisphereRays::gather(const std::vector<vec3>& radiosityOfPatch) const {
    std::vector<vec3> result(m_receiverCount, vec3(0));
    parallelFor(m_receiverCount, [&](size_t i) {
        vec3 sum(0);
        for (size_t r = i * m_rayCount; r < (i + 1) * m_rayCount; ++r)
            if (m_hit[r] >= 0) sum += radiosityOfPatch[static_cast<size_t>(m_hit[r])];
        result[i] = sum / static_cast<float>(m_rayCount);
    });
    return result;
}

std::vector<LightColumn> HemisphereRays::skyColumns(const LightScene& scene) const {
    std::vector<LightColumn> columns(scene.kinds.size());
    for (size_t k = 0; k < columns.size(); ++k) {
        const EmitterKind::Type type = scene.kinds[k].type;
        if (type == EmitterKind::Type::Surface) continue;
        for (size_t i = 0; i < m_receiverCount; ++i) {
            size_t count = 0;
            for (size_t r = i * m_rayCount; r < (i + 1) * m_rayCount; ++r) {
                if (m_hit[r] > -2) continue;
                const bool counts =
                    type == EmitterKind::Type::SkyDome
                        ? m_above[r] != 0
                        : scene.skyKindOfSurface[static_cast<size_t>(-2 - m_hit[r])] == static_cast<int>(k);
                count += counts ? 1 : 0;
            }
            columns[k].append(i, static_cast<float>(count) / static_cast<float>(m_rayCount));
        }
    }
    return columns;
}

} // namespace q3rt
