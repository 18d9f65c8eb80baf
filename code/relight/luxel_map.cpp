#include "relight/luxel_map.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "relight/sampling.hpp"
#include "scene/luxels.hpp"

namespace q3rt {
namespace {

constexpr int kPageTexels = kLightmapSize * kLightmapSize;
/// Blocks of luxels that patches are split from, texels a side.
constexpr int kLargestBlock = 16;
/// A patch bends no more than this: cosine between a luxel's normal and the mean.
constexpr float kLeastNormalCosine = 0.9f;
/// Variance of the baked light within a luxel's rounding and filtering: not worth a split.
constexpr double kEvenVariance = 1.0;
constexpr float kSaturatedShare = 0.5f;

bool hasLuxels(const World& world, const MaterialLibrary& materials, size_t s) {
    const WorldSurface& surface = world.surfaces[s];
    const int page = world.bsp.surfaces[s].lightmap;
    const Material& material = materials.get(surface.material);
    return surface.drawn && page >= 0 && static_cast<size_t>(page) < world.bsp.lightmapPageCount() && !material.isSky;
}

/// Places the texels of one triangle.
void placeTriangle(const World& world, int page, uint32_t firstIndex, std::vector<int>& owner, int surface,
                   std::vector<PlacedLuxel>& out) {
    const Vertex* v[3];
    dvec3 st[3];
    for (uint32_t i = 0; i < 3; ++i) {
        v[i] = &world.vertices[world.indices[firstIndex + i]];
        st[i] = dvec3(dvec3(v[i]->lightmapSt, 0) * double(kLightmapSize));
        if (!(std::abs(st[i].x) <= 2 * kLightmapSize && std::abs(st[i].y) <= 2 * kLightmapSize)) return;
    }
    const double twice = (st[1].x - st[0].x) * (st[2].y - st[0].y) - (st[1].y - st[0].y) * (st[2].x - st[0].x);
    if (twice == 0) return;
    const float worldArea =
        0.5f * glm::length(glm::cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position));
    const auto texelArea = static_cast<float>(worldArea / std::abs(0.5 * twice));
    const auto bound = [&](int axis, bool upper) {
        const double a = st[0][axis], b = st[1][axis], c = st[2][axis];
        return std::clamp(static_cast<int>(std::floor(upper ? std::max({a, b, c}) : std::min({a, b, c}))), 0,
                          kLightmapSize - 1);
    };
    for (int y = bound(1, false); y <= bound(1, true); ++y)
        for (int x = bound(0, false); x <= bound(0, true); ++x) {
            const double px = x + 0.5 - st[0].x, py = y + 0.5 - st[0].y;
            const double b1 = (px * (st[2].y - st[0].y) - py * (st[2].x - st[0].x)) / twice,
                         b2 = (py * (st[1].x - st[0].x) - px * (st[1].y - st[0].y)) / twice;
            if (b1 < 0 || b2 < 0 || b1 + b2 > 1) continue;
            const auto texel = static_cast<size_t>(page * kPageTexels + y * kLightmapSize + x);
            if (owner[texel] >= 0) continue; // on an edge that triangles share
            const auto w1 = static_cast<float>(b1), w2 = static_cast<float>(b2), w0 = 1 - w1 - w2;
            PlacedLuxel luxel;
            luxel.position = w0 * v[0]->position + w1 * v[1]->position + w2 * v[2]->position;
            luxel.normal = normalAt(world, firstIndex, {w0, w1, w2});
            if (luxel.normal == vec3(0)) continue;
            luxel.texel = static_cast<uint32_t>(texel);
            luxel.areaQu2 = texelArea;
            if (world.clusterOf(luxel.position + kSampleOffsetQu * luxel.normal) < 0) continue;
            owner[texel] = surface;
            out.push_back(luxel);
        }
}

/// A block of one surface's luxels that may still be split.
struct Block {
    std::vector<PlacedLuxel> luxels;
    int surface = 0, sizeTexels = 0;
    double priority = 0; ///< what a split could gain
};
bool operator<(const Block& a, const Block& b) { return a.priority < b.priority; }

class PatchBuilder {
  public:
    PatchBuilder(const World& world, const MaterialLibrary& materials, const LuxelMapSettings& settings)
        : m_world(world)
        , m_materials(materials)
        , m_settings(settings) {}

    LuxelMap run() {
        m_map.world = &m_world;
        m_map.patchOfTexel.assign(m_world.bsp.lightmapPageCount() * size_t{kPageTexels}, -1);
        placeAll();
        splitBlocks();
        for (Block& block : m_done)
            addPatch(block);
        growPatches();
        return std::move(m_map);
    }

  private:
    const World& m_world;
    const MaterialLibrary& m_materials;
    const LuxelMapSettings& m_settings;
    LuxelMap m_map;
    std::priority_queue<Block> m_open;
    std::vector<Block> m_done;

    void placeAll() {
        std::vector<int> owner(m_map.patchOfTexel.size(), -1);
        std::vector<PlacedLuxel> luxels;
        const BspModel& model = m_world.bsp.models[0];
        for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
            const auto number = static_cast<size_t>(s);
            if (!hasLuxels(m_world, m_materials, number)) continue;
            const WorldSurface& surface = m_world.surfaces[number];
            luxels.clear();
            for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3)
                placeTriangle(m_world, m_world.bsp.surfaces[number].lightmap, surface.firstIndex + i, owner, s, luxels);
            addBlocks(luxels, s, kLargestBlock);
        }
    }

    static uint32_t cellOf(const PlacedLuxel& luxel, int size) {
        const auto x = luxel.texel % kLightmapSize, y = luxel.texel / kLightmapSize;
        return (y / static_cast<uint32_t>(size)) * kLightmapSize + x / static_cast<uint32_t>(size);
    }

    /// Groups luxels by aligned squares of texels.
    void addBlocks(std::vector<PlacedLuxel>& luxels, int surface, int size) {
        std::stable_sort(luxels.begin(), luxels.end(), [size](const PlacedLuxel& a, const PlacedLuxel& b) {
            return cellOf(a, size) < cellOf(b, size);
        });
        for (size_t first = 0; first < luxels.size();) {
            size_t end = first;
            while (end < luxels.size() && cellOf(luxels[end], size) == cellOf(luxels[first], size))
                ++end;
            Block block{{luxels.begin() + static_cast<std::ptrdiff_t>(first),
                         luxels.begin() + static_cast<std::ptrdiff_t>(end)},
                        surface,
                        size,
                        0};
            block.priority = gainOf(block);
            if (size == 1 || block.priority <= 0)
                m_done.push_back(std::move(block));
            else
                m_open.push(std::move(block));
            first = end;
        }
    }

    /// Area times the variance of the light; infinite for a block that bends.
    double gainOf(const Block& block) const {
        dvec3 mean(0), square(0), normal(0);
        double area = 0;
        for (const PlacedLuxel& luxel : block.luxels) {
            const dvec3 baked(m_map.bakedAt(luxel));
            area += luxel.areaQu2;
            mean += double(luxel.areaQu2) * baked;
            square += double(luxel.areaQu2) * baked * baked;
            normal += dvec3(luxel.normal);
        }
        if (block.luxels.size() < 2 || !(area > 0)) return 0;
        const double length = glm::length(normal);
        for (const PlacedLuxel& luxel : block.luxels)
            if (glm::dot(normal, dvec3(luxel.normal)) < kLeastNormalCosine * length)
                return std::numeric_limits<double>::infinity();
        mean /= area;
        const dvec3 variance = square / area - mean * mean;
        const double largest = std::max({variance.x, variance.y, variance.z});
        // Relative to what is there: dark places are seen too.
        const double level = 8.0 + std::max({mean.x, mean.y, mean.z});
        return largest > kEvenVariance ? std::sqrt(area) * largest / level : 0;
    }

    void splitBlocks() {
        while (!m_open.empty() && m_open.size() + m_done.size() < m_settings.patchCount) {
            Block block = m_open.top();
            m_open.pop();
            addBlocks(block.luxels, block.surface, block.sizeTexels / 2);
        }
        for (; !m_open.empty(); m_open.pop())
            m_done.push_back(m_open.top());
        std::stable_sort(m_done.begin(), m_done.end(), [](const Block& a, const Block& b) {
            return std::pair(a.surface, a.luxels[0].texel) < std::pair(b.surface, b.luxels[0].texel);
        });
    }

    vec3 albedoOf(int surface) const {
        const Material& material = m_materials.get(m_world.surfaces[static_cast<size_t>(surface)].material);
        for (const Stage& stage : material.stages)
            for (const TextureUnit& unit : stage.unit)
                if (!unit.frames.empty() && !unit.isLightmap && !unit.isWhite)
                    return m_materials.textures().get(unit.frames[0]).averageColor;
        return vec3(0.5f);
    }

    void addPatch(const Block& block) {
        LuxelPatch patch;
        float saturatedArea = 0;
        const auto number = static_cast<int>(m_map.patches.size());
        patch.firstLuxel = static_cast<uint32_t>(m_map.luxels.size());
        patch.luxelCount = static_cast<uint32_t>(block.luxels.size());
        patch.surface = block.surface;
        for (const PlacedLuxel& luxel : block.luxels) {
            const vec3 baked = m_map.bakedAt(luxel);
            m_map.patchOfTexel[luxel.texel] = number;
            m_map.luxels.push_back(luxel);
            if (isHeldOut(luxel.texel, m_settings.heldOutOneIn)) continue;
            patch.areaQu2 += luxel.areaQu2;
            patch.baked += luxel.areaQu2 * baked;
            patch.position += luxel.areaQu2 * luxel.position;
            patch.normal += luxel.areaQu2 * luxel.normal;
            if (std::max({baked.x, baked.y, baked.z}) >= 255) saturatedArea += luxel.areaQu2;
        }
        const float length = glm::length(patch.normal);
        if (!(patch.areaQu2 > 0) || !(length > 0)) {
            // All of it is held out.
            patch.areaQu2 = 0;
            patch.normal = block.luxels[0].normal;
            patch.position = block.luxels[0].position;
        } else {
            patch.baked /= patch.areaQu2;
            patch.position /= patch.areaQu2;
            patch.normal /= length;
        }
        patch.saturated = saturatedArea > kSaturatedShare * patch.areaQu2;
        patch.albedo = albedoOf(block.surface);
        m_map.patches.push_back(patch);
    }

    /// Rays also meet the border texels whose centres lie off their triangles: they take a neighbour's patch.
    void growPatches() {
        const std::vector<int> before = m_map.patchOfTexel;
        for (size_t texel = 0; texel < before.size(); ++texel) {
            if (before[texel] >= 0) continue;
            const int page = static_cast<int>(texel) / kPageTexels, x = static_cast<int>(texel) % kLightmapSize,
                      y = static_cast<int>(texel) / kLightmapSize % kLightmapSize;
            for (const auto& [dx, dy] :
                 {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
                if (x + dx < 0 || x + dx >= kLightmapSize || y + dy < 0 || y + dy >= kLightmapSize) continue;
                const int found = before[static_cast<size_t>(page * kPageTexels + (y + dy) * kLightmapSize + x + dx)];
                if (found >= 0) {
                    m_map.patchOfTexel[texel] = found;
                    break;
                }
            }
        }
    }
};

} // namespace

bool isHeldOut(uint32_t texel, unsigned oneIn) { return hashOf(texel) % oneIn == 0; }

vec3 LuxelMap::bakedAt(const PlacedLuxel& luxel) const {
    const uint8_t* rgb = &world->bsp.lightmaps[size_t{3} * luxel.texel];
    return {rgb[0], rgb[1], rgb[2]};
}

int LuxelMap::patchAt(uint32_t surface, uint32_t firstIndex, const vec2& barycentric) const {
    const int page = world->bsp.surfaces[surface].lightmap;
    if (page < 0 || static_cast<size_t>(page) >= world->bsp.lightmapPageCount()) return -1;
    const auto st = [&](uint32_t i) { return world->vertices[world->indices[firstIndex + i]].lightmapSt; };
    const vec2 at = ((1 - barycentric.x - barycentric.y) * st(0) + barycentric.x * st(1) + barycentric.y * st(2)) *
                    float(kLightmapSize);
    const auto clampTexel = [](float v) { return std::clamp(static_cast<int>(v), 0, kLightmapSize - 1); };
    return patchOfTexel[static_cast<size_t>(page * kPageTexels + clampTexel(at.y) * kLightmapSize + clampTexel(at.x))];
}

LuxelMap buildLuxelMap(const World& world, const MaterialLibrary& materials, const LuxelMapSettings& settings) {
    return PatchBuilder(world, materials, settings).run();
}

} // namespace q3rt
