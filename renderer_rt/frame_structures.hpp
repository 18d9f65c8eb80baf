#pragma once
// Structures that live for one frame: bottom levels of what moves, and the top level. Kept a frame in flight each, so a
// build never touches what another frame still traces; memory is reused from frame to frame.

#include <map>
#include <memory>
#include <vector>

#include "gpu/acceleration_structure.hpp"

namespace q3rt {

class FrameStructures {
  public:
    FrameStructures(Device& device, uint32_t framesInFlight);
    void beginFrame(uint32_t slot);
    /// A structure with room for this geometry; valid until the slot comes round again.
    AccelerationStructure& takeBottom(const TriangleGeometry& geometry);
    AccelerationStructure& takeTop(uint32_t instanceCount);
    AccelerationScratch& scratch() { return *m_slots[m_slot].scratch; }
    /// New structures made since the last call: 0 in a steady state.
    uint32_t takeCreatedCount();

  private:
    /// Structures of one size class; the first `used` are taken this frame.
    struct Bucket {
        std::vector<std::unique_ptr<AccelerationStructure>> structures;
        size_t used = 0;
    };
    struct Slot {
        std::map<std::pair<uint32_t, bool>, Bucket> bottoms; ///< by triangle capacity and opacity
        std::map<uint32_t, Bucket> tops;                     ///< by instance capacity
        std::unique_ptr<AccelerationScratch> scratch;
    };
    Device& m_device;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    uint32_t m_created = 0;
};

} // namespace q3rt
