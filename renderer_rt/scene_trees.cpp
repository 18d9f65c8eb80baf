#include "renderer_rt/scene_trees.hpp"

#include <cmath>

#include "gpu/device.hpp"

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

} // namespace

TreeData buildTree(std::span<const Vertex> vertices, std::span<const uint32_t> indices, bool opaque, bool lasting) {
    std::vector<vec3> positions;
    positions.reserve(indices.size());
    for (const uint32_t index : indices)
        positions.push_back(vertices[index].position);
    const std::vector<Bounds> boxes = triangleBounds(positions);
    Bvh bvh = lasting ? buildSah(boxes) : buildMorton(boxes);
    const std::vector<uint8_t> flags(opaque ? 0 : indices.size() / 3, 0);
    std::vector<BvhTriangle> triangles = leafTriangles(bvh, positions, flags);
    return {.nodes = std::move(bvh.nodes), .triangles = std::move(triangles), .bounds = bvh.bounds};
}

size_t StaticTrees::add(std::span<const Vertex> vertices, std::span<const uint32_t> indices, bool opaque) {
    const TreeData built = buildTree(vertices, indices, opaque, true);
    m_trees.push_back({.nodes = m_nodeList.size() * sizeof(BvhNode),
                       .triangles = m_triangleList.size() * sizeof(BvhTriangle),
                       .bounds = built.bounds});
    m_nodeList.insert(m_nodeList.end(), built.nodes.begin(), built.nodes.end());
    m_triangleList.insert(m_triangleList.end(), built.triangles.begin(), built.triangles.end());
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

TreeAddress sendMovingTree(GrowingBuffer& stream, std::span<const Vertex> vertices, std::span<const uint32_t> indices,
                           bool opaque) {
    const TreeData built = buildTree(vertices, indices, opaque, false);
    return {.nodes = stream.append(std::span<const BvhNode>(built.nodes)).address,
            .triangles = stream.append(std::span<const BvhTriangle>(built.triangles)).address,
            .bounds = built.bounds};
}

SceneTree sendSceneTree(GrowingBuffer& stream, std::span<const TreeInstance> instances) {
    std::vector<Bounds> boxes;
    std::vector<BvhInstance> placed;
    for (const TreeInstance& instance : instances) {
        const mat4 inverse(glm::inverse(glm::dmat4(instance.worldFromModel)));
        if (instance.tree.bounds.empty() || !isFinite(inverse)) continue;
        BvhInstance out{};
        for (int row = 0; row < 3; ++row)
            out.modelFromWorld[row] =
                vec4(inverse[0][row], inverse[1][row], inverse[2][row], instance.worldFromModel[3][row]);
        out.nodes = instance.tree.nodes;
        out.triangles = instance.tree.triangles;
        out.customIndex = instance.customIndex;
        out.mask = instance.mask;
        out.cullBack = instance.cullBack ? 1 : 0;
        placed.push_back(out);
        boxes.push_back(transformBounds(instance.tree.bounds, instance.worldFromModel));
    }
    const Bvh bvh = buildSah(boxes, {.maxLeafItems = 1});
    std::vector<BvhInstance> ordered;
    for (const uint32_t item : bvh.order)
        ordered.push_back(placed[item]);
    return {.nodes = stream.append(std::span<const BvhNode>(bvh.nodes)).address,
            .instances = stream.append(std::span<const BvhInstance>(ordered)).address};
}

} // namespace q3rt
