// The light grid: baked light for things that move (spec of world 1.5 and 7.1).

#include <algorithm>
#include <cmath>

#include "base/log.hpp"
#include "scene/wave.hpp"
#include "scene/world.hpp"

namespace q3rt {
namespace {

constexpr size_t kRecordBytes = 8;     // ambient rgb, directed rgb, polar angle, azimuth
constexpr float kEnoughWeight = 0.99f; // below this the colours of the corners that count are rescaled

/// Table steps: a byte is 1/256 turn, the sine table has 1024 entries a turn.
vec3 decodeDirection(uint8_t polar, uint8_t azimuth) {
    const int lng = polar * 4, lat = azimuth * 4;
    const auto cosine = [](int i) { return sineTable((i + 256) & 1023); };
    return {cosine(lat) * sineTable(lng), sineTable(lat) * sineTable(lng), cosine(lng)};
}

} // namespace

LightGrid LightGrid::build(const Bsp& bsp, const vec3& cellSize, int shift) {
    LightGrid grid;
    grid.cellSize = cellSize;
    if (bsp.lightGrid.empty() || bsp.models.empty()) return grid;
    double cells = 1;
    for (int i = 0; i < 3; ++i) {
        grid.origin[i] = cellSize[i] * std::ceil(bsp.models[0].mins[i] / cellSize[i]);
        const float top = cellSize[i] * std::floor(bsp.models[0].maxs[i] / cellSize[i]);
        grid.counts[i] = static_cast<int>((top - grid.origin[i]) / cellSize[i] + 1);
        cells *= std::max(grid.counts[i], 0);
    }
    if (cells * kRecordBytes != static_cast<double>(bsp.lightGrid.size())) {
        logLine(LogLevel::Warning, "light grid ignored: %zu bytes, but %dx%dx%d cells need %.0f", bsp.lightGrid.size(),
                grid.counts.x, grid.counts.y, grid.counts.z, cells * kRecordBytes);
        return grid;
    }
    grid.m_cells.reserve(bsp.lightGrid.size() / kRecordBytes);
    for (size_t i = 0; i < bsp.lightGrid.size(); i += kRecordBytes) {
        const uint8_t* record = &bsp.lightGrid[i];
        grid.m_cells.push_back({shiftBakedLight({record[0], record[1], record[2], 255}, shift),
                                shiftBakedLight({record[3], record[4], record[5], 255}, shift),
                                decodeDirection(record[6], record[7])});
    }
    return grid;
}

GridLight LightGrid::sample(const vec3& point) const {
    GridLight light;
    if (m_cells.empty()) return light;
    // The fraction is that of the unclamped cell: outside the grid the border cells are extrapolated by design.
    const vec3 scaled = (point - origin) / cellSize;
    if (glm::any(glm::isnan(scaled))) return light;
    const vec3 base = glm::floor(scaled), fraction = scaled - base;
    const ivec3 cell(glm::clamp(base, vec3(0.0f), vec3(counts - 1)));
    float total = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 offset(corner & 1, (corner >> 1) & 1, corner >> 2);
        const ivec3 at = cell + offset;
        if (at.x >= counts.x || at.y >= counts.y || at.z >= counts.z) continue;
        const auto row = static_cast<size_t>(at.z) * static_cast<size_t>(counts.y) + static_cast<size_t>(at.y);
        const Cell& c = m_cells[row * static_cast<size_t>(counts.x) + static_cast<size_t>(at.x)];
        if (c.ambient.r + c.ambient.g + c.ambient.b == 0) continue; // inside a wall
        float weight = 1.0f;
        for (int i = 0; i < 3; ++i) {
            weight *= offset[i] ? fraction[i] : 1.0f - fraction[i];
        }
        total += weight;
        light.ambient += weight * vec3(c.ambient);
        light.directed += weight * vec3(c.directed);
        light.direction += weight * c.direction;
    }
    if (total > 0.0f && total < kEnoughWeight) {
        light.ambient /= total;
        light.directed /= total;
    }
    const float length = glm::length(light.direction);
    if (length > 0.0f) light.direction /= length;
    return light;
}

} // namespace q3rt
