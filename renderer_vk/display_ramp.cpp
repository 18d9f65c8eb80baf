#include "renderer_vk/display_ramp.hpp"

#include <algorithm>
#include <cstring>

#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "spirv/vk_display_ramp_comp.hpp"

namespace q3rt {

DisplayRamp::DisplayRamp(Device& device, VkExtent2D extent)
    : m_device(device)
    , m_layout(device,
               {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}},
               "display ramp")
    , m_pipeline(device, {"display ramp", {shaders::vk_display_ramp_comp, {}}, {{m_layout.handle()}, 0}})
    , m_extent(extent) {
    for (size_t i = 0; i < m_table.size(); ++i)
        m_table[i] = static_cast<uint8_t>(i);
    warm();
}

/// Software drivers compile at the first dispatch: not while somebody turns the brightness up.
void DisplayRamp::warm() {
    GpuImage pixel(m_device, {.usage = VK_IMAGE_USAGE_STORAGE_BIT, .name = "ramp warm-up"});
    const Buffer bytes(
        m_device,
        {.size = sizeof(uint32_t) * 256, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, .name = "ramp warm-up"});
    DescriptorArena arena(m_device);
    const VkDescriptorSet set =
        arena.make(m_layout, {bindStorageImage(0, pixel.view()), bindStorageImage(1, pixel.view()),
                              bindStorageBuffer(2, bytes.handle())});
    m_device.submitAndWait([&](VkCommandBuffer commands) {
        pixel.transition(commands,
                         {access::kComputeWrite.stages, access::kComputeWrite.access, access::kComputeWrite.layout});
        m_pipeline.bind(commands);
        m_pipeline.bindSets(commands, {set});
        m_pipeline.warmUp(commands);
    });
}

void DisplayRamp::follow(const RampTable& table) {
    if (table == m_table) return;
    m_table = table;
    m_changesPicture = false;
    std::array<uint32_t, 256> entries;
    for (size_t i = 0; i < table.size(); ++i) {
        entries[i] = table[i];
        m_changesPicture = m_changesPicture || table[i] != i;
    }
    if (!m_changesPicture) return;
    // A fresh one: frames in flight still read the old table.
    m_buffer = Buffer(m_device, {.size = sizeof(entries),
                                 .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                 .domain = MemoryDomain::Upload,
                                 .name = "display ramp"});
    std::memcpy(m_buffer.mapped(), entries.data(), sizeof(entries));
    if (!m_shown)
        m_shown = GpuImage(m_device, {.extent = m_extent, .usage = VK_IMAGE_USAGE_STORAGE_BIT, .name = "shown"});
}

ImageId DisplayRamp::addPass(FrameGraph& graph, ImageId picture) {
    ImageId shown = graph.importImage("shown", m_shown);
    graph.addPass(
        "display ramp",
        [&](PassBuilder& pass) {
            pass.read(picture, access::kComputeRead);
            shown = pass.write(shown, access::kComputeWrite);
        },
        [this, picture, shown](PassContext& pass) {
            const VkDescriptorSet set =
                pass.makeSet(m_layout, {bindStorageImage(0, pass.view(picture)), bindStorageImage(1, pass.view(shown)),
                                        bindStorageBuffer(2, m_buffer.handle())});
            m_pipeline.bind(pass.commands());
            m_pipeline.bindSets(pass.commands(), {set});
            m_pipeline.dispatchOver(pass.commands(), m_extent);
        });
    return shown;
}

} // namespace q3rt
