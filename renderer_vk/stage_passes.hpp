#pragma once
// Which stages of a material are drawn in one pass, and which need not be drawn at all. Pure CPU.

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/material.hpp"
#include "shaders/shared/stage.h"

namespace q3rt {

/// Shadow volumes are drawn after surfaces of this shader sort. Each pass of a later one takes from their count where
/// it is seen: the original leaves the stencil test on.
inline constexpr float kShadowVolumeSort = 14.0f;

/// Stages that a pass holds at most, the first among them.
inline constexpr uint32_t kMaxLayers = 4;

/// A stage after the first of a pass: blended in the fragment shader.
struct LayerState {
    BlendFactor source = BlendFactor::One, destination = BlendFactor::Zero;
    AlphaTest alphaTest = AlphaTest::None; ///< decides whether the layer is laid on
    bool white = false;                    ///< its colour is 1 at every vertex, and not looked at
    auto operator<=>(const LayerState&) const = default;
};

/// The layers over the first stage; equal to the default where there is none.
using LayerStates = std::array<LayerState, kMaxLayers - 1>;

/// Stages of a material that one pass draws.
struct StagePass {
    uint32_t firstStage = 0, stageCount = 1;
    LayerStates layers;
};

/// All stages in their order. `merge`: blended ones are laid over the opaque one before them in its pass wherever the
/// picture stays the same, each rounded to bytes as the frame buffer would.
std::vector<StagePass> findStagePasses(const std::vector<Stage>& stages, bool merge);
/// Of a material: what takes from the count of shadow volumes keeps its passes.
std::vector<StagePass> findStagePasses(const Material& material, bool merge);

/// Clouds over a sky's box, which is drawn from the same triangles: their layers if one pass may draw both.
std::optional<LayerStates> findCloudLayers(const std::vector<Stage>& clouds);

/// Does this stage leave every pixel as it is at its time, whatever its textures hold?
bool changesNothing(const Stage& stage, const StageState& state);

} // namespace q3rt
