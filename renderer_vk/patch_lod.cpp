#include "renderer_vk/patch_lod.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

namespace {

void keepLines(const std::vector<float>& errors, int count, float allowed, std::vector<uint32_t>& kept) {
    kept.clear();
    for (int i = 0; i < count; ++i) {
        const bool outer = i == 0 || i == count - 1;
        if (outer || errors[static_cast<size_t>(i)] <= allowed) kept.push_back(static_cast<uint32_t>(i));
    }
}

} // namespace

void appendPatchIndices(const WorldSurface& surface, const PatchGrid& grid, const RasterView& view,
                        const mat4& worldFromModel, float curveError, std::vector<uint32_t>& out) {
    const vec3 origin(worldFromModel * vec4(grid.lodOrigin, 1.0f));
    const float depth = std::abs(glm::dot(view.eye.axis[0], origin - view.eye.origin)) - grid.lodRadius;
    const float allowed = curveError < 0 ? 0.0f : curveError / std::max(depth, 1.0f);
    std::vector<uint32_t> rows, columns;
    keepLines(grid.columnError, grid.width, allowed, columns);
    keepLines(grid.rowError, grid.height, allowed, rows);
    const auto at = [&](size_t row, size_t column) {
        return surface.firstVertex + rows[row] * static_cast<uint32_t>(grid.width) + columns[column];
    };
    for (size_t r = 0; r + 1 < rows.size(); ++r) {
        for (size_t c = 0; c + 1 < columns.size(); ++c) {
            const uint32_t cell[6] = {at(r, c),     at(r + 1, c), at(r, c + 1),
                                      at(r, c + 1), at(r + 1, c), at(r + 1, c + 1)};
            out.insert(out.end(), cell, cell + 6);
        }
    }
}

} // namespace q3rt
