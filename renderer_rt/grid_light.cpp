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

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/light.glsl"

/// Shadow rays of a cell to the lights of its row. The estimate is unbiased with any number.
constexpr uint32_t kRowRays = 32;
class GridExplainer {
  public:
    GridExplainer(const World& world, const MaterialLibrary& materials, LightTables& tables)
        : m_world(world)
        , m_tables(tables)
        , m_farQu(2.0f * glm::length(world.bounds.maxs - world.bounds.mins)) {
        std::vector<vec3> positions;
        const BspModel& model = world.bsp.models.front();
        for (int s = 0; s < model.surfaceCount; ++s) {
            const WorldSurface& surface = world.surfaces[static_cast<size_t>(model.firstSurface + s)];
            const auto surfaceClass = classifySurface(materials.get(surface.material));
            if (!surface.drawn || !surfaceClass || !isOpaqueClass(*surfaceClass)) continue;
            for (uint32_t i = 0; i < surface.indexCount; ++i)
                positions.push_back(world.vertices[world.indices[surface.firstIndex + i]].position);
            m_isSky.resize(positions.size() / 3, *surfaceClass == SurfaceClass::Sky);
        }
        m_tracer = std::make_unique<CpuTracer>(positions);
    }

    GridIrradiance explain(size_t index, std::mt19937& random) const {
        GridIrradiance explained{};
        RtGridCell& cell = m_tables.grid[index];
        if (cell.valid == 0) return explained;
        const float length = glm::length(cell.direction);
        const Frame frame = frameAround(length > 0.0f ? cell.direction / length : vec3(0, 0, 1));
        const vec3 point = pointOf(index);
        const int cluster = m_world.clusterOf(point);
        const RtLightRow& row = cluster >= 0 && cluster < m_world.bsp.clusterCount
                                    ? m_tables.rows.ofCluster(static_cast<size_t>(cluster))
                                    : m_tables.rows.outside();
        addRow(point, row, frame, random, explained);
        if (row.seesSky != 0) cell.sunSeen = addSuns(point, frame, explained);
        takeAway(explained, cell.surfaces);
        takeAway(explained, cell.models);
        return explained;
    }

  private:
    vec3 pointOf(size_t index) const {
        const auto nx = static_cast<size_t>(m_world.grid.counts.x), ny = static_cast<size_t>(m_world.grid.counts.y);
        return m_world.grid.origin + m_world.grid.cellSize * vec3(static_cast<float>(index % nx),
                                                                  static_cast<float>(index / nx % ny),
                                                                  static_cast<float>(index / (nx * ny)));
    }

    /// Light that comes along a line, as irradiance across it.
    static void add(const vec3& flux, const vec3& way, const Frame& frame, GridIrradiance& sum) {
        const vec3 direction = glm::normalize(way);
        const vec3 ways[kGridWays] = {frame.normal,   -frame.normal,   frame.tangent,
                                      -frame.tangent, frame.bitangent, -frame.bitangent};
        for (size_t k = 0; k < kGridWays; ++k)
            sum[k] += flux * std::max(0.0f, dot(ways[k], direction));
    }

    void addRow(const vec3& point, const RtLightRow& row, const Frame& frame, std::mt19937& random,
                GridIrradiance& sum) const {
        if (row.facing == 0) return;
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        const auto start = static_cast<uint32_t>(random());
        for (uint32_t i = 0; i < kRowRays; ++i) {
            const DrawnLight drawn = drawLight(m_tables.rows, row, start + i * (~0u / kRowRays));
            const float u = uniform(random), v = uniform(random);
            vec3 way(0.0f), flux(0.0f);
            if (drawn.light < m_tables.triangles.size())
                lookAtTriangle(m_tables.triangles[drawn.light], point, u, v, way, flux);
            else
                lookAtPoint(m_tables.points[drawn.light - m_tables.triangles.size()], point, way, flux);
            if (flux == vec3(0.0f) || m_tracer->occluded(point, way, 1.0f)) continue;
            add(flux * (drawn.weight / kRowRays), way, frame, sum);
        }
    }

    static void lookAtTriangle(const RtTriangleLight& light, const vec3& point, float u, float v, vec3& way,
                               vec3& flux) {
        const vec3 corner = light.corner - point;
        const float height = -dot(light.normal, corner);
        // A point in the light's own plane takes nothing from it.
        if (std::abs(height) <= light.error || (height < 0.0f && (light.flags & kLightTwoSided) == 0)) return;
        const SphericalTriangle seen =
            makeSphericalTriangle(corner, light.edge1, light.edge2, std::abs(height), light.areaQu2);
        way = sampleSphericalTriangle(seen, u, v);
        if ((light.flags & kLightUpward) != 0 && way.z <= 0.0f) return;
        flux = light.radiance * (2.0f * seen.halfAngle);
        way += light.normal * (height > 0.0f ? light.error : -light.error); // short of the light's own surface
    }

    static void lookAtPoint(const RtLight& light, const vec3& point, vec3& way, vec3& flux) {
        way = light.position - point;
        const float distance2 = std::max(dot(way, way), kLightMinDistanceQu * kLightMinDistanceQu);
        flux = light.power / distance2;
        if (isFaint(flux, light.faintest)) flux = vec3(0.0f);
        if (light.spot > 0.0f) flux *= spotShare(light.axis, light.spot, -way);
    }

    /// Returns the share of the suns' light that arrives.
    float addSuns(const vec3& point, const Frame& frame, GridIrradiance& sum) const {
        float all = 0, arrived = 0;
        for (const RtLight& sun : m_tables.others) {
            CpuHit hit;
            all += lightWeight(sun.power);
            if (!m_tracer->closest(point, sun.position, 0.0f, m_farQu, hit) || !m_isSky[hit.triangle]) continue;
            arrived += lightWeight(sun.power);
            add(sun.power, sun.position, frame, sum);
        }
        return all > 0 ? arrived / all : 0;
    }

    /// What is left, by channel: along the direction what is not explained there, elsewhere no more than is not
    /// explained across and behind. Never below 0.
    static void takeAway(const GridIrradiance& explained, RtGridLight& light) {
        const vec3 around = (explained[1] + explained[2] + explained[3] + explained[4] + explained[5]) / 5.0f;
        const vec3 along = glm::max(light.ambient + light.directed - explained[0], vec3(0.0f));
        light.ambient = glm::min(glm::max(light.ambient - around, vec3(0.0f)), along);
        light.directed = along - light.ambient;
    }

    const World& m_world;
    LightTables& m_tables;
    std::unique_ptr<CpuTracer> m_tracer;
    std::vector<char> m_isSky; ///< by triangle of the tracer
    float m_farQu;
};

} // namespace

std::vector<GridIrradiance> explainGrid(const World& world, const MaterialLibrary& materials, LightTables& tables) {
    std::vector<GridIrradiance> explained(tables.grid.size());
    if (tables.grid.empty()) return explained;
    const GridExplainer explainer(world, materials, tables);
    const size_t threadCount = std::max(1u, std::thread::hardware_concurrency());
    const size_t share = (tables.grid.size() + threadCount - 1) / threadCount;
    std::vector<std::thread> threads;
    for (size_t t = 0; t < threadCount; ++t)
        threads.emplace_back([&, t] {
            const size_t end = std::min(tables.grid.size(), (t + 1) * share);
            for (size_t i = t * share; i < end; ++i) {
                std::mt19937 random(static_cast<unsigned>(i)); // by cell: the same grid on any number of cores
                explained[i] = explainer.explain(i, random);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    return explained;
}

void limitGrid(std::vector<RtGridCell>& grid, const vec3& mean, const vec3& ambient) {
    dvec3 sum(0);
    size_t count = 0;
    for (RtGridCell& cell : grid) {
        if (cell.valid == 0) continue;
        cell.surfaces.ambient = glm::max(cell.surfaces.ambient - ambient, vec3(0.0f));
        sum += dvec3(cell.surfaces.ambient) +
               0.25 * dvec3(cell.surfaces.directed); // the mean of max(0, cosine) over all directions
        ++count;
    }
    const vec3 bounced = glm::max(mean - ambient, vec3(0.0f));
    vec3 scale(1.0f);
    for (int c = 0; c < 3; ++c)
        if (sum[c] > 0) scale[c] = std::min(1.0f, static_cast<float>(bounced[c] * static_cast<double>(count) / sum[c]));
    for (RtGridCell& cell : grid) {
        cell.surfaces.ambient = scale * cell.surfaces.ambient + ambient;
        cell.surfaces.directed *= scale;
    }
}

void raiseGrid(std::vector<RtGridCell>& grid, const std::vector<GridIrradiance>& explained, const vec3& floor) {
    for (size_t i = 0; i < grid.size(); ++i) {
        RtGridCell& cell = grid[i];
        if (cell.valid == 0) continue;
        vec3 lacking(0.0f);
        for (size_t k = 0; k < kGridWays; ++k) {
            const vec3 given = explained[i][k] + cell.surfaces.ambient + (k == 0 ? cell.surfaces.directed : vec3(0.0f));
            lacking += glm::max(floor - given, vec3(0.0f));
        }
        cell.surfaces.ambient += lacking / static_cast<float>(kGridWays);
    }
}

} // namespace q3rt
