#include "scene/light_animation.hpp"

#include <algorithm>
#include <cmath>

#include "scene/stage_table.hpp"

namespace q3rt {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "shaders/lib/material_affine.glsl"

/// Times over which the mean is taken: spread over more than any wave's period, not in step with any.
constexpr int kTimes = 512;
constexpr double kSpanSeconds = 128, kGoldenRatio = 0.6180339887498949;
/// Glow that changes by less than one step of the display.
constexpr float kSteady = 1.0f / 255.0f;

double timeOf(int i) { return kSpanSeconds * (i * kGoldenRatio - std::floor(i * kGoldenRatio)); }

} // namespace

uint32_t LightAnimation::find(MaterialId material) {
    const Material& drawn = m_materials.drawn(material);
    const MaterialId id = drawn.sharedStages;
    for (size_t i = 0; i < m_animated.size(); ++i)
        if (m_animated[i].material == id) return static_cast<uint32_t>(i) + 1;
    if (!drawn.usesTime || std::find(m_steady.begin(), m_steady.end(), id) != m_steady.end()) return 0;
    vec3 least(std::numeric_limits<float>::max()), most(0.0f);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kTimes; ++i) {
        const vec3 glow = glowOf(id, timeOf(i));
        least = glm::min(least, glow);
        most = glm::max(most, glow);
        sum += glm::dvec3(glow);
    }
    if (glm::all(glm::lessThan(most - least, vec3(kSteady)))) {
        m_steady.push_back(id);
        return 0;
    }
    m_animated.push_back({id, vec3(sum / double(kTimes))});
    return static_cast<uint32_t>(m_animated.size());
}

std::vector<vec3> LightAnimation::evaluate(double shaderTimeSeconds) const {
    std::vector<vec3> colors;
    for (const Animated& animated : m_animated) {
        const vec3 glow = glowOf(animated.material, shaderTimeSeconds);
        vec3& color = colors.emplace_back(1.0f);
        for (int k = 0; k < 3; ++k)
            if (animated.meanGlow[k] > 0.0f) color[k] = glow[k] / animated.meanGlow[k];
    }
    return colors;
}

/// What the stages add without any light, on mean texels.
vec3 LightAnimation::glowOf(MaterialId material, double shaderTimeSeconds) const {
    const Material& drawn = m_materials.get(material);
    StageInputs inputs;
    inputs.shaderTimeSeconds = shaderTimeSeconds;
    const VertexIn vertex{vec3(0.0f), vec3(0, 0, 1), vec2(0.0f), vec2(0.0f), vec4(1.0f)};
    AffineColor color = beginAffine();
    for (const Stage& stage : drawn.stages) {
        const StageState state = evaluateStage(drawn, stage, inputs, 1.0f);
        const vec4 texel0 = m_textures.get(state.unit[0].texture).averageColor;
        const vec4 texel1 =
            state.combine != kCombineSingle ? m_textures.get(state.unit[1].texture).averageColor : vec4(1.0f);
        color = addStage(color, state, stageColor(state, vertex, EntityIn{}), texel0, texel1);
    }
    return color.unlit;
}

} // namespace q3rt
