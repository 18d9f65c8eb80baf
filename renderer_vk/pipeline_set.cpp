#include "renderer_vk/pipeline_set.hpp"

#include <bit>
#include <cstddef>
#include <set>

#include "gpu/device.hpp"

#include "shaders/shared/raster.h"
#include "shaders/shared/stage.h"
#include "shaders/shared/vertex.h"
#include "spirv/vk_raster_frag.hpp"
#include "spirv/vk_raster_vert.hpp"

namespace q3rt {

namespace {

VkBlendFactor toVulkan(BlendFactor factor) {
    switch (factor) {
    case BlendFactor::Zero:
        return VK_BLEND_FACTOR_ZERO;
    case BlendFactor::One:
        return VK_BLEND_FACTOR_ONE;
    case BlendFactor::SrcColor:
        return VK_BLEND_FACTOR_SRC_COLOR;
    case BlendFactor::OneMinusSrcColor:
        return VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR;
    case BlendFactor::DstColor:
        return VK_BLEND_FACTOR_DST_COLOR;
    case BlendFactor::OneMinusDstColor:
        return VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR;
    case BlendFactor::SrcAlpha:
        return VK_BLEND_FACTOR_SRC_ALPHA;
    case BlendFactor::OneMinusSrcAlpha:
        return VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    case BlendFactor::DstAlpha:
        return VK_BLEND_FACTOR_DST_ALPHA;
    case BlendFactor::OneMinusDstAlpha:
        return VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA;
    case BlendFactor::SrcAlphaSaturate:
        return VK_BLEND_FACTOR_SRC_ALPHA_SATURATE;
    }
    return VK_BLEND_FACTOR_ONE;
}

VkCompareOp toVulkan(DepthFunc function) {
    switch (function) {
    case DepthFunc::LessEqual:
        return VK_COMPARE_OP_LESS_OR_EQUAL;
    case DepthFunc::Equal:
        return VK_COMPARE_OP_EQUAL;
    case DepthFunc::Always:
        return VK_COMPARE_OP_ALWAYS;
    }
    return VK_COMPARE_OP_LESS_OR_EQUAL;
}

uint32_t offsetInVertex(size_t offset) { return static_cast<uint32_t>(offset); }

std::vector<VkVertexInputAttributeDescription> vertexAttributes() {
    return {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetInVertex(offsetof(Vertex, position))},
            {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetInVertex(offsetof(Vertex, normal))},
            {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetInVertex(offsetof(Vertex, st))},
            {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetInVertex(offsetof(Vertex, lightmapSt))},
            {4, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetInVertex(offsetof(Vertex, color))}};
}

// Red, green, blue: the original's frame buffer has no alpha, it always reads 1.
VkColorComponentFlags writeMaskOf(const StateKey& key) {
    if (key.pass == kPassDepth) return 0;
    return VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;
}

uint32_t layerWord(const LayerState& layer) {
    return static_cast<uint32_t>(layer.source) | static_cast<uint32_t>(layer.destination) << kLayerDestinationShift |
           static_cast<uint32_t>(layer.alphaTest) << kLayerTestShift | (layer.white ? kLayerWhite : 0u);
}

std::optional<VkStencilOpState> stencilState(StencilUse use) {
    constexpr uint32_t kAll = 0xff;
    if (use == StencilUse::None) return std::nullopt;
    VkStencilOpState state{
        VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, kAll, kAll, 0};
    if (use == StencilUse::CountUp) state.passOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP;
    if (use == StencilUse::CountDown) state.passOp = VK_STENCIL_OP_DECREMENT_AND_CLAMP;
    if (use == StencilUse::Clear) state.passOp = VK_STENCIL_OP_ZERO;
    if (use == StencilUse::WhereCounted) state.compareOp = VK_COMPARE_OP_NOT_EQUAL;
    return state;
}

} // namespace

StateKey stageKey(const Stage& stage, bool clipped) {
    StateKey key;
    key.blended = stage.blended;
    if (stage.blended) {
        key.source = stage.source;
        key.destination = stage.destination;
    }
    key.depthFunc = stage.depthFunc;
    key.depthWrite = stage.depthWrite;
    key.alphaTest = stage.alphaTest;
    key.combine = stage.combine;
    key.pass = kPassStage;
    key.clipped = clipped;
    return key;
}

StateKey passKey(const std::vector<Stage>& stages, const StagePass& pass, bool clipped) {
    StateKey key = stageKey(stages[pass.firstStage], clipped);
    key.layerCount = static_cast<uint8_t>(pass.stageCount);
    key.layers = pass.layers;
    return key;
}

StateKey lightKey(bool additive, bool clipped) {
    StateKey key;
    key.blended = true;
    key.source = additive ? BlendFactor::One : BlendFactor::DstColor;
    key.destination = BlendFactor::One;
    key.depthFunc = DepthFunc::Equal;
    key.depthWrite = false;
    key.pass = kPassLight;
    key.clipped = clipped;
    return key;
}

StateKey fogKey(bool depthEqual, bool clipped) {
    StateKey key;
    key.blended = true;
    key.source = BlendFactor::SrcAlpha;
    key.destination = BlendFactor::OneMinusSrcAlpha;
    key.depthFunc = depthEqual ? DepthFunc::Equal : DepthFunc::LessEqual;
    key.depthWrite = false;
    key.pass = kPassFog;
    key.clipped = clipped;
    return key;
}

StateKey overlayKey() {
    StateKey key;
    key.blended = true;
    key.source = BlendFactor::SrcAlpha;
    key.destination = BlendFactor::OneMinusSrcAlpha;
    key.depthFunc = DepthFunc::Always;
    key.depthWrite = false;
    return key;
}

StateKey depthKey() {
    StateKey key;
    key.pass = kPassDepth;
    return key;
}

StateKey depthClearKey() {
    StateKey key = depthKey();
    key.depthFunc = DepthFunc::Always;
    key.stencil = StencilUse::Clear;
    return key;
}

StateKey shadowVolumeKey(bool up, bool clipped) {
    StateKey key = depthKey();
    key.depthWrite = false;
    key.stencil = up ? StencilUse::CountUp : StencilUse::CountDown;
    key.clipped = clipped;
    return key;
}

StateKey shadowShadeKey() {
    StateKey key;
    key.blended = true;
    key.source = BlendFactor::DstColor;
    key.destination = BlendFactor::Zero;
    key.stencil = StencilUse::WhereCounted;
    return key;
}

StateKey erasingShadows(StateKey key) {
    key.stencil = StencilUse::CountDown;
    return key;
}

StateKey flareKey(const Stage& stage) {
    StateKey key = stageKey(stage, false);
    key.depthFunc = DepthFunc::Always;
    key.depthWrite = false;
    return key;
}

StateKey flareTestKey() {
    StateKey key = depthKey();
    key.depthWrite = false;
    return key;
}

StateKey edgesKey(bool clipped) {
    StateKey key;
    key.lines = true;
    key.clipped = clipped;
    return key;
}

StateKey normalsKey(bool clipped) {
    StateKey key;
    key.segments = true;
    key.clipped = clipped;
    return key;
}

StateKey skyBoxKey(bool clipped, const std::vector<Stage>& clouds) {
    StateKey key;
    key.depthWrite = false;
    key.clipped = clipped;
    if (const auto layers = findCloudLayers(clouds)) {
        key.layers = *layers;
        key.layerCount = static_cast<uint8_t>(1 + clouds.size());
    }
    return key;
}

PipelineSet::PipelineSet(Device& device, VkDescriptorSetLayout frameLayout, VkDescriptorSetLayout textureLayout,
                         VkFormat depthFormat, VkSampleCountFlagBits samples, bool blueFirst)
    : m_device(device)
    , m_frameLayout(frameLayout)
    , m_textureLayout(textureLayout)
    , m_depthFormat(depthFormat)
    , m_samples(samples)
    , m_blueFirst(blueFirst) {}

void PipelineSet::setGreyscale(float amount) {
    if (amount != m_greyscale) m_pipelines.clear();
    m_greyscale = amount;
}

const GraphicsPipeline& PipelineSet::find(const StateKey& key) {
    if (const auto known = m_pipelines.find(key); known != m_pipelines.end()) return known->second;
    // The vertex shader branches on the stage's data: equal code for all pipelines of a pass is compiled once.
    const std::vector<uint32_t> vertexConstants = {
        key.pass, 0, 0, key.clipped ? 1u : 0u, std::bit_cast<uint32_t>(m_greyscale), key.layerCount};
    const std::vector<uint32_t> constants = {key.pass,
                                             static_cast<uint32_t>(key.combine),
                                             static_cast<uint32_t>(key.alphaTest),
                                             key.clipped ? 1u : 0u,
                                             0,
                                             key.layerCount,
                                             layerWord(key.layers[0]),
                                             layerWord(key.layers[1]),
                                             layerWord(key.layers[2]),
                                             m_blueFirst ? 1u : 0u};
    GraphicsPipelineInfo info;
    info.name = "raster";
    info.vertex = {shaders::vk_raster_vert, vertexConstants};
    if (key.pass != kPassDepth) info.fragment = {shaders::vk_raster_frag, constants};
    info.interface = {{m_frameLayout, m_textureLayout}, sizeof(RasterDraw), VK_SHADER_STAGE_VERTEX_BIT};
    info.vertexBindings = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    info.vertexAttributes = vertexAttributes();
    info.depthBias = true; // 0 unless a material asks for an offset
    info.depthTest = true;
    info.depthWrite = key.depthWrite;
    info.depthCompare = toVulkan(key.depthFunc);
    info.depthFormat = m_depthFormat;
    info.samples = m_samples;
    info.stencil = stencilState(key.stencil);
    if (key.segments) info.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    if (key.lines) info.polygonMode = VK_POLYGON_MODE_LINE;
    info.colorFormats = {VK_FORMAT_R8G8B8A8_UNORM};
    info.blends = {{key.blended, toVulkan(key.source), toVulkan(key.destination), VK_BLEND_OP_ADD, writeMaskOf(key)}};
    info.dynamicStates = {VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE, VK_DYNAMIC_STATE_DEPTH_BIAS};
    return m_pipelines.emplace(key, GraphicsPipeline(m_device, info)).first->second;
}

std::vector<StateKey> PipelineSet::statesOf(const MaterialLibrary& materials, bool clipped, MaterialId flare,
                                            MaterialId sun, bool mergeStages) const {
    std::set<StateKey> states = {depthKey(), depthClearKey(), overlayKey(), shadowShadeKey(), flareTestKey()};
    for (const Stage& stage : materials.get(flare).stages)
        states.insert(flareKey(stage));
    for (const bool clips : {false, true}) {
        if (clips && !clipped) continue;
        states.insert({skyBoxKey(clips), lightKey(false, clips), lightKey(true, clips), fogKey(true, clips),
                       fogKey(false, clips), shadowVolumeKey(true, clips), shadowVolumeKey(false, clips),
                       normalsKey(clips)});
        if (m_device.capabilities().fillModeNonSolid) states.insert(edgesKey(clips));
    }
    for (size_t i = 0; i < materials.count(); ++i) {
        const Material& material = materials.get(static_cast<MaterialId>(i));
        const std::vector<Stage>& stages = material.stages;
        if (material.isSky && mergeStages) states.insert(skyBoxKey(false, stages));
        if (material.isSky && mergeStages && clipped) states.insert(skyBoxKey(true, stages));
        const bool erases = material.sort > kShadowVolumeSort || i == sun;
        const auto insert = [&](const StateKey& key) {
            states.insert(key);
            if (erases) states.insert(erasingShadows(key));
        };
        for (const bool clips : {false, true}) {
            if (clips && !clipped) continue;
            for (const StagePass& pass : findStagePasses(material, mergeStages))
                insert(passKey(stages, pass, clips));
            if (erases && (material.contentFlags & surfaceParm::kContentsFog) != 0) insert(fogKey(false, clips));
        }
    }
    return {states.begin(), states.end()};
}

} // namespace q3rt
