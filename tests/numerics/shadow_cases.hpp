#pragma once
// The set-up of the shadow-ray rows: a view of a map, each pixel's surface point and a light, and whether double
// precision sees the light from there. The map may be moved far from the origin, or be a rotated instance there.

#include <optional>

#include "accel/reference/world_triangles.hpp"
#include "numerics/meshes.hpp"

namespace q3rt::test {

/// Where the map stands.
struct Placement {
    std::optional<glm::dmat3> rotation; ///< none: the corners themselves are in the world
    dvec3 move{0};
    vec4 worldFromModel[3] = {}; ///< rows, as the renderer has them
};
Placement makePlacement(float distance, bool rotated);

/// A pixel that may be lit.
struct ShadowCase {
    uint32_t triangle = 0; ///< of PlacedMap::corners
    vec2 barycentric{0};
    vec3 normal{0}; ///< unit, on the side that is seen
    vec3 light{0};
    bool hidden = false; ///< double precision: something is between the point and the light
};

struct PlacedMap {
    Placement placement;
    vec3 eye{0};     ///< world
    Corners corners; ///< of the tree's triangles: in model space if rotated
    TestScene scene;
    std::vector<ShadowCase> cases;
    size_t undecided = 0; ///< left out: what an offset may hide decides
};
/// 320 x 240 pixels.
PlacedMap makeShadowCases(const WorldTriangles& map, const Placement& placement);

} // namespace q3rt::test
