#pragma once
// Where in the map's tree the search for a point's cluster begins: the deepest node that holds all of the cell of a
// regular grid that the point is in. Of a dozen steps from the root two or three are left.

#include <vector>

#include "math/vector.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

struct NodeStarts {
    vec3 origin{0};
    float cellQu = 1;
    ivec3 counts{0};
    std::vector<int32_t> starts; ///< as RtNode::front; x runs fastest
};

/// Of points inside the bounds; empty without nodes.
NodeStarts findNodeStarts(const std::vector<RtNode>& nodes, const vec3& mins, const vec3& maxs);

} // namespace q3rt
