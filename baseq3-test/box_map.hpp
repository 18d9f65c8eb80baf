#pragma once
// Maps made of axis-aligned boxes of air; all else is solid. Boxes must not overlap; where two touch, the wall between
// them is open. From this description the generator makes a complete IBSP-46 map with baked light.

#include <string>
#include <vector>

#include "baseq3-test/form_factor.hpp"
#include "formats/bsp.hpp"
#include "math/vector.hpp"

namespace q3rt {

/// Integer box, qu. Flat in one axis where it stands for a rectangle.
struct IntBox {
    ivec3 mins{0}, maxs{0};

    bool contains(const IntBox& other) const {
        return glm::all(glm::lessThanEqual(mins, other.mins)) && glm::all(glm::lessThanEqual(other.maxs, maxs));
    }
    bool touches(const IntBox& other) const {
        return glm::all(glm::lessThanEqual(mins, other.maxs)) && glm::all(glm::lessThanEqual(other.mins, maxs));
    }
};

/// A room or a piece of one. Boxes that share a cluster see each other always.
struct AirBox {
    IntBox box;
    int cluster = 0;
    std::string wallShader;
};

/// A rectangle in a wall, floor or ceiling with a shader of its own; emits light if surfaceLight > 0.
struct WallPanel {
    IntBox rectangle; ///< flat, lies in a side of an air box
    std::string shader;
    float surfaceLight = 0; ///< q3map_surfacelight of that shader
    vec3 lightColor{1};     ///< q3map_lightRGB of that shader, largest component 1
};

struct BoxMap {
    std::vector<AirBox> air;
    std::vector<WallPanel> panels;
    std::string entities; ///< whole lump
};

/// An opening between two boxes of air.
struct BoxPortal {
    size_t from = 0, to = 0;
    IntBox rectangle;
};

/// One quadrilateral of a side of a box.
struct BoxFace {
    size_t airBox = 0;
    int axis = 0;     ///< of the normal
    int towards = 1;  ///< +1 or -1: sign of the normal, which points into the air
    IntBox rectangle; ///< flat in `axis`
    int panel = -1;   ///< index in BoxMap::panels, -1 wall
};

/// Corners of a flat box, clockwise as seen from the side that axis * towards points to.
RectangleCorners computeCorners(const IntBox& rectangle, int axis, int towards);

std::vector<BoxPortal> findPortals(const BoxMap& map);
std::vector<BoxFace> buildFaces(const BoxMap& map, const std::vector<BoxPortal>& portals);

/// Cluster rows of bits: b is visible from a unless no straight line passes all the openings of any way from a to b.
/// Conservative: lines are looked for in the three axis projections.
struct BoxVisibility {
    int clusterCount = 0, rowBytes = 0;
    std::vector<uint8_t> rows;
};
BoxVisibility computeVisibility(const BoxMap& map, const std::vector<BoxPortal>& portals);

/// Direct light at a point on a side of air box `airBox`, in luxel units: each light in 8 x 8 parts, each part exact
/// where its centre is seen. Exact as a whole where nothing hides any part.
dvec3 computeIrradiance(const BoxMap& map, const std::vector<BoxPortal>& portals, const std::vector<BoxFace>& faces,
                        size_t airBox, const dvec3& point, const dvec3& normal);

/// The complete map. Throws UsageError for a description that can't be built (overlapping boxes, a panel in no wall).
Bsp buildBoxMap(const BoxMap& map);

} // namespace q3rt
