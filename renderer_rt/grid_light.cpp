#include "renderer_rt/grid_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <thread>

#include "accel/cpu_tracer.hpp"
#include "renderer_rt/surface_class.hpp"
#include "shaders/shared/constants.h"

namespace q3rt {

namespace {

// Of each cell. The estimate is unbiased with any of these; the grid's interpolation smooths what noise is left.
constexpr int kShadowRays = 3;
constexpr int kSkyRays = 12;
constexpr size_t kLargestRow = 64; ///< triangle lights weighed; longer rows are strided

float largestOf(const vec3& v) { return std::max({v.x, v.y, v.z}); }

/// Solid surfaces of the world model.
std::vector<vec3> gatherOccluders(const World& world, const MaterialLibrary& materials) {
    std::vector<vec3> positions;
    const BspModel& model = world.bsp.models.front();
    for (int s = 0; s < model.surfaceCount; ++s) {
        const WorldSurface& surface = world.surfaces[static_cast<size_t>(model.firstSurface + s)];
        const auto surfaceClass = classifySurface(materials.get(surface.material));
        if (!surface.drawn || !surfaceClass || !isOpaqueClass(*surfaceClass) || *surfaceClass == SurfaceClass::Sky)
            continue;
        for (uint32_t i = 0; i < surface.indexCount; ++i)
            positions.push_back(world.vertices[world.indices[surface.firstIndex + i]].position);
    }
    return positions;
}

class GridExplainer {
  public:
    GridExplainer(const World& world, const MaterialLibrary& materials, LightTables& tables)
        : m_world(world)
        , m_tables(tables)
        , m_tracer(gatherOccluders(world, materials))
        , m_farQu(glm::length(world.bounds.maxs - world.bounds.mins)) {}

    void explain(size_t index, std::mt19937& random) const {
        RtGridCell& cell = m_tables.grid[index];
        const float length = glm::length(cell.direction);
        if (cell.valid == 0 || length == 0.0f) return;
        const vec3 point = pointOf(index), normal = cell.direction / length;
        const int cluster = m_world.clusterOf(point);
        const RtLightRow& row = cluster >= 0 && cluster < m_world.bsp.clusterCount
                                    ? m_tables.rows.ofCluster(static_cast<size_t>(cluster))
                                    : m_tables.rows.outside();
        vec3 explained = triangleLight(point, normal, row, random);
        if (row.seesSky != 0) explained += skyLight(point, normal, random, cell.skySeen);
        const float whole = largestOf(cell.directed);
        if (whole > 0.0f) cell.directed *= std::max(0.0f, 1.0f - largestOf(explained) / whole);
    }

  private:
    vec3 pointOf(size_t index) const {
        const auto nx = static_cast<size_t>(m_world.grid.counts.x), ny = static_cast<size_t>(m_world.grid.counts.y);
        return m_world.grid.origin + m_world.grid.cellSize * vec3(static_cast<float>(index % nx),
                                                                  static_cast<float>(index / nx % ny),
                                                                  static_cast<float>(index / (nx * ny)));
    }

    /// Light from the middle of each triangle, shadowed for some chosen in proportion to what they give.
    vec3 triangleLight(const vec3& point, const vec3& normal, const RtLightRow& row, std::mt19937& random) const {
        const size_t stride = (row.facing + kLargestRow - 1) / kLargestRow;
        std::array<float, kLargestRow> running;
        std::array<const RtTriangleLight*, kLargestRow> lights;
        size_t count = 0;
        float sum = 0;
        for (size_t i = 0; stride > 0 && i < row.facing; i += stride) {
            const uint32_t number = m_tables.rows.entries[row.first + i].light;
            if (number >= m_tables.triangles.size()) continue;
            const RtTriangleLight& light = m_tables.triangles[number];
            sum += largestOf(unshadowed(point, normal, light)) * static_cast<float>(stride);
            running[count] = sum;
            lights[count++] = &light;
        }
        if (sum <= 0.0f) return vec3(0.0f);
        std::uniform_real_distribution<float> uniform(0.0f, sum);
        vec3 total(0.0f);
        for (int ray = 0; ray < kShadowRays; ++ray) {
            const size_t chosen = std::min(
                static_cast<size_t>(
                    std::lower_bound(running.begin(), running.begin() + static_cast<long>(count), uniform(random)) -
                    running.begin()),
                count - 1);
            const vec3 given = unshadowed(point, normal, *lights[chosen]);
            const vec3 toLight = middleOf(*lights[chosen]) - point;
            // The ray stops short of the light's own surface by its bound.
            const float end = 1.0f - std::min(1.0f, (lights[chosen]->error + 1.0f) / glm::length(toLight));
            if (largestOf(given) > 0.0f && !m_tracer.occluded(point, toLight, end))
                total += given * (sum / largestOf(given));
        }
        return total / static_cast<float>(kShadowRays);
    }

    static vec3 middleOf(const RtTriangleLight& light) { return light.corner + (light.edge1 + light.edge2) / 3.0f; }

    static vec3 unshadowed(const vec3& point, const vec3& normal, const RtTriangleLight& light) {
        const vec3 toLight = middleOf(light) - point;
        const float distance2 = std::max(dot(toLight, toLight), kLightMinDistanceQu * kLightMinDistanceQu);
        const float receiver = dot(normal, toLight);
        const float emitter = light.twoSided ? std::abs(dot(light.normal, toLight)) : -dot(light.normal, toLight);
        if (receiver <= 0.0f || emitter <= 0.0f) return vec3(0.0f);
        return light.radiance * (light.areaQu2 * receiver * emitter / (distance2 * distance2));
    }

    /// Suns by one ray each, the sky by rays over all directions. `seen`: the larger share of either that arrives.
    vec3 skyLight(const vec3& point, const vec3& normal, std::mt19937& random, float& seen) const {
        vec3 total(0.0f);
        std::normal_distribution<float> gauss;
        seen = 0;
        for (const RtLight& light : m_tables.others) {
            if (light.kind == kLightSun && !m_tracer.occluded(point, light.position * m_farQu, 1.0f)) {
                seen = 1;
                total += light.power * std::max(0.0f, dot(normal, light.position));
            }
            if (light.kind != kLightSky) continue;
            float arrived = 0, open = 0;
            for (int ray = 0; ray < kSkyRays; ++ray) {
                const vec3 direction = glm::normalize(vec3(gauss(random), gauss(random), gauss(random)) + vec3(1e-6f));
                if (m_tracer.occluded(point, direction * m_farQu, 1.0f)) continue;
                open += 1.0f / kSkyRays;
                arrived += 4.0f * std::max(0.0f, dot(normal, direction)) / kSkyRays; // uniform: 1 / (4 pi); E = pi L
            }
            seen = std::max(seen, std::min(1.0f, 2.0f * open));
            total += light.power * arrived;
        }
        return total;
    }

    const World& m_world;
    LightTables& m_tables;
    CpuTracer m_tracer;
    float m_farQu;
};

} // namespace

void explainGrid(const World& world, const MaterialLibrary& materials, LightTables& tables) {
    if (tables.grid.empty()) return;
    const GridExplainer explainer(world, materials, tables);
    const size_t threadCount = std::max(1u, std::thread::hardware_concurrency());
    const size_t share = (tables.grid.size() + threadCount - 1) / threadCount;
    std::vector<std::thread> threads;
    for (size_t t = 0; t < threadCount; ++t)
        threads.emplace_back([&, t] {
            const size_t end = std::min(tables.grid.size(), (t + 1) * share);
            for (size_t i = t * share; i < end; ++i) {
                std::mt19937 random(static_cast<unsigned>(i)); // by cell: the same grid on any number of cores
                explainer.explain(i, random);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
}

} // namespace q3rt
