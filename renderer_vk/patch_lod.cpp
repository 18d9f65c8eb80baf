#include "renderer_vk/patch_lod.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

namespace {

/// The outer lines of a grid and those whose error shows.
bool isKept(const std::vector<float>& errors, int line, int count, float allowed) {
    return line == 0 || line == count - 1 || errors[static_cast<size_t>(line)] <= allowed;
}

} // namespace

void appendPatchIndices(const WorldSurface& surface, const PatchGrid& grid, const RasterView& view,
                        const mat4& worldFromModel, float curveError, std::vector<uint32_t>& out) {
    const vec3 origin(worldFromModel * vec4(grid.lodOrigin, 1.0f));
    const float depth = std::abs(glm::dot(view.eye.axis[0], origin - view.eye.origin)) - grid.lodRadius;
    const float allowed = curveError < 0 ? 0.0f : curveError / std::max(depth, 1.0f);
    const auto at = [&](int row, int column) {
        return surface.firstVertex + static_cast<uint32_t>(row * grid.width + column);
    };
    int up = 0;
    for (int row = 1; row < grid.height; ++row) {
        if (!isKept(grid.rowError, row, grid.height, allowed)) continue;
        int left = 0;
        for (int column = 1; column < grid.width; ++column) {
            if (!isKept(grid.columnError, column, grid.width, allowed)) continue;
            const uint32_t cell[6] = {at(up, left),   at(row, left), at(up, column),
                                      at(up, column), at(row, left), at(row, column)};
            out.insert(out.end(), cell, cell + 6);
            left = column;
        }
        up = row;
    }
}

} // namespace q3rt
