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

constexpr int kFewSamples = 8; // a triangle whose box holds more nearly always covers one

// A smaller triangle hides less than its depth costs: any value from 100 to 1500 serves as well.
constexpr float kLargePx = 400;

/// Samples of one axis of the view that may lie in [least, greatest]; none if last < first.
struct SampleRange {
    SampleRange(float least, float greatest, float slackPx, float sizePx)
        : first(std::max(std::ceil(least - slackPx - 0.5f), 0.0f))
        , last(std::min(std::floor(greatest + slackPx - 0.5f), sizePx - 1.0f)) {}
    float count() const { return last - first + 1.0f; }
    float first, last;
};

float cross(const vec2& a, const vec2& b) { return a.x * b.y - a.y * b.x; }

} // namespace

bool rectangleShows(const vec2& corner, const vec2& opposite, const vec2& viewSizePx) {
    const vec2 least = glm::min(corner, opposite), greatest = glm::max(corner, opposite);
    return SampleRange(least.x, greatest.x, kSlackPx, viewSizePx.x).count() >= 1.0f &&
           SampleRange(least.y, greatest.y, kSlackPx, viewSizePx.y).count() >= 1.0f;
}

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
        result.px = (vec2(clip) * (1.0f / clip.w) + 1.0f) * (0.5f * view.sizePx);
    return result;
}

bool TriangleCuller::large(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
    if ((a.outside | b.outside | c.outside) & (kUnknown | kNear)) return true;
    return std::abs(cross(b.px - a.px, c.px - a.px)) >= 2.0f * kLargePx;
}

bool TriangleCuller::shows(const TriangleView& view, const ScreenVertex& a, const ScreenVertex& b,
                           const ScreenVertex& c) {
    if (a.outside & b.outside & c.outside & ~kUnknown) return false;
    if ((a.outside | b.outside | c.outside) & (kUnknown | kNear)) return true;
    const vec2 least = glm::min(a.px, glm::min(b.px, c.px)), greatest = glm::max(a.px, glm::max(b.px, c.px));
    const float slackPx = view.manySamples ? 0.5f + kSlackPx : kSlackPx;
    const SampleRange columns(least.x, greatest.x, slackPx, view.sizePx.x),
        rows(least.y, greatest.y, slackPx, view.sizePx.y);
    if (columns.count() < 1.0f || rows.count() < 1.0f) return false;
    // Clockwise on the screen, whose y points down, is positive: the front, unless a mirror turns it round.
    const vec2 extent = greatest - least;
    const float area = cross(b.px - a.px, c.px - a.px);
    const float doubtful = 2.0f * kSlackPx * (extent.x + extent.y + kSlackPx);
    if (view.cull != CullMode::None) {
        const bool frontShows = (view.cull == CullMode::Front) != view.mirrored;
        if (frontShows ? area <= -doubtful : area >= doubtful) return false;
    }
    if (view.manySamples || columns.count() * rows.count() > kFewSamples || std::abs(area) <= doubtful) return true;
    const float turn = area > 0 ? 1.0f : -1.0f;
    for (float row = rows.first; row <= rows.last; ++row) {
        for (float column = columns.first; column <= columns.last; ++column) {
            const vec2 sample(column + 0.5f, row + 0.5f);
            const float outside = std::min({turn * cross(b.px - a.px, sample - a.px), //
                                            turn * cross(c.px - b.px, sample - b.px), //
                                            turn * cross(a.px - c.px, sample - c.px)});
            if (outside > -doubtful) return true;
        }
    }
    return false;
}

void TriangleCuller::cull(const TriangleView& wanted, std::span<const Vertex> vertices, std::vector<uint32_t>& indices,
                          size_t first, std::vector<uint32_t>* occluders) {
    if (first >= indices.size()) return;
    const TriangleView view = wanted; // a copy that nothing written here may be: its part of the work is done once
    const auto range = std::minmax_element(indices.begin() + static_cast<std::ptrdiff_t>(first), indices.end());
    const uint32_t least = *range.first, count = *range.second - least + 1;
    m_screen.resize(count);
    for (uint32_t i = 0; i < count; ++i)
        m_screen[i] = project(view, vertices[least + i].position);
    size_t kept = first;
    for (size_t i = first; i + 2 < indices.size(); i += 3) {
        const uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        const ScreenVertex &onA = m_screen[a - least], &onB = m_screen[b - least], &onC = m_screen[c - least];
        if (!shows(view, onA, onB, onC)) continue;
        if (occluders && large(onA, onB, onC)) occluders->insert(occluders->end(), {a, b, c});
        indices[kept] = a;
        indices[kept + 1] = b;
        indices[kept + 2] = c;
        kept += 3;
    }
    indices.resize(kept);
}

} // namespace q3rt
