#pragma once
// Where a dynamic light can change a picture: its own picture is black from the border on, so that most of what a lit
// surface covers stays as it is. Pure CPU.

#include <span>
#include <vector>

#include "scene/triangle_cull.hpp"
#include "shaders/shared/raster.h"

namespace q3rt {

/// Pixels of a view, counted from its top-left corner: from <= p < to. Empty as it is made.
struct PixelBox {
    glm::ivec2 from{0}, to{0};
    bool empty() const { return from.x >= to.x || from.y >= to.y; }
};

/// Appends to `indices` those triangles of [first, first + count) in it that the light, in their own space, brightens
/// anywhere in the view. Outside of the box that it returns it adds nothing to any pixel.
PixelBox appendLitTriangles(const TriangleView& view, const RasterLight& light, std::span<const Vertex> vertices,
                            std::vector<uint32_t>& indices, size_t first, size_t count);

} // namespace q3rt
