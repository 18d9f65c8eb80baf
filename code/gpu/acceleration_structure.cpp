#include "gpu/acceleration_structure.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

VkAccelerationStructureGeometryKHR triangleGeometry(const TriangleGeometry& source) {
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = source.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
    VkAccelerationStructureGeometryTrianglesDataKHR& data = geometry.geometry.triangles;
    data = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR};
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = source.vertices;
    data.vertexStride = source.vertexStride;
    data.maxVertex = source.vertexCount ? source.vertexCount - 1 : 0;
    data.indexType = source.indexed ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_NONE_KHR;
    data.indexData.deviceAddress = source.indices;
    return geometry;
}

VkAccelerationStructureGeometryKHR instanceGeometry(VkDeviceAddress instances) {
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR};
    geometry.geometry.instances.data.deviceAddress = instances;
    return geometry;
}

/// The geometry stays where it is as long as this is used.
VkAccelerationStructureBuildGeometryInfoKHR buildInfo(const AccelerationInfo& info, VkAccelerationStructureTypeKHR type,
                                                      const VkAccelerationStructureGeometryKHR& geometry) {
    VkAccelerationStructureBuildGeometryInfoKHR build{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    build.type = type;
    build.flags = info.preference == BuildPreference::FastTrace
                      ? VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR
                      : VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
    if (info.allowUpdate) build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    if (info.allowCompaction) build.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    build.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.geometryCount = 1;
    build.pGeometries = &geometry;
    return build;
}

VkAccelerationStructureBuildSizesInfoKHR
measure(Device& device, const VkAccelerationStructureBuildGeometryInfoKHR& build, uint32_t count) {
    VkAccelerationStructureBuildSizesInfoKHR sizes{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    vkGetAccelerationStructureBuildSizesKHR(device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build,
                                            &count, &sizes);
    return sizes;
}

void recordMemoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 fromStages, VkAccessFlags2 fromAccess,
                         VkPipelineStageFlags2 toStages, VkAccessFlags2 toAccess) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, fromStages, fromAccess, toStages, toAccess};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2KHR(commands, &dependency);
}

// Bytes of the first scratch buffer: what a few hundred small dynamic structures need on the devices measured.
constexpr VkDeviceSize kFirstScratchBytes = 1 << 20;

} // namespace

VkDeviceAddress AccelerationScratch::take(VkDeviceSize size) {
    const VkDeviceSize alignment =
        std::max(m_device->capabilities().acceleration.minAccelerationStructureScratchOffsetAlignment, 1u);
    const auto aligned = [&] {
        const VkDeviceAddress start = m_buffer.address() + m_used;
        return (start + alignment - 1) / alignment * alignment;
    };
    if (!m_buffer || aligned() + size > m_buffer.address() + m_buffer.size()) {
        const VkDeviceSize bytes = std::max({kFirstScratchBytes, m_buffer ? m_buffer.size() * 2 : 0, size + alignment});
        m_buffer =
            Buffer(*m_device, {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                               MemoryDomain::DeviceLocal, "acceleration scratch"});
        m_used = 0;
    }
    const VkDeviceAddress address = aligned();
    m_used = address + size - m_buffer.address();
    return address;
}

AccelerationStructure AccelerationStructure::makeBottom(Device& device, const TriangleGeometry& triangles,
                                                        const AccelerationInfo& info) {
    AccelerationStructure made;
    made.m_device = &device;
    made.m_info = info;
    const VkAccelerationStructureGeometryKHR geometry = triangleGeometry(triangles);
    const auto build = buildInfo(info, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry);
    const auto sizes = measure(device, build, triangles.triangleCount);
    made.m_buildScratch = sizes.buildScratchSize;
    made.m_updateScratch = sizes.updateScratchSize;
    made.create(device, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, sizes.accelerationStructureSize);
    return made;
}

AccelerationStructure AccelerationStructure::makeTop(Device& device, uint32_t maxInstances,
                                                     const AccelerationInfo& info) {
    AccelerationStructure made;
    made.m_device = &device;
    made.m_info = info;
    made.m_maxInstances = maxInstances;
    const VkAccelerationStructureGeometryKHR geometry = instanceGeometry(0);
    const auto build = buildInfo(info, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, geometry);
    const auto sizes = measure(device, build, maxInstances);
    made.m_buildScratch = sizes.buildScratchSize;
    made.m_updateScratch = sizes.updateScratchSize;
    made.create(device, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, sizes.accelerationStructureSize);
    return made;
}

void AccelerationStructure::create(Device& device, VkAccelerationStructureTypeKHR type, VkDeviceSize size) {
    if (!device.capabilities().accelerationStructure)
        throw DeviceError(formatText("%s has no acceleration structures: set rt_backend compute",
                                     device.capabilities().deviceName.c_str()));
    m_type = type;
    m_buffer = Buffer(
        device,
        {size, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
         MemoryDomain::DeviceLocal, m_info.name});
    VkAccelerationStructureCreateInfoKHR create{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    create.buffer = m_buffer.handle();
    create.size = size;
    create.type = type;
    vkCheck(vkCreateAccelerationStructureKHR(device.handle(), &create, nullptr, &m_handle),
            "vkCreateAccelerationStructureKHR");
    device.setName(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(m_handle), m_info.name);
    VkAccelerationStructureDeviceAddressInfoKHR address{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
    address.accelerationStructure = m_handle;
    m_address = vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &address);
}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    if (this == &other) return *this;
    release();
    m_device = std::exchange(other.m_device, nullptr);
    m_info = std::move(other.m_info);
    m_type = other.m_type;
    m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
    m_address = std::exchange(other.m_address, 0);
    m_buffer = std::move(other.m_buffer);
    m_buildScratch = other.m_buildScratch;
    m_updateScratch = other.m_updateScratch;
    m_maxInstances = other.m_maxInstances;
    return *this;
}

void AccelerationStructure::release() {
    if (!m_handle) return;
    // Before the buffer, which is retired after it.
    m_device->retire([device = m_device->handle(), handle = m_handle] {
        vkDestroyAccelerationStructureKHR(device, handle, nullptr);
    });
    m_handle = VK_NULL_HANDLE;
    m_address = 0;
}

void recordBuilds(VkCommandBuffer commands, AccelerationScratch& scratch, std::span<const BottomBuild> builds) {
    if (builds.empty()) return;
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    for (const BottomBuild& build : builds) {
        geometries.push_back(triangleGeometry(build.triangles));
        ranges.push_back({build.triangles.triangleCount, 0, 0, 0});
    }
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> rangeOf;
    for (size_t i = 0; i < builds.size(); ++i) {
        const AccelerationStructure& structure = *builds[i].structure;
        auto& info = infos.emplace_back(buildInfo(structure.m_info, structure.m_type, geometries[i]));
        info.dstAccelerationStructure = structure.m_handle;
        info.scratchData.deviceAddress = scratch.take(structure.m_buildScratch);
        rangeOf.push_back(&ranges[i]);
    }
    vkCmdBuildAccelerationStructuresKHR(commands, static_cast<uint32_t>(infos.size()), infos.data(), rangeOf.data());
}

void AccelerationStructure::recordUpdate(VkCommandBuffer commands, AccelerationScratch& scratch,
                                         const TriangleGeometry& triangles) {
    if (!m_info.allowUpdate)
        throw UsageError(formatText("acceleration structure \"%s\" was made without allowUpdate", m_info.name.c_str()));
    const VkAccelerationStructureGeometryKHR geometry = triangleGeometry(triangles);
    auto build = buildInfo(m_info, m_type, geometry);
    build.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
    build.srcAccelerationStructure = build.dstAccelerationStructure = m_handle;
    build.scratchData.deviceAddress = scratch.take(m_updateScratch);
    const VkAccelerationStructureBuildRangeInfoKHR range{triangles.triangleCount, 0, 0, 0};
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    vkCmdBuildAccelerationStructuresKHR(commands, 1, &build, &ranges);
}

void AccelerationStructure::recordBuildTop(VkCommandBuffer commands, AccelerationScratch& scratch,
                                           VkDeviceAddress instances, uint32_t instanceCount) {
    if (instanceCount > m_maxInstances)
        throw UsageError(formatText("acceleration structure \"%s\" holds %u instances, %u were given",
                                    m_info.name.c_str(), m_maxInstances, instanceCount));
    const VkAccelerationStructureGeometryKHR geometry = instanceGeometry(instances);
    auto build = buildInfo(m_info, m_type, geometry);
    build.dstAccelerationStructure = m_handle;
    build.scratchData.deviceAddress = scratch.take(m_buildScratch);
    const VkAccelerationStructureBuildRangeInfoKHR range{instanceCount, 0, 0, 0};
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    vkCmdBuildAccelerationStructuresKHR(commands, 1, &build, &ranges);
}

void recordBuildBarrier(Device& device, VkCommandBuffer commands) {
    VkPipelineStageFlags2 tracers =
        VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    if (device.capabilities().rayTracingPipeline) tracers |= VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
    recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                        VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, tracers,
                        VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR |
                            VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR);
}

void recordBuildInputBarrier(VkCommandBuffer commands) {
    recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                        VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                        VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR |
                            VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR);
}

VkAccelerationStructureInstanceKHR makeInstance(const AccelerationStructure& bottom,
                                                const float (&worldFromObject)[3][4], uint32_t customIndex,
                                                uint8_t mask, uint32_t hitGroupOffset,
                                                VkGeometryInstanceFlagsKHR flags) {
    // Both fields have 24 bits in the instance record.
    constexpr uint32_t kLimit = 1u << 24;
    if (customIndex >= kLimit || hitGroupOffset >= kLimit)
        throw UsageError(
            formatText("instance index %u or hit group offset %u is not below 16777216", customIndex, hitGroupOffset));
    VkAccelerationStructureInstanceKHR instance{};
    std::memcpy(instance.transform.matrix, worldFromObject, sizeof(instance.transform.matrix));
    instance.instanceCustomIndex = customIndex & (kLimit - 1);
    instance.mask = mask;
    instance.instanceShaderBindingTableRecordOffset = hitGroupOffset & (kLimit - 1);
    instance.flags = flags & 0xff;
    instance.accelerationStructureReference = bottom.address();
    return instance;
}

} // namespace q3rt
