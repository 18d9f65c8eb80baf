// Keywords of a stage.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "formats/text_case.hpp"
#include "scene/material_compile.hpp"

namespace q3rt {
namespace {

constexpr size_t kMaxAnimationFrames = 8, kMaxTexMods = 4; // of the language

using FactorWord = std::pair<std::string_view, BlendFactor>;
constexpr FactorWord kSourceWords[] = {{"gl_one", BlendFactor::One},
                                       {"gl_zero", BlendFactor::Zero},
                                       {"gl_dst_color", BlendFactor::DstColor},
                                       {"gl_one_minus_dst_color", BlendFactor::OneMinusDstColor},
                                       {"gl_src_alpha", BlendFactor::SrcAlpha},
                                       {"gl_one_minus_src_alpha", BlendFactor::OneMinusSrcAlpha},
                                       {"gl_dst_alpha", BlendFactor::DstAlpha},
                                       {"gl_one_minus_dst_alpha", BlendFactor::OneMinusDstAlpha},
                                       {"gl_src_alpha_saturate", BlendFactor::SrcAlphaSaturate}};
constexpr FactorWord kDestinationWords[] = {{"gl_one", BlendFactor::One},
                                            {"gl_zero", BlendFactor::Zero},
                                            {"gl_src_color", BlendFactor::SrcColor},
                                            {"gl_one_minus_src_color", BlendFactor::OneMinusSrcColor},
                                            {"gl_src_alpha", BlendFactor::SrcAlpha},
                                            {"gl_one_minus_src_alpha", BlendFactor::OneMinusSrcAlpha},
                                            {"gl_dst_alpha", BlendFactor::DstAlpha},
                                            {"gl_one_minus_dst_alpha", BlendFactor::OneMinusDstAlpha}};

template <typename Value, size_t Count>
std::optional<Value> findWord(const std::pair<std::string_view, Value> (&words)[Count], std::string_view word) {
    for (const auto& [name, value] : words)
        if (equalsIgnoringCase(name, word)) return value;
    return std::nullopt;
}

/// Byte of a constant: truncated, and wrapped as the original's store does (2.0 gives 254).
uint8_t toWrappedByte(float value) {
    return static_cast<uint8_t>(static_cast<int>(std::fmod(std::trunc(255.0f * value), 256.0f)));
}

TextureFlags stageFlags(const MaterialDraft& draft, bool clamp) { return {!draft.noMipmaps, !draft.noPicmip, clamp}; }

void readMap(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line, const CompileContext& context) {
    const bool clamp = line.keyword == "clampmap";
    const std::string_view name = argumentAt(line, 0);
    if (name.empty()) return draft.fail(line.line, line.keyword + " without an image");
    TextureUnit& unit = stage.stage.unit[0];
    unit.framesPerSecond = 0;
    unit.videoSlot = -1;
    unit.isLightmap = unit.isWhite = false;
    stage.hasImage = false;
    if (!clamp && equalsIgnoringCase(name, "$whiteimage")) {
        unit.frames = {builtinTexture::kWhite};
        unit.isWhite = stage.hasImage = true;
        return;
    }
    if (!clamp && equalsIgnoringCase(name, "$lightmap")) {
        const auto page = static_cast<size_t>(context.lightmap);
        unit.isLightmap = context.lightmap >= 0 && page < context.lightmaps.size();
        unit.isWhite = !unit.isLightmap;
        unit.frames = {unit.isLightmap ? context.lightmaps[page] : builtinTexture::kWhite};
        stage.namedLightmap = stage.hasImage = true;
        return;
    }
    const auto image = context.textures.load(name, stageFlags(draft, clamp));
    if (!image) return draft.fail(line.line, "no image '" + std::string(name) + "'");
    unit.frames = {*image};
    stage.hasImage = true;
    unit.isWhite = *image == builtinTexture::kWhite;
}

void readAnimation(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line, const CompileContext& context) {
    if (line.arguments.empty()) return draft.fail(line.line, "animMap without a frequency");
    TextureUnit& unit = stage.stage.unit[0];
    unit.frames.clear();
    unit.isLightmap = unit.isWhite = stage.hasImage = false;
    unit.framesPerSecond = numberAt(line, 0);
    if (line.arguments.size() > kMaxAnimationFrames + 1) draft.warn(line.line, "animMap: only 8 frames count");
    const size_t end = std::min(line.arguments.size(), kMaxAnimationFrames + 1);
    for (size_t i = 1; i < end; ++i) {
        const auto image = context.textures.load(line.arguments[i], stageFlags(draft, false));
        if (!image) return draft.fail(line.line, "no image '" + line.arguments[i] + "'");
        unit.frames.push_back(*image);
    }
    stage.hasImage = !unit.frames.empty();
}

void readVideo(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line, const CompileContext& context) {
    TextureUnit& unit = stage.stage.unit[0];
    unit.videoName = argumentAt(line, 0);
    if (unit.videoName.empty()) return draft.fail(line.line, "videoMap without a file");
    unit.videoSlot = context.startVideo ? context.startVideo(unit.videoName) : -1;
    stage.hasImage = unit.videoSlot >= 0 && unit.videoSlot < builtinTexture::kScratchCount;
    if (!stage.hasImage) return draft.warn(line.line, "videoMap: can't start '" + unit.videoName + "'");
    unit.frames = {builtinTexture::kScratch0 + static_cast<TextureId>(unit.videoSlot)};
    unit.isLightmap = unit.isWhite = false;
}

void readAlphaFunc(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    constexpr std::pair<std::string_view, AlphaTest> kWords[] = {
        {"gt0", AlphaTest::Greater0}, {"lt128", AlphaTest::Less128}, {"ge128", AlphaTest::GreaterEqual128}};
    const auto test = findWord(kWords, argumentAt(line, 0));
    if (!test) draft.warn(line.line, "unknown alphaFunc word: no test");
    stage.stage.alphaTest = test.value_or(AlphaTest::None);
}

void readDepthFunc(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    constexpr std::pair<std::string_view, DepthFunc> kWords[] = {{"lequal", DepthFunc::LessEqual},
                                                                 {"equal", DepthFunc::Equal}};
    const auto function = findWord(kWords, argumentAt(line, 0));
    if (!function) return draft.warn(line.line, "unknown depthFunc word: ignored");
    stage.stage.depthFunc = *function;
}

BlendFactor readFactor(const MaterialDraft& draft, const ScriptLine& line, std::optional<BlendFactor> factor) {
    if (!factor) draft.warn(line.line, "unknown blendFunc factor: GL_ONE");
    return factor.value_or(BlendFactor::One);
}

void readBlendFunc(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    const std::string_view word = argumentAt(line, 0);
    if (word.empty()) return draft.warn(line.line, "blendFunc without factors: ignored");
    Stage& result = stage.stage;
    if (equalsIgnoringCase(word, "add")) {
        result.source = result.destination = BlendFactor::One;
    } else if (equalsIgnoringCase(word, "filter")) {
        result.source = BlendFactor::DstColor;
        result.destination = BlendFactor::Zero;
    } else if (equalsIgnoringCase(word, "blend")) {
        result.source = BlendFactor::SrcAlpha;
        result.destination = BlendFactor::OneMinusSrcAlpha;
    } else {
        // The original stops the game when it draws such a stage.
        if (line.arguments.size() < 2) return draft.fail(line.line, "blendFunc with one factor only");
        result.source = readFactor(draft, line, findWord(kSourceWords, word));
        result.destination = readFactor(draft, line, findWord(kDestinationWords, argumentAt(line, 1)));
    }
    stage.blendGiven = true;
    if (!stage.depthWriteGiven) result.depthWrite = false;
}

void readRgbGen(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    constexpr std::pair<std::string_view, RgbGen> kWords[] = {{"identity", RgbGen::Identity},
                                                              {"identitylighting", RgbGen::IdentityLighting},
                                                              {"const", RgbGen::Constant},
                                                              {"vertex", RgbGen::Vertex},
                                                              {"exactvertex", RgbGen::ExactVertex},
                                                              {"oneminusvertex", RgbGen::OneMinusVertex},
                                                              {"entity", RgbGen::Entity},
                                                              {"oneminusentity", RgbGen::OneMinusEntity},
                                                              {"wave", RgbGen::Wave},
                                                              {"lightingdiffuse", RgbGen::LightingDiffuse}};
    const auto generator = findWord(kWords, argumentAt(line, 0));
    if (!generator) return draft.warn(line.line, "unknown rgbGen word: ignored");
    Stage& result = stage.stage;
    if (*generator == RgbGen::Wave) {
        const auto wave = waveAt(draft, line, 1);
        if (!wave) return draft.fail(line.line, "rgbGen wave without a function");
        result.rgbWave = *wave;
    } else if (*generator == RgbGen::Constant) {
        size_t next = 1;
        const vec3 color = vectorAt(line, next).value_or(vec3(0));
        for (int k = 0; k < 3; ++k)
            result.constantColor[k] = toWrappedByte(color[k]);
    }
    result.rgbGen = *generator;
    stage.rgbGenGiven = true;
    if (*generator == RgbGen::Vertex && result.alphaGen == AlphaGen::Identity) result.alphaGen = AlphaGen::Vertex;
}

void readAlphaGen(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    constexpr std::pair<std::string_view, AlphaGen> kWords[] = {
        {"identity", AlphaGen::Identity}, {"const", AlphaGen::Constant},
        {"vertex", AlphaGen::Vertex},     {"oneminusvertex", AlphaGen::OneMinusVertex},
        {"entity", AlphaGen::Entity},     {"oneminusentity", AlphaGen::OneMinusEntity},
        {"wave", AlphaGen::Wave},         {"lightingspecular", AlphaGen::LightingSpecular},
        {"portal", AlphaGen::Portal}};
    constexpr float kDefaultPortalRange = 256;
    const auto generator = findWord(kWords, argumentAt(line, 0));
    if (!generator) return draft.warn(line.line, "unknown alphaGen word: ignored");
    Stage& result = stage.stage;
    if (*generator == AlphaGen::Wave) {
        const auto wave = waveAt(draft, line, 1);
        if (!wave) return draft.fail(line.line, "alphaGen wave without a function");
        result.alphaWave = *wave;
    } else if (*generator == AlphaGen::Constant) {
        result.constantColor.a = toWrappedByte(numberAt(line, 1));
    } else if (*generator == AlphaGen::Portal) {
        draft.material.portalRange = line.arguments.size() > 1 ? numberAt(line, 1) : kDefaultPortalRange;
    }
    result.alphaGen = *generator;
}

void readTexCoordGen(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    constexpr std::pair<std::string_view, TexCoordGen> kWords[] = {{"texture", TexCoordGen::Texture},
                                                                   {"base", TexCoordGen::Texture},
                                                                   {"lightmap", TexCoordGen::Lightmap},
                                                                   {"environment", TexCoordGen::Environment},
                                                                   {"vector", TexCoordGen::Vector}};
    const auto generator = findWord(kWords, argumentAt(line, 0));
    if (!generator) return draft.warn(line.line, "unknown tcGen word: ignored");
    TextureUnit& unit = stage.stage.unit[0];
    if (*generator == TexCoordGen::Vector) {
        size_t next = 1;
        unit.texCoordVectors[0] = vectorAt(line, next).value_or(vec3(0));
        unit.texCoordVectors[1] = vectorAt(line, next).value_or(vec3(0));
    }
    unit.texCoordGen = *generator;
    stage.texCoordGenGiven = true;
}

/// A kind that stays None ends the list when it is applied, as in the original.
TexMod parseTexMod(const MaterialDraft& draft, const ScriptLine& line) {
    struct ModWord {
        std::string_view name;
        TexModKind kind;
        size_t numbers;
    };
    constexpr ModWord kWords[] = {{"scale", TexModKind::Scale, 2},
                                  {"scroll", TexModKind::Scroll, 2},
                                  {"entitytranslate", TexModKind::EntityTranslate, 0},
                                  {"turb", TexModKind::Turb, 4},
                                  {"stretch", TexModKind::Stretch, 5},
                                  {"transform", TexModKind::Transform, 6},
                                  {"rotate", TexModKind::Rotate, 1}};
    TexMod mod;
    const auto* word = std::find_if(std::begin(kWords), std::end(kWords), [&](const ModWord& candidate) {
        return equalsIgnoringCase(candidate.name, argumentAt(line, 0));
    });
    if (word == std::end(kWords) || line.arguments.size() < word->numbers + 1) {
        draft.warn(line.line, "tcMod unknown or with missing numbers: it and all later ones have no effect");
        return mod;
    }
    if (word->kind == TexModKind::Stretch) {
        mod.wave = *waveAt(draft, line, 1);
    } else if (word->kind == TexModKind::Turb) {
        mod.wave = {WaveFunction::Sin, numberAt(line, 1), numberAt(line, 2), numberAt(line, 3), numberAt(line, 4)};
    } else {
        for (size_t i = 0; i < word->numbers; ++i)
            mod.value[i] = numberAt(line, i + 1);
    }
    mod.kind = word->kind;
    return mod;
}

void readTexMod(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line) {
    std::vector<TexMod>& mods = stage.stage.unit[0].mods;
    if (mods.size() == kMaxTexMods) return draft.fail(line.line, "more than 4 tcMods in a stage");
    mods.push_back(parseTexMod(draft, line));
}

} // namespace

void readStageLine(MaterialDraft& draft, StageDraft& stage, const ScriptLine& line, const CompileContext& context) {
    const std::string& keyword = line.keyword;
    if (keyword == "map" || keyword == "clampmap") return readMap(draft, stage, line, context);
    if (keyword == "animmap") return readAnimation(draft, stage, line, context);
    if (keyword == "videomap") return readVideo(draft, stage, line, context);
    if (keyword == "alphafunc") return readAlphaFunc(draft, stage, line);
    if (keyword == "depthfunc") return readDepthFunc(draft, stage, line);
    if (keyword == "blendfunc") return readBlendFunc(draft, stage, line);
    if (keyword == "rgbgen") return readRgbGen(draft, stage, line);
    if (keyword == "alphagen") return readAlphaGen(draft, stage, line);
    if (keyword == "tcgen" || keyword == "texgen") return readTexCoordGen(draft, stage, line);
    if (keyword == "tcmod") return readTexMod(draft, stage, line);
    if (keyword == "detail") {
        stage.stage.detail = true;
    } else if (keyword == "depthwrite") {
        stage.stage.depthWrite = true;
        stage.depthWriteGiven = true;
    } else {
        draft.fail(line.line, "unknown stage keyword '" + keyword + "'");
    }
}

void finishStage(StageDraft& draft) {
    Stage& stage = draft.stage;
    if (!draft.rgbGenGiven) {
        const bool lit = !draft.blendGiven || stage.source == BlendFactor::One || stage.source == BlendFactor::SrcAlpha;
        stage.rgbGen = lit ? RgbGen::IdentityLighting : RgbGen::Identity;
    }
    stage.blended = draft.blendGiven && (stage.source != BlendFactor::One || stage.destination != BlendFactor::Zero);
    if (draft.blendGiven && !stage.blended) stage.depthWrite = true;
    if (!draft.texCoordGenGiven && draft.namedLightmap) stage.unit[0].texCoordGen = TexCoordGen::Lightmap;
    // Script form only: outside an entity the generator leaves alpha 0 (spec of materials, 2.7).
    if (stage.rgbGen == RgbGen::LightingDiffuse && stage.alphaGen == AlphaGen::Identity)
        stage.alphaGen = AlphaGen::KeepFromRgb;
}

} // namespace q3rt
