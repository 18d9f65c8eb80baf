#include "renderer_rt/model_geometry.hpp"

#include <algorithm>
#include <utility>

#include "gpu/device.hpp"
#include "renderer_rt/triangle_sort.hpp"

namespace q3rt {

namespace {

constexpr VkBufferUsageFlags kModelUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                           VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
constexpr size_t kAlignment = 64; ///< bytes, of each table in a part's memory: whole nodes in cache lines

/// Tables one after the other in one buffer.
class TableWriter {
  public:
    template <typename T>
    size_t add(std::span<const T> items) {
        const size_t at = (m_bytes.size() + kAlignment - 1) / kAlignment * kAlignment;
        const std::span<const std::byte> bytes = std::as_bytes(items);
        m_bytes.resize(at);
        m_bytes.insert(m_bytes.end(), bytes.begin(), bytes.end());
        return at;
    }
    const std::vector<std::byte>& bytes() const { return m_bytes; }

  private:
    std::vector<std::byte> m_bytes;
};

} // namespace

ModelPart& ModelGeometry::find(const ModelSurface* source, SurfaceClass surfaceClass, std::span<const Vertex> vertices,
                               std::span<const uint32_t> indices) {
    std::unique_ptr<ModelPart>& part = m_parts[{source, surfaceClass}];
    if (part) return *part;
    part = std::make_unique<ModelPart>();
    const uint32_t low = *std::min_element(indices.begin(), indices.end());
    const uint32_t high = *std::max_element(indices.begin(), indices.end());
    std::vector<uint32_t> ordered;
    for (const uint32_t triangle : sortTriangles(vertices, indices))
        for (size_t corner = 0; corner < 3; ++corner)
            ordered.push_back(indices[3 * triangle + corner] - low);
    fill(*part, surfaceClass, vertices.subspan(low, high - low + 1), ordered);
    m_new.push_back(part.get());
    return *part;
}

void ModelGeometry::fill(ModelPart& part, SurfaceClass surfaceClass, std::span<const Vertex> vertices,
                         std::span<const uint32_t> indices) {
    const auto triangleCount = static_cast<uint32_t>(indices.size() / 3);
    const std::vector<uint32_t> surfaceOfTriangle(triangleCount, 0);
    TableWriter tables;
    const size_t verticesAt = tables.add(vertices), indicesAt = tables.add(indices);
    const size_t surfacesAt = tables.add(std::span<const uint32_t>(surfaceOfTriangle));
    size_t nodesAt = 0, trianglesAt = 0;
    if (!usesStructures(m_backend)) {
        const TreePart whole{vertices, indices, surfaceClass};
        const TreeData tree = buildTree({&whole, 1}, true);
        nodesAt = tables.add(std::span<const BvhNode>(tree.bvh.nodes));
        trianglesAt = tables.add(std::span<const BvhTriangle>(tree.triangles));
        part.tree.bounds = tree.bvh.bounds;
    }
    part.memory = Buffer(
        m_device,
        {.size = tables.bytes().size(), .usage = kModelUsage, .domain = MemoryDomain::Upload, .name = "model surface"});
    std::memcpy(part.memory.mapped(), tables.bytes().data(), tables.bytes().size());
    const VkDeviceAddress base = part.memory.address();
    part.surfaceOfTriangle = base + surfacesAt;
    part.tree.nodes = base + nodesAt;
    part.tree.triangles = base + trianglesAt;
    part.geometry = {.vertices = base + verticesAt,
                     .vertexStride = sizeof(Vertex),
                     .vertexCount = static_cast<uint32_t>(vertices.size()),
                     .indices = base + indicesAt,
                     .triangleCount = triangleCount,
                     .opaque = isOpaqueClass(surfaceClass)};
    if (usesStructures(m_backend))
        part.structure = AccelerationStructure::makeBottom(m_device, part.geometry,
                                                           {.preference = BuildPreference::FastTrace, .name = "model"});
}

std::vector<ModelPart*> ModelGeometry::takeNew() { return std::exchange(m_new, {}); }

} // namespace q3rt
