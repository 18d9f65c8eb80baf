#include "renderer_vk/lit_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace q3rt {

namespace {

// A light's picture spans radius / 2 to each side in x and y; its border is black for another thirty-second of that,
// more than any rounding of texture coordinates.
constexpr float kHalfSpan = 0.5f;
constexpr float kLeastW = 1e-3f; // qu: what is nearer has no place on the screen
constexpr float kSlackPx = 1.0f; // samples beside a pixel's centre, and rounding

/// Of a point: inside where it is not negative.
struct HalfSpace {
    vec3 normal;
    float offset;
    float at(const vec3& p) const { return glm::dot(normal, p) + offset; }
};

/// A triangle, cut by up to five planes. A cut adds a corner at most for each that it takes: 3, 4, 6, 9, 13, 19.
struct Polygon {
    std::array<vec3, 19> corners;
    size_t count = 0;
};

Polygon cut(const Polygon& polygon, const HalfSpace& space) {
    Polygon kept;
    for (size_t i = 0; i < polygon.count; ++i) {
        const vec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const float atA = space.at(a), atB = space.at(b);
        if (atA >= 0) kept.corners[kept.count++] = a;
        if ((atA >= 0) != (atB >= 0)) kept.corners[kept.count++] = a + (b - a) * (atA / (atA - atB));
    }
    return kept;
}

/// Before the eye, and in the column over and under the light that its picture fills.
std::array<HalfSpace, 5> litSpaces(const mat4& clipFromModel, const RasterLight& light) {
    const vec3& o = light.origin;
    const float half = kHalfSpan * light.radius;
    const vec4 w = glm::transpose(clipFromModel)[3];
    return {{{vec3(w), w.w - kLeastW},
             {vec3(1, 0, 0), half - o.x},
             {vec3(-1, 0, 0), half + o.x},
             {vec3(0, 1, 0), half - o.y},
             {vec3(0, -1, 0), half + o.y}}};
}

/// The light's strength at a corner is 0, by the very arithmetic of the vertex shader.
bool dark(const RasterLight& light, const vec3& corner) { return std::abs(light.origin.z - corner.z) > light.radius; }

} // namespace

PixelBox appendLitTriangles(const TriangleView& view, const RasterLight& light, std::span<const Vertex> vertices,
                            std::vector<uint32_t>& indices, size_t first, size_t count) {
    const auto spaces = litSpaces(view.clipFromModel, light);
    vec2 least = view.sizePx, greatest(0.0f);
    for (size_t i = first; i + 2 < first + count; i += 3) {
        const std::array<uint32_t, 3> triangle = {indices[i], indices[i + 1], indices[i + 2]};
        Polygon polygon;
        for (const uint32_t index : triangle)
            polygon.corners[polygon.count++] = vertices[index].position;
        if (std::all_of(polygon.corners.begin(), polygon.corners.begin() + 3,
                        [&](const vec3& corner) { return dark(light, corner); }))
            continue;
        for (const HalfSpace& space : spaces)
            polygon = cut(polygon, space);
        vec2 from = view.sizePx, to(0.0f);
        for (size_t k = 0; k < polygon.count; ++k) {
            const vec4 clip = view.clipFromModel * vec4(polygon.corners[k], 1.0f);
            const vec2 px = (vec2(clip) / std::max(clip.w, kLeastW * 0.5f) + 1.0f) * (0.5f * view.sizePx);
            from = glm::min(from, px - kSlackPx);
            to = glm::max(to, px + kSlackPx);
        }
        from = glm::max(from, vec2(0.0f));
        to = glm::min(to, view.sizePx);
        if (!(from.x < to.x && from.y < to.y)) continue;
        least = glm::min(least, from);
        greatest = glm::max(greatest, to);
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    return {glm::ivec2(glm::floor(least)), glm::ivec2(glm::ceil(greatest))};
}

} // namespace q3rt
