// Deforms that move vertices where they are (spec of materials 2.4, of models 6).

#include "scene/deform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/deform_sprites.hpp"
#include "scene/wave.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr double kBulgeTableSteps = 1024.0 / (2.0 * std::numbers::pi); // sine table entries a radian
constexpr float kNoiseScale = 0.98f;       // lattice cells a unit of position: never exactly on a lattice point
constexpr float kNoiseAxisOffset = 100.0f; // lattice distance between the three components' noises
constexpr float kLongestNormal = 1.002f;   // a normal that fastNormalize has made
constexpr float kLowestShadowSlope = 0.5f; // flatter light is lifted: keeps shadows short

void deformWave(const Deform& deform, double time, std::vector<Vertex>& vertices) {
    Wave wave = deform.wave;
    if (wave.frequency == 0.0f) {
        const auto offset = static_cast<float>(evaluateWave(wave, time));
        for (Vertex& vertex : vertices) {
            vertex.position += vertex.normal * offset;
        }
        return;
    }
    for (Vertex& vertex : vertices) {
        const vec3& p = vertex.position;
        wave.phase = deform.wave.phase + (p.x + p.y + p.z) * deform.spread;
        vertex.position += vertex.normal * static_cast<float>(evaluateWave(wave, time));
    }
}

void deformNormal(const Deform& deform, double time, std::vector<Vertex>& vertices) {
    for (Vertex& vertex : vertices) {
        const vec3 p = vertex.position * kNoiseScale;
        for (int k = 0; k < 3; ++k) {
            const double noise =
                latticeNoise(kNoiseAxisOffset * static_cast<float>(k) + p.x, p.y, p.z, time * deform.wave.frequency);
            vertex.normal[k] += deform.wave.amplitude * static_cast<float>(noise);
        }
        vertex.normal = fastNormalize(vertex.normal);
    }
}

void deformBulge(const Deform& deform, int sceneTimeMs, std::vector<Vertex>& vertices) {
    const double now = sceneTimeMs * 0.001 * deform.bulgeSpeed;
    for (Vertex& vertex : vertices) {
        const double angle = static_cast<double>(vertex.st.x) * deform.bulgeWidth + now;
        const auto entry = static_cast<int64_t>(std::fmod(kBulgeTableSteps * angle, 1024.0));
        vertex.position += vertex.normal * (sineTable(static_cast<int>(entry & 1023)) * deform.bulgeHeight);
    }
}

void deformProjectionShadow(const DeformContext& context, std::vector<Vertex>& vertices) {
    const vec3& ground = context.worldUpInModel;
    vec3 light = context.lightDirection;
    float slope = glm::dot(light, ground);
    if (slope < kLowestShadowSlope) {
        light += ground * (kLowestShadowSlope - slope);
        slope = glm::dot(light, ground);
    }
    if (slope == 0.0f) return; // axes of length 0: nothing to see either
    light /= slope;
    for (Vertex& vertex : vertices) {
        vertex.position -= light * (glm::dot(vertex.position, ground) + context.heightAboveShadowPlane);
    }
}

bool isSprite(const Deform& deform) {
    return deform.kind == DeformKind::AutoSprite || deform.kind == DeformKind::AutoSprite2;
}

} // namespace

void deformVertices(const Material& material, const DeformContext& context, std::vector<Vertex>& vertices,
                    std::vector<uint32_t>& indices) {
    double time = context.shaderTimeSeconds - material.timeOffsetSeconds;
    if (material.clampTimeSeconds != 0.0f) time = std::min<double>(time, material.clampTimeSeconds);
    for (const Deform& deform : material.deforms) {
        switch (deform.kind) {
        case DeformKind::None:
            break;
        case DeformKind::Wave:
            deformWave(deform, time, vertices);
            break;
        case DeformKind::Normal:
            deformNormal(deform, time, vertices);
            break;
        case DeformKind::Move: {
            const vec3 offset = deform.move * static_cast<float>(evaluateWave(deform.wave, time));
            for (Vertex& vertex : vertices) {
                vertex.position += offset;
            }
            break;
        }
        case DeformKind::Bulge:
            deformBulge(deform, context.sceneTimeMs, vertices);
            break;
        case DeformKind::ProjectionShadow:
            deformProjectionShadow(context, vertices);
            break;
        case DeformKind::AutoSprite:
            deformAutoSprite(context, vertices, indices);
            break;
        case DeformKind::AutoSprite2:
            deformAutoSprite2(context, vertices, indices);
            break;
        case DeformKind::Text:
            deformText(context, deform.text, vertices, indices);
            break;
        }
    }
}

float deformReachQu(const Material& material) {
    float reach = 0;
    for (const Deform& deform : material.deforms) {
        const float wave = std::abs(deform.wave.base) + std::abs(deform.wave.amplitude);
        switch (deform.kind) {
        case DeformKind::None:
        case DeformKind::Normal:
            break;
        case DeformKind::Wave:
            reach += wave * kLongestNormal;
            break;
        case DeformKind::Move:
            reach += wave * glm::length(deform.move);
            break;
        case DeformKind::Bulge:
            reach += std::abs(deform.bulgeHeight) * kLongestNormal;
            break;
        case DeformKind::AutoSprite:
        case DeformKind::AutoSprite2:
        case DeformKind::ProjectionShadow:
        case DeformKind::Text:
            return std::numeric_limits<float>::infinity();
        }
    }
    return reach;
}

bool deformsWithView(const Material& material) { return std::ranges::any_of(material.deforms, isSprite); }

Bounds deformedBounds(const Material& material, const Bounds& box) {
    if (box.empty()) return {};
    float reach = deformReachQu(material);
    // Four corners turn about their mean, which lies in the box as they do: none is farther from it than the diagonal.
    if (material.deforms.size() == 1 && isSprite(material.deforms[0])) reach = glm::length(box.maxs - box.mins);
    return std::isfinite(reach) ? Bounds{box.mins - reach, box.maxs + reach} : Bounds{};
}

} // namespace q3rt
