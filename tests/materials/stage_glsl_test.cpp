// The stage functions of the shaders against independent references in double.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "glsl_shim.hpp"
#include "scene/stage_table.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {
namespace {

using glm::dvec2;
using glm::dvec4;

std::mt19937 g_generator(20261122);

float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(g_generator); }
vec3 uniform3(float low, float high) { return {uniform(low, high), uniform(low, high), uniform(low, high)}; }
vec3 uniformDirection() {
    vec3 v = uniform3(-1, 1);
    while (glm::length(v) < 0.1f)
        v = uniform3(-1, 1);
    return glm::normalize(v);
}

StageState makeState() {
    StageState state{};
    state.color = vec4(1);
    return state;
}

TEST(StageGlsl, VertexColoursAreTruncatedBytes) {
    int checked = 0;
    for (const float identityLight : {1.0f, 0.5f, 0.25f})
        for (int value = 0; value < 256; ++value) {
            StageState state = makeState();
            state.color = vec4(vec3(identityLight), 1);
            glsl::VertexIn vertex{};
            vertex.color = vec4(static_cast<float>(value) / 255.0f);
            state.rgbGen = kColorVertex;
            state.alphaGen = kAlphaVertex;
            EXPECT_EQ(std::lround(glsl::stageColor(state, vertex, {}).r * 255), int(value * identityLight));
            EXPECT_EQ(std::lround(glsl::stageColor(state, vertex, {}).a * 255), value);
            state.rgbGen = kColorOneMinusVertex;
            state.alphaGen = kAlphaOneMinusVertex;
            EXPECT_EQ(std::lround(glsl::stageColor(state, vertex, {}).g * 255), int((255 - value) * identityLight));
            EXPECT_EQ(std::lround(glsl::stageColor(state, vertex, {}).a * 255), 255 - value);
            ++checked;
        }
    EXPECT_EQ(checked, 768);
}

TEST(StageGlsl, DiffuseLightFollowsTheFormula) {
    int checked = 0;
    for (int i = 0; i < 5000; ++i) {
        glsl::EntityIn entity{};
        entity.ambient = uniform3(0, 255);
        entity.directed = uniform3(0, 400);
        entity.lightDirection = uniformDirection();
        glsl::VertexIn vertex{};
        vertex.normal = uniformDirection();
        StageState state = makeState();
        state.rgbGen = kColorLightingDiffuse;
        const vec4 color = glsl::stageColor(state, vertex, entity);
        const double incoming = glm::dot(dvec3(vertex.normal), dvec3(entity.lightDirection));
        for (int k = 0; k < 3; ++k) {
            const double light = entity.ambient[k] + (incoming > 0 ? incoming * entity.directed[k] : 0);
            // The truncation may fall to either side where the float is next to a whole number.
            EXPECT_NEAR(color[k] * 255, std::min(255.0, std::floor(light)),
                        std::abs(light - std::round(light)) < 1e-3 ? 1.001 : 1e-3);
        }
        ++checked;
    }
    EXPECT_EQ(checked, 5000);
}

TEST(StageGlsl, SpecularAndPortalAlpha) {
    for (int i = 0; i < 5000; ++i) {
        glsl::VertexIn vertex{};
        vertex.position = uniform3(-500, 500);
        vertex.normal = uniformDirection();
        glsl::EntityIn entity{};
        entity.eye = uniform3(-500, 500);
        const dvec3 toLight = glm::normalize(dvec3(-960, 1980, 96) - dvec3(vertex.position));
        const dvec3 toEye = glm::normalize(dvec3(entity.eye) - dvec3(vertex.position));
        const dvec3 mirrored = 2.0 * glm::dot(dvec3(vertex.normal), toLight) * dvec3(vertex.normal) - toLight;
        const double along = std::max(0.0, glm::dot(mirrored, toEye));
        StageState state = makeState();
        state.alphaGen = kAlphaLightingSpecular;
        EXPECT_NEAR(glsl::stageColor(state, vertex, entity).a * 255, std::floor(255 * std::pow(along, 4)), 1.001);
        state.alphaGen = kAlphaPortal;
        state.portalRange = 700;
        entity.viewOrigin = entity.eye;
        const double share = glm::distance(dvec3(vertex.position), dvec3(entity.eye)) / 700;
        EXPECT_NEAR(glsl::stageColor(state, vertex, entity).a * 255, std::floor(255 * std::min(1.0, share)), 1.001);
    }
    glsl::VertexIn at{};
    EXPECT_EQ(glsl::portalAlpha(vec3(0), vec3(0), 0), 1.0f) << "no range: opaque, not a division by zero";
    EXPECT_EQ(glsl::specularAlpha(at, vec3(0)), 0.0f) << "eye on the vertex";
}

TEST(StageGlsl, EnvironmentAndVectorCoordinates) {
    for (int i = 0; i < 5000; ++i) {
        glsl::VertexIn vertex{};
        vertex.position = uniform3(-1000, 1000);
        vertex.normal = uniformDirection();
        const vec3 eye = uniform3(-1000, 1000);
        TextureUnitState unit{};
        unit.coord = kCoordEnvironment;
        const dvec3 w = glm::normalize(dvec3(eye) - dvec3(vertex.position));
        const dvec3 r = 2.0 * glm::dot(dvec3(vertex.normal), w) * dvec3(vertex.normal) - w;
        const vec2 st = glsl::unitCoordinates(unit, vertex, eye);
        EXPECT_NEAR(st.x, 0.5 + r.y / 2, 2e-6);
        EXPECT_NEAR(st.y, 0.5 - r.z / 2, 2e-6);
        unit.coord = kCoordVector;
        unit.vectorS = uniform3(-0.1f, 0.1f);
        unit.vectorT = uniform3(-0.1f, 0.1f);
        const vec2 projected = glsl::unitCoordinates(unit, vertex, eye);
        EXPECT_NEAR(projected.x, glm::dot(dvec3(vertex.position), dvec3(unit.vectorS)), 1e-4);
        EXPECT_NEAR(projected.y, glm::dot(dvec3(vertex.position), dvec3(unit.vectorT)), 1e-4);
    }
    TextureUnitState unit{};
    unit.coord = kCoordLightmap;
    glsl::VertexIn vertex{};
    vertex.lightmapSt = vec2(0.25f, 0.75f);
    EXPECT_EQ(glsl::unitCoordinates(unit, vertex, vec3(0)), vertex.lightmapSt);
    unit.coord = kCoordEnvironment;
    EXPECT_EQ(glsl::unitCoordinates(unit, vertex, vec3(0)), vec2(0.5f)) << "eye on the vertex: no NaN";
}

double sineOf(int64_t index) { return std::sin(2 * 3.14159265358979323846 * double(index & 1023) / 1023.0); }

/// One mod by its definition, nothing folded.
dvec2 applyByDefinition(dvec2 st, const TexMod& mod, double time, dvec3 position, dvec2 entityCoord) {
    const auto frac = [](double x) { return x - std::floor(x); };
    const auto& v = mod.value;
    switch (mod.kind) {
    case TexModKind::Scale:
        return {st.x * v[0], st.y * v[1]};
    case TexModKind::Scroll:
        return {st.x + frac(v[0] * time), st.y + frac(v[1] * time)};
    case TexModKind::EntityTranslate:
        return {st.x + frac(entityCoord.x * time), st.y + frac(entityCoord.y * time)};
    case TexModKind::Stretch: {
        const double k = 1 / evaluateWave(mod.wave, time);
        return {st.x * k + 0.5 - 0.5 * k, st.y * k + 0.5 - 0.5 * k};
    }
    case TexModKind::Transform:
        return {st.x * v[0] + st.y * v[2] + v[4], st.x * v[1] + st.y * v[3] + v[5]};
    case TexModKind::Rotate: {
        const auto i = static_cast<int64_t>(-double(v[0]) * time * 1024 / 360);
        const double s = sineOf(i), c = sineOf(i + 256);
        return {c * st.x - s * st.y + 0.5 - 0.5 * c + 0.5 * s, s * st.x + c * st.y + 0.5 - 0.5 * s - 0.5 * c};
    }
    case TexModKind::Turb: {
        const double now = mod.wave.phase + time * mod.wave.frequency;
        const auto at = [&](double x) {
            return mod.wave.amplitude * sineOf(static_cast<int64_t>(std::floor((x / 1024 + frac(now)) * 1024)));
        };
        return {st.x + at(position.x + position.z), st.y + at(position.y)};
    }
    case TexModKind::None:
        break;
    }
    return st;
}

TexMod randomMod() {
    TexMod mod;
    mod.kind = static_cast<TexModKind>(1 + g_generator() % 7);
    for (float& value : mod.value)
        value = uniform(-3, 3);
    mod.wave = {WaveFunction::Sin, uniform(1, 2), uniform(-0.5f, 0.5f), uniform(0, 1), uniform(-2, 2)};
    return mod;
}

TEST(StageGlsl, TexModsAreFoldedWithoutChangingTheirOrder) {
    int checked = 0, turbs = 0;
    for (int i = 0; i < 20000; ++i) {
        Material material;
        Stage stage;
        TextureUnit& unit = stage.unit[0];
        unit.frames = {1};
        for (size_t n = g_generator() % 5; n > 0; --n)
            unit.mods.push_back(randomMod());
        StageInputs inputs;
        inputs.shaderTimeSeconds = uniform(0, 4000);
        inputs.entityTexCoord = vec2(uniform(-1, 1), uniform(-1, 1));
        glsl::VertexIn vertex{};
        // On the grid of the sine table's cells plus a half: no float rounding decides the cell.
        vertex.position = glm::floor(uniform3(0, 2000)) + vec3(0.25f);
        vertex.st = vec2(uniform(-4, 4), uniform(-4, 4));
        dvec2 expected = vertex.st;
        double magnitude = 4;
        for (const TexMod& mod : unit.mods) {
            expected =
                applyByDefinition(expected, mod, inputs.shaderTimeSeconds, vertex.position, inputs.entityTexCoord);
            magnitude = std::max({magnitude, std::abs(expected.x), std::abs(expected.y)}) * 4;
            turbs += mod.kind == TexModKind::Turb;
        }
        const StageState state = evaluateStage(material, stage, inputs, 1);
        EXPECT_LE(state.unit[0].modCount, kMaxTexMods);
        const vec2 st = glsl::unitCoordinates(state.unit[0], vertex, vec3(0));
        // A turb may land in the neighbouring cell of the sine table: 2 pi / 1023 of its amplitude (at most 0.5 here),
        // scaled by what follows.
        const double cell = turbs ? 0.5 * 6.3 / 1023 : 0;
        EXPECT_NEAR(st.x, expected.x, magnitude * (1e-6 + cell));
        EXPECT_NEAR(st.y, expected.y, magnitude * (1e-6 + cell));
        turbs = 0;
        ++checked;
    }
    EXPECT_EQ(checked, 20000);
}

TEST(StageGlsl, CombineAndAlphaTest) {
    const vec4 color(0.5f, 1, 0.25f, 0.5f), t0(0.8f, 0.6f, 1, 1), t1(0.7f, 0.7f, 0.9f, 0.5f);
    EXPECT_EQ(glsl::combineTexels(kCombineSingle, color, t0, t1), t0 * color);
    EXPECT_EQ(glsl::combineTexels(kCombineMultiply, color, t0, t1), t0 * t1 * color);
    const vec4 sum = glsl::combineTexels(kCombineAdd, color, t0, t1);
    EXPECT_EQ(sum, vec4(1, 1, 1, 0.25f)) << "1.1, 1.3, 1.15 saturate; alphas multiply";
    const vec4 half(127.0f / 255);
    EXPECT_EQ(glsl::combineTexels(kCombineMultiply, half, vec4(1), vec4(1)), half) << "one colour for both textures";
    const float below = 127.0f / 255, above = 128.0f / 255;
    EXPECT_FALSE(glsl::passesAlphaTest(kTestGreaterEqual128, below));
    EXPECT_TRUE(glsl::passesAlphaTest(kTestGreaterEqual128, above));
    EXPECT_TRUE(glsl::passesAlphaTest(kTestLess128, below));
    EXPECT_FALSE(glsl::passesAlphaTest(kTestLess128, above));
    EXPECT_FALSE(glsl::passesAlphaTest(kTestGreater0, 0));
    EXPECT_TRUE(glsl::passesAlphaTest(kTestGreater0, 1.0f / 255));
    EXPECT_TRUE(glsl::passesAlphaTest(kTestNone, 0));
}

TEST(StageGlsl, FogFollowsTheOriginal) {
    // Measured: depth for opaque 912, 500 away and inside leaves 66 of 255.
    const float density = glsl::fogDensity(glsl::fogCoordinates(500, 912, 100, 10));
    EXPECT_EQ(std::floor(255 * (1 - density)), 66);
    EXPECT_EQ(glsl::fogDensity(glsl::fogCoordinates(500, 912, -1, 10)), 0) << "the point is above the surface";
    EXPECT_EQ(glsl::fogDensity(glsl::fogCoordinates(-5, 912, 100, 10)), 0) << "behind the eye";
    EXPECT_EQ(glsl::fogDensity(glsl::fogCoordinates(1e9f, 0, 0, 1)), 1) << "no surface, no depth";
    const MipLevel image = makeFogImage();
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 256; ++x) {
            const vec2 st((static_cast<float>(x) + 0.5f) / 256, (static_cast<float>(y) + 0.5f) / 32);
            EXPECT_EQ(static_cast<int>(255 * glsl::fogDensity(st)),
                      image.rgba[static_cast<size_t>(y * 256 + x) * 4 + 3]);
            EXPECT_EQ(glsl::fogDensity(st), fogDensity(st.x, st.y));
        }
    for (int i = 0; i < 5000; ++i) {
        const float inside = uniform(1, 500), eye = uniform(-500, -0.01f);
        const vec2 st = glsl::fogCoordinates(100, 800, inside, eye);
        EXPECT_NEAR(st.y, 1.0 / 32 + 30.0 / 32 * inside / (double(inside) - eye), 1e-6);
    }
}

TEST(StageGlsl, BlendedStagesFadeInFog) {
    const vec4 color(200 / 255.0f, 100 / 255.0f, 50 / 255.0f, 80 / 255.0f);
    const auto bytes = [](vec4 c) { return ivec3(glm::round(vec3(c) * 255.0f)); };
    const vec4 rgb = glsl::fadeColorInFog(color, kFadeRgb, 0.75f),
               alpha = glsl::fadeColorInFog(color, kFadeAlpha, 0.75f);
    EXPECT_EQ(bytes(rgb), ivec3(50, 25, 12));
    EXPECT_EQ(rgb.a, color.a);
    EXPECT_EQ(bytes(alpha), ivec3(200, 100, 50));
    EXPECT_EQ(std::lround(alpha.a * 255), 20);
    EXPECT_EQ(std::lround(glsl::fadeColorInFog(color, kFadeRgba, 0.75f).a * 255), 20);
    EXPECT_EQ(glsl::fadeColorInFog(color, kFadeNone, 0.75f), color);
}

/// A blend factor by the definition of the language; alpha of the frame is 1.
double factorOf(uint factor, const dvec4& source, double destination, int k) {
    switch (factor) {
    case kBlendOne:
        return 1;
    case kBlendSrcColor:
        return source[k];
    case kBlendOneMinusSrcColor:
        return 1 - source[k];
    case kBlendDstColor:
        return destination;
    case kBlendOneMinusDstColor:
        return 1 - destination;
    case kBlendSrcAlpha:
        return source.a;
    case kBlendOneMinusSrcAlpha:
        return 1 - source.a;
    case kBlendDstAlpha:
        return 1;
    default:
        return 0; // zero, 1 - destination alpha, saturate: min(alpha, 1 - 1)
    }
}

TEST(StageGlsl, BlendOfAllFactorPairs) {
    int checked = 0;
    for (uint source = 0; source <= kBlendSrcAlphaSaturate; ++source)
        for (uint destination = 0; destination <= kBlendOneMinusDstAlpha; ++destination)
            for (int i = 0; i < 20; ++i) {
                const vec4 color(uniform3(0, 1), uniform(0, 1));
                const vec3 frame = uniform3(0, 1);
                const vec3 result = glsl::blendColors(source, destination, color, frame);
                for (int k = 0; k < 3; ++k) {
                    const double expected = color[k] * factorOf(source, color, frame[k], k) +
                                            frame[k] * factorOf(destination, color, frame[k], k);
                    EXPECT_NEAR(result[k], std::clamp(expected, 0.0, 1.0), 1e-6);
                }
                ++checked;
            }
    EXPECT_EQ(checked, 11 * 10 * 20);
}

// T3 of the content survey: coordinates up to 2.9e9.
TEST(StageGlsl, T3HugeCoordinatesStayFiniteAndWrap) {
    Material material;
    Stage stage;
    stage.unit[0].frames = {1};
    TexMod scroll, turb, rotate;
    scroll.kind = TexModKind::Scroll;
    scroll.value = {0.3f, -0.7f};
    turb.kind = TexModKind::Turb;
    turb.wave = {WaveFunction::Sin, 0, 0.1f, 0, 0.5f};
    rotate.kind = TexModKind::Rotate;
    rotate.value = {30};
    stage.unit[0].mods = {scroll, turb, rotate};
    int checked = 0;
    for (const double time : {0.0, 10.3, 86400.0 * 30})
        for (const float size : {1e3f, 5e3f, 1e6f, 2.9e9f, -2.9e9f}) {
            StageInputs inputs;
            inputs.shaderTimeSeconds = time;
            const StageState state = evaluateStage(material, stage, inputs, 1);
            glsl::VertexIn vertex{};
            vertex.st = vec2(size, -size * 0.77f);
            vertex.position = vec3(16000, -16000, 16000);
            const vec2 st = glsl::unitCoordinates(state.unit[0], vertex, vec3(0));
            EXPECT_TRUE(std::isfinite(st.x) && std::isfinite(st.y));
            const vec2 wrapped = glsl::wrapCoordinates(st);
            EXPECT_TRUE(wrapped.x >= 0 && wrapped.x <= 1 && wrapped.y >= 0 && wrapped.y <= 1);
            ++checked;
        }
    EXPECT_EQ(checked, 15);
}

} // namespace
} // namespace q3rt
