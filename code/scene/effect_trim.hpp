#pragma once
// Effects are pictures with wide empty margins: of a square of one only the part that shows is drawn or traced. Pure
// CPU.

#include <array>
#include <span>
#include <vector>

#include "math/vector.hpp"
#include "scene/texture.hpp"
#include "shaders/shared/stage.h"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Texture coordinates outside which a texture has nothing; and a circle, outside which it has nothing either. A
/// clamped texture that has something at a side goes on beyond it.
struct TexturePart {
    vec2 least{0.0f}, greatest{1.0f};
    vec2 centre{0.5f};
    float radius = 1.0f;
    bool whole() const { return least == vec2(0.0f) && greatest == vec2(1.0f); }
    bool empty() const { return least.x >= greatest.x || least.y >= greatest.y; }
};

/// Cells of a texture, a row a word: which of them have something.
inline constexpr size_t kTextureCells = 32;
using TextureCells = std::array<uint32_t, kTextureCells>;

struct TextureParts {
    static constexpr size_t kDepths = 5;
    vec2 sizeTexels{1.0f};
    bool clamped = false;
    /// Outside alpha is 0, or red, green and blue are: by depth d, drawn with no more than 2^d texels a pixel.
    std::array<TexturePart, kDepths> withAlpha, withColor;
    /// The same cell by cell, by coarsest mip level that is read. Empty: nobody looked.
    std::vector<TextureCells> cellsWithAlpha, cellsWithColor;
};

TextureParts findTextureParts(const Texture& texture);

/// Of a square that holds a texture once, [0, 1] of both axes, where a stage leaves something; all of it if that isn't
/// known. `texelsPerPixel`: if the stage doesn't move its texture.
TexturePart findPartShown(const StageState& state, const TextureParts& parts, float texelsPerPixel);

/// A parallelogram of one colour that holds the whole texture once, on the screen.
class EffectSquare {
  public:
    /// `sizePx`: of the picture that clip coordinates from -w to w are.
    EffectSquare(std::span<const Vertex, 4> square, const mat4& clipFromModel, const vec2& sizePx);
    /// False: it is none, or is so tilted that it can't be said which mip levels are read. Then it is to be left alone.
    bool usable() const { return m_usable; }
    /// The more of the two directions.
    float texelsPerPixel(const vec2& sizeTexels) const;
    /// Most texels from a pixel to the next, as any driver may reckon them, of a texture that a matrix turns.
    float mostTexelsPerPixel(const vec2& sizeTexels, const glm::mat2& turn) const;
    /// The part of it, in the order of the square's vertices.
    void write(const TexturePart& part, std::span<Vertex, 4> out) const;

  private:
    bool findCorners();
    bool place(const mat4& clipFromModel, const vec2& sizePx);
    std::array<Vertex, 4> m_square;
    std::array<size_t, 4> m_corners{};     ///< by s + 2 t: which vertex
    vec2 m_acrossS{0.0f}, m_acrossT{0.0f}; ///< px
    float m_tilt = 1;                      ///< greatest depth of a corner over the least
    bool m_usable = false;
};

/// Cells of a square, a bit each by rows of t: where something shows.
inline constexpr uint32_t kSquareCells = 16;
using SquareCells = std::array<uint16_t, kSquareCells>;

/// findPartShown() cell by cell: tighter where what a clamped texture has at a side makes stripes beyond it. All of it
/// if the texture turns.
SquareCells findCellsShown(const StageState& state, const TextureParts& parts, const EffectSquare& square);

} // namespace q3rt
