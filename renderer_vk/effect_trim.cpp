#include "renderer_vk/effect_trim.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace q3rt {

namespace {

constexpr float kNearestW = 1.0f; // qu: what is nearer is left alone

// Depths of the corners may differ by this factor: texels a pixel then differ by its square, less than the two between
// what is asked for and what the part holds for.
constexpr float kMostTilt = 1.1f;

// Of the square's size: how far the fourth corner may be from where the others want it. Pixels move by less than a
// tenth of that of a square as large as the screen.
constexpr float kRoughness = 1e-4f;

/// First and last texel with something, of columns or of rows; first > last: none.
struct TexelRange {
    int first, last;
};

template <typename HasSomething>
TexelRange findRange(int count, const HasSomething& hasSomething) {
    TexelRange range{0, count - 1};
    while (range.first <= range.last && !hasSomething(range.first))
        ++range.first;
    while (range.last > range.first && !hasSomething(range.last))
        --range.last;
    return range;
}

/// Filters reach half a texel beyond its border; as much again is for the driver's rounding.
void addRange(const TexelRange& range, int count, bool clamped, float& least, float& greatest) {
    if (range.first > range.last) return;
    const auto size = static_cast<float>(count);
    float from = static_cast<float>(range.first - 1) / size, to = static_cast<float>(range.last + 2) / size;
    if (from < 0 || to > 1) {
        // What touches one side of a texture that repeats comes in at the other.
        from = clamped ? std::max(from, 0.0f) : 0.0f;
        to = clamped ? std::min(to, 1.0f) : 1.0f;
    }
    least = std::min(least, from);
    greatest = std::max(greatest, to);
}

template <typename TexelHasSomething>
TexturePart findPart(const Texture& texture, const TexelHasSomething& texelHasSomething) {
    TexturePart part{vec2(1.0f), vec2(0.0f)};
    constexpr size_t kLevels = 2; // full size and half
    for (size_t i = 0; i < std::min(kLevels, texture.levels.size()); ++i) {
        const MipLevel& level = texture.levels[i];
        const auto texel = [&](int x, int y) {
            return texelHasSomething(&level.rgba[(static_cast<size_t>(y) * level.width + x) * 4]);
        };
        const auto row = [&](int y) {
            for (int x = 0; x < level.width; ++x)
                if (texel(x, y)) return true;
            return false;
        };
        const auto column = [&](int x) {
            for (int y = 0; y < level.height; ++y)
                if (texel(x, y)) return true;
            return false;
        };
        const bool clamped = texture.flags.clamp;
        addRange(findRange(level.height, row), level.height, clamped, part.least.y, part.greatest.y);
        addRange(findRange(level.width, column), level.width, clamped, part.least.x, part.greatest.x);
    }
    const bool empty = part.least.x >= part.greatest.x || part.least.y >= part.greatest.y;
    return empty ? TexturePart{} : part;
}

/// Corners by s + 2 t.
using Corners = std::array<Vertex*, 4>;

bool findCorners(std::span<Vertex, 4> square, Corners& corners) {
    corners = {};
    for (Vertex& vertex : square) {
        const vec2& st = vertex.st;
        if ((st.x != 0 && st.x != 1) || (st.y != 0 && st.y != 1) || vertex.color != square[0].color) return false;
        corners[static_cast<size_t>(st.x + 2 * st.y)] = &vertex;
    }
    if (std::ranges::find(corners, nullptr) != corners.end()) return false;
    const vec3 across = corners[3]->position - corners[0]->position;
    const vec3 gap = corners[1]->position + corners[2]->position - corners[0]->position - corners[3]->position;
    return glm::dot(gap, gap) <= kRoughness * kRoughness * glm::dot(across, across);
}

/// Texels a pixel, the more of the two directions; a large number if it can't be said.
float texelsPerPixel(const Corners& corners, const vec2& sizeTexels, const TriangleView& view) {
    constexpr float kMany = 1e9f;
    std::array<vec2, 4> px;
    float leastW = kMany, greatestW = 0;
    for (size_t i = 0; i < 4; ++i) {
        const vec4 clip = view.clipFromModel * vec4(corners[i]->position, 1.0f);
        leastW = std::min(leastW, clip.w);
        greatestW = std::max(greatestW, clip.w);
        px[i] = vec2(clip) / std::max(clip.w, kNearestW) * 0.5f * view.sizePx;
    }
    if (!(leastW >= kNearestW && greatestW <= kMostTilt * leastW)) return kMany;
    const vec2 s = px[1] - px[0], t = px[2] - px[0];
    const float area = std::abs(s.x * t.y - s.y * t.x);
    const float most = std::max(sizeTexels.x * glm::length(t), sizeTexels.y * glm::length(s));
    return area > 0 ? most / area : kMany;
}

} // namespace

TextureParts findTextureParts(const Texture& texture) {
    TextureParts parts;
    const MipLevel& base = texture.levels.front();
    parts.sizeTexels = vec2(base.width, base.height);
    if (base.rgba.empty()) return parts;
    parts.withAlpha = findPart(texture, [](const uint8_t* texel) { return texel[3] != 0; });
    parts.withColor = findPart(texture, [](const uint8_t* texel) { return (texel[0] | texel[1] | texel[2]) != 0; });
    return parts;
}

TexturePart findPartShown(const Stage& stage, const StageState& state, const TextureParts& parts) {
    const TextureUnitState& unit = state.unit[0];
    const bool once = state.combine == kCombineSingle && unit.coord == kCoordTexture && unit.modCount == 0;
    if (!once || !stage.blended || stage.depthWrite) return {};
    const BlendFactor source = stage.source, destination = stage.destination;
    const bool keepsWhereClear = destination == BlendFactor::One || destination == BlendFactor::OneMinusSrcAlpha;
    if (source == BlendFactor::SrcAlpha && keepsWhereClear) return parts.withAlpha;
    const bool keepsWhereBlack = destination == BlendFactor::One || destination == BlendFactor::OneMinusSrcColor;
    return source == BlendFactor::One && keepsWhereBlack ? parts.withColor : TexturePart{};
}

void trimSquare(std::span<Vertex, 4> square, const TexturePart& part, const vec2& sizeTexels,
                const TriangleView& view) {
    Corners corners;
    if (!findCorners(square, corners) || texelsPerPixel(corners, sizeTexels, view) > 1.0f) return;
    const std::array<vec3, 4> p = {corners[0]->position, corners[1]->position, corners[2]->position,
                                   corners[3]->position};
    for (size_t i = 0; i < 4; ++i) {
        const vec2 st(i & 1 ? part.greatest.x : part.least.x, i & 2 ? part.greatest.y : part.least.y);
        corners[i]->st = st;
        corners[i]->position = glm::mix(glm::mix(p[0], p[1], st.x), glm::mix(p[2], p[3], st.x), st.y);
    }
}

} // namespace q3rt
