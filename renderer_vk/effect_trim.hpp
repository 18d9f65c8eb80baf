#pragma once
// Effects are pictures with wide empty margins: of a square of one only the part that shows is drawn. Pure CPU.

#include <span>

#include "renderer_vk/triangle_cull.hpp"
#include "scene/stage_table.hpp"
#include "scene/texture.hpp"

namespace q3rt {

/// Texture coordinates outside which a texture has nothing, drawn no smaller than half its size.
struct TexturePart {
    vec2 least{0.0f}, greatest{1.0f};
    void add(const TexturePart& other) {
        least = glm::min(least, other.least);
        greatest = glm::max(greatest, other.greatest);
    }
};

struct TextureParts {
    vec2 sizeTexels{1.0f};
    TexturePart withAlpha, withColor; ///< outside alpha is 0, or red, green and blue are
};

TextureParts findTextureParts(const Texture& texture);

/// Where a stage leaves something; all of the texture if that isn't known.
TexturePart findPartShown(const Stage& stage, const StageState& state, const TextureParts& parts);

/// Makes a square as small as the part of its texture. Left alone: what is not a parallelogram of one colour that holds
/// the whole texture once, and what is so small or so tilted on the screen that smaller mip levels may be read.
void trimSquare(std::span<Vertex, 4> square, const TexturePart& part, const vec2& sizeTexels, const TriangleView& view);

} // namespace q3rt
