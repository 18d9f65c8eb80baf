#include "scene/triangle_cull.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

// Pixels by which a corner may lie elsewhere for the driver: half a step of its 1/256 grid, and rounding of float at
// coordinates below 16384, with as much again.
constexpr float kSlackPx = 1.0f / 64.0f;
constexpr float kLeastW = 1e-3f;     // qu: nearer corners have no place on the screen
constexpr float kDepthSlack = 1e-5f; // of w: rounding of the near plane's test

// Where a vertex is outside.
constexpr int kLeft = 1, kRight = 2, kAbove = 4, kBelow = 8, kNear = 16;
constexpr int kUnknown = 32; // no place on the screen

constexpr float kFewSamples = 8; // a triangle whose box holds more nearly always covers one

// A smaller triangle hides less than its depth costs: any value from 100 to 1500 serves as well.
constexpr float kLargePx = 400;

constexpr size_t kLanes = 4;
using FourIndices = std::array<uint32_t, 3 * kLanes>;

/// Samples of one axis of the view that may lie in [least, greatest]; none if last < first.
struct SampleRange {
    SampleRange(Float4 least, Float4 greatest, float slackPx, float sizePx)
        : first(maximum(roundUp(nearView(least - slackPx - 0.5f, sizePx)), Float4{}))
        , last(minimum(roundDown(nearView(greatest + slackPx - 0.5f, sizePx)), Float4{} + (sizePx - 1.0f))) {}
    static Float4 nearView(Float4 px, float sizePx) { return minimum(maximum(px, Float4{} - 1.0f), Float4{} + sizePx); }
    Float4 count() const { return last - first + 1.0f; }
    Float4 first, last;
};

/// One corner of four triangles. Arithmetic is that of the lanes; `outside` has the bits above.
struct Corners {
    Corners(const std::vector<Float4>& screen, const FourIndices& indices, size_t corner)
        : x(screen[indices[corner]])
        , y(screen[indices[corner + 3]]) {
        Float4 third = screen[indices[corner + 6]], fourth = screen[indices[corner + 9]];
        transpose(x, y, third, fourth);
        outside = std::bit_cast<Int4>(third);
    }
    vec2 px(size_t lane) const { return {x[lane], y[lane]}; }
    Float4 x, y;
    Int4 outside;
};

/// Four triangles on the screen.
class FourTriangles {
  public:
    FourTriangles(const TriangleView& view, const std::vector<Float4>& screen, const FourIndices& indices);
    bool noneShows() const { return std::bit_cast<std::array<uint64_t, 2>>(m_mayShow) == std::array<uint64_t, 2>{}; }
    bool shows(size_t lane) const { return m_mayShow[lane] != 0 && (m_shows[lane] != 0 || coversSample(lane)); }
    bool large(size_t lane) const { return m_unplaced[lane] != 0 || std::abs(m_area[lane]) >= 2.0f * kLargePx; }

  private:
    bool coversSample(size_t lane) const;
    Corners m_a, m_b, m_c;
    SampleRange m_columns, m_rows;
    Float4 m_area;     // twice, px^2; clockwise on the screen, whose y points down, is positive: the front
    Float4 m_doubtful; // of m_area: what rounding may have made
    Int4 m_unplaced;   // a corner has no place on the screen
    Int4 m_mayShow;    // it doesn't if this is 0,
    Int4 m_shows;      // and does if this isn't; between the two the samples decide
};

Float4 leastOf(Float4 a, Float4 b, Float4 c) { return minimum(a, minimum(b, c)); }
Float4 greatestOf(Float4 a, Float4 b, Float4 c) { return maximum(a, maximum(b, c)); }

float slackOf(const TriangleView& view) { return view.manySamples ? 0.5f + kSlackPx : kSlackPx; }

FourTriangles::FourTriangles(const TriangleView& view, const std::vector<Float4>& screen, const FourIndices& indices)
    : m_a(screen, indices, 0)
    , m_b(screen, indices, 1)
    , m_c(screen, indices, 2)
    , m_columns(leastOf(m_a.x, m_b.x, m_c.x), greatestOf(m_a.x, m_b.x, m_c.x), slackOf(view), view.sizePx.x)
    , m_rows(leastOf(m_a.y, m_b.y, m_c.y), greatestOf(m_a.y, m_b.y, m_c.y), slackOf(view), view.sizePx.y) {
    m_area = (m_b.x - m_a.x) * (m_c.y - m_a.y) - (m_b.y - m_a.y) * (m_c.x - m_a.x);
    const Float4 extent = greatestOf(m_a.x, m_b.x, m_c.x) - leastOf(m_a.x, m_b.x, m_c.x) +
                          greatestOf(m_a.y, m_b.y, m_c.y) - leastOf(m_a.y, m_b.y, m_c.y);
    m_doubtful = 2.0f * kSlackPx * (extent + kSlackPx);
    m_unplaced = ((m_a.outside | m_b.outside | m_c.outside) & (kUnknown | kNear)) != 0;
    m_mayShow = (m_columns.count() >= 1.0f) & (m_rows.count() >= 1.0f);
    if (view.cull != CullMode::None) {
        const bool frontShows = (view.cull == CullMode::Front) != view.mirrored;
        m_mayShow &= frontShows ? m_area > -m_doubtful : m_area < m_doubtful;
    }
    m_mayShow |= m_unplaced;
    m_mayShow &= (m_a.outside & m_b.outside & m_c.outside & ~kUnknown) == 0;
    m_shows = m_unplaced | (m_columns.count() * m_rows.count() > kFewSamples) | (magnitude(m_area) <= m_doubtful);
    if (view.manySamples) m_shows = m_mayShow;
}

float cross(const vec2& a, const vec2& b) { return a.x * b.y - a.y * b.x; }

bool FourTriangles::coversSample(size_t lane) const {
    const vec2 a = m_a.px(lane), b = m_b.px(lane), c = m_c.px(lane);
    const float turn = m_area[lane] > 0 ? 1.0f : -1.0f;
    for (float row = m_rows.first[lane]; row <= m_rows.last[lane]; ++row) {
        for (float column = m_columns.first[lane]; column <= m_columns.last[lane]; ++column) {
            const vec2 sample(column + 0.5f, row + 0.5f);
            const float outside = std::min({turn * cross(b - a, sample - a), //
                                            turn * cross(c - b, sample - b), //
                                            turn * cross(a - c, sample - c)});
            if (outside > -m_doubtful[lane]) return true;
        }
    }
    return false;
}

/// The least and the greatest.
std::pair<uint32_t, uint32_t> rangeOf(std::span<const uint32_t> numbers) {
    uint32_t least = numbers[0], greatest = numbers[0];
    for (const uint32_t number : numbers) {
        least = std::min(least, number);
        greatest = std::max(greatest, number);
    }
    return {least, greatest};
}

} // namespace

bool rectangleShows(const vec2& corner, const vec2& opposite, const vec2& viewSizePx) {
    const auto holdsSample = [](float a, float b, float sizePx) {
        const Float4 from = Float4{} + std::min(a, b), to = Float4{} + std::max(a, b);
        return SampleRange(from, to, kSlackPx, sizePx).count()[0] >= 1.0f;
    };
    return holdsSample(corner.x, opposite.x, viewSizePx.x) && holdsSample(corner.y, opposite.y, viewSizePx.y);
}

TriangleCuller::TriangleCuller() { m_screen.reserve(busyFrame::kWorkVertices); }

Q3RT_NEWER_PROCESSORS_TOO
void TriangleCuller::project(const TriangleView& view, const Positions& positions, size_t first, size_t count) {
    const mat4& m = view.clipFromModel;
    const vec2 edge = 1.0f + 2.0f * kSlackPx / view.sizePx, half = 0.5f * view.sizePx;
    m_screen.resize((count + kLanes - 1) / kLanes * kLanes);
    for (size_t i = 0; i < count; i += kLanes) {
        // Past the end the last one is done again.
        const auto load = [&](size_t lane) { return positions.at(first + std::min(i + lane, count - 1)); };
        Float4 x = load(0), y = load(1), z = load(2), unused = load(3);
        transpose(x, y, z, unused);
        const auto row = [&](int r) { return (m[0][r] * x + m[1][r] * y) + (m[2][r] * z + m[3][r]); };
        const Float4 clipX = row(0), clipY = row(1), clipZ = row(2), w = row(3);
        const Float4 edgeX = w * edge.x, edgeY = w * edge.y, placed = maximum(w, Float4{} + kLeastW);
        Int4 outside = ((clipX < -edgeX) & kLeft) | ((clipX > edgeX) & kRight) | ((clipY < -edgeY) & kAbove) |
                       ((clipY > edgeY) & kBelow) | ((clipZ < -kDepthSlack * magnitude(w)) & kNear) |
                       (~(w > kLeastW) & kUnknown);
        Float4 pxX = (clipX / placed + 1.0f) * half.x, pxY = (clipY / placed + 1.0f) * half.y;
        Float4 bits = std::bit_cast<Float4>(outside);
        transpose(pxX, pxY, bits, unused);
        m_screen[i] = pxX;
        m_screen[i + 1] = pxY;
        m_screen[i + 2] = bits;
        m_screen[i + 3] = unused;
    }
}

Q3RT_NEWER_PROCESSORS_TOO
void TriangleCuller::cull(const TriangleView& view, const Positions& positions, std::vector<uint32_t>& indices,
                          size_t first, std::vector<uint32_t>* occluders) {
    if (first >= indices.size()) return;
    const auto [least, greatest] = rangeOf(std::span(indices).subspan(first));
    project(view, positions, least, greatest - least + 1);
    const size_t end = indices.size() - (indices.size() - first) % 3;
    size_t kept = first;
    for (size_t i = first; i < end; i += 3 * kLanes) {
        const size_t count = std::min(end - i, 3 * kLanes);
        FourIndices onScreen{}; // what is missing of the last four is some triangle of no size
        for (size_t k = 0; k < count; ++k)
            onScreen[k] = indices[i + k] - least;
        const FourTriangles triangles(view, m_screen, onScreen);
        if (triangles.noneShows()) continue; // nearly always, of a model far away
        for (size_t lane = 0; lane < count / 3; ++lane) {
            if (!triangles.shows(lane)) continue;
            for (size_t k = 3 * lane; k < 3 * lane + 3; ++k) {
                indices[kept++] = onScreen[k] + least;
                if (occluders && triangles.large(lane)) occluders->push_back(onScreen[k] + least);
            }
        }
    }
    indices.resize(kept);
}

} // namespace q3rt
