// What follows from the stages as a whole: the cut at an imageless stage, sort, fog fading, the pass that two stages
// share, baked light. Also the materials of plain images.
#include <algorithm>
#include <utility>

#include "scene/material_compile.hpp"

namespace q3rt {
namespace {

/// A stage without an image is cut off together with every later one; detail stages go where they are not wanted.
void dropStages(MaterialDraft& draft, const CompileContext& context) {
    std::vector<StageDraft>& stages = draft.stages;
    if (!context.settings.detailTextures) std::erase_if(stages, [](const StageDraft& s) { return s.stage.detail; });
    const auto imageless = std::find_if(stages.begin(), stages.end(), [](const StageDraft& s) { return !s.hasImage; });
    if (imageless == stages.end()) return;
    if (draft.failure.empty()) draft.warn(draft.line, "a stage has no image: it and all later ones are not drawn");
    stages.erase(imageless, stages.end());
}

float resolveSort(const MaterialDraft& draft) {
    constexpr float kSky = 2, kOpaque = 3, kDecal = 4, kSeeThrough = 5, kFog = 7, kBlend = 9;
    if (draft.stages.empty() && !draft.material.isSky) return kFog;
    if (draft.material.isSky) return kSky;
    if (draft.sort != 0) return draft.sort;
    if (draft.material.polygonOffset) return kDecal;
    if (!draft.stages.empty() && draft.stages[0].stage.blended)
        return draft.stages[0].stage.depthWrite ? kSeeThrough : kBlend;
    return kOpaque;
}

bool hasBlend(const Stage& stage, BlendFactor source, BlendFactor destination) {
    return stage.blended && stage.source == source && stage.destination == destination;
}

FogFade findFogFade(const Stage& stage) {
    using enum BlendFactor;
    if (hasBlend(stage, One, One) || hasBlend(stage, Zero, OneMinusSrcColor)) return FogFade::Rgb;
    if (hasBlend(stage, SrcAlpha, OneMinusSrcAlpha)) return FogFade::Alpha;
    if (hasBlend(stage, One, OneMinusSrcAlpha)) return FogFade::Rgba;
    return FogFade::None;
}

bool isFilter(const Stage& stage) {
    return hasBlend(stage, BlendFactor::DstColor, BlendFactor::Zero) ||
           hasBlend(stage, BlendFactor::Zero, BlendFactor::SrcColor);
}

bool sameWave(const Wave& a, const Wave& b) {
    return a.function == b.function && a.base == b.base && a.amplitude == b.amplitude && a.phase == b.phase &&
           a.frequency == b.frequency;
}

/// Do both generators give one colour, by the original's test (kinds, and parameters of waves; constants are not looked
/// at)?
bool sameGenerators(const Stage& a, const Stage& b) {
    if (a.rgbGen != b.rgbGen || a.alphaGen != b.alphaGen) return false;
    if (a.rgbGen == RgbGen::Wave && !sameWave(a.rgbWave, b.rgbWave)) return false;
    return a.alphaGen != AlphaGen::Wave || sameWave(a.alphaWave, b.alphaWave);
}

bool isConstantWhite(const Stage& stage, bool identityLightIsOne) {
    const bool white =
        stage.rgbGen == RgbGen::Identity || (stage.rgbGen == RgbGen::IdentityLighting && identityLightIsOne);
    return white && stage.alphaGen == AlphaGen::Identity;
}

/// Beyond the original: an opaque stage and a filter over it, both constant white at identity light 1 and without alpha
/// test, are drawn as one product. The same picture up to the 8-bit rounding between its two passes, at half the fill.
bool canMergeFilter(const Stage& first, const Stage& second, bool identityLightIsOne) {
    return !first.blended && isFilter(second) && first.depthWrite && first.depthFunc == DepthFunc::LessEqual &&
           first.alphaTest == AlphaTest::None && second.alphaTest == AlphaTest::None &&
           isConstantWhite(first, identityLightIsOne) && isConstantWhite(second, identityLightIsOne);
}

/// How the first two stages share a pass, Combine::Single if they don't (spec of materials, 3.3).
Combine findCombine(const Stage& first, const Stage& second, bool identityLightIsOne) {
    using enum BlendFactor;
    if (canMergeFilter(first, second, identityLightIsOne)) return Combine::Multiply;
    if (first.alphaTest != second.alphaTest || first.depthFunc != second.depthFunc || !sameGenerators(first, second))
        return Combine::Single;
    if ((!first.blended || isFilter(first)) && isFilter(second)) return Combine::Multiply;
    const bool adds = (!first.blended || hasBlend(first, One, One)) && hasBlend(second, One, One);
    return adds && first.rgbGen == RgbGen::Identity ? Combine::Add : Combine::Single;
}

void collapseFirstStages(std::vector<StageDraft>& stages, const CompileContext& context) {
    if (!context.settings.multitexture || stages.size() < 2) return;
    Stage &first = stages[0].stage, &second = stages[1].stage;
    first.combine = findCombine(first, second, context.textures.settings().overbrightBits == 0);
    if (first.combine == Combine::Single) return;
    first.unit[1] = std::move(second.unit[0]);
    if (stages[0].namedLightmap) std::swap(first.unit[0], first.unit[1]);
    if (isFilter(first)) {
        first.source = BlendFactor::DstColor;
        first.destination = BlendFactor::Zero;
    }
    stages[0].namedLightmap = stages[0].namedLightmap || stages[1].namedLightmap;
    stages.erase(stages.begin() + 1);
}

int rankForVertexLight(const StageDraft& draft) {
    const Stage& stage = draft.stage;
    int rank = draft.namedLightmap ? -100 : 0;
    if (stage.unit[0].texCoordGen != TexCoordGen::Texture) rank -= 5;
    if (!stage.unit[0].mods.empty()) rank -= 5;
    if (stage.rgbGen != RgbGen::Identity && stage.rgbGen != RgbGen::IdentityLighting) rank -= 3;
    return rank;
}

/// r_vertexLight: one stage is left (spec of materials, 3.7).
void keepOneStage(std::vector<StageDraft>& stages, int lightmap) {
    if (stages.size() < 2) return;
    if (!stages[0].stage.blended) {
        const auto best = std::max_element(stages.begin(), stages.end(), [](const StageDraft& a, const StageDraft& b) {
            return rankForVertexLight(a) < rankForVertexLight(b);
        });
        StageDraft kept = std::move(*best);
        kept.stage.blended = false;
        kept.stage.source = BlendFactor::One;
        kept.stage.destination = BlendFactor::Zero;
        kept.stage.depthWrite = true;
        kept.stage.rgbGen = lightmap == lightmapContext::kNone ? RgbGen::LightingDiffuse : RgbGen::ExactVertex;
        kept.stage.alphaGen = AlphaGen::KeepFromRgb;
        stages.assign(1, std::move(kept));
        return;
    }
    const bool crossFades = stages[0].stage.rgbGen == RgbGen::OneMinusEntity ||
                            stages[1].stage.rgbGen == RgbGen::OneMinusEntity ||
                            (stages[0].stage.rgbGen == RgbGen::Wave && stages[1].stage.rgbGen == RgbGen::Wave &&
                             stages[0].stage.rgbWave.function != stages[1].stage.rgbWave.function &&
                             stages[0].stage.rgbWave.function >= WaveFunction::Sawtooth &&
                             stages[1].stage.rgbWave.function >= WaveFunction::Sawtooth);
    StageDraft kept = std::move(stages[stages[0].namedLightmap ? 1 : 0]);
    if (crossFades) kept.stage.rgbGen = RgbGen::IdentityLighting;
    stages.assign(1, std::move(kept));
}

/// r_lightmap 1: nothing after the first stage with a lightmap; in a shared pass the lightmap replaces the texture.
void showLightmapOnly(std::vector<StageDraft>& stages) {
    const auto lit = std::find_if(stages.begin(), stages.end(), [](const StageDraft& s) { return s.namedLightmap; });
    if (lit == stages.end()) return;
    if (lit->stage.combine != Combine::Single) {
        lit->stage.unit[0] = std::exchange(lit->stage.unit[1], {});
        lit->stage.combine = Combine::Single;
    }
    stages.erase(lit + 1, stages.end());
}

bool isAdditive(const Stage& stage) { return stage.blended && stage.destination == BlendFactor::One; }

BakedLight findBakedLight(const Stage& stage, int lightmap, bool anyLightmap) {
    if (stage.unit[0].isLightmap || stage.unit[1].isLightmap) return BakedLight::Lightmap;
    if (stage.rgbGen == RgbGen::LightingDiffuse) return BakedLight::LightGrid;
    // Vertex colours are baked light on the world's vertex-lit surfaces, and where a script ignores its page.
    const bool vertexLit = lightmap == lightmapContext::kByVertex || (lightmap >= 0 && !anyLightmap);
    const bool byVertex = stage.rgbGen == RgbGen::Vertex || stage.rgbGen == RgbGen::ExactVertex;
    return vertexLit && byVertex && !isAdditive(stage) ? BakedLight::VertexColor : BakedLight::None;
}

bool unitUsesTime(const TextureUnit& unit) {
    return unit.frames.size() > 1 || std::any_of(unit.mods.begin(), unit.mods.end(), [](const TexMod& mod) {
               return mod.kind != TexModKind::Scale && mod.kind != TexModKind::Transform &&
                      mod.kind != TexModKind::None;
           });
}

bool unitUsesEntity(const TextureUnit& unit) {
    return std::any_of(unit.mods.begin(), unit.mods.end(),
                       [](const TexMod& mod) { return mod.kind == TexModKind::EntityTranslate; });
}

} // namespace

void markStageUses(Material& material, int lightmap) {
    const bool anyLightmap = std::any_of(material.stages.begin(), material.stages.end(), [](const Stage& stage) {
        return stage.unit[0].isLightmap || stage.unit[1].isLightmap;
    });
    for (Stage& stage : material.stages) {
        stage.bakedLight = findBakedLight(stage, lightmap, anyLightmap);
        material.usesTime = material.usesTime || stage.rgbGen == RgbGen::Wave || stage.alphaGen == AlphaGen::Wave ||
                            unitUsesTime(stage.unit[0]) || unitUsesTime(stage.unit[1]);
        material.usesEntity = material.usesEntity || stage.rgbGen == RgbGen::Entity ||
                              stage.rgbGen == RgbGen::OneMinusEntity || stage.rgbGen == RgbGen::LightingDiffuse ||
                              stage.alphaGen == AlphaGen::Entity || stage.alphaGen == AlphaGen::OneMinusEntity ||
                              unitUsesEntity(stage.unit[0]) || unitUsesEntity(stage.unit[1]);
    }
}

void finishMaterial(MaterialDraft& draft, const CompileContext& context) {
    Material& material = draft.material;
    dropStages(draft, context);
    material.isDefault = !draft.failure.empty();
    material.isFog = (material.contentFlags & surfaceParm::kContentsFog) != 0;
    if (context.settings.vertexLight) keepOneStage(draft.stages, context.lightmap);
    material.sort = resolveSort(draft);
    material.isPortal = material.sort == 1;
    if (!draft.stages.empty() && draft.stages[0].stage.blended)
        for (StageDraft& stage : draft.stages)
            stage.stage.fogFade = findFogFade(stage.stage);
    collapseFirstStages(draft.stages, context);
    if (context.settings.lightmapMode != 0) showLightmapOnly(draft.stages);
    const bool usesPage =
        std::any_of(draft.stages.begin(), draft.stages.end(), [](const StageDraft& s) { return s.namedLightmap; });
    for (StageDraft& stage : draft.stages)
        material.stages.push_back(std::move(stage.stage));
    markStageUses(material, context.lightmap);
    // A page that no stage reads: the material is that of "no lightmap", and every surface owns a copy (draw order).
    if (context.lightmap >= 0 && !usesPage && !material.isDefault) material.lightmap = lightmapContext::kNone;
}

Material compileImage(std::string_view name, TextureId image, const CompileContext& context) {
    MaterialDraft draft;
    draft.material.name = name;
    draft.material.lightmap = context.lightmap;
    StageDraft base;
    base.hasImage = true;
    base.stage.unit[0].frames = {image};
    StageDraft below = base; // what a filter stage is laid over
    below.stage.unit[0].frames = {builtinTexture::kWhite};
    below.stage.unit[0].isWhite = true;
    if (context.lightmap == lightmapContext::kNone) {
        base.stage.rgbGen = RgbGen::LightingDiffuse; // alpha stays identity: 255 in every use
    } else if (context.lightmap == lightmapContext::kByVertex) {
        base.stage.rgbGen = RgbGen::ExactVertex;
        base.stage.alphaGen = AlphaGen::KeepFromRgb;
    } else if (context.lightmap == lightmapContext::k2D) {
        base.stage.rgbGen = RgbGen::Vertex;
        base.stage.alphaGen = AlphaGen::Vertex;
        base.stage.blended = true;
        base.stage.source = BlendFactor::SrcAlpha;
        base.stage.destination = BlendFactor::OneMinusSrcAlpha;
        base.stage.depthFunc = DepthFunc::Always;
        base.stage.depthWrite = false;
    } else {
        base.stage.blended = true;
        base.stage.source = BlendFactor::DstColor;
        base.stage.depthWrite = false;
        below.stage.rgbGen = RgbGen::IdentityLighting;
        const auto page = static_cast<size_t>(context.lightmap);
        if (context.lightmap >= 0) {
            below.namedLightmap = true;
            below.stage.rgbGen = RgbGen::Identity;
            below.stage.unit[0].texCoordGen = TexCoordGen::Lightmap;
            below.stage.unit[0].isLightmap = page < context.lightmaps.size();
            below.stage.unit[0].isWhite = !below.stage.unit[0].isLightmap;
            if (page < context.lightmaps.size()) below.stage.unit[0].frames = {context.lightmaps[page]};
        }
        draft.stages.push_back(std::move(below));
    }
    draft.stages.push_back(std::move(base));
    finishMaterial(draft, context);
    return std::move(draft.material);
}

} // namespace q3rt
