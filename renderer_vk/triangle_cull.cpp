#include "renderer_vk/triangle_cull.hpp"

#include <algorithm>
#include <cmath>

#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

// Pixels by which a corner may lie elsewhere for the driver: half a step of its 1/256 grid, and rounding of float at
// coordinates below 16384, with as much again.
constexpr float kSlackPx = 1.0f / 64.0f;
constexpr float kLeastW = 1e-3f;     // qu: nearer corners have no place on the screen
constexpr float kDepthSlack = 1e-5f; // of w: rounding of the near plane's test

constexpr uint32_t kLeft = 1, kRight = 2, kAbove = 4, kBelow = 8, kNear = 16;
constexpr uint32_t kUnknown = 32; // no place on the screen

/// Is there a sample in [least, greatest] of one axis?
bool holdsSample(float least, float greatest, float slackPx) {
    return std::floor(greatest + slackPx - 0.5f) >= std::ceil(least - slackPx - 0.5f);
}

} // namespace

TriangleCuller::TriangleCuller() { m_screen.reserve(busyFrame::kWorkVertices); }

TriangleCuller::ScreenVertex TriangleCuller::project(const TriangleView& view, const vec3& position) {
    const vec4 clip = view.clipFromModel * vec4(position, 1.0f);
    const vec2 edge = clip.w * (1.0f + 2.0f * kSlackPx / view.sizePx);
    ScreenVertex result{vec2(0.0f), 0};
    if (clip.x < -edge.x) result.outside |= kLeft;
    if (clip.x > edge.x) result.outside |= kRight;
    if (clip.y < -edge.y) result.outside |= kAbove;
    if (clip.y > edge.y) result.outside |= kBelow;
    if (clip.z < -kDepthSlack * std::abs(clip.w)) result.outside |= kNear;
    if (!(clip.w > kLeastW))
        result.outside |= kUnknown;
    else
        result.px = (vec2(clip) / clip.w + 1.0f) * 0.5f * view.sizePx;
    return result;
}

bool TriangleCuller::shows(const TriangleView& view, const ScreenVertex& a, const ScreenVertex& b,
                           const ScreenVertex& c) {
    if (a.outside & b.outside & c.outside & ~kUnknown) return false;
    if ((a.outside | b.outside | c.outside) & (kUnknown | kNear)) return true;
    const vec2 least = glm::min(a.px, glm::min(b.px, c.px)), greatest = glm::max(a.px, glm::max(b.px, c.px));
    const float slackPx = view.manySamples ? 0.5f + kSlackPx : kSlackPx;
    if (!holdsSample(least.x, greatest.x, slackPx) || !holdsSample(least.y, greatest.y, slackPx)) return false;
    if (view.cull == CullMode::None) return true;
    const vec2 ab = b.px - a.px, ac = c.px - a.px, extent = greatest - least;
    // Clockwise on the screen, whose y points down, is positive: the front, unless a mirror turns it round.
    const float area = ab.x * ac.y - ab.y * ac.x;
    const float doubtful = 2.0f * kSlackPx * (extent.x + extent.y + kSlackPx);
    const bool frontShows = (view.cull == CullMode::Front) != view.mirrored;
    return frontShows ? area > -doubtful : area < doubtful;
}

void TriangleCuller::cull(const TriangleView& view, std::span<const Vertex> vertices, std::vector<uint32_t>& indices,
                          size_t first) {
    if (first >= indices.size()) return;
    const auto range = std::minmax_element(indices.begin() + static_cast<std::ptrdiff_t>(first), indices.end());
    const uint32_t least = *range.first, count = *range.second - least + 1;
    m_screen.resize(count);
    for (uint32_t i = 0; i < count; ++i)
        m_screen[i] = project(view, vertices[least + i].position);
    size_t kept = first;
    for (size_t i = first; i + 2 < indices.size(); i += 3) {
        const uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (!shows(view, m_screen[a - least], m_screen[b - least], m_screen[c - least])) continue;
        indices[kept] = a;
        indices[kept + 1] = b;
        indices[kept + 2] = c;
        kept += 3;
    }
    indices.resize(kept);
}

} // namespace q3rt
