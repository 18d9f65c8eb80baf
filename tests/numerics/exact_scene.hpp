#pragma once
// Rays against triangles in double precision: what single precision is held against. Our own tree only names
// candidates, by boxes that are rounded outwards.

#include <vector>

#include "accel/bvh.hpp"
#include "math/vector.hpp"

namespace q3rt::test {

class ExactScene {
  public:
    /// 3 corners a triangle.
    explicit ExactScene(std::vector<dvec3> corners);
    /// Is anything at t in (tMin, tMax), in units of |direction|?
    bool isHit(const dvec3& origin, const dvec3& direction, double tMin, double tMax) const;

  private:
    bool meets(size_t triangle, const dvec3& origin, const dvec3& direction, double tMin, double tMax) const;
    std::vector<dvec3> m_corners;
    Bvh m_bvh;
};

} // namespace q3rt::test
