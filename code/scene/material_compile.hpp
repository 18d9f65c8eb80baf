#pragma once
// One script definition, or one plain image, to one material. The passes: read the text in file order (general lines
// and stages interleave), then finish (cut, sort, collapse, fog, baked light). Used by MaterialLibrary only.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/material.hpp"

namespace q3rt {

/// Everything outside the definition that its meaning depends on.
struct CompileContext {
    TextureLibrary& textures;
    const MaterialSettings& settings;
    const std::vector<TextureId>& lightmaps;
    const VideoStarter& startVideo;
    int lightmap = lightmapContext::kNone; ///< who asks
};

/// A stage while its lines are read. What was given matters for the defaults.
struct StageDraft {
    Stage stage;
    bool hasImage = false;
    bool namedLightmap = false; ///< a `map $lightmap` stood in it, whatever it bound
    bool depthWriteGiven = false, blendGiven = false, rgbGenGiven = false, texCoordGenGiven = false;
};

/// A definition while it is compiled.
struct MaterialDraft {
    Material material;
    std::vector<StageDraft> stages;
    bool noMipmaps = false, noPicmip = false; ///< so far in the text
    float sort = 0;                           ///< 0: not given
    std::string failure;                      ///< not empty: the definition is the default material
    std::optional<vec3> sunDirection, sunLight;
    std::optional<float> cloudHeight;
    std::string file; ///< for messages
    int line = 0;     ///< of the definition

    void fail(int line, std::string_view what);
    void warn(int line, std::string_view what) const;
};

/// Runs all passes. Side effects that outlive the material are left in the draft (sun, cloud height).
MaterialDraft compileScript(const ScriptDefinition& definition, const CompileContext& context);
/// A material for an image without a script; its form depends on who asks.
Material compileImage(std::string_view name, TextureId image, const CompileContext& context);

void readStageLine(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line, const CompileContext& context);
void readGeneralLine(MaterialDraft& draft, const ScriptLine& line, const CompileContext& context);
void finishStage(StageDraft& draft);
void finishMaterial(MaterialDraft& draft, const CompileContext& context);
/// Marks the form of baked light of every stage and what the stages depend on.
void markStageUses(Material& material, int lightmap);
/// The keywords that map compilers read: from all lines, also of a definition that failed.
LightDirectives readLightDirectives(const ScriptDefinition& definition);

// Arguments; a missing one is an empty token, as the engine's tokeniser gives it.
std::string_view argumentAt(const ScriptLine& line, size_t index);
float numberAt(const ScriptLine& line, size_t index);
/// "( x y z )" from argument `index` on, advanced behind it. nullopt without the opening bracket.
std::optional<vec3> vectorAt(const ScriptLine& line, size_t& index);
/// "function base amplitude phase frequency"; an unknown function word warns and is sin.
std::optional<Wave> waveAt(const MaterialDraft& draft, const ScriptLine& line, size_t index);

} // namespace q3rt
