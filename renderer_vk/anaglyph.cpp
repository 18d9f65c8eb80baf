#include "renderer_vk/anaglyph.hpp"

#include <utility>

#include "frame/frame_executor.hpp"
#include "renderer_vk/raster_scene.hpp"
#include "spirv/vk_anaglyph_comp.hpp"

namespace q3rt {

namespace {

constexpr int kSwappedFrom = 5; // modes 1 to 4 again, with the eyes exchanged

struct AnaglyphPush {
    vec3 left, right; // 1: that eye's colour is shown
};

/// Colours of the two eyes: of the glasses' left side, of their right side.
AnaglyphPush glassesOf(int mode) {
    static constexpr vec3 kRed(1, 0, 0), kGreen(0, 1, 0), kBlue(0, 0, 1);
    static constexpr AnaglyphPush kModes[] = {
        {kRed, kGreen + kBlue}, {kRed, kBlue}, {kRed, kGreen}, {kGreen, kRed + kBlue}};
    AnaglyphPush push = kModes[(mode - 1) % 4];
    if (mode >= kSwappedFrom) std::swap(push.left, push.right);
    return push;
}

} // namespace

Anaglyph::Anaglyph(GpuContext& context)
    : m_context(context)
    , m_layout(context.device(),
               {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}},
               "anaglyph")
    , m_pipeline(context.device(),
                 {"anaglyph", {shaders::vk_anaglyph_comp, {}}, {{m_layout.handle()}, sizeof(AnaglyphPush)}}) {
    warm();
}

void Anaglyph::warm() {
    GpuImage& picture = m_context.target();
    DescriptorArena arena(m_context.device());
    const VkDescriptorSet set =
        arena.make(m_layout, {bindStorageImage(0, picture.view()), bindStorageImage(1, picture.view())});
    m_context.device().submitAndWait([&](VkCommandBuffer commands) {
        picture.transition(commands,
                           {access::kComputeWrite.stages, access::kComputeWrite.access, access::kComputeWrite.layout});
        m_pipeline.bind(commands);
        m_pipeline.bindSets(commands, {set});
        m_pipeline.push(commands, AnaglyphPush{});
        m_pipeline.warmUp(commands);
    });
}

void Anaglyph::follow(int mode) {
    if (mode == m_mode) return;
    m_mode = mode;
    m_left = mode != 0 ? m_context.makeTargets(m_context.extent(), "left eye") : TargetImages{};
}

FrameTargets Anaglyph::leftEye(FrameGraph& graph, const FrameTargets& main) {
    FrameTargets left;
    left.color = graph.importImage("left eye", m_left.color);
    left.depth = main.depth;
    if (m_left.samples) left.samples = graph.importImage("left eye samples", m_left.samples);
    return left;
}

void Anaglyph::record(PassContext& pass, ImageId left, ImageId picture) const {
    const VkDescriptorSet set =
        pass.makeSet(m_layout, {bindStorageImage(0, pass.view(left)), bindStorageImage(1, pass.view(picture))});
    m_pipeline.bind(pass.commands());
    m_pipeline.bindSets(pass.commands(), {set});
    AnaglyphPush glasses = glassesOf(m_mode);
    if (m_context.blueFirst())
        for (vec3* colors : {&glasses.left, &glasses.right})
            std::swap(colors->r, colors->b);
    m_pipeline.push(pass.commands(), glasses);
    m_pipeline.dispatchOver(pass.commands(), pass.extent(picture));
}

void Anaglyph::addPass(FrameGraph& graph, ImageId left, FrameTargets& main) {
    graph.addPass(
        "anaglyph",
        [&](PassBuilder& pass) {
            pass.read(left, access::kComputeRead);
            main.color = pass.write(main.color, access::kComputeWrite);
        },
        [this, left, picture = main.color](PassContext& pass) { record(pass, left, picture); });
}

} // namespace q3rt
