#pragma once
// The sky: which blocks of a cube around the eye its polygons cover, and the box and cloud geometry of those blocks
// (spec of world section 5).

#include <array>
#include <span>
#include <vector>

#include "math/vector.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Far distance over the half size of the sky cube: its corners stay inside.
inline constexpr float kSkyPart = 1.75f;
inline constexpr int kSkyFaces = 6;      ///< +X -X +Y -Y +Z -Z: images rt lf bk ft up dn
inline constexpr int kSkyCloudFaces = 5; ///< clouds never show below
inline constexpr int kSkyBlocks = 8;     ///< blocks a face side

/// Covered part of each face in s, t of [-1, 1].
class SkyCoverage {
  public:
    SkyCoverage();
    void clear();
    /// One triangle, relative to the eye.
    void addTriangle(const vec3& a, const vec3& b, const vec3& c);
    struct BlockRange {
        int firstS = 0, lastS = 0, firstT = 0, lastT = 0; ///< grid lines, 0..8; empty if first >= last
        bool empty() const { return firstS >= lastS || firstT >= lastT; }
    };
    /// Rounded outward to whole blocks.
    BlockRange blocks(int face) const;

  private:
    void clip(size_t firstPoint, size_t plane);
    void appendSide(size_t firstPoint, size_t endPoint, const vec3& inwardNormal);
    void addPolygon(std::span<const vec3> polygon);
    std::array<vec2, kSkyFaces> m_mins{}, m_maxs{};
    std::vector<vec3> m_points; ///< a stack of polygons, the one that is being clipped on top
};

/// Direction of grid point (s, t) of a face; length 1 along the face's axis.
vec3 skyDirection(int face, float s, float t);
/// Cloud texture coordinates in radians for a direction and a cloud height in qu.
vec2 cloudCoordinates(const vec3& direction, float heightQu);

struct SkyFaceRange {
    uint32_t firstIndex = 0, indexCount = 0;
};
/// Appends the covered blocks of a face at `eye` + direction * halfSizeQu. Texture coordinates are those of the cloud
/// layer, lightmap coordinates 0..1 those of the box's picture.
SkyFaceRange appendSkyFace(const SkyCoverage& coverage, int face, const vec3& eye, float halfSizeQu,
                           float cloudHeightQu, std::vector<Vertex>& vertices, std::vector<uint32_t>& indices);

} // namespace q3rt
