#include "renderer_vk/stage_passes.hpp"

namespace q3rt {

namespace {

bool canBeLayer(const Stage& stage) {
    return stage.blended && !stage.depthWrite && stage.depthFunc != DepthFunc::Always &&
           stage.combine == Combine::Single;
}

/// Every pixel that the first stage gives a colour gets that of the layer too, and no other does: equal depths pass
/// both tests, and where an alpha test left a hole only `equal` keeps the layer out of it, unless a stage before has
/// written that depth already (`depthBefore`).
bool canLayOver(const Stage& first, const Stage& layer, bool depthBefore) {
    if (first.blended || !first.depthWrite || first.depthFunc != DepthFunc::LessEqual) return false;
    if (!canBeLayer(layer) || layer.fogFade != FogFade::None) return false;
    return first.alphaTest == AlphaTest::None || (layer.depthFunc == DepthFunc::Equal && !depthBefore);
}

LayerState layerOf(const Stage& stage) {
    const bool white = stage.rgbGen == RgbGen::Identity && stage.alphaGen == AlphaGen::Identity;
    return {stage.source, stage.destination, stage.alphaTest, white};
}

} // namespace

std::vector<StagePass> findStagePasses(const std::vector<Stage>& stages, bool merge) {
    std::vector<StagePass> passes;
    for (uint32_t i = 0; i < stages.size(); ++i) {
        if (merge && !passes.empty()) {
            StagePass& last = passes.back();
            if (last.stageCount < kMaxLayers && canLayOver(stages[last.firstStage], stages[i], last.firstStage > 0)) {
                last.layers[last.stageCount - 1] = layerOf(stages[i]);
                ++last.stageCount;
                continue;
            }
        }
        passes.push_back({i, 1, {}});
    }
    return passes;
}

std::vector<StagePass> findStagePasses(const Material& material, bool merge) {
    return findStagePasses(material.stages, merge && material.sort <= kShadowVolumeSort);
}

std::optional<LayerStates> findCloudLayers(const std::vector<Stage>& clouds) {
    if (clouds.empty() || clouds.size() >= kMaxLayers) return std::nullopt;
    LayerStates layers;
    for (size_t i = 0; i < clouds.size(); ++i) {
        if (!canBeLayer(clouds[i]) || clouds[i].depthFunc != DepthFunc::LessEqual) return std::nullopt;
        layers[i] = layerOf(clouds[i]);
    }
    return layers;
}

bool changesNothing(const Stage& stage, const StageState& state) {
    if (!stage.blended || stage.depthWrite) return false;
    const bool scaled = state.rgbGen == kColorConstant || state.rgbGen == kColorVertex ||
                        state.rgbGen == kColorOneMinusVertex; // color.rgb is a factor of the stage's colour
    const bool black = scaled && vec3(state.color) == vec3(0.0f) && stage.combine != Combine::Add;
    const bool clear = state.alphaGen == kAlphaConstant && state.color.a == 0;
    const bool addsNothing =
        black || stage.source == BlendFactor::Zero || (clear && stage.source == BlendFactor::SrcAlpha);
    const bool keeps = stage.destination == BlendFactor::One ||
                       (black && stage.destination == BlendFactor::OneMinusSrcColor) ||
                       (clear && stage.destination == BlendFactor::OneMinusSrcAlpha);
    return addsNothing && keeps;
}

} // namespace q3rt
