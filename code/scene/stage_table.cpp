// Stages evaluated at one shader time (spec of materials, sections 2.3 to 2.5).
#include "scene/stage_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace q3rt {
namespace {

static_assert(static_cast<uint>(BlendFactor::Zero) == kBlendZero);
static_assert(static_cast<uint>(BlendFactor::One) == kBlendOne);
static_assert(static_cast<uint>(BlendFactor::SrcColor) == kBlendSrcColor);
static_assert(static_cast<uint>(BlendFactor::OneMinusSrcColor) == kBlendOneMinusSrcColor);
static_assert(static_cast<uint>(BlendFactor::DstColor) == kBlendDstColor);
static_assert(static_cast<uint>(BlendFactor::OneMinusDstColor) == kBlendOneMinusDstColor);
static_assert(static_cast<uint>(BlendFactor::SrcAlpha) == kBlendSrcAlpha);
static_assert(static_cast<uint>(BlendFactor::OneMinusSrcAlpha) == kBlendOneMinusSrcAlpha);
static_assert(static_cast<uint>(BlendFactor::DstAlpha) == kBlendDstAlpha);
static_assert(static_cast<uint>(BlendFactor::OneMinusDstAlpha) == kBlendOneMinusDstAlpha);
static_assert(static_cast<uint>(BlendFactor::SrcAlphaSaturate) == kBlendSrcAlphaSaturate);
static_assert(static_cast<uint>(AlphaTest::None) == kTestNone);
static_assert(static_cast<uint>(AlphaTest::Greater0) == kTestGreater0);
static_assert(static_cast<uint>(AlphaTest::Less128) == kTestLess128);
static_assert(static_cast<uint>(AlphaTest::GreaterEqual128) == kTestGreaterEqual128);
static_assert(static_cast<uint>(Combine::Single) == kCombineSingle);
static_assert(static_cast<uint>(Combine::Multiply) == kCombineMultiply);
static_assert(static_cast<uint>(Combine::Add) == kCombineAdd);
static_assert(static_cast<uint>(BakedLight::None) == kBakedNone);
static_assert(static_cast<uint>(BakedLight::Lightmap) == kBakedLightmap);
static_assert(static_cast<uint>(BakedLight::VertexColor) == kBakedVertex);
static_assert(static_cast<uint>(BakedLight::LightGrid) == kBakedGrid);
static_assert(static_cast<uint>(FogFade::None) == kFadeNone);
static_assert(static_cast<uint>(FogFade::Rgb) == kFadeRgb);
static_assert(static_cast<uint>(FogFade::Alpha) == kFadeAlpha);
static_assert(static_cast<uint>(FogFade::Rgba) == kFadeRgba);
static_assert(static_cast<uint>(TexCoordGen::Texture) == kCoordTexture);
static_assert(static_cast<uint>(TexCoordGen::Lightmap) == kCoordLightmap);
static_assert(static_cast<uint>(TexCoordGen::Environment) == kCoordEnvironment);
static_assert(static_cast<uint>(TexCoordGen::Vector) == kCoordVector);

/// The fraction in [0, 1), also after rounding to float.
float wrapToUnit(double value) {
    const auto fraction = static_cast<float>(value - std::floor(value));
    return fraction < 1.0f ? fraction : 0.0f;
}

/// A colour byte's value on the [0, 1] scale: truncated as the original stores it.
float toByteScale(double value) { return static_cast<float>(std::trunc(255.0 * std::clamp(value, 0.0, 1.0)) / 255.0); }

/// s' = m00 s + m10 t + x, t' = m01 s + m11 t + y, in double while it is folded.
struct Affine {
    double m00 = 1, m01 = 0, m10 = 0, m11 = 1, x = 0, y = 0;

    Affine then(const Affine& next) const {
        return {m00 * next.m00 + m01 * next.m10,      m00 * next.m01 + m01 * next.m11,
                m10 * next.m00 + m11 * next.m10,      m10 * next.m01 + m11 * next.m11,
                x * next.m00 + y * next.m10 + next.x, x * next.m01 + y * next.m11 + next.y};
    }
};

Affine scaleAboutCentre(double factor) { return {factor, 0, 0, factor, 0.5 - 0.5 * factor, 0.5 - 0.5 * factor}; }

Affine rotateAboutCentre(double degreesPerSecond, double time) {
    constexpr int kTableSize = 1024;
    const double position = std::trunc(-degreesPerSecond * time * kTableSize / 360.0);
    const int index = static_cast<int>(std::fmod(position, double(kTableSize)));
    const double s = sineTable(index), c = sineTable(index + kTableSize / 4);
    return {c, s, -s, c, 0.5 - 0.5 * c + 0.5 * s, 0.5 - 0.5 * s - 0.5 * c};
}

Affine evaluateAffine(const TexMod& mod, double time, vec2 entityTexCoord) {
    const auto& v = mod.value;
    switch (mod.kind) {
    case TexModKind::Scale:
        return {v[0], 0, 0, v[1], 0, 0};
    case TexModKind::Scroll:
        return {1, 0, 0, 1, wrapToUnit(v[0] * time), wrapToUnit(v[1] * time)};
    case TexModKind::EntityTranslate:
        return {1, 0, 0, 1, wrapToUnit(entityTexCoord.x * time), wrapToUnit(entityTexCoord.y * time)};
    case TexModKind::Stretch: {
        // A wave at 0 would be an infinite scale; the largest finite one keeps infinities out of buffers.
        constexpr double kLargestStretch = 1e6;
        const double wave = evaluateWave(mod.wave, time);
        return scaleAboutCentre(wave != 0 ? std::clamp(1.0 / wave, -kLargestStretch, kLargestStretch)
                                          : kLargestStretch);
    }
    case TexModKind::Transform:
        return {v[0], v[1], v[2], v[3], v[4], v[5]};
    case TexModKind::Rotate:
        return rotateAboutCentre(v[0], time);
    case TexModKind::Turb:
    case TexModKind::None:
        break;
    }
    return {};
}

TexModState toState(const Affine& a) {
    TexModState state{};
    state.matrix = vec4(a.m00, a.m01, a.m10, a.m11);
    state.translate = vec2(a.x, a.y);
    state.kind = kModAffine;
    return state;
}

TexModState evaluateTurb(const Wave& wave, double time) {
    TexModState state{};
    state.matrix = vec4(wave.amplitude, wrapToUnit(wave.phase + time * wave.frequency), 0, 0);
    state.kind = kModTurb;
    return state;
}

/// Neighbouring affine mods become one; a turb stays a step of its own. An unknown mod ends the list.
void evaluateMods(const TextureUnit& unit, double time, const StageInputs& inputs, TextureUnitState& state) {
    Affine pending;
    bool hasPending = false;
    const auto flush = [&] {
        if (hasPending) state.mods[state.modCount++] = toState(pending);
        pending = {};
        hasPending = false;
    };
    for (const TexMod& mod : unit.mods) {
        if (mod.kind == TexModKind::None) break;
        if (mod.kind == TexModKind::Turb) {
            flush();
            state.mods[state.modCount++] = evaluateTurb(mod.wave, time);
            continue;
        }
        pending = pending.then(evaluateAffine(mod, time, inputs.entityTexCoord));
        hasPending = true;
    }
    flush();
}

TextureId frameAt(const TextureUnit& unit, double time) {
    if (unit.frames.size() < 2) return unit.frames.empty() ? builtinTexture::kWhite : unit.frames[0];
    // 10 bits of fraction are dropped after truncation, so a frame lasts a whole number of 1/1024 steps.
    const double steps = std::trunc(time * unit.framesPerSecond * 1024.0);
    const double frame = steps > 0 ? std::floor(steps / 1024.0) : 0.0;
    return unit.frames[static_cast<size_t>(std::fmod(frame, static_cast<double>(unit.frames.size())))];
}

TextureUnitState evaluateUnit(const TextureUnit& unit, double time, const StageInputs& inputs) {
    TextureUnitState state{};
    state.texture = frameAt(unit, time);
    state.coord = static_cast<uint>(unit.texCoordGen);
    state.vectorS = unit.texCoordVectors[0];
    state.vectorT = unit.texCoordVectors[1];
    state.isLightmap = unit.isLightmap ? 1 : 0;
    evaluateMods(unit, time, inputs, state);
    return state;
}

vec3 rgbOf(U8vec4 color) { return vec3(color) / 255.0f; }

double evaluateRgbWave(const Wave& wave, double time, float identityLight) {
    const double value = evaluateWave(wave, time);
    return wave.function == WaveFunction::Noise ? value : value * identityLight;
}

void evaluateRgb(const Stage& stage, double time, const StageInputs& inputs, float identityLight, StageState& state) {
    vec3 rgb{1};
    state.rgbGen = kColorConstant;
    switch (stage.rgbGen) {
    case RgbGen::Identity:
        break;
    case RgbGen::IdentityLighting:
        rgb = vec3(toByteScale(identityLight));
        break;
    case RgbGen::Constant:
        rgb = rgbOf(stage.constantColor);
        break;
    case RgbGen::Vertex:
    case RgbGen::ExactVertex:
        state.rgbGen = kColorVertex;
        rgb = vec3(stage.rgbGen == RgbGen::Vertex ? identityLight : 1.0f);
        break;
    case RgbGen::OneMinusVertex:
        state.rgbGen = kColorOneMinusVertex;
        rgb = vec3(identityLight);
        break;
    case RgbGen::Entity:
        rgb = inputs.hasEntity ? rgbOf(inputs.entityColor) : vec3(0);
        break;
    case RgbGen::OneMinusEntity:
        rgb = inputs.hasEntity ? vec3(1) - rgbOf(inputs.entityColor) : vec3(1);
        break;
    case RgbGen::Wave:
        rgb = vec3(toByteScale(evaluateRgbWave(stage.rgbWave, time, identityLight)));
        break;
    case RgbGen::LightingDiffuse:
        // Nothing is lit outside an entity: black.
        if (inputs.hasEntity) state.rgbGen = kColorLightingDiffuse;
        rgb = vec3(inputs.hasEntity ? 1.0f : 0.0f);
        break;
    }
    state.color = vec4(rgb, 1);
}

/// Alpha as the rgb generator left it.
void keepAlpha(const Stage& stage, const StageInputs& inputs, float identityLight, StageState& state) {
    switch (stage.rgbGen) {
    case RgbGen::IdentityLighting:
        state.color.a = toByteScale(identityLight);
        break;
    case RgbGen::Constant:
        state.color.a = static_cast<float>(stage.constantColor.a) / 255.0f;
        break;
    case RgbGen::Vertex:
    case RgbGen::ExactVertex:
        state.alphaGen = kAlphaVertex;
        break;
    case RgbGen::Entity:
        state.color.a = inputs.hasEntity ? static_cast<float>(inputs.entityColor.a) / 255.0f : 0.0f;
        break;
    case RgbGen::OneMinusEntity:
        state.color.a = inputs.hasEntity ? 1.0f - static_cast<float>(inputs.entityColor.a) / 255.0f : 1.0f;
        break;
    case RgbGen::LightingDiffuse:
        state.color.a = inputs.hasEntity ? 1.0f : 0.0f;
        break;
    case RgbGen::Identity:
    case RgbGen::OneMinusVertex:
    case RgbGen::Wave:
        break;
    }
}

void evaluateAlpha(const Stage& stage, double time, const StageInputs& inputs, float identityLight, StageState& state) {
    const float entityAlpha = inputs.hasEntity ? static_cast<float>(inputs.entityColor.a) / 255.0f : 0.0f;
    state.alphaGen = kAlphaConstant;
    switch (stage.alphaGen) {
    case AlphaGen::Identity:
        // At identity light 1 the original takes a short cut that leaves the vertex alpha.
        if (stage.rgbGen == RgbGen::Vertex && identityLight == 1.0f) state.alphaGen = kAlphaVertex;
        break;
    case AlphaGen::Constant:
        state.color.a = static_cast<float>(stage.constantColor.a) / 255.0f;
        break;
    case AlphaGen::Vertex:
        state.alphaGen = kAlphaVertex;
        break;
    case AlphaGen::OneMinusVertex:
        state.alphaGen = kAlphaOneMinusVertex;
        break;
    case AlphaGen::Entity:
        state.color.a = entityAlpha;
        break;
    case AlphaGen::OneMinusEntity:
        state.color.a = 1.0f - entityAlpha;
        break;
    case AlphaGen::Wave:
        state.color.a = toByteScale(evaluateWave(stage.alphaWave, time));
        break;
    case AlphaGen::LightingSpecular:
        state.alphaGen = kAlphaLightingSpecular;
        break;
    case AlphaGen::Portal:
        state.alphaGen = kAlphaPortal;
        break;
    case AlphaGen::KeepFromRgb:
        keepAlpha(stage, inputs, identityLight, state);
        break;
    }
}

uint64_t mixHash(uint64_t hash, uint64_t value) {
    constexpr uint64_t kGoldenRatio = 0x9e3779b97f4a7c15u; // 2^64 divided by the golden ratio
    hash = (hash ^ value) * kGoldenRatio;
    return hash ^ (hash >> 32);
}

uint64_t hashInputs(MaterialId material, const StageInputs& inputs) {
    uint64_t hash = mixHash(material, std::bit_cast<uint64_t>(inputs.shaderTimeSeconds));
    hash = mixHash(hash, std::bit_cast<uint32_t>(inputs.entityColor));
    hash = mixHash(hash, std::bit_cast<uint64_t>(inputs.entityTexCoord));
    return mixHash(hash, inputs.hasEntity ? 1 : 0);
}

bool sameInputs(const StageInputs& a, const StageInputs& b) {
    return a.shaderTimeSeconds == b.shaderTimeSeconds && a.entityColor == b.entityColor &&
           a.entityTexCoord == b.entityTexCoord && a.hasEntity == b.hasEntity;
}

} // namespace

StageState evaluateStage(const Material& material, const Stage& stage, const StageInputs& inputs, float identityLight) {
    double time = inputs.shaderTimeSeconds - material.timeOffsetSeconds;
    if (material.clampTimeSeconds != 0) time = std::min(time, static_cast<double>(material.clampTimeSeconds));
    StageState state{};
    evaluateRgb(stage, time, inputs, identityLight, state);
    evaluateAlpha(stage, time, inputs, identityLight, state);
    state.unit[0] = evaluateUnit(stage.unit[0], time, inputs);
    state.unit[1] = evaluateUnit(stage.unit[1], time, inputs);
    state.combine = static_cast<uint>(stage.combine);
    state.bakedLight = static_cast<uint>(stage.bakedLight);
    state.sourceBlend = static_cast<uint>(stage.source);
    state.destinationBlend = static_cast<uint>(stage.destination);
    state.blended = stage.blended ? 1 : 0;
    state.alphaTest = static_cast<uint>(stage.alphaTest);
    state.fogFade = static_cast<uint>(stage.fogFade);
    state.portalRange = material.portalRange;
    state.depthEqual = stage.depthFunc == DepthFunc::Equal ? 1 : 0;
    state.depthWrite = stage.depthWrite ? 1 : 0;
    return state;
}

void StageTable::beginFrame() {
    // What was new in the last frame and lasts moves forward to what did before.
    for (Key& key : m_keys) {
        if (!key.lasts || key.range.first < m_lastingCount) continue;
        std::copy_n(m_states.begin() + key.range.first, key.range.count,
                    m_states.begin() + static_cast<ptrdiff_t>(m_lastingCount));
        key.range.first = static_cast<uint32_t>(m_lastingCount);
        m_lastingCount += key.range.count;
    }
    m_states.resize(m_lastingCount);
    std::erase_if(m_keys, [](const Key& key) { return !key.lasts; });
    m_heads.assign(kBuckets, kNoKey);
    for (Key& key : m_keys)
        addToChain(key);
}

void StageTable::addToChain(Key& key) {
    uint32_t& head = m_heads[hashInputs(key.material, key.inputs) % kBuckets];
    key.next = head;
    head = static_cast<uint32_t>(&key - m_keys.data());
}

StageRange StageTable::evaluate(MaterialId material, const StageInputs& inputs) {
    const Material& drawn = m_materials.drawn(material);
    const MaterialId id = drawn.sharedStages;
    // What no stage reads does not tell evaluations apart.
    StageInputs used;
    used.entityColor = U8vec4(0);
    if (drawn.usesTime) used.shaderTimeSeconds = inputs.shaderTimeSeconds - drawn.timeOffsetSeconds;
    if (drawn.usesEntity) {
        used.entityColor = inputs.entityColor;
        used.entityTexCoord = inputs.entityTexCoord;
        used.hasEntity = inputs.hasEntity;
    }
    if (m_heads.empty()) m_heads.assign(kBuckets, kNoKey);
    for (uint32_t key = m_heads[hashInputs(id, used) % kBuckets]; key != kNoKey; key = m_keys[key].next)
        if (m_keys[key].material == id && sameInputs(m_keys[key].inputs, used)) return m_keys[key].range;
    const StageRange range{static_cast<uint32_t>(m_states.size()), static_cast<uint32_t>(drawn.stages.size())};
    for (const Stage& stage : drawn.stages) {
        StageState state = evaluateStage(drawn, stage, inputs, m_identityLight);
        for (TextureUnitState& unit : state.unit)
            unit.clamped = m_textures.get(unit.texture).flags.clamp ? 1 : 0;
        m_states.push_back(state);
    }
    m_keys.push_back({id, used, range, kNoKey, !drawn.usesTime && !drawn.usesEntity});
    addToChain(m_keys.back());
    return range;
}

} // namespace q3rt
