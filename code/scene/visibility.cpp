// Point queries on a loaded map: leaf, potentially visible set, fog (spec of world 3.1, 6.2 and 9).

#include "scene/world.hpp"

namespace q3rt {

int World::leafOf(const vec3& point) const {
    if (bsp.nodes.empty()) return 0;
    int child = 0;
    while (child >= 0) {
        const BspNode& node = bsp.nodes[static_cast<size_t>(child)];
        const Plane& plane = bsp.planes[static_cast<size_t>(node.plane)];
        child = node.children[glm::dot(plane.normal, point) - plane.distance > 0.0f ? 0 : 1];
    }
    return -1 - child;
}

bool World::inPvs(const vec3& from, const vec3& to) const {
    const int target = clusterOf(to);
    if (bsp.visibility.empty()) return true;
    int source = clusterOf(from);
    if (source < 0 || source >= bsp.clusterCount) source = 0;
    const size_t row = static_cast<size_t>(source) * static_cast<size_t>(bsp.clusterRowBytes);
    // Cluster -1 addresses the last bit before the row, as the original's lookup does; row 0 has nothing before it.
    if (target < 0) return row > 0 && (bsp.visibility[row - 1] & 0x80) != 0;
    if (target >= bsp.clusterCount) return false;
    return (bsp.visibility[row + static_cast<size_t>(target >> 3)] >> (target & 7) & 1) != 0;
}

int World::fogOf(const Bounds& box) const {
    for (size_t i = 1; i < fogs.size(); ++i) {
        const Bounds& fog = fogs[i].bounds;
        if (glm::all(glm::lessThan(box.mins, fog.maxs)) && glm::all(glm::greaterThan(box.maxs, fog.mins))) {
            return static_cast<int>(i);
        }
    }
    return 0;
}

} // namespace q3rt
