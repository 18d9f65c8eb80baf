#include "renderer_rt/surface_class.hpp"

#include <algorithm>

#include "shaders/shared/rt_scene.h"

namespace q3rt {

namespace {

constexpr float kSortOpaque = 3; ///< of the shader language's sort keyword

} // namespace

std::optional<SurfaceClass> classifySurface(const Material& material) {
    if (material.isSky) return SurfaceClass::Sky;
    if (material.stages.empty() && material.isFog) return SurfaceClass::Layer;
    if (material.stages.empty()) return std::nullopt;
    // A decal lies in the plane of another surface: the drawing order decides there, as among layers.
    if (material.polygonOffset) return SurfaceClass::Layer;
    // Drawn before everything else, a portal hides what lies behind it, though its stages are blended.
    if (material.isPortal && material.cull == CullMode::Front) return SurfaceClass::Solid;
    if (material.isPortal && material.cull == CullMode::None) return SurfaceClass::SolidTwoSided;
    const auto covers = [](const Stage& s) { return !s.blended && s.depthFunc != DepthFunc::Equal; };
    const auto& stages = material.stages;
    const bool covered = std::any_of(stages.begin(), stages.end(),
                                     [&](const Stage& s) { return covers(s) && s.alphaTest == AlphaTest::None; });
    if (covered && material.cull == CullMode::Front) return SurfaceClass::Solid;
    if (covered && material.cull == CullMode::None) return SurfaceClass::SolidTwoSided;
    if (covered || std::any_of(stages.begin(), stages.end(), covers)) return SurfaceClass::Tested;
    return SurfaceClass::Layer;
}

namespace {

/// Translucent, and the script says what it is: the boundary of water or slime, or a pane (surfaceparm trans) with a
/// fake reflection, which the traced one replaces.
uint32_t reflectionFlag(const Material& material) {
    using namespace surfaceParm;
    const uint32_t contents = material.contentFlags;
    if ((contents & (kContentsWater | kContentsSlime)) != 0 && (contents & kContentsLava) == 0) return kSurfaceWater;
    const bool fakes = std::any_of(material.stages.begin(), material.stages.end(),
                                   [](const Stage& s) { return s.unit[0].texCoordGen == TexCoordGen::Environment; });
    return fakes && (contents & kContentsTranslucent) != 0 ? kSurfaceGlass : 0;
}

bool isModels(const Material& material) {
    return std::any_of(material.stages.begin(), material.stages.end(),
                       [](const Stage& s) { return s.bakedLight == BakedLight::LightGrid; });
}

} // namespace

bool isThin(const Material& material) {
    const bool letsLightPass =
        (material.contentFlags & surfaceParm::kContentsTranslucent) != 0 || material.light.alphaShadow;
    return material.cull == CullMode::None && !material.polygonOffset && (letsLightPass || isModels(material));
}

uint32_t surfaceFlags(const Material& material, SurfaceClass surfaceClass) {
    uint32_t flags = 0;
    const bool tested = std::any_of(material.stages.begin(), material.stages.end(),
                                    [](const Stage& s) { return s.alphaTest != AlphaTest::None; });
    if (tested) flags |= kSurfaceTested;
    if (material.cull == CullMode::Front) flags |= kSurfaceCullBack;
    if (material.cull == CullMode::Back) flags |= kSurfaceCullFront;
    if (surfaceClass == SurfaceClass::Sky) flags |= kSurfaceSky;
    if (surfaceClass == SurfaceClass::Layer && !material.polygonOffset) flags |= reflectionFlag(material);
    if (isThin(material)) flags |= kSurfaceThin;
    if (isModels(material)) flags |= kSurfaceModel;
    // The engine's fog pass: opaque materials, and the faces of fog volumes themselves.
    if (material.sort <= kSortOpaque || material.isFog) flags |= kSurfaceFogged;
    return flags;
}

uint32_t coverOf(std::span<const StageState> stages) {
    const StageState* only = nullptr;
    for (const StageState& stage : stages) {
        if (stage.blended != 0 || stage.depthEqual != 0) continue;
        if (only || stage.alphaTest == kTestNone) return 0;
        only = &stage;
    }
    if (!only) return 0;
    const TextureUnitState& unit = only->unit[0];
    const bool isOneTexel = only->combine == kCombineSingle && only->alphaGen == kAlphaConstant &&
                            only->color.a == 1.0f && unit.coord == kCoordTexture && unit.modCount == 0;
    if (!isOneTexel || unit.texture >> (32 - kCoverTextureShift) != 0) return 0;
    return unit.texture << kCoverTextureShift | (unit.clamped != 0 ? kCoverClamped : 0) | only->alphaTest;
}

uint8_t instanceMask(SurfaceClass surfaceClass, const Visibility& visibility) {
    // To light a sky is what the map compilers take it for: a wall that shines.
    if (surfaceClass == SurfaceClass::Sky) return kMaskSky | kMaskShadow;
    const bool layer = surfaceClass == SurfaceClass::Layer;
    uint32_t mask = 0;
    if (visibility.eye && visibility.near) mask |= layer ? kMaskNearLayer : kMaskNearSolid;
    if (visibility.eye && !visibility.near) mask |= layer ? kMaskLayer : kMaskSolid;
    if (visibility.mirrors) mask |= layer ? kMaskLayerMirror : kMaskSolidMirror;
    if (visibility.shadow && !layer) mask |= kMaskShadow;
    return static_cast<uint8_t>(mask);
}

} // namespace q3rt
