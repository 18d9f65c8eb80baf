#include "renderer_rt/grid_light.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace q3rt {

namespace {

constexpr uint32_t kCellRays = 32;

/// What is left, by channel: along the direction what is not explained there, elsewhere no more than is not explained
/// across and behind. Never below 0.
void takeAway(const ProbeWays& explained, GridShare& light) {
    const vec3 around = (explained[1] + explained[2] + explained[3] + explained[4] + explained[5]) / 5.0f;
    const vec3 along = glm::max(light.ambient + light.directed - explained[0], vec3(0.0f));
    light.ambient = glm::min(glm::max(light.ambient - around, vec3(0.0f)), along);
    light.directed = along - light.ambient;
}

} // namespace

vec3 pointOf(const LightGrid& shape, size_t cell) {
    const auto nx = static_cast<size_t>(shape.counts.x), ny = static_cast<size_t>(shape.counts.y);
    return shape.origin + shape.cellSize * vec3(static_cast<float>(cell % nx), static_cast<float>(cell / nx % ny),
                                                static_cast<float>(cell / (nx * ny)));
}

std::vector<ProbeWays> explainGrid(const LightProbe& probe, const LightGrid& shape, std::vector<GridCell>& grid) {
    std::vector<ProbeWays> explained(grid.size());
    parallelFor(grid.size(), [&](size_t i) {
        GridCell& cell = grid[i];
        if (!cell.models.valid) return;
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
        if (cell.isFitted) cell.surfaces.ambient += ambient;
        if (cell.isFitted || !cell.surfaces.valid) continue;
        cell.surfaces.ambient = glm::max(cell.surfaces.ambient, ambient);
        vec3 lacking(0.0f);
        for (size_t k = 0; k < explained[i].size(); ++k) {
            const vec3 given = explained[i][k] + cell.surfaces.ambient + (k == 0 ? cell.surfaces.directed : vec3(0.0f));
            lacking += glm::max(floor - given, vec3(0.0f));
        }
        cell.surfaces.ambient += lacking / static_cast<float>(explained[i].size());
    }
}

} // namespace q3rt
