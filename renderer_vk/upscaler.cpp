#include "renderer_vk/upscaler.hpp"

#include <algorithm>

#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "gpu/sampler.hpp"
#include "renderer_vk/raster_scene.hpp"
#include "spirv/vk_upscale_frag.hpp"
#include "spirv/vk_upscale_vert.hpp"

namespace q3rt {

namespace {

constexpr VkColorComponentFlags kRgb =
    VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT; // alpha stays 1

/// Of the source, [0, 1]: where the drawn part begins and how large it is.
struct UpscalePush {
    vec2 origin, size;
};

GraphicsPipelineInfo describePipeline(const DescriptorLayout& layout, VkSampleCountFlagBits samples) {
    GraphicsPipelineInfo info;
    info.name = "upscale";
    info.vertex = {shaders::vk_upscale_vert, {}};
    info.fragment = {shaders::vk_upscale_frag, {}};
    info.interface = {{layout.handle()}, sizeof(UpscalePush), VK_SHADER_STAGE_VERTEX_BIT};
    info.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    info.samples = samples;
    info.colorFormats = {kTargetFormat};
    info.blends = {{.writeMask = kRgb}};
    return info;
}

VkSampler clampedSampler(Device& device) {
    SamplerInfo info;
    info.addressU = info.addressV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = 0;
    return device.samplers().find(info);
}

} // namespace

Upscaler::Upscaler(Device& device, TargetImages& from, TargetImages& to)
    : m_device(device)
    , m_layout(device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}}, "upscale")
    , m_pipeline(device, describePipeline(m_layout, to.samples ? to.samples.info().samples : VK_SAMPLE_COUNT_1_BIT))
    , m_sampler(clampedSampler(device)) {
    warm(from, to);
}

void Upscaler::warm(TargetImages& from, TargetImages& to) {
    DescriptorArena arena(m_device);
    const VkDescriptorSet set = arena.make(m_layout, {bindSampledImage(0, from.color.view(), m_sampler)});
    GpuImage& target = to.samples ? to.samples : to.color;
    m_device.submitAndWait([&](VkCommandBuffer commands) {
        const auto become = [&](GpuImage& image, const Access& how) {
            image.transition(commands, {how.stages, how.access, how.layout});
        };
        become(from.color, access::kFragmentSample);
        become(target, access::kColorAttachment);
        const Attachment color{.view = target.view()};
        beginRendering(commands, target.extent(), color);
        draw(commands, set, {}, {1, 1}, {{0, 0}, {1, 1}});
        vkCmdEndRenderingKHR(commands);
    });
}

VkRect2D Upscaler::scaledArea(const VkRect2D& area, VkExtent2D from, VkExtent2D to) {
    const auto scale = [](int64_t value, uint32_t fromSize, uint32_t toSize) {
        return static_cast<int32_t>(value * toSize / fromSize);
    };
    const int32_t left = scale(area.offset.x, from.width, to.width), top = scale(area.offset.y, from.height, to.height);
    const int32_t right = scale(int64_t{area.offset.x} + area.extent.width, from.width, to.width);
    const int32_t bottom = scale(int64_t{area.offset.y} + area.extent.height, from.height, to.height);
    return {{left, top},
            {static_cast<uint32_t>(std::max(right - left, 1)), static_cast<uint32_t>(std::max(bottom - top, 1))}};
}

void Upscaler::draw(VkCommandBuffer commands, VkDescriptorSet set, const VkRect2D& drawn, VkExtent2D size,
                    const VkRect2D& shown) const {
    const VkViewport viewport{static_cast<float>(shown.offset.x),
                              static_cast<float>(shown.offset.y),
                              static_cast<float>(shown.extent.width),
                              static_cast<float>(shown.extent.height),
                              0.0f,
                              1.0f};
    const vec2 whole(size.width, size.height);
    m_pipeline.bind(commands);
    m_pipeline.bindSets(commands, {set});
    m_pipeline.push(commands, UpscalePush{vec2(drawn.offset.x, drawn.offset.y) / whole,
                                          vec2(drawn.extent.width, drawn.extent.height) / whole});
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdDraw(commands, 4, 1, 0, 0);
}

void Upscaler::addPass(FrameGraph& graph, ImageId world, const VkRect2D& drawn, FrameTargets& targets,
                       const VkRect2D& shown) {
    graph.addPass(
        "upscale",
        [&](PassBuilder& pass) {
            pass.read(world, access::kFragmentSample);
            targets.color = pass.write(targets.color, access::kColorAttachment);
            if (targets.samples) targets.samples = pass.write(targets.samples, access::kColorAttachment);
        },
        [this, world, drawn, shown, current = targets](PassContext& pass) {
            const VkDescriptorSet set = pass.makeSet(m_layout, {bindSampledImage(0, pass.view(world), m_sampler)});
            const Attachment color = colorAttachment(pass, current);
            beginRendering(pass.commands(), pass.extent(current.color), color);
            draw(pass.commands(), set, drawn, pass.extent(world), shown);
            vkCmdEndRenderingKHR(pass.commands());
        });
}

} // namespace q3rt
