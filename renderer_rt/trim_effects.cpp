#include "renderer_rt/trim_effects.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace q3rt {

namespace {

constexpr uint32_t kCorners = 4;
static_assert(kSquareCells == kShownSide);

/// Rays that turn see squares from where nobody knows how many texels a pixel takes.
bool turnsRays(const ViewTables& tables) {
    return std::ranges::any_of(tables.surfaces, [](const RtSurface& surface) {
        return surface.portal != 0 || (surface.flags & (kSurfaceWater | kSurfaceGlass)) != 0;
    });
}

/// Of the picture that the detail of textures is chosen for.
mat4 clipFromWorld(const RtFrame& camera) {
    const glm::dmat3 amounts = glm::inverse(glm::dmat3(dvec3(camera.left), dvec3(camera.up), dvec3(camera.forward)));
    mat4 clip(0.0f);
    for (int axis = 0; axis < 3; ++axis)
        clip[axis] = vec4(amounts[axis].x, amounts[axis].y, 0, amounts[axis].z);
    const dvec3 eye = amounts * dvec3(camera.eye);
    clip[3] = vec4(-eye.x, -eye.y, 0, -eye.z);
    return clip;
}

/// Where any of its stages leaves something.
SquareCells findShown(const EffectSquare& square, std::span<const StageState> stages,
                      std::span<const TextureParts> textureParts) {
    SquareCells shown{};
    for (const StageState& stage : stages) {
        const size_t texture = stage.unit[0].texture;
        const SquareCells ofStage =
            findCellsShown(stage, texture < textureParts.size() ? textureParts[texture] : TextureParts{}, square);
        for (size_t t = 0; t < kSquareCells; ++t)
            shown[t] |= ofStage[t];
    }
    return shown;
}

/// The least rectangle with all cells that show. Without any it has no area: no ray meets it.
TexturePart rectangleOf(const SquareCells& shown) {
    uint16_t columns = 0;
    for (const uint16_t row : shown)
        columns |= row;
    if (columns == 0) return {vec2(0.0f), vec2(0.0f)};
    const auto holds = [](uint16_t row) { return row != 0; };
    const auto first = std::ranges::find_if(shown, holds) - shown.begin();
    const auto last = shown.rend() - std::find_if(shown.rbegin(), shown.rend(), holds);
    return {vec2(std::countr_zero(columns), first) / float(kSquareCells),
            vec2(std::bit_width(columns), last) / float(kSquareCells)};
}

} // namespace

void trimEffects(const RtFrame& camera, std::span<const StageState> stages, std::span<const TextureParts> textureParts,
                 ViewTables& tables, ViewGeometry& geometry) {
    if (turnsRays(tables)) return;
    const mat4 clip = clipFromWorld(camera);
    const vec2 sizePx = vec2(camera.size) / camera.footprint;
    for (size_t i = 0; i < tables.sources.size(); ++i) {
        const ViewTables::Source& source = tables.sources[i];
        if (source.dynamicPart < 0 || source.surfaceClass != SurfaceClass::Layer) continue;
        const auto numbers = tables.surfacesOf(tables.parts[static_cast<size_t>(source.dynamicPart)]);
        const mat4 clipFromModel = clip * geometry.entities[source.entity].worldFromModel;
        for (size_t k = 0; k < numbers.size(); ++k) {
            RtSurface& surface = tables.surfaces[tables.instances[i].firstSurface + k];
            const EntitySurface& shape = geometry.surfaces[numbers[k]];
            const bool fogged = surface.fog != 0 && (surface.flags & kSurfaceFogged) != 0;
            if (shape.vertexCount != kCorners || shape.partly || surface.stageCount == 0 || fogged) continue;
            const auto corners = std::span(geometry.vertices).subspan(shape.firstVertex).first<kCorners>();
            const EffectSquare square(corners, clipFromModel, sizePx);
            if (!square.usable()) continue;
            const SquareCells shown =
                findShown(square, stages.subspan(surface.firstStage, surface.stageCount), textureParts);
            if (std::ranges::all_of(shown, [](uint16_t row) { return row == 0xffff; })) continue;
            surface.flags |= kSurfacePartly;
            static_assert(sizeof(shown) == sizeof(surface.shown));
            std::memcpy(surface.shown, shown.data(), sizeof(shown));
            square.write(rectangleOf(shown), corners);
        }
    }
}

} // namespace q3rt
