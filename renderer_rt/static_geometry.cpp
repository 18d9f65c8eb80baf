#include "renderer_rt/static_geometry.hpp"

#include <array>

#include "base/log.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/triangle_sort.hpp"

namespace q3rt {

namespace {

constexpr VkBufferUsageFlags kGeometryUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                              VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                              VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

template <typename T>
Buffer makeFilled(Device& device, Uploader& uploader, const std::vector<T>& items, const char* name) {
    Buffer buffer(device, {.size = items.size() * sizeof(T), .usage = kGeometryUsage, .name = name});
    uploader.upload(buffer, std::span<const T>(items));
    return buffer;
}

} // namespace

struct StaticGeometry::PartTriangles {
    std::vector<uint32_t> indices;
    std::vector<uint32_t> surfaceOfTriangle;
};

void StaticGeometry::gather(const World& world, const MaterialLibrary& materials,
                            std::vector<PartTriangles>& gathered) {
    for (size_t model = 0; model < world.bsp.models.size(); ++model) {
        std::array<StaticPart, kSurfaceClassCount> parts;
        std::array<PartTriangles, kSurfaceClassCount> triangles;
        const BspModel& bspModel = world.bsp.models[model];
        for (int s = 0; s < bspModel.surfaceCount; ++s) {
            const auto number = static_cast<uint32_t>(bspModel.firstSurface + s);
            const WorldSurface& surface = world.surfaces[number];
            const Material& material = materials.drawn(surface.material);
            const auto surfaceClass = classifySurface(material);
            if (!surface.drawn || surface.indexCount == 0 || !surfaceClass || !material.deforms.empty()) continue;
            const auto c = static_cast<size_t>(*surfaceClass);
            const auto first = world.indices.begin() + surface.firstIndex;
            triangles[c].indices.insert(triangles[c].indices.end(), first, first + surface.indexCount);
            triangles[c].surfaceOfTriangle.insert(triangles[c].surfaceOfTriangle.end(), surface.indexCount / 3,
                                                  static_cast<uint32_t>(parts[c].surfaces.size()));
            parts[c].surfaces.push_back(number);
        }
        for (size_t c = 0; c < kSurfaceClassCount; ++c) {
            if (triangles[c].indices.empty()) continue;
            parts[c].model = static_cast<int>(model);
            parts[c].surfaceClass = static_cast<SurfaceClass>(c);
            m_parts.push_back(std::move(parts[c]));
            gathered.push_back(std::move(triangles[c]));
        }
    }
}

StaticGeometry::StaticGeometry(Device& device, Uploader& uploader, const World& world, const MaterialLibrary& materials,
                               Backend backend) {
    std::vector<PartTriangles> gathered;
    gather(world, materials, gathered);
    std::vector<uint32_t> indices, surfaceOfTriangle;
    std::vector<size_t> firstTriangle;
    for (size_t p = 0; p < m_parts.size(); ++p) {
        const PartTriangles& part = gathered[p];
        firstTriangle.push_back(surfaceOfTriangle.size());
        for (const uint32_t triangle : sortTriangles(world.vertices, part.indices)) {
            indices.insert(indices.end(), part.indices.begin() + 3 * triangle, part.indices.begin() + 3 * triangle + 3);
            surfaceOfTriangle.push_back(part.surfaceOfTriangle[triangle]);
        }
        m_parts[p].triangleCount = static_cast<uint32_t>(surfaceOfTriangle.size() - firstTriangle[p]);
    }
    m_triangleCount = static_cast<uint32_t>(surfaceOfTriangle.size());
    m_vertices = makeFilled(device, uploader, world.vertices, "world vertices");
    m_indices = makeFilled(device, uploader, indices, "world indices");
    m_surfaceOfTriangle = makeFilled(device, uploader, surfaceOfTriangle, "world surface numbers");
    uploader.flush();
    for (size_t p = 0; p < m_parts.size(); ++p) {
        m_parts[p].indices = m_indices.address() + firstTriangle[p] * 3 * sizeof(uint32_t);
        m_parts[p].surfaceOfTriangle = m_surfaceOfTriangle.address() + firstTriangle[p] * sizeof(uint32_t);
    }
    if (usesStructures(backend))
        buildStructures(device, static_cast<uint32_t>(world.vertices.size()));
    else
        buildTrees(device, uploader, world, indices);
}

void StaticGeometry::buildTrees(Device& device, Uploader& uploader, const World& world,
                                std::span<const uint32_t> indices) {
    size_t firstIndex = 0;
    for (size_t p = 0; p < m_parts.size();) {
        std::vector<TreePart> parts;
        const size_t first = p;
        for (; p < m_parts.size() && m_parts[p].model == m_parts[first].model; ++p) {
            const size_t count = size_t{3} * m_parts[p].triangleCount;
            parts.push_back({world.vertices, indices.subspan(firstIndex, count), m_parts[p].surfaceClass});
            firstIndex += count;
        }
        const size_t tree = m_trees.add(parts);
        for (size_t i = first; i < p; ++i) {
            m_parts[i].tree = tree;
            m_parts[i].partOfTree = i - first;
        }
    }
    m_trees.upload(device, uploader);
    uploader.flush();
    if (m_trees.rejectedCount() > 0)
        logLine(LogLevel::Warning, "%s: %u triangles are not finite or beyond %g units and are not traced",
                world.name.c_str(), m_trees.rejectedCount(), static_cast<double>(kBvhFarthest));
}

void StaticGeometry::buildStructures(Device& device, uint32_t vertexCount) {
    std::vector<BottomBuild> builds;
    for (StaticPart& part : m_parts) {
        const TriangleGeometry triangles{.vertices = m_vertices.address(),
                                         .vertexStride = sizeof(Vertex),
                                         .vertexCount = vertexCount,
                                         .indices = part.indices,
                                         .triangleCount = part.triangleCount,
                                         .opaque = isOpaqueClass(part.surfaceClass)};
        part.structure = AccelerationStructure::makeBottom(device, triangles,
                                                           {.preference = BuildPreference::FastTrace, .name = "world"});
        builds.push_back({&part.structure, triangles});
    }
    AccelerationScratch scratch(device);
    device.submitAndWait([&](VkCommandBuffer commands) {
        recordBuildInputBarrier(commands);
        recordBuilds(commands, scratch, builds);
        recordBuildBarrier(device, commands);
    });
}

VkDeviceSize StaticGeometry::bytes() const {
    VkDeviceSize sum = m_vertices.size() + m_indices.size() + m_surfaceOfTriangle.size() + m_trees.bytes();
    for (const StaticPart& part : m_parts)
        sum += part.structure.size();
    return sum;
}

} // namespace q3rt
