#pragma once
// Effects are pictures with wide empty margins: of a square of one only the part that shows is drawn. Pure CPU.

#include <array>
#include <span>

#include "scene/triangle_cull.hpp"
#include "scene/stage_table.hpp"
#include "scene/texture.hpp"

namespace q3rt {

/// Texture coordinates outside which a texture has nothing; and a circle, outside which it has nothing either.
struct TexturePart {
    vec2 least{0.0f}, greatest{1.0f};
    vec2 centre{0.5f};
    float radius = 1.0f;
    bool whole() const { return least == vec2(0.0f) && greatest == vec2(1.0f); }
    bool empty() const { return least.x >= greatest.x || least.y >= greatest.y; }
};

struct TextureParts {
    static constexpr size_t kDepths = 5;
    vec2 sizeTexels{1.0f};
    bool clamped = false;
    /// Outside alpha is 0, or red, green and blue are: by depth d, drawn with no more than 2^d texels a pixel.
    std::array<TexturePart, kDepths> withAlpha, withColor;
};

TextureParts findTextureParts(const Texture& texture);

/// Of a square that holds a texture once, [0, 1] of both axes, where a stage leaves something; all of it if that isn't
/// known. `texelsPerPixel`: if the stage doesn't move its texture.
TexturePart findPartShown(const Stage& stage, const StageState& state, const TextureParts& parts, float texelsPerPixel);

/// A parallelogram of one colour that holds the whole texture once, on the screen.
class EffectSquare {
  public:
    EffectSquare(std::span<const Vertex, 4> square, const TriangleView& view);
    /// False: it is none, or is so tilted that it can't be said which mip levels are read. Then it is to be left alone.
    bool usable() const { return m_usable; }
    /// The more of the two directions.
    float texelsPerPixel(const vec2& sizeTexels) const;
    /// The part of it, in the order of the square's vertices.
    void write(const TexturePart& part, std::span<Vertex, 4> out) const;

  private:
    bool findCorners();
    bool place(const TriangleView& view);
    std::array<Vertex, 4> m_square;
    std::array<size_t, 4> m_corners{};     ///< by s + 2 t: which vertex
    vec2 m_acrossS{0.0f}, m_acrossT{0.0f}; ///< px
    bool m_usable = false;
};

} // namespace q3rt
