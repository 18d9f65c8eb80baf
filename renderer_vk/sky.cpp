#include "renderer_vk/sky.hpp"

#include <algorithm>
#include <cmath>

#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

constexpr float kEmptyMin = 9999.0f, kEmptyMax = -9999.0f;
constexpr float kSideEpsilon = 0.1f; // of the unnormalised dot product
constexpr float kLeastDepth = 0.001f;
constexpr float kWorldRadiusQu = 4096.0f; // of the sphere that clouds lie on

// Planes through the eye that cut space into the six face pyramids.
constexpr std::array<vec3, 6> kClipNormals = {vec3(1, 1, 0), vec3(1, -1, 0), vec3(0, -1, 1),
                                              vec3(0, 1, 1), vec3(1, 0, 1),  vec3(-1, 0, 1)};

/// Which axis carries s, t and depth of each face, with signs: index 1..3 = x, y, z.
struct FaceAxes {
    int s, t, depth;
};
constexpr std::array<FaceAxes, kSkyFaces> kFaceAxes = {FaceAxes{-2, 3, 1},  FaceAxes{2, 3, -1},  FaceAxes{1, 3, 2},
                                                       FaceAxes{-1, 3, -2}, FaceAxes{-2, -1, 3}, FaceAxes{-2, 1, -3}};

float component(const vec3& v, int axis) { return axis > 0 ? v[axis - 1] : -v[-axis - 1]; }

int faceOf(const vec3& sum) {
    const vec3 a = glm::abs(sum);
    if (a.x > a.y && a.x > a.z) return sum.x < 0 ? 1 : 0;
    if (a.y > a.z && a.y > a.x) return sum.y < 0 ? 3 : 2;
    return sum.z < 0 ? 5 : 4;
}

float gridCoordinate(int line) { return static_cast<float>(line) / (kSkyBlocks / 2) - 1.0f; }

} // namespace

SkyCoverage::SkyCoverage() { m_points.reserve(busyFrame::kSmall); }

void SkyCoverage::clear() {
    m_mins.fill(vec2(kEmptyMin));
    m_maxs.fill(vec2(kEmptyMax));
}

void SkyCoverage::addTriangle(const vec3& a, const vec3& b, const vec3& c) {
    m_points.assign({a, b, c});
    clip(0, 0);
}

/// Pushes the part of a polygon that lies in front of a plane through the eye, or near it.
void SkyCoverage::appendSide(size_t firstPoint, size_t endPoint, const vec3& inwardNormal) {
    for (size_t i = firstPoint; i < endPoint; ++i) {
        const vec3 point = m_points[i], next = m_points[i + 1 < endPoint ? i + 1 : firstPoint];
        const float d = glm::dot(point, inwardNormal), e = glm::dot(next, inwardNormal);
        if (d >= -kSideEpsilon) m_points.push_back(point);
        const bool crosses = (d > kSideEpsilon && e < -kSideEpsilon) || (d < -kSideEpsilon && e > kSideEpsilon);
        if (crosses) m_points.push_back(point + (next - point) * (d / (d - e)));
    }
}

/// Takes the polygon on top of the stack apart by `plane` and those after it, and removes it.
void SkyCoverage::clip(size_t firstPoint, size_t plane) {
    const size_t endPoint = m_points.size();
    for (; plane < kClipNormals.size(); ++plane) {
        const vec3& normal = kClipNormals[plane];
        bool front = false, back = false;
        for (size_t i = firstPoint; i < endPoint; ++i) {
            const float distance = glm::dot(m_points[i], normal);
            front |= distance > kSideEpsilon;
            back |= distance < -kSideEpsilon;
        }
        if (front && back) break;
    }
    if (plane < kClipNormals.size()) {
        for (const float side : {1.0f, -1.0f}) {
            appendSide(firstPoint, endPoint, kClipNormals[plane] * side);
            clip(endPoint, plane + 1);
        }
    } else {
        addPolygon(std::span(m_points).subspan(firstPoint));
    }
    m_points.resize(firstPoint);
}

void SkyCoverage::addPolygon(std::span<const vec3> polygon) {
    vec3 sum(0.0f);
    for (const vec3& point : polygon)
        sum += point;
    const auto face = static_cast<size_t>(faceOf(sum));
    const FaceAxes& axes = kFaceAxes[face];
    for (const vec3& point : polygon) {
        const float depth = component(point, axes.depth);
        if (depth < kLeastDepth) continue;
        const vec2 st(component(point, axes.s) / depth, component(point, axes.t) / depth);
        m_mins[face] = glm::min(m_mins[face], st);
        m_maxs[face] = glm::max(m_maxs[face], st);
    }
}

SkyCoverage::BlockRange SkyCoverage::blocks(int face) const {
    constexpr float kHalf = kSkyBlocks / 2;
    const auto index = static_cast<size_t>(face);
    if (m_mins[index].x >= m_maxs[index].x || m_mins[index].y >= m_maxs[index].y) return {};
    const auto line = [&](float value, bool up) {
        const float scaled = up ? std::ceil(value * kHalf) : std::floor(value * kHalf);
        return static_cast<int>(std::clamp(scaled, -kHalf, kHalf) + kHalf);
    };
    return {line(m_mins[index].x, false), line(m_maxs[index].x, true), line(m_mins[index].y, false),
            line(m_maxs[index].y, true)};
}

vec3 skyDirection(int face, float s, float t) {
    const FaceAxes& axes = kFaceAxes[static_cast<size_t>(face)];
    vec3 result(0.0f);
    const auto set = [&](int axis, float value) { result[std::abs(axis) - 1] = axis > 0 ? value : -value; };
    set(axes.s, s);
    set(axes.t, t);
    set(axes.depth, 1.0f);
    return result;
}

vec2 cloudCoordinates(const vec3& direction, float heightQu) {
    const dvec3 k(direction);
    const double r = kWorldRadiusQu, h = heightQu;
    const double square = glm::dot(k, k);
    const double p = (-k.z * r + std::sqrt(k.z * k.z * r * r + square * (2.0 * r * h + h * h))) / square;
    const dvec3 q = glm::normalize(p * k + dvec3(0, 0, r));
    return vec2(std::acos(q.x), std::acos(q.y));
}

SkyFaceRange appendSkyFace(const SkyCoverage& coverage, int face, const vec3& eye, float halfSizeQu,
                           float cloudHeightQu, std::vector<Vertex>& vertices, std::vector<uint32_t>& indices) {
    const SkyCoverage::BlockRange range = coverage.blocks(face);
    SkyFaceRange result{static_cast<uint32_t>(indices.size()), 0};
    if (range.empty()) return result;
    const auto first = static_cast<uint32_t>(vertices.size());
    const auto rowLength = static_cast<uint32_t>(range.lastS - range.firstS + 1);
    for (int t = range.firstT; t <= range.lastT; ++t) {
        for (int s = range.firstS; s <= range.lastS; ++s) {
            const float fs = gridCoordinate(s), ft = gridCoordinate(t);
            const vec3 direction = skyDirection(face, fs, ft);
            Vertex vertex{};
            vertex.position = eye + direction * halfSizeQu;
            vertex.st = cloudCoordinates(direction, cloudHeightQu);
            vertex.lightmapSt = vec2((fs + 1) * 0.5f, 1 - (ft + 1) * 0.5f);
            vertex.color = 0xFFFFFFFFu;
            vertices.push_back(vertex);
        }
    }
    for (uint32_t t = 0; t + 1 < static_cast<uint32_t>(range.lastT - range.firstT + 1); ++t) {
        for (uint32_t s = 0; s + 1 < rowLength; ++s) {
            const uint32_t a = first + t * rowLength + s, up = a + rowLength;
            // Clockwise as seen from inside, s to the right and t up.
            const uint32_t quad[6] = {a, up, a + 1, a + 1, up, up + 1};
            indices.insert(indices.end(), quad, quad + 6);
        }
    }
    result.indexCount = static_cast<uint32_t>(indices.size()) - result.firstIndex;
    return result;
}

} // namespace q3rt
