#include "direct_shader.hpp"

#include "shaders/shared/constants.h"
#include "shaders/shared/rt_look.h"
#include "shaders/shared/rt_motion.h"
#include "shaders/shared/rt_shadow.h"
#include "shaders/shared/vertex.h"

namespace q3rt::test {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

// GLSL's four numbers with the selections that the stage's text makes of them.
struct Numbers4 {
    float x, y, z, w;
    vec2 xy;
    explicit Numbers4(const glm::vec4& v)
        : x(v.x)
        , y(v.y)
        , z(v.z)
        , w(v.w)
        , xy(v.x, v.y) {}
    Numbers4(const vec3& v, float last)
        : Numbers4(glm::vec4(v, last)) {}
};

const DirectInputs* inputsOfRun;
#define rtFrame inputsOfRun->frame

// In place of lib/random.glsl and of the tables and the tracer behind rt/scene.glsl.
#define Q3RT_LIB_RANDOM_GLSL
#define Q3RT_RT_SCENE_GLSL
#define Q3RT_RT_SAMPLER_GLSL
#define Q3RT_RT_SKY_HIT_GLSL
#define Q3RT_RT_WORK_GLSL
const uint kWorkLight = 0;
void countWork(uint, uint) {}
float unitFloat(uint bits) { return float(bits >> 8) * 0x1p-24f; }
Numbers4 unitFloats(uvec4 bits) {
    return Numbers4(glm::vec4(unitFloat(bits.x), unitFloat(bits.y), unitFloat(bits.z), unitFloat(bits.w)));
}
uvec4 sampleBits(uvec4, uint dimension) { return inputsOfRun->random(dimension); }
Numbers4 sampleNumbers(uvec4 key, uint dimension) { return unitFloats(sampleBits(key, dimension)); }
struct Hit {
    float t;
    bool sky;
};
Hit traceSolid(vec3 origin, vec3 direction, float, uint, bool first) {
    if (first) return {1, inputsOfRun->sky(origin, direction)};
    return {inputsOfRun->visible(origin, direction) ? 0.0f : 1.0f, false};
}
void countRay() {}
void reportRays(uvec2) {}
bool isSky(Hit hit) { return hit.sky; }
uint pixelIndex(uvec2) { return 0; }

struct NumberTable {
    uint at[1];
};
struct ColorTable {
    Numbers4 at[1];
};

#include "lib/light.glsl"
#include "lib/offset.glsl"

// `buffer T { ... }` declares a table, `T(address)` reaches it.
#define layout(...)
#define readonly
#define buffer struct
#define TABLE(name, address) (*reinterpret_cast<name*>(address))
#define NumberTable(address) TABLE(NumberTable, address)
#define RowTable(address) TABLE(RowTable, address)
#define ColorTable(address) TABLE(ColorTable, address)
#define LightColorTable(address) TABLE(LightColorTable, address)
#define NodeStartTable(address) TABLE(NodeStartTable, address)
#define LightTable(address) TABLE(LightTable, address)
#define vec4 Numbers4
#include "rt/direct.glsl"
#undef vec4

} // namespace

const uint kChoiceDimension = kDimensionChoice;
const float kLeastSunShare = kLeastSunChance;

RtLightRow rowOfPixel(DirectInputs& inputs, const RtPixel& pixel) {
    inputsOfRun = &inputs;
    return lightRowOf(offsetOrigin(pixel.position, pixel.error, pixel.geometricNormal), pixel.normal);
}

float chanceOfColumn(const RtLightEntry& entry) { return chanceOf(entry); }

Drawn drawFromRow(DirectInputs& inputs, const RtLightRow& row, uint bits) {
    inputsOfRun = &inputs;
    const DrawnLight drawn = drawLight(row, bits);
    return {drawn.light, drawn.weight, drawn.seen};
}

size_t keptCandidate(const std::vector<double>& weights, float random) {
    LightChoice choice = beginChoice(random);
    for (size_t i = 0; i < weights.size(); ++i)
        choice = considerWeighted(choice, darkSample(vec3(float(i))), float(weights[i]));
    return static_cast<size_t>(choice.kept.direction.x);
}

vec3 runDirectStage(DirectInputs& inputs, const RtPixel& pixel) {
    RtPixel copy = pixel;
    Numbers4 result(vec3(0.0f), 0.0f), ambient(vec3(0.0f), 0.0f);
    inputs.frame.pixels = reinterpret_cast<uint64_t>(&copy);
    inputs.frame.irradiance = reinterpret_cast<uint64_t>(&result);
    inputs.frame.ambientL = reinterpret_cast<uint64_t>(&ambient);
    inputsOfRun = &inputs;
    directPixel(uvec2(0));
    return {result.x + ambient.x, result.y + ambient.y, result.z + ambient.z};
}

RtPixel makeLitPixel(const vec3 corner[3], const vec2& barycentric, const vec3& shadingNormal,
                     const vec3& geometricNormal) {
    const HitPoint hit = makeHitPoint(corner[0], corner[1], corner[2], barycentric);
    RtPixel pixel{};
    pixel.position = hit.position;
    pixel.error = hit.error;
    pixel.lit = 1;
    pixel.normal = shadingNormal;
    pixel.geometricNormal = geometricNormal;
    return pixel;
}

vec3 shadowOriginOf(const RtPixel& pixel) { return offsetOrigin(pixel.position, pixel.error, pixel.geometricNormal); }

} // namespace q3rt::test
