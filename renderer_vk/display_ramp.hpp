#pragma once
// Stands in for a display's gamma ramp, which Vulkan doesn't reach: a table over the finished picture's bytes.

#include <array>
#include <optional>

#include "frame/frame_graph.hpp"
#include "gpu/buffer.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/gpu_image.hpp"
#include "gpu/graphics_pipeline.hpp"

namespace q3rt {

using RampTable = std::array<uint8_t, 256>;

/// How often the table doubles every byte, up to white; none if it does something else.
std::optional<int> doublingsOf(const RampTable& table);

class DisplayRamp {
  public:
    /// Pictures of `extent` pixels; what is shown has `screenFormat`.
    DisplayRamp(Device& device, VkExtent2D extent, VkFormat screenFormat);
    /// Takes effect from the next frame on.
    void follow(const RampTable& table);
    uint8_t operator[](uint8_t value) const { return m_table[value]; }

    /// `picture` through a table that does more than to double, in an image of its own; else `picture` itself.
    ImageId addTable(FrameGraph& graph, ImageId picture);
    /// The doublings that are left, in place: without r_gamma a table is no more, and this is by far the cheapest.
    ImageId addDoublings(FrameGraph& graph, ImageId screen);

  private:
    void warm(VkFormat screenFormat);

    Device& m_device;
    DescriptorLayout m_layout;
    GraphicsPipeline m_byTable, m_doubling;
    VkSampler m_sampler;
    GpuImage m_shown; ///< made when first needed
    VkExtent2D m_extent;
    Buffer m_buffer;
    RampTable m_table{};
    std::optional<int> m_doublings = 0; ///< of the table
};

} // namespace q3rt
