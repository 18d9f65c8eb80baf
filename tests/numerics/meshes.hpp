#pragma once
// Closed meshes around their centre: every edge is shared by two triangles whose corners are the same floats.

#include <random>
#include <vector>

#include "accel/shader_traversal.hpp"
#include "math/vector.hpp"

namespace q3rt::test {

/// 3 corners a triangle.
using Corners = std::vector<vec3>;

/// An icosahedron whose faces are divided `levels` times in four, radius 1 +- 0.2, irregular. Seen from its centre no
/// part hides another.
Corners makeBumpyBall(int levels, uint32_t seed);
/// A tube of `sides` sides with its ends closed by fans, along x; length and radius 1 each: the sides are slivers.
Corners makeTube(int sides);
/// Scaled, then moved; in float, as a map compiler would store it.
Corners place(const Corners& mesh, float scale, const vec3& centre);

TestScene makeScene(const Corners& mesh);
/// The mesh as an instance: world = rotation of `scale` x model + `centre`.
TestScene makeInstanceScene(const Corners& mesh, const glm::dmat3& rotation, double scale, const dvec3& centre);
/// About an axis off all others.
glm::dmat3 makeRotation(double angleRadians);

vec3 randomDirection(std::mt19937& random);

} // namespace q3rt::test
