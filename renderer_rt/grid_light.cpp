#include "renderer_rt/grid_light.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "scene/luxels.hpp"

namespace q3rt {

namespace {

constexpr uint32_t kCellRays = 32, kLuxelRays = 16;
/// Luxels looked at for each square of the grid.
constexpr double kLuxelsPerCell = 4;
/// How far off their faces map compilers put their samples, qu.
constexpr float kLuxelOffsetQu = 1;

float sumOf(const vec3& v) { return v.x + v.y + v.z; }

vec3 pointOf(const LightGrid& grid, size_t index) {
    const auto nx = static_cast<size_t>(grid.counts.x), ny = static_cast<size_t>(grid.counts.y);
    return grid.origin + grid.cellSize * vec3(static_cast<float>(index % nx), static_cast<float>(index / nx % ny),
                                              static_cast<float>(index / (nx * ny)));
}

/// What is left, by channel: along the direction what is not explained there, elsewhere no more than is not explained
/// across and behind. Never below 0.
void takeAway(const ProbeWays& explained, GridShare& light) {
    const vec3 around = (explained[1] + explained[2] + explained[3] + explained[4] + explained[5]) / 5.0f;
    const vec3 along = glm::max(light.ambient + light.directed - explained[0], vec3(0.0f));
    light.ambient = glm::min(glm::max(light.ambient - around, vec3(0.0f)), along);
    light.directed = along - light.ambient;
}

/// The cells that a point takes its light from, as the shaders weigh them (shaders/rt/grid.glsl): weights sum to 1.
struct CellMix {
    size_t count = 0;
    size_t cell[8];
    float weight[8];
};

CellMix mixAt(const LightGrid& shape, const std::vector<GridCell>& grid, const vec3& point) {
    const vec3 v = (point - shape.origin) / shape.cellSize;
    const ivec3 low = glm::clamp(ivec3(glm::floor(v)), ivec3(0), shape.counts - 1);
    const vec3 f = glm::clamp(v - vec3(low), 0.0f, 1.0f);
    CellMix mix;
    float total = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2), at = low + step;
        if (glm::any(glm::greaterThanEqual(at, shape.counts))) continue;
        const auto cell =
            static_cast<size_t>(at.x) +
            static_cast<size_t>(shape.counts.x) *
                (static_cast<size_t>(at.y) + static_cast<size_t>(shape.counts.y) * static_cast<size_t>(at.z));
        const vec3 weights = glm::mix(1.0f - f, f, vec3(step));
        const float weight = weights.x * weights.y * weights.z;
        if (grid[cell].valid == 0 || weight == 0) continue;
        mix.cell[mix.count] = cell;
        mix.weight[mix.count++] = weight;
        total += weight;
    }
    if (!(total > 0)) return {};
    for (size_t k = 0; k < mix.count; ++k)
        mix.weight[k] /= total;
    return mix;
}

vec3 lightOf(const std::vector<GridCell>& grid, const CellMix& mix, const vec3& normal) {
    vec3 ambient(0), directed(0), direction(0);
    for (size_t k = 0; k < mix.count; ++k) {
        const GridCell& cell = grid[mix.cell[k]];
        ambient += mix.weight[k] * cell.surfaces.ambient;
        directed += mix.weight[k] * cell.surfaces.directed;
        direction += mix.weight[k] * cell.direction;
    }
    const float length = glm::length(direction);
    return ambient + directed * (length > 0 ? std::max(0.0f, glm::dot(normal, direction) / length) : 0.0f);
}

} // namespace

std::vector<ProbeWays> explainGrid(const LightProbe& probe, const LightGrid& shape, std::vector<GridCell>& grid) {
    std::vector<ProbeWays> explained(grid.size());
    parallelFor(grid.size(), [&](size_t i) {
        GridCell& cell = grid[i];
        if (cell.valid == 0) return;
        std::mt19937 random(static_cast<unsigned>(i)); // by cell: the same grid on any number of cores
        const float length = glm::length(cell.direction);
        const vec3 axis = length > 0.0f ? cell.direction / length : vec3(0, 0, 1);
        const LightProbe::Seen seen = probe.look(pointOf(shape, i), axis, kCellRays, random);
        explained[i] = seen.irradiance;
        cell.sunSeen = seen.sunSeen;
        takeAway(explained[i], cell.surfaces);
        takeAway(explained[i], cell.models);
    });
    return explained;
}

void raiseGrid(std::vector<GridCell>& grid, const std::vector<ProbeWays>& explained, const vec3& ambient,
               const vec3& floor) {
    for (size_t i = 0; i < grid.size(); ++i) {
        GridCell& cell = grid[i];
        if (cell.valid == 0) continue;
        cell.surfaces.ambient = glm::max(cell.surfaces.ambient, ambient);
        vec3 lacking(0.0f);
        for (size_t k = 0; k < explained[i].size(); ++k) {
            const vec3 given = explained[i][k] + cell.surfaces.ambient + (k == 0 ? cell.surfaces.directed : vec3(0.0f));
            lacking += glm::max(floor - given, vec3(0.0f));
        }
        cell.surfaces.ambient += lacking / static_cast<float>(explained[i].size());
    }
}

std::vector<LuxelLack> findLacks(const World& world, const MaterialLibrary& materials, const LightProbe& probe) {
    const double square = double(world.grid.cellSize.x) * world.grid.cellSize.y;
    const auto count = static_cast<size_t>(kLuxelsPerCell * luxelAreaQu2(world, materials) / square);
    const std::vector<Luxel> luxels = sampleLuxels(world, materials, count, 1);
    std::vector<LuxelLack> lacks(luxels.size());
    parallelFor(luxels.size(), [&](size_t i) {
        const Luxel& luxel = luxels[i];
        const vec3 point = luxel.position + kLuxelOffsetQu * luxel.normal;
        if (world.clusterOf(point) < 0) return; // covered by another face
        std::mt19937 random(static_cast<unsigned>(i));
        lacks[i] = {luxel.position, luxel.normal,
                    sumOf(luxel.baked - probe.look(point, luxel.normal, kLuxelRays, random).irradiance[0]), true};
    });
    std::erase_if(lacks, [](const LuxelLack& lack) { return !lack.isOpen; });
    return lacks;
}

void capGrid(const LightGrid& shape, std::vector<GridCell>& grid, const std::vector<LuxelLack>& lacks) {
    struct Sum {
        double lacks = 0, has = 0;
        float share() const {
            const double most = std::max(0.0, lacks);
            return has > most ? static_cast<float>(most / has) : 1.0f;
        }
    };
    std::vector<Sum> sums(grid.size());
    std::vector<char> isAsked(grid.size(), 0);
    Sum all;
    for (const LuxelLack& lack : lacks) {
        const CellMix mix = mixAt(shape, grid, lack.position);
        const double has = sumOf(lightOf(grid, mix, lack.normal));
        if (mix.count == 0) continue;
        all.lacks += lack.light;
        all.has += has;
        for (size_t k = 0; k < mix.count; ++k) {
            sums[mix.cell[k]].lacks += double(mix.weight[k]) * lack.light;
            sums[mix.cell[k]].has += mix.weight[k] * has;
            isAsked[mix.cell[k]] = 1;
        }
    }
    for (size_t i = 0; i < grid.size(); ++i) {
        const float share = (isAsked[i] != 0 ? sums[i] : all).share();
        grid[i].surfaces.ambient *= share;
        grid[i].surfaces.directed *= share;
    }
}

} // namespace q3rt
