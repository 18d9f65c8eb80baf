// What of a model is drawn for an entity: material, frames, level of detail (spec of models 2).

#include <algorithm>
#include <cmath>

#include "scene/model.hpp"

namespace q3rt {
namespace {

constexpr float kMaxLodScale = 20.0f;

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

int chooseLod(int count, const Bounds& box, const vec3& entityOrigin, const Orientation& view, float fovYRadians,
              float lodScale, int lodBias) {
    if (count == 0) return 0;
    int lod = 0;
    if (count > 1) {
        const float radius = glm::length(glm::max(glm::abs(box.mins), glm::abs(box.maxs)));
        const float depth = glm::dot(entityOrigin - view.origin, view.axis[0]);
        const float shown = depth <= 0.0f ? 0.0f : std::min(1.0f, radius / (std::tan(fovYRadians * 0.5f) * depth));
        const float coarseness = shown == 0.0f ? 0.0f : 1.0f - shown * std::min(lodScale, kMaxLodScale);
        lod = std::clamp(static_cast<int>(coarseness * static_cast<float>(count)), 0, count - 1);
    }
    return std::clamp(lod + lodBias, 0, count - 1);
}

} // namespace q3rt
