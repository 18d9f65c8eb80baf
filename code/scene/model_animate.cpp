// What of a model is drawn for an entity: material, frames, interpolated vertices, level of detail (spec of models 2).

#include <algorithm>
#include <cmath>

#include "scene/model.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kMaxLodScale = 20.0f;
constexpr uint32_t kWhite = 0xffffffffu; // MD3 carries no colours

} // namespace

MaterialId surfaceMaterial(const ModelLibrary& models, const ModelSurface& surface, int customShader, int customSkin,
                           int skinNumber) {
    if (customShader != 0) {
        const bool valid = customShader > 0 && static_cast<size_t>(customShader) < models.materials().count();
        return valid ? static_cast<MaterialId>(customShader) : 0;
    }
    if (const Skin* skin = models.skin(customSkin)) {
        for (const auto& [name, material] : skin->surfaces) {
            if (name == surface.name) return material;
        }
        return 0; // surfaces that a skin doesn't name show the default look; they are not hidden
    }
    const auto count = static_cast<int>(surface.materials.size());
    return surface.materials[static_cast<size_t>(((skinNumber % count) + count) % count)];
}

void resolveFrames(size_t frameCount, bool wrap, int& frame, int& oldFrame) {
    const auto count = static_cast<int>(frameCount);
    if (wrap && count > 0) {
        frame %= count;
        oldFrame %= count;
    }
    const auto bad = [count](int f) { return f < 0 || f >= count; };
    if (bad(frame) || bad(oldFrame)) {
        frame = 0;
        oldFrame = 0;
    }
}

void appendModelVertices(const Md3Surface& surface, int frame, int oldFrame, float backLerp, std::vector<Vertex>& out) {
    const size_t count = surface.vertexCount;
    const size_t first = out.size();
    out.resize(first + count);
    const vec3* position = surface.positions.data() + static_cast<size_t>(frame) * count;
    const vec3* normal = surface.normals.data() + static_cast<size_t>(frame) * count;
    Vertex* vertex = out.data() + first;
    if (frame == oldFrame || backLerp == 0.0f) {
        for (size_t i = 0; i < count; ++i) {
            vertex[i] = {position[i], normal[i], surface.st[i], vec2(0.0f), kWhite, 0};
        }
        return;
    }
    const vec3* oldPosition = surface.positions.data() + static_cast<size_t>(oldFrame) * count;
    const vec3* oldNormal = surface.normals.data() + static_cast<size_t>(oldFrame) * count;
    const float weight = 1.0f - backLerp;
    for (size_t i = 0; i < count; ++i) {
        vertex[i] = {oldPosition[i] * backLerp + position[i] * weight,
                     fastNormalize(oldNormal[i] * backLerp + normal[i] * weight),
                     surface.st[i],
                     vec2(0.0f),
                     kWhite,
                     0};
    }
}

int chooseLod(const Model& model, int frame, const vec3& entityOrigin, const Orientation& view, float fovYRadians,
              float lodScale, int lodBias) {
    const int count = static_cast<int>(model.lods.size());
    if (count == 0) return 0;
    int lod = 0;
    const std::vector<Md3Frame>& frames = model.lods[0].md3.frames;
    if (count > 1 && frame >= 0 && static_cast<size_t>(frame) < frames.size()) {
        const Md3Frame& box = frames[static_cast<size_t>(frame)];
        const float radius = glm::length(glm::max(glm::abs(box.mins), glm::abs(box.maxs)));
        const float depth = glm::dot(entityOrigin - view.origin, view.axis[0]);
        const float shown = depth <= 0.0f ? 0.0f : std::min(1.0f, radius / (std::tan(fovYRadians * 0.5f) * depth));
        const float coarseness = shown == 0.0f ? 0.0f : 1.0f - shown * std::min(lodScale, kMaxLodScale);
        lod = std::clamp(static_cast<int>(coarseness * static_cast<float>(count)), 0, count - 1);
    }
    return std::clamp(lod + lodBias, 0, count - 1);
}

} // namespace q3rt
