#include "scene/bsp_clip.hpp"

#include <algorithm>
#include <limits>

namespace q3rt {
namespace {

/// The part of a convex polygon with dot(normal, p) - distance >= -slack.
Polygon clipToFront(const Polygon& polygon, const vec3& normal, float distance, float slackQu) {
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float da = glm::dot(normal, a) - distance + slackQu;
        const float db = glm::dot(normal, b) - distance + slackQu;
        if (da >= 0.0f) kept.push_back(a);
        if ((da >= 0.0f) != (db >= 0.0f)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

/// The part of a box that may lie in front of a plane: exact for planes across an axis, all of it for others.
Bounds cutBox(Bounds box, const vec3& normal, float distance) {
    for (int axis = 0; axis < 3; ++axis) {
        if (normal[(axis + 1) % 3] != 0.0f || normal[(axis + 2) % 3] != 0.0f || normal[axis] == 0.0f) continue;
        const float at = distance / normal[axis];
        if (normal[axis] > 0.0f)
            box.mins[axis] = std::max(box.mins[axis], at);
        else
            box.maxs[axis] = std::min(box.maxs[axis], at);
    }
    return box;
}

} // namespace

void visitLeafs(const Bsp& bsp, Polygon polygon, float slackQu,
                const std::function<void(const BspLeaf& leaf, const Polygon& part)>& visit) {
    struct Part {
        int child;
        Polygon polygon;
    };
    std::vector<Part> open;
    open.push_back({bsp.nodes.empty() ? -1 : 0, std::move(polygon)});
    while (!open.empty()) {
        const Part part = std::move(open.back());
        open.pop_back();
        if (part.polygon.empty()) continue;
        if (part.child < 0) {
            visit(bsp.leafs[static_cast<size_t>(-1 - part.child)], part.polygon);
            continue;
        }
        const BspNode& node = bsp.nodes[static_cast<size_t>(part.child)];
        const Plane& plane = bsp.planes[static_cast<size_t>(node.plane)];
        open.push_back({node.children[0], clipToFront(part.polygon, plane.normal, plane.distance, slackQu)});
        open.push_back({node.children[1], clipToFront(part.polygon, -plane.normal, -plane.distance, slackQu)});
    }
}

std::vector<Bounds> boundClusters(const Bsp& bsp) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<Bounds> boxes(static_cast<size_t>(bsp.clusterCount));
    struct Part {
        int child;
        Bounds box;
    };
    std::vector<Part> open{{bsp.nodes.empty() ? -1 : 0, {vec3(-kInfinity), vec3(kInfinity)}}};
    while (!open.empty()) {
        const Part part = open.back();
        open.pop_back();
        if (glm::any(glm::greaterThan(part.box.mins, part.box.maxs))) continue;
        if (part.child < 0) {
            const int cluster = bsp.leafs[static_cast<size_t>(-1 - part.child)].cluster;
            if (cluster >= 0 && cluster < bsp.clusterCount) boxes[static_cast<size_t>(cluster)].add(part.box);
            continue;
        }
        const BspNode& node = bsp.nodes[static_cast<size_t>(part.child)];
        const Plane& plane = bsp.planes[static_cast<size_t>(node.plane)];
        open.push_back({node.children[0], cutBox(part.box, plane.normal, plane.distance)});
        open.push_back({node.children[1], cutBox(part.box, -plane.normal, -plane.distance)});
    }
    return boxes;
}

} // namespace q3rt
