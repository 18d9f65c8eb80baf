// Scene polys and deformed world surfaces of a view.

#include "scene/entity_geometry_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

/// First fog whose box the poly's box touches; also in scenes without the world (spec of models 4, polys).
int fogOfPoly(const ViewBuild& build, const Bounds& box) {
    if (!build.world) return 0;
    const auto& fogs = build.world->fogs;
    for (size_t i = 1; i < fogs.size(); ++i) {
        const Bounds& fog = fogs[i].bounds;
        if (glm::all(glm::lessThanEqual(box.mins, fog.maxs)) && glm::all(glm::greaterThanEqual(box.maxs, fog.mins))) {
            return static_cast<int>(i);
        }
    }
    return 0;
}

/// Left out are only polys that nothing else depends on: not what their batch looks like, nor a sky behind them.
bool mayShow(const ViewBuild& build, MaterialId id, std::span<const PolyVertex> points) {
    const PictureOfView& picture = build.settings.picture;
    const Material& material = build.materials.drawn(id);
    if (picture.sizePx.x <= 0 || material.isSky || build.materials.get(id).entityMergable) return true;
    return hullShows(picture.clipFromWorld, picture.sizePx, points.size(),
                     [&](size_t i) { return points[i].position; });
}

void addPoly(const ViewBuild& build, const ScenePoly& poly) {
    if (poly.shader == 0 || poly.vertexCount < 3) return;
    const std::span points = std::span(build.frame.polyVertices).subspan(poly.firstVertex, poly.vertexCount);
    const MaterialId material = materialOfHandle(build, poly.shader);
    if (!mayShow(build, material, points)) return;
    EntitySurface& surface = openSurface(build, material, 0);
    surface.isPoly = true;
    Bounds box;
    vec3 normal(0.0f);
    for (uint32_t i = 0; i < points.size(); ++i) {
        box.add(points[i].position);
        if (i >= 2) normal += clockwiseCross(points[0].position, points[i - 1].position, points[i].position);
    }
    normal = normalizeOrZero(normal);
    for (uint32_t i = 0; i < points.size(); ++i) {
        build.out.vertices.push_back(
            {points[i].position, normal, points[i].st, vec2(0.0f), packColor(points[i].color), 0});
        if (i >= 2) {
            const uint32_t first = surface.firstVertex;
            build.out.indices.insert(build.out.indices.end(), {first, first + i - 1, first + i});
        }
    }
    surface.fog = fogOfPoly(build, box);
    closeSurface(build, surface);
}

/// Of the world's own surfaces: those of brush models are few.
bool mayShow(const ViewBuild& build, const WorldSurface& surface, const Material& material, uint32_t record) {
    const PictureOfView& picture = build.settings.picture;
    if (picture.sizePx.x <= 0 || record != 0) return true;
    const Bounds box = deformedBounds(material, surface.bounds);
    return box.empty() || boxShows(picture.clipFromWorld, picture.sizePx, box);
}

/// A deformed copy of one surface, in the space of its record; an empty one where it can't show.
void addDeformedSurface(const ViewBuild& build, uint32_t number, const Material& material, const DeformContext& context,
                        uint32_t record) {
    const WorldSurface& source = build.world->surfaces[number];
    ViewGeometry& out = build.out;
    EntitySurface& surface = openSurface(build, source.material, record);
    surface.fog = source.fog;
    surface.worldSurface = static_cast<int>(number);
    surface.deformed = true;
    if (!mayShow(build, source, material, record)) return;
    const auto firstVertex = build.world->vertices.begin() + source.firstVertex;
    out.batchVertices.assign(firstVertex, firstVertex + source.vertexCount);
    out.batchIndices.clear();
    for (uint32_t i = 0; i < source.indexCount; ++i) {
        out.batchIndices.push_back(build.world->indices[source.firstIndex + i] - source.firstVertex);
    }
    deformVertices(material, context, out.batchVertices, out.batchIndices);
    out.vertices.insert(out.vertices.end(), out.batchVertices.begin(), out.batchVertices.end());
    for (const uint32_t index : out.batchIndices) {
        out.indices.push_back(surface.firstVertex + index);
    }
    closeSurface(build, surface);
}

DeformContext contextOfRecord(const ViewBuild& build, uint32_t record) {
    const EntityRecord& of = build.out.entities[record];
    if (of.sceneIndex < 0) return makeDeformContext(build, Orientation{}, false, of.stage.shaderTimeSeconds);
    const SceneEntity& entity = build.frame.entities[build.view.firstEntity + static_cast<uint32_t>(of.sceneIndex)];
    return makeDeformContext(build, entity.orientation, entity.nonNormalizedAxes, of.stage.shaderTimeSeconds);
}

} // namespace

void addPolys(const ViewBuild& build) {
    for (uint32_t i = 0; i < build.view.polyCount; ++i) {
        addPoly(build, build.frame.polys[build.view.firstPoly + i]);
    }
}

void addDeformedWorld(const ViewBuild& build) {
    const DeformContext worldContext = contextOfRecord(build, 0);
    for (const World::MaterialGroup& group : build.world->materialGroups) {
        const Material& material = build.materials.drawn(group.material);
        if (material.deforms.empty() || material.isSky) continue;
        for (const uint32_t number : group.surfaces) {
            const auto model = static_cast<size_t>(build.world->surfaces[number].bspModel);
            if (model == 0) {
                const auto visible = build.settings.visibleSurfaces;
                if (build.drawsWorld() && (visible.empty() || visible[number] != 0))
                    addDeformedSurface(build, number, material, worldContext, 0);
            } else if (const uint32_t record = build.out.recordOfInlineModel[model]) {
                addDeformedSurface(build, number, material, contextOfRecord(build, record), record);
            }
        }
    }
}

} // namespace q3rt
