#include "renderer_rt/grid_fit.hpp"

#include <algorithm>
#include <span>

#include "base/parallel.hpp"
#include "renderer_rt/grid_light.hpp"
#include "renderer_rt/surface_class.hpp"
#include "scene/luxels.hpp"

namespace q3rt {

namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using uint = uint32_t;

#include "lib/grid_mix.glsl"

constexpr uint32_t kLuxelRays = 64;
/// Off by so much says little of a luxel, as relighting has it; a bright one counts less for one unit than a dark one.
constexpr float kToleranceLuxels = 3, kToleranceShare = 0.1f;
/// Luxels looked at for each square of the grid.
constexpr double kLuxelsPerCell = 8;
/// No more of a map of absurd extent: its light is noise, and loading it must end.
constexpr double kMostLuxels = 1 << 20;
/// How many luxels at a cell's own place outweigh what it begins with. Neighbours that share their luxels can't be told
/// apart: this keeps one from taking the light of the other.
constexpr float kFirstGuessLuxels = 2;
/// Of all cells. A round leaves half of what is left to do where luxels face along the cells' direction and against it.
constexpr int kRounds = 12;

/// The cells that a point takes its light from, as the shaders weigh them (shaders/rt/grid.glsl): weights sum to 1.
struct CellMix {
    uint32_t count = 0;
    uint32_t cell[8];
    float weight[8];
    bool isBehind = true; ///< all of them behind the surface, if there are any
};

template <typename IsUsed>
CellMix mixAt(const LightGrid& shape, const LuxelLack& luxel, const IsUsed& isUsed) {
    const GridShape grid{shape.origin, shape.cellSize, shape.counts};
    const GridPlace place = placeInGrid(grid, luxel.position);
    const vec3 front = luxel.isThin ? vec3(0) : luxel.normal;
    CellMix mix;
    float total = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const GridCorner at = findGridCorner(grid, place, front, corner);
        if (at.weight == 0 || !isUsed(at.cell)) continue;
        mix.cell[mix.count] = at.cell;
        mix.weight[mix.count++] = at.weight;
        total += at.weight;
    }
    for (uint32_t k = 0; k < mix.count; ++k)
        mix.weight[k] /= total;
    mix.isBehind = total <= kGridBehindShare;
    return mix;
}

/// Of the light that comes along the cells' direction, what a luxel takes.
float facingOf(const std::vector<GridCell>& grid, const CellMix& mix, const LuxelLack& luxel) {
    vec3 direction(0);
    for (uint32_t k = 0; k < mix.count; ++k)
        direction += mix.weight[k] * grid[mix.cell[k]].direction;
    const float length = glm::length(direction);
    if (!(length > 0)) return 0;
    const float facing = glm::dot(luxel.normal, direction) / length;
    return luxel.isThin ? std::abs(facing) : std::max(0.0f, facing);
}

CellMix mixOfValid(const LightGrid& shape, const std::vector<GridCell>& grid, const LuxelLack& luxel) {
    return mixAt(shape, luxel, [&](uint32_t cell) { return grid[cell].surfaces.valid; });
}

vec3 lightOf(const std::vector<GridCell>& grid, const CellMix& mix, float facing) {
    vec3 sum(0);
    for (uint32_t k = 0; k < mix.count; ++k) {
        const GridShare& light = grid[mix.cell[k]].surfaces;
        sum += mix.weight[k] * (light.ambient + facing * light.directed);
    }
    return sum;
}

/// Least squares by Gauss and Seidel: one unknown after the other is set to its best value beside all others.
class GridFit {
  public:
    GridFit(const LightGrid& shape, std::vector<GridCell>& grid, const std::vector<LuxelLack>& lacks)
        : m_grid(grid)
        , m_takers(grid.size())
        , m_first(grid.size()) {
        for (const LuxelLack& lack : lacks) {
            const CellMix mix = mixOfValid(shape, grid, lack);
            if (mix.count == 0) continue;
            for (uint32_t k = 0; k < mix.count; ++k)
                m_takers[mix.cell[k]].push_back({static_cast<uint32_t>(m_luxels.size()), mix.weight[k]});
            m_luxels.push_back({mix, facingOf(grid, mix, lack), lack.light, lack.weight});
        }
    }

    void darkenUnasked() {
        vec3 has(0), lacks(0);
        for (const AskedLuxel& luxel : m_luxels) {
            has += lightOf(luxel);
            lacks += luxel.lack;
        }
        const float all = has.x + has.y + has.z, most = std::max(0.0f, lacks.x + lacks.y + lacks.z);
        for (size_t i = 0; i < m_grid.size() && all > most; ++i) {
            if (!m_takers[i].empty()) continue;
            m_grid[i].surfaces.ambient *= most / all;
            m_grid[i].surfaces.directed *= most / all;
        }
    }

    void begin() {
        for (size_t i = 0; i < m_grid.size(); ++i) {
            if (m_takers[i].empty()) continue;
            vec3 sum(0);
            float weight = 0;
            for (const Taker& taker : m_takers[i]) {
                const AskedLuxel& luxel = m_luxels[taker.luxel];
                sum += taker.weight * luxel.weight * luxel.lack;
                weight += taker.weight * luxel.weight;
            }
            m_first[i] = glm::max(sum / weight, vec3(0));
            m_grid[i].surfaces.ambient = m_first[i];
            m_grid[i].surfaces.directed = vec3(0);
            m_grid[i].isFitted = true;
        }
        for (AskedLuxel& luxel : m_luxels)
            luxel.lack -= lightOf(luxel);
    }

    void improve() {
        for (size_t i = 0; i < m_grid.size(); ++i) {
            if (m_takers[i].empty()) continue;
            GridShare& light = m_grid[i].surfaces;
            improve(m_takers[i], m_first[i], light.ambient, [](const AskedLuxel&) { return 1.0f; });
            improve(m_takers[i], vec3(0), light.directed, [](const AskedLuxel& luxel) { return luxel.facing; });
        }
    }

  private:
    struct AskedLuxel {
        CellMix mix;
        float facing;
        vec3 lack;    ///< since begin(): what the grid does not give it yet
        float weight; ///< how much it counts
    };
    struct Taker {
        uint32_t luxel;
        float weight;
    };
    std::vector<GridCell>& m_grid;
    std::vector<AskedLuxel> m_luxels;
    std::vector<std::vector<Taker>> m_takers; ///< by cell
    std::vector<vec3> m_first;                ///< what a cell begins with

    vec3 lightOf(const AskedLuxel& luxel) const { return q3rt::lightOf(m_grid, luxel.mix, luxel.facing); }

    template <typename ShareTaken>
    void improve(std::span<const Taker> takers, const vec3& first, vec3& light, const ShareTaken& shareTaken) {
        float taken = 0, counted = 0;
        for (const Taker& taker : takers) {
            taken += taker.weight;
            counted += taker.weight * m_luxels[taker.luxel].weight;
        }
        const float guess = kFirstGuessLuxels * counted / taken;
        vec3 sum = guess * (first - light);
        float size = guess;
        for (const Taker& taker : takers) {
            const AskedLuxel& luxel = m_luxels[taker.luxel];
            const float share = taker.weight * shareTaken(luxel);
            sum += luxel.weight * share * luxel.lack;
            size += luxel.weight * share * share;
        }
        const vec3 better = glm::max(light + sum / size, vec3(0));
        for (const Taker& taker : takers)
            m_luxels[taker.luxel].lack -= taker.weight * shareTaken(m_luxels[taker.luxel]) * (better - light);
        light = better;
    }
};

} // namespace

std::vector<LuxelLack> findLacks(const World& world, const MaterialLibrary& materials, const LightGrid& shape,
                                 const LightProbe& probe, const vec3& ambient, const vec3& floor) {
    const double square = double(shape.cellSize.x) * shape.cellSize.y;
    const double wanted = kLuxelsPerCell * luxelAreaQu2(world, materials, LuxelFaces::AllBaked) / square;
    const auto count = static_cast<size_t>(wanted < kMostLuxels ? wanted : kMostLuxels); // not a number: the most
    const std::vector<Luxel> luxels = sampleLuxels(world, materials, LuxelFaces::AllBaked, count, 1);
    std::vector<LuxelLack> lacks(luxels.size());
    parallelFor(luxels.size(), [&](size_t i) {
        const Luxel& luxel = luxels[i];
        const vec3 offset = kLuxelOffsetQu * luxel.normal;
        if (world.clusterOf(samplePointOf(luxel)) < 0) return; // covered by another face
        std::mt19937 random(static_cast<unsigned>(i));
        const LightProbe::Seen seen = probe.look(samplePointOf(luxel), luxel.normal, kLuxelRays, random);
        vec3 lights = ambient + seen.irradiance[0];
        const bool thin = isThin(materials.get(world.surfaces[static_cast<size_t>(luxel.surface)].material));
        if (thin) lights += probe.look(luxel.position - offset, -luxel.normal, kLuxelRays, random).irradiance[0];
        const vec3 light = glm::max(luxel.baked, floor);
        lacks[i] = {luxel.position, luxel.normal, light - lights, seen.sunSeen, thin, true};
        lacks[i].weight = 1 / (kToleranceLuxels + kToleranceShare * std::max({light.x, light.y, light.z}));
    });
    std::erase_if(lacks, [](const LuxelLack& lack) { return !lack.isOpen; });
    return lacks;
}

void openCells(const World& world, const LightGrid& shape, std::vector<GridCell>& grid,
               const std::vector<LuxelLack>& lacks) {
    std::vector<bool> mayOpen(grid.size());
    for (size_t i = 0; i < grid.size(); ++i)
        mayOpen[i] = grid[i].surfaces.valid || world.clusterOf(pointOf(shape, i)) >= 0;
    const std::vector<bool> isOpen = mayOpen;
    for (const LuxelLack& lack : lacks) {
        if (!mixAt(shape, lack, [&](uint32_t cell) { return isOpen[cell]; }).isBehind) continue;
        const CellMix around = mixAt(shape, lack, [](uint32_t) { return true; });
        for (uint32_t k = 0; k < around.count; ++k)
            mayOpen[around.cell[k]] = true;
    }
    std::vector<float> weight(grid.size(), 0), sunSeen(grid.size(), 0);
    for (const LuxelLack& lack : lacks) {
        const CellMix mix = mixAt(shape, lack, [&](uint32_t cell) { return mayOpen[cell]; });
        for (uint32_t k = 0; k < mix.count; ++k) {
            weight[mix.cell[k]] += mix.weight[k];
            sunSeen[mix.cell[k]] += mix.weight[k] * lack.sunSeen;
        }
    }
    for (size_t i = 0; i < grid.size(); ++i) {
        if (grid[i].surfaces.valid || !(weight[i] > 0)) continue;
        grid[i].surfaces.valid = true;
        grid[i].sunSeen = sunSeen[i] / weight[i];
    }
}

void fitGrid(const LightGrid& shape, std::vector<GridCell>& grid, const std::vector<LuxelLack>& lacks) {
    GridFit fit(shape, grid, lacks);
    fit.darkenUnasked();
    fit.begin();
    for (int round = 0; round < kRounds; ++round)
        fit.improve();
}

void explainGrid(const World& world, const MaterialLibrary& materials, const LightProbe& probe, const LightSet& lights,
                 LightTables& tables) {
    const LightGrid& shape = tables.gridShape;
    std::vector<GridCell>& grid = tables.grid;
    const std::vector<ProbeWays> explained = explainGrid(probe, shape, grid);
    const std::vector<LuxelLack> lacks = findLacks(world, materials, shape, probe, lights.ambient, lights.floor);
    openCells(world, shape, grid, lacks);
    fitGrid(shape, grid, lacks);
    raiseGrid(grid, explained, lights.ambient, lights.floor);
    if (!world.grid.empty()) return;
    for (GridCell& cell : grid)
        cell.models = cell.surfaces; // all that is known
}

vec3 lightOfGrid(const LightGrid& shape, const std::vector<GridCell>& grid, const LuxelLack& luxel) {
    const CellMix mix = mixOfValid(shape, grid, luxel);
    return lightOf(grid, mix, facingOf(grid, mix, luxel));
}

} // namespace q3rt
