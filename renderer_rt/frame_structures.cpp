#include "renderer_rt/frame_structures.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "gpu/device.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

namespace {

/// Sizes are rounded up to powers of two, so that a structure serves the next frame's slightly different model too.
constexpr uint32_t kSmallestTriangleCapacity = 16, kSmallestInstanceCapacity = 64;

} // namespace

FrameStructures::FrameStructures(Device& device, uint32_t framesInFlight)
    : m_device(device)
    , m_slots(framesInFlight) {
    for (Slot& slot : m_slots)
        slot.scratch = std::make_unique<AccelerationScratch>(device);
}

void FrameStructures::beginFrame(uint32_t slot) {
    m_slot = slot;
    for (auto& [capacity, bucket] : m_slots[slot].bottoms)
        bucket.used = 0;
    for (auto& [capacity, bucket] : m_slots[slot].tops)
        bucket.used = 0;
    m_slots[slot].scratch->reset();
}

AccelerationStructure& FrameStructures::takeBottom(const TriangleGeometry& geometry) {
    const uint32_t wanted = std::max(geometry.triangleCount, (geometry.vertexCount + 2) / 3);
    const uint32_t capacity = std::bit_ceil(std::max(wanted, kSmallestTriangleCapacity));
    Bucket& bucket = m_slots[m_slot].bottoms[{capacity, geometry.opaque}];
    if (bucket.used == bucket.structures.size()) {
        TriangleGeometry largest = geometry;
        largest.triangleCount = capacity;
        largest.vertexCount = 3 * capacity;
        bucket.structures.push_back(std::make_unique<AccelerationStructure>(AccelerationStructure::makeBottom(
            m_device, largest, {.preference = BuildPreference::FastBuild, .name = "moving"})));
        ++m_created;
    }
    return *bucket.structures[bucket.used++];
}

AccelerationStructure& FrameStructures::takeTop(uint32_t instanceCount) {
    const uint32_t capacity = std::bit_ceil(std::max(instanceCount, kSmallestInstanceCapacity));
    Bucket& bucket = m_slots[m_slot].tops[capacity];
    if (bucket.used == bucket.structures.size()) {
        bucket.structures.push_back(std::make_unique<AccelerationStructure>(AccelerationStructure::makeTop(
            m_device, capacity, {.preference = BuildPreference::FastBuild, .name = "scene"})));
        ++m_created;
    }
    return *bucket.structures[bucket.used++];
}

uint32_t FrameStructures::takeCreatedCount() { return std::exchange(m_created, 0); }

} // namespace q3rt
