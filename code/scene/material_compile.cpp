// General keywords of a definition, and the order in which a definition is read.
#include "scene/material_compile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

constexpr size_t kMaxStages = 8, kMaxDeforms = 3; // of the language

struct ParmFlag {
    std::string_view name;
    uint32_t surface, contents;
};
// The surfaceparm words that any renderer or light rule here reads.
constexpr ParmFlag kParmFlags[] = {
    {"nodamage", surfaceParm::kNoDamage, 0},
    {"slick", surfaceParm::kSlick, 0},
    {"sky", surfaceParm::kSky, 0},
    {"noimpact", surfaceParm::kNoImpact, 0},
    {"nomarks", surfaceParm::kNoMarks, 0},
    {"nodraw", surfaceParm::kNoDraw, 0},
    {"nodlight", surfaceParm::kNoDlight, 0},
    {"lava", 0, surfaceParm::kContentsLava},
    {"slime", 0, surfaceParm::kContentsSlime},
    {"water", 0, surfaceParm::kContentsWater},
    {"fog", 0, surfaceParm::kContentsFog},
    {"trans", 0, surfaceParm::kContentsTranslucent},
};

struct SortWord {
    std::string_view name;
    float value;
};
constexpr SortWord kSortWords[] = {{"portal", 1},     {"sky", 2},        {"opaque", 3},
                                   {"decal", 4},      {"seethrough", 5}, {"banner", 6},
                                   {"underwater", 8}, {"additive", 10},  {"nearest", 16}};

void readSky(MaterialDraft& draft, const ScriptLine& line, const CompileContext& context) {
    if (line.arguments.size() < 3) {
        draft.warn(line.line, "skyparms wants an outer box, a cloud height and an inner box: not a sky");
        return;
    }
    SkyParameters& sky = draft.material.sky;
    const std::string outer = line.arguments[0];
    if (outer != "-") {
        constexpr const char* kSides[6] = {"rt", "lf", "bk", "ft", "up", "dn"};
        const TextureFlags flags{true, true, true};
        for (size_t i = 0; i < 6; ++i)
            sky.box[i] =
                context.textures.load(outer + "_" + kSides[i] + ".tga", flags).value_or(builtinTexture::kDefault);
        sky.hasBox = sky.box[0] != builtinTexture::kDefault;
    }
    sky.cloudHeight = numberAt(line, 1);
    if (sky.cloudHeight == 0) sky.cloudHeight = 512;
    draft.cloudHeight = sky.cloudHeight;
    draft.material.isSky = true;
}

void readCull(MaterialDraft& draft, const ScriptLine& line) {
    const std::string_view word = argumentAt(line, 0);
    if (equalsIgnoringCase(word, "none") || equalsIgnoringCase(word, "twosided") || equalsIgnoringCase(word, "disable"))
        draft.material.cull = CullMode::None;
    else if (equalsIgnoringCase(word, "back") || equalsIgnoringCase(word, "backside") ||
             equalsIgnoringCase(word, "backsided"))
        draft.material.cull = CullMode::Back;
    else
        draft.warn(line.line, "unknown cull word: front-sided");
}

void readSort(MaterialDraft& draft, const ScriptLine& line) {
    if (line.arguments.empty()) return draft.warn(line.line, "sort without a value");
    draft.sort = numberAt(line, 0);
    for (const SortWord& word : kSortWords)
        if (equalsIgnoringCase(word.name, line.arguments[0])) draft.sort = word.value;
}

void readSun(MaterialDraft& draft, const ScriptLine& line) {
    constexpr float kRadians = 3.14159265358979f / 180.0f;
    const vec3 color{numberAt(line, 0), numberAt(line, 1), numberAt(line, 2)};
    const float length = glm::length(color), yaw = numberAt(line, 4) * kRadians, pitch = numberAt(line, 5) * kRadians;
    draft.sunLight = length > 0 ? color / length * numberAt(line, 3) : vec3(0);
    draft.sunDirection = vec3(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
}

void readFog(MaterialDraft& draft, const ScriptLine& line) {
    size_t next = 0;
    const auto color = vectorAt(line, next);
    if (!color) return draft.fail(line.line, "fogParms wants ( red green blue ) depth");
    if (next >= line.arguments.size()) draft.warn(line.line, "fogParms without a depth");
    draft.material.fog = {*color, numberAt(line, next)};
}

bool readSimpleDeform(Deform& deform, std::string_view word) {
    constexpr std::pair<std::string_view, DeformKind> kWords[] = {{"projectionshadow", DeformKind::ProjectionShadow},
                                                                  {"autosprite", DeformKind::AutoSprite},
                                                                  {"autosprite2", DeformKind::AutoSprite2}};
    for (const auto& [name, kind] : kWords)
        if (equalsIgnoringCase(word, name)) {
            deform.kind = kind;
            return true;
        }
    if (word.size() == 5 && equalsIgnoringCase(word.substr(0, 4), "text")) {
        deform.kind = DeformKind::Text;
        deform.text = std::clamp(word[4] - '0', 0, 7);
        return true;
    }
    return false;
}

void readDeform(MaterialDraft& draft, const ScriptLine& line) {
    if (draft.material.deforms.size() == kMaxDeforms) return draft.warn(line.line, "only 3 deformVertexes count");
    const std::string_view word = argumentAt(line, 0);
    Deform deform;
    std::optional<Wave> wave = Wave{};
    if (readSimpleDeform(deform, word)) {
    } else if (equalsIgnoringCase(word, "wave")) {
        constexpr float kSpreadOfZero = 100;
        const float div = numberAt(line, 1);
        if (div == 0) draft.warn(line.line, "deformVertexes wave with a division of 0");
        deform.kind = DeformKind::Wave;
        deform.spread = div != 0 ? 1 / div : kSpreadOfZero;
        wave = waveAt(draft, line, 2);
    } else if (equalsIgnoringCase(word, "normal")) {
        deform.kind = DeformKind::Normal;
        wave->amplitude = numberAt(line, 1);
        wave->frequency = numberAt(line, 2);
    } else if (equalsIgnoringCase(word, "move")) {
        deform.kind = DeformKind::Move;
        deform.move = {numberAt(line, 1), numberAt(line, 2), numberAt(line, 3)};
        wave = waveAt(draft, line, 4);
    } else if (equalsIgnoringCase(word, "bulge")) {
        deform.kind = DeformKind::Bulge;
        deform.bulgeWidth = numberAt(line, 1);
        deform.bulgeHeight = numberAt(line, 2);
        deform.bulgeSpeed = numberAt(line, 3);
    } else {
        return draft.warn(line.line, "unknown deformVertexes word: no effect");
    }
    if (!wave) return draft.fail(line.line, "deformVertexes without its wave function");
    deform.wave = *wave;
    draft.material.deforms.push_back(deform);
}

void readSurfaceParm(MaterialDraft& draft, const ScriptLine& line) {
    for (const ParmFlag& flag : kParmFlags)
        if (equalsIgnoringCase(flag.name, argumentAt(line, 0))) {
            draft.material.surfaceFlags |= flag.surface;
            draft.material.contentFlags |= flag.contents;
        }
}

/// Read by editors and map compilers only.
bool isToolKeyword(std::string_view keyword) {
    return keyword.starts_with("qer") || keyword.starts_with("q3map") || keyword == "tesssize" || keyword == "light" ||
           keyword == "sun";
}

void readStage(MaterialDraft& draft, const ScriptStage& script, const CompileContext& context) {
    if (draft.stages.size() == kMaxStages) return draft.fail(draft.line, "more than 8 stages");
    StageDraft stage;
    for (const ScriptLine& line : script.lines) {
        readStageLine(draft, stage, line, context);
        if (!draft.failure.empty()) break;
    }
    finishStage(stage);
    draft.stages.push_back(std::move(stage));
}

} // namespace

std::string_view argumentAt(const ScriptLine& line, size_t index) {
    return index < line.arguments.size() ? std::string_view(line.arguments[index]) : std::string_view();
}

float numberAt(const ScriptLine& line, size_t index) { return parseScriptNumber(argumentAt(line, index)); }

std::optional<vec3> vectorAt(const ScriptLine& line, size_t& index) {
    if (argumentAt(line, index) != "(") return std::nullopt;
    vec3 result;
    for (int k = 0; k < 3; ++k)
        result[k] = numberAt(line, ++index);
    ++index;
    // A missing closing bracket costs nothing: the numbers count.
    if (argumentAt(line, index) == ")") ++index;
    return result;
}

std::optional<Wave> waveAt(const MaterialDraft& draft, const ScriptLine& line, size_t index) {
    constexpr std::pair<std::string_view, WaveFunction> kFunctions[] = {
        {"sin", WaveFunction::Sin},
        {"square", WaveFunction::Square},
        {"triangle", WaveFunction::Triangle},
        {"sawtooth", WaveFunction::Sawtooth},
        {"inversesawtooth", WaveFunction::InverseSawtooth},
        {"noise", WaveFunction::Noise}};
    if (index >= line.arguments.size()) return std::nullopt;
    const auto* known = std::find_if(std::begin(kFunctions), std::end(kFunctions), [&](const auto& entry) {
        return equalsIgnoringCase(entry.first, line.arguments[index]);
    });
    Wave wave;
    if (known == std::end(kFunctions))
        draft.warn(line.line, "unknown wave function '" + line.arguments[index] + "': sin");
    else
        wave.function = known->second;
    wave.base = numberAt(line, index + 1);
    wave.amplitude = numberAt(line, index + 2);
    wave.phase = numberAt(line, index + 3);
    wave.frequency = numberAt(line, index + 4);
    return wave;
}

void MaterialDraft::fail(int line, std::string_view what) {
    failure = what;
    warn(line, std::string(what) + ": the default material is drawn instead");
}

void MaterialDraft::warn(int line, std::string_view what) const {
    logLineOnce(LogLevel::Warning, "%s:%d: shader %s: %.*s", file.c_str(), line, material.name.c_str(),
                static_cast<int>(what.size()), what.data());
}

void readGeneralLine(MaterialDraft& draft, const ScriptLine& line, const CompileContext& context) {
    const std::string& keyword = line.keyword;
    Material& material = draft.material;
    if (keyword == "surfaceparm") return readSurfaceParm(draft, line);
    if (keyword == "deformvertexes") return readDeform(draft, line);
    if (keyword == "skyparms") return readSky(draft, line, context);
    if (keyword == "cull") return readCull(draft, line);
    if (keyword == "sort") return readSort(draft, line);
    if (keyword == "fogparms") return readFog(draft, line);
    if (keyword.starts_with("q3map_sun")) return readSun(draft, line);
    if (isToolKeyword(keyword)) return;
    if (keyword == "clamptime")
        material.clampTimeSeconds = numberAt(line, 0);
    else if (keyword == "nomipmaps")
        draft.noMipmaps = draft.noPicmip = true;
    else if (keyword == "nopicmip")
        draft.noPicmip = true;
    else if (keyword == "polygonoffset")
        material.polygonOffset = true;
    else if (keyword == "entitymergable")
        material.entityMergable = true;
    else if (keyword == "portal")
        draft.sort = 1;
    else
        draft.fail(line.line, "unknown keyword '" + keyword + "'");
}

MaterialDraft compileScript(const ScriptDefinition& definition, const CompileContext& context) {
    MaterialDraft draft;
    draft.file = definition.file;
    draft.line = definition.line;
    draft.material.name = definition.name;
    draft.material.lightmap = context.lightmap;
    draft.material.explicitScript = true;
    size_t line = 0;
    const auto readLinesUpTo = [&](size_t end) {
        for (; line < end && line < definition.lines.size() && draft.failure.empty(); ++line)
            readGeneralLine(draft, definition.lines[line], context);
    };
    for (size_t i = 0; i < definition.stages.size() && draft.failure.empty(); ++i) {
        readLinesUpTo(i < definition.stageAfterLine.size() ? definition.stageAfterLine[i] : definition.lines.size());
        if (draft.failure.empty()) readStage(draft, definition.stages[i], context);
    }
    readLinesUpTo(definition.lines.size());
    if (definition.failed && draft.failure.empty()) draft.failure = definition.failure; // reported by the parser
    const bool isFog = (draft.material.contentFlags & surfaceParm::kContentsFog) != 0;
    if (draft.failure.empty() && draft.stages.empty() && !draft.material.isSky && !isFog)
        draft.fail(definition.line, "no stages");
    finishMaterial(draft, context);
    draft.material.light = readLightDirectives(definition);
    return draft;
}

} // namespace q3rt
