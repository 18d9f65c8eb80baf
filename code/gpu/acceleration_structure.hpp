#pragma once
// Bottom-level structures from triangle buffers, top-level ones from an instance buffer.
// lavapipe's tree follows the order of triangles: give it SAH leaf order (spec: 1.8 to 4 times faster).

#include <span>
#include <string>
#include <vector>

#include "gpu/buffer.hpp"

namespace q3rt {

/// Positions are the first 12 bytes (3 floats) of each vertex.
struct TriangleGeometry {
    VkDeviceAddress vertices = 0;
    VkDeviceSize vertexStride = 12; // bytes
    uint32_t vertexCount = 0;
    VkDeviceAddress indices = 0; // 32-bit, three a triangle
    bool indexed = true;         // false: every three vertices are a triangle
    uint32_t triangleCount = 0;
    bool opaque = true; // false: any-hit shaders run
};

enum class BuildPreference { FastTrace, FastBuild };

struct AccelerationInfo {
    BuildPreference preference = BuildPreference::FastTrace;
    bool allowUpdate = false;     // recordUpdate() may follow
    bool allowCompaction = false; // compactStructures() may follow
    std::string name = "acceleration";
};

/// Scratch memory for builds of one command buffer; slices of concurrent builds never overlap.
class AccelerationScratch {
  public:
    explicit AccelerationScratch(Device& device)
        : m_device(&device) {}
    /// Aligned device address of `size` bytes. A fuller buffer is retired and a larger one takes its place.
    VkDeviceAddress take(VkDeviceSize size);
    /// Everything handed out is free again: call at the start of a frame, after a barrier against earlier builds.
    void reset() { m_used = 0; }

  private:
    Device* m_device;
    Buffer m_buffer;
    VkDeviceSize m_used = 0;
};

class AccelerationStructure;

/// A bottom-level structure and what it becomes.
struct BottomBuild {
    AccelerationStructure* structure;
    TriangleGeometry triangles;
};

class AccelerationStructure {
  public:
    AccelerationStructure() = default;
    /// Reserves memory for these triangles. Addresses may be 0 here (only counts matter) and change at each build.
    static AccelerationStructure makeBottom(Device& device, const TriangleGeometry& triangles,
                                            const AccelerationInfo& info);
    /// Reserves memory for up to `maxInstances` VkAccelerationStructureInstanceKHR.
    static AccelerationStructure makeTop(Device& device, uint32_t maxInstances, const AccelerationInfo& info);
    ~AccelerationStructure() { release(); }
    AccelerationStructure(AccelerationStructure&& other) noexcept { *this = std::move(other); }
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

    explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
    VkAccelerationStructureKHR handle() const { return m_handle; }
    /// What an instance refers to.
    VkDeviceAddress address() const { return m_address; }
    VkDeviceSize size() const { return m_buffer.size(); }
    uint32_t maxInstances() const { return m_maxInstances; }

    /// Refit: same counts and indices, moved vertices. Needs allowUpdate and a build before.
    void recordUpdate(VkCommandBuffer commands, AccelerationScratch& scratch, const TriangleGeometry& triangles);
    /// Records a build of a top-level structure; `instances` is 16-byte aligned.
    void recordBuildTop(VkCommandBuffer commands, AccelerationScratch& scratch, VkDeviceAddress instances,
                        uint32_t instanceCount);

  private:
    friend void compactStructures(Device& device, std::span<AccelerationStructure* const> structures);
    friend void recordBuilds(VkCommandBuffer commands, AccelerationScratch& scratch,
                             std::span<const BottomBuild> builds);
    void create(Device& device, VkAccelerationStructureTypeKHR type, VkDeviceSize size);
    void release();

    Device* m_device = nullptr;
    AccelerationInfo m_info;
    VkAccelerationStructureTypeKHR m_type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    VkAccelerationStructureKHR m_handle = VK_NULL_HANDLE;
    VkDeviceAddress m_address = 0;
    Buffer m_buffer;
    VkDeviceSize m_buildScratch = 0;
    VkDeviceSize m_updateScratch = 0;
    uint32_t m_maxInstances = 0;
};

/// Records builds in one command: a driver spreads small ones over the device, and reads the command once (378 a frame
/// one by one cost the processor 3 ms more). No barrier: recordBuildBarrier() follows.
void recordBuilds(VkCommandBuffer commands, AccelerationScratch& scratch, std::span<const BottomBuild> builds);
/// Builds -> builds and traces: before a top-level build that uses fresh bottom levels, and before the first trace.
void recordBuildBarrier(Device& device, VkCommandBuffer commands);
/// Shader and transfer writes of vertices or instances -> builds, and traces of the last frame -> builds over them.
void recordBuildInputBarrier(VkCommandBuffer commands);

/// Replaces each built structure (allowCompaction) by its compacted copy; waits, so for loading. Addresses change.
void compactStructures(Device& device, std::span<AccelerationStructure* const> structures);

/// Row-major 3x4 instance transform; worldFromObject.
VkAccelerationStructureInstanceKHR makeInstance(const AccelerationStructure& bottom,
                                                const float (&worldFromObject)[3][4], uint32_t customIndex,
                                                uint8_t mask, uint32_t hitGroupOffset,
                                                VkGeometryInstanceFlagsKHR flags);

} // namespace q3rt
