#include "scene/light_occluders.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

LightOccluders::LightOccluders(const World& world, const MaterialLibrary& materials)
    : m_world(world)
    , m_materials(materials)
    , m_isSky(world.surfaces.size(), false) {
    std::vector<vec3> positions;
    std::vector<uint8_t> opaque;
    const BspModel& model = world.bsp.models[0];
    for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
        const WorldSurface& surface = world.surfaces[static_cast<size_t>(s)];
        const Material& material = materials.get(surface.material);
        m_isSky[static_cast<size_t>(s)] = material.isSky;
        const bool translucent = material.contentFlags & surfaceParm::kContentsTranslucent;
        if (!surface.drawn || (translucent && !material.light.alphaShadow)) continue;
        for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3) {
            for (uint32_t corner = 0; corner < 3; ++corner)
                positions.push_back(world.vertices[world.indices[surface.firstIndex + i + corner]].position);
            m_occluders.push_back({static_cast<uint32_t>(s), surface.firstIndex + i});
            opaque.push_back(material.light.alphaShadow ? 0 : 1);
        }
    }
    m_tracer = std::make_unique<CpuTracer>(positions, opaque);
    m_tracer->accept = [this](uint32_t triangle, const vec2& at) { return !letsLightPass(triangle, at); };
    const Bounds& bounds = m_tracer->bvh().bounds;
    m_farQu = bounds.empty() ? 1 : 2 * glm::length(bounds.maxs - bounds.mins);
}

bool LightOccluders::closest(const vec3& origin, const vec3& direction, float tMax, OccluderHit& hit) const {
    CpuHit found;
    if (!m_tracer->closest(origin, direction, 0, tMax, found)) return false;
    const Occluder& occluder = m_occluders[found.triangle];
    hit = {found.t, occluder.surface, occluder.firstIndex, found.barycentric};
    return true;
}

bool LightOccluders::letsLightPass(uint32_t triangle, const vec2& barycentric) const {
    const Occluder& occluder = m_occluders[triangle];
    const Material& material = m_materials.get(m_world.surfaces[occluder.surface].material);
    if (material.stages.empty() || material.stages[0].unit[0].frames.empty()) return false;
    const auto vertex = [&](uint32_t i) -> const Vertex& {
        return m_world.vertices[m_world.indices[occluder.firstIndex + i]];
    };
    const vec2 st = (1 - barycentric.x - barycentric.y) * vertex(0).st + barycentric.x * vertex(1).st +
                    barycentric.y * vertex(2).st;
    const Texture& texture = m_materials.textures().get(material.stages[0].unit[0].frames[0]);
    const MipLevel& level = texture.levels[0];
    const auto texel = [](float coordinate, int size) {
        const float wrapped = coordinate - std::floor(coordinate);
        return std::min(static_cast<int>(wrapped * static_cast<float>(size)), size - 1);
    };
    const auto at = static_cast<size_t>(texel(st.y, level.height) * level.width + texel(st.x, level.width));
    return level.rgba[4 * at + 3] < 128;
}

} // namespace q3rt
