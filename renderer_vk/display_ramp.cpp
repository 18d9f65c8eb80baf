#include "renderer_vk/display_ramp.hpp"

#include <algorithm>
#include <cstring>

#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "gpu/sampler.hpp"
#include "spirv/vk_display_double_frag.hpp"
#include "spirv/vk_display_ramp_frag.hpp"
#include "spirv/vk_display_ramp_vert.hpp"

namespace q3rt {

namespace {

constexpr VkFormat kShownFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkDeviceSize kTableBytes = sizeof(uint32_t) * std::tuple_size_v<RampTable>;
constexpr VkColorComponentFlags kRgb = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;

GpuImage makeShown(Device& device, VkExtent2D extent, VkFormat format) {
    return GpuImage(device, {.extent = extent,
                             .format = format,
                             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                             .name = "shown"});
}

GraphicsPipelineInfo describeTable(const DescriptorLayout& layout) {
    GraphicsPipelineInfo info;
    info.name = "display ramp";
    info.vertex = {shaders::vk_display_ramp_vert, {}};
    info.fragment = {shaders::vk_display_ramp_frag, {}};
    info.interface = {{layout.handle()}};
    info.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    info.colorFormats = {kShownFormat};
    return info;
}

/// White times what is there, and what is there.
GraphicsPipelineInfo describeDoubling(VkFormat format) {
    GraphicsPipelineInfo info;
    info.name = "display doubling";
    info.vertex = {shaders::vk_display_ramp_vert, {}};
    info.fragment = {shaders::vk_display_double_frag, {}};
    info.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    info.colorFormats = {format};
    info.blends = {
        {.enable = true, .source = VK_BLEND_FACTOR_DST_COLOR, .destination = VK_BLEND_FACTOR_ONE, .writeMask = kRgb}};
    return info;
}

} // namespace

std::optional<int> doublingsOf(const RampTable& table) {
    constexpr int kMostDoublings = 8; // of 1 to more than 255
    for (int times = 0; times <= kMostDoublings; ++times) {
        bool same = true;
        for (int i = 0; i < static_cast<int>(table.size()) && same; ++i)
            same = table[static_cast<size_t>(i)] == std::min(i << times, 255);
        if (same) return times;
    }
    return std::nullopt;
}

DisplayRamp::DisplayRamp(Device& device, VkExtent2D extent, VkFormat screenFormat)
    : m_device(device)
    , m_layout(device,
               {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT},
                {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_FRAGMENT_BIT}},
               "display ramp")
    , m_byTable(device, describeTable(m_layout))
    , m_doubling(device, describeDoubling(screenFormat))
    , m_sampler(device.samplers().find({}))
    , m_extent(extent) {
    for (size_t i = 0; i < m_table.size(); ++i)
        m_table[i] = static_cast<uint8_t>(i);
    warm(screenFormat);
}

/// Software drivers compile at the first draw: not while somebody turns the brightness up.
void DisplayRamp::warm(VkFormat screenFormat) {
    constexpr VkExtent2D kPixel{1, 1};
    GpuImage picture(m_device, {.name = "ramp warm-up"});
    GpuImage shown = makeShown(m_device, kPixel, kShownFormat), screen = makeShown(m_device, kPixel, screenFormat);
    const Buffer bytes(m_device,
                       {.size = kTableBytes, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, .name = "ramp warm-up"});
    DescriptorArena arena(m_device);
    const VkDescriptorSet set =
        arena.make(m_layout, {bindSampledImage(0, picture.view(), m_sampler), bindStorageBuffer(1, bytes.handle())});
    m_device.submitAndWait([&](VkCommandBuffer commands) {
        const auto become = [&](GpuImage& image, const Access& how) {
            image.transition(commands, {how.stages, how.access, how.layout});
        };
        become(picture, access::kFragmentSample);
        become(shown, access::kColorAttachment);
        become(screen, access::kColorAttachment);
        beginRendering(commands, kPixel, {.view = shown.view(), .load = VK_ATTACHMENT_LOAD_OP_DONT_CARE});
        m_byTable.bind(commands);
        m_byTable.bindSets(commands, {set});
        vkCmdDraw(commands, 4, 1, 0, 0);
        vkCmdEndRenderingKHR(commands);
        beginRendering(commands, kPixel, {.view = screen.view()});
        m_doubling.bind(commands);
        vkCmdDraw(commands, 4, 1, 0, 0);
        vkCmdEndRenderingKHR(commands);
    });
}

void DisplayRamp::follow(const RampTable& table) {
    if (table == m_table) return;
    m_table = table;
    m_doublings = doublingsOf(table);
    if (m_doublings) return;
    std::array<uint32_t, std::tuple_size_v<RampTable>> entries;
    std::ranges::copy(table, entries.begin());
    // A fresh one: frames in flight still read the old table.
    m_buffer = Buffer(m_device, {.size = kTableBytes,
                                 .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                 .domain = MemoryDomain::Upload,
                                 .name = "display ramp"});
    std::memcpy(m_buffer.mapped(), entries.data(), sizeof(entries));
    if (!m_shown) m_shown = makeShown(m_device, m_extent, kShownFormat);
}

ImageId DisplayRamp::addTable(FrameGraph& graph, ImageId picture) {
    if (m_doublings) return picture;
    ImageId shown = graph.importImage("shown", m_shown);
    graph.addPass(
        "display ramp",
        [&](PassBuilder& pass) {
            pass.read(picture, access::kFragmentSample);
            shown = pass.write(shown, access::kColorAttachment);
        },
        [this, picture, shown](PassContext& pass) {
            const VkDescriptorSet set = pass.makeSet(m_layout, {bindSampledImage(0, pass.view(picture), m_sampler),
                                                                bindStorageBuffer(1, m_buffer.handle())});
            beginRendering(pass.commands(), m_extent,
                           {.view = pass.view(shown), .load = VK_ATTACHMENT_LOAD_OP_DONT_CARE});
            m_byTable.bind(pass.commands());
            m_byTable.bindSets(pass.commands(), {set});
            vkCmdDraw(pass.commands(), 4, 1, 0, 0);
            vkCmdEndRenderingKHR(pass.commands());
        });
    return shown;
}

ImageId DisplayRamp::addDoublings(FrameGraph& graph, ImageId screen) {
    if (m_doublings.value_or(0) == 0) return screen;
    graph.addPass(
        "display doubling", [&](PassBuilder& pass) { screen = pass.write(screen, access::kColorAttachment); },
        [this, screen](PassContext& pass) {
            beginRendering(pass.commands(), pass.extent(screen), {.view = pass.view(screen)});
            m_doubling.bind(pass.commands());
            for (int i = 0; i < *m_doublings; ++i)
                vkCmdDraw(pass.commands(), 4, 1, 0, 0);
            vkCmdEndRenderingKHR(pass.commands());
        });
    return screen;
}

} // namespace q3rt
