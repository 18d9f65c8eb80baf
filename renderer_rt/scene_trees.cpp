#include "renderer_rt/scene_trees.hpp"

#include <cmath>

#include "gpu/device.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

namespace {

constexpr VkBufferUsageFlags kTreeUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

Bounds transformBounds(const Bounds& bounds, const mat4& transform) {
    Bounds out;
    for (int corner = 0; corner < 8; ++corner)
        out.add(vec3(transform * vec4((corner & 1) ? bounds.maxs.x : bounds.mins.x,
                                      (corner & 2) ? bounds.maxs.y : bounds.mins.y,
                                      (corner & 4) ? bounds.maxs.z : bounds.mins.z, 1.0f)));
    return out;
}

bool isFinite(const mat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row])) return false;
    return true;
}

/// Skies are looked for by themselves, and stop light.
uint8_t groupsOf(SurfaceClass surfaceClass) {
    if (surfaceClass == SurfaceClass::Sky) return kBvhSolidGroup | kBvhOtherGroup;
    return static_cast<uint8_t>(surfaceClass == SurfaceClass::Layer ? kBvhOtherGroup : kBvhSolidGroup);
}

/// Groups that rays of these masks look for.
uint8_t groupsOfMask(uint32_t mask) {
    return static_cast<uint8_t>(((mask & kMasksOfSolids) != 0 ? kBvhSolidGroup : 0) |
                                ((mask & ~kMasksOfSolids) != 0 ? kBvhOtherGroup : 0));
}

uint32_t flagsOf(SurfaceClass surfaceClass, size_t part) {
    return (isOpaqueClass(surfaceClass) ? kBvhTriangleOpaque : 0u) |
           (surfaceClass == SurfaceClass::Solid ? kBvhTriangleCullBack : 0u) |
           static_cast<uint32_t>(part) << kBvhPartShift;
}

BvhInstance describe(const TreeInstance& instance, const mat4& modelFromWorld) {
    BvhInstance out{};
    for (int row = 0; row < 3; ++row)
        out.modelFromWorld[row] = vec4(modelFromWorld[0][row], modelFromWorld[1][row], modelFromWorld[2][row],
                                       instance.worldFromModel[3][row]);
    out.nodes = instance.tree.nodes;
    out.triangles = instance.tree.triangles;
    out.customIndex = instance.customIndex;
    if (instance.worldFromModel == mat4(1.0f)) out.mask = kBvhInPlace;
    for (size_t part = 0; part < instance.masks.size(); ++part) {
        out.mask |= instance.masks[part];
        out.partMasks[part / 4] |= uint32_t{instance.masks[part]} << (8 * (part % 4));
    }
    return out;
}

} // namespace

TreeData buildTree(std::span<const TreePart> parts, bool lasting) {
    std::vector<vec3> positions;
    std::vector<TriangleLabel> labels;
    std::vector<uint8_t> groups;
    for (size_t p = 0; p < parts.size(); ++p) {
        for (const uint32_t index : parts[p].indices)
            positions.push_back(parts[p].vertices[index].position);
        const auto count = static_cast<uint32_t>(parts[p].indices.size() / 3);
        for (uint32_t number = 0; number < count; ++number)
            labels.push_back({number, flagsOf(parts[p].surfaceClass, p)});
        groups.insert(groups.end(), count, groupsOf(parts[p].surfaceClass));
    }
    const std::vector<Bounds> boxes = triangleBounds(positions);
    const BvhBuildSettings settings{.reinsert = lasting, .groups = groups};
    Bvh bvh = lasting ? buildSah(boxes, settings) : buildMorton(boxes, settings);
    std::vector<BvhTriangle> triangles = leafTriangles(bvh, positions, labels);
    return {std::move(bvh), std::move(triangles)};
}

size_t StaticTrees::add(std::span<const TreePart> parts) {
    const TreeData built = buildTree(parts, true);
    m_trees.push_back({.nodes = m_nodeList.size() * sizeof(BvhNode),
                       .triangles = m_triangleList.size() * sizeof(BvhTriangle),
                       .bounds = built.bvh.bounds});
    m_nodeList.insert(m_nodeList.end(), built.bvh.nodes.begin(), built.bvh.nodes.end());
    m_triangleList.insert(m_triangleList.end(), built.triangles.begin(), built.triangles.end());
    m_rejectedCount += built.bvh.rejectedCount;
    return m_trees.size() - 1;
}

void StaticTrees::upload(Device& device, Uploader& uploader) {
    m_nodes = Buffer(device, {.size = m_nodeList.size() * sizeof(BvhNode), .usage = kTreeUsage, .name = "tree nodes"});
    m_triangles = Buffer(
        device, {.size = m_triangleList.size() * sizeof(BvhTriangle), .usage = kTreeUsage, .name = "tree triangles"});
    if (!m_nodeList.empty()) uploader.upload(m_nodes, std::span<const BvhNode>(m_nodeList));
    if (!m_triangleList.empty()) uploader.upload(m_triangles, std::span<const BvhTriangle>(m_triangleList));
    for (TreeAddress& tree : m_trees) {
        tree.nodes += m_nodes.address();
        tree.triangles += m_triangles.address();
    }
    m_nodeList = {};
    m_triangleList = {};
}

TreeAddress sendTree(GrowingBuffer& stream, const TreeData& tree) {
    return {.nodes = stream.append(std::span<const BvhNode>(tree.bvh.nodes), sizeof(BvhNode)).address,
            .triangles = stream.append(std::span<const BvhTriangle>(tree.triangles)).address,
            .bounds = tree.bvh.bounds};
}

SceneTreeData buildSceneTree(std::span<const TreeInstance> instances) {
    std::vector<Bounds> boxes;
    std::vector<uint8_t> groups;
    std::vector<BvhInstance> placed;
    for (const TreeInstance& instance : instances) {
        const mat4 inverse(glm::inverse(glm::dmat4(instance.worldFromModel)));
        if (instance.tree.bounds.empty() || !isFinite(inverse)) continue;
        placed.push_back(describe(instance, inverse));
        boxes.push_back(transformBounds(instance.tree.bounds, instance.worldFromModel));
        groups.push_back(groupsOfMask(placed.back().mask & ~kBvhInPlace));
    }
    Bvh bvh = buildSah(boxes, {.maxLeafItems = 1, .groups = groups});
    std::vector<BvhInstance> ordered;
    for (const uint32_t item : bvh.order)
        ordered.push_back(placed[item]);
    return {std::move(bvh.nodes), std::move(ordered)};
}

SceneTree sendSceneTree(GrowingBuffer& stream, std::span<const TreeInstance> instances) {
    const SceneTreeData built = buildSceneTree(instances);
    return {.nodes = stream.append(std::span<const BvhNode>(built.nodes), sizeof(BvhNode)).address,
            .instances = stream.append(std::span<const BvhInstance>(built.instances)).address};
}

} // namespace q3rt
