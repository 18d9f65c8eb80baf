#pragma once
// Triangles that no pixel shows, left out before they are drawn: a software driver takes longer over one than this
// does. Pure CPU.

#include <cstddef>
#include <ranges>
#include <vector>

#include "math/lanes.hpp"
#include "scene/material.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Where triangles are drawn, and which side of them shows.
struct TriangleView {
    mat4 clipFromModel{1.0f};
    vec2 sizePx{0}; ///< of the viewport
    CullMode cull = CullMode::Front;
    bool mirrored = false;
    bool manySamples = false; ///< a pixel has samples beside its centre
};

/// Where vertices are: each begins with three floats, and four may be read.
struct Positions {
    template <std::ranges::contiguous_range List>
    Positions(const List& list)
        : first(std::ranges::data(list))
        , strideBytes(sizeof(std::ranges::range_value_t<List>))
        , count(std::ranges::size(list)) {}
    Float4 at(size_t i) const { return loadFloat4(static_cast<const std::byte*>(first) + i * strideBytes); }
    const void* first;
    size_t strideBytes, count;
};

/// Does the middle of a pixel lie in this rectangle, or so near that the driver may see it there? Pixels.
bool rectangleShows(const vec2& corner, const vec2& opposite, const vec2& viewSizePx);

class TriangleCuller {
  public:
    TriangleCuller();
    /// Removes from `indices`, beginning at `first`, the triangles that are wholly outside the view, turn their hidden
    /// side to the eye or lie between samples. What the driver's rounding might decide otherwise is kept.
    /// Those that stay and are large, so that much may lie behind them, are appended to `occluders`, if there is one.
    void cull(const TriangleView& view, const Positions& positions, std::vector<uint32_t>& indices, size_t first,
              std::vector<uint32_t>* occluders = nullptr);

  private:
    void project(const TriangleView& view, const Positions& positions, size_t first, size_t count);
    /// Of each vertex in the span of the indices: x, y in pixels, and where it is outside as the bits of an integer.
    std::vector<Float4> m_screen;
};

} // namespace q3rt
