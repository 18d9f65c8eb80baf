#pragma once
// Stands in for a display's gamma ramp, which Vulkan doesn't reach: a table over the finished picture's bytes.

#include <array>

#include "frame/frame_graph.hpp"
#include "gpu/buffer.hpp"
#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/gpu_image.hpp"

namespace q3rt {

using RampTable = std::array<uint8_t, 256>;

class DisplayRamp {
  public:
    DisplayRamp(Device& device, VkExtent2D extent);
    /// Takes effect from the next frame on.
    void follow(const RampTable& table);
    bool changesPicture() const { return m_changesPicture; }
    /// A pass that writes `picture` through the table into an image of its own, which it returns.
    ImageId addPass(FrameGraph& graph, ImageId picture);
    uint8_t operator[](uint8_t value) const { return m_table[value]; }

  private:
    void warm();
    Device& m_device;
    DescriptorLayout m_layout;
    ComputePipeline m_pipeline;
    GpuImage m_shown; ///< made when first needed
    VkExtent2D m_extent;
    Buffer m_buffer;
    RampTable m_table{};
    bool m_changesPicture = false;
};

} // namespace q3rt
