// Mesh models and inline brush models of a view (spec of models 2 and 7).

#include <algorithm>

#include "scene/entity_geometry_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

void addTransformedBox(const mat4& worldFromModel, const vec3& mins, const vec3& maxs, Bounds& out) {
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 p(corner & 1 ? maxs.x : mins.x, corner & 2 ? maxs.y : mins.y, corner & 4 ? maxs.z : mins.z);
        out.add(vec3(worldFromModel * vec4(p, 1.0f)));
    }
}

/// Is the box wholly behind one of the planes?
bool isOutside(std::span<const Plane> planes, const Bounds& box) {
    if (box.empty()) return false;
    const vec3 centre = (box.mins + box.maxs) * 0.5f, half = (box.maxs - box.mins) * 0.5f;
    return std::ranges::any_of(planes, [&](const Plane& plane) {
        return glm::dot(plane.normal, centre) + glm::dot(glm::abs(plane.normal), half) < plane.distance;
    });
}

/// Only the first entity of a view that uses an inline model is drawn, as in the original.
void addInlineModel(const ViewBuild& build, const SceneEntity& entity, int sceneIndex, int inlineModel) {
    if (!build.world || static_cast<size_t>(inlineModel) >= build.world->bsp.models.size()) return;
    uint32_t& known = build.out.recordOfInlineModel[static_cast<size_t>(inlineModel)];
    if (known != 0) return;
    known = addRecord(build, entity, sceneIndex);
    EntityRecord& record = build.out.entities[known];
    record.inlineModel = inlineModel;
    const BspModel& box = build.world->bsp.models[static_cast<size_t>(inlineModel)];
    addTransformedBox(record.worldFromModel, box.mins, box.maxs, record.worldBounds);
}

/// Appends a deformed copy; the bounds of its record grow to hold it.
void appendDeformed(const ViewBuild& build, const Material& material, const DeformContext& context,
                    const AnimatedMesh& mesh, EntitySurface& surface) {
    ViewGeometry& out = build.out;
    out.batchVertices.clear();
    const size_t source = surface.source->surface;
    mesh.appendVertices(source, {surface.frame, surface.oldFrame, surface.backLerp}, out.bones, out.batchVertices);
    const std::span<const uint32_t> indices = mesh.indices(source);
    out.batchIndices.assign(indices.begin(), indices.end());
    deformVertices(material, context, out.batchVertices, out.batchIndices);
    EntityRecord& record = out.entities[surface.entity];
    for (const Vertex& vertex : out.batchVertices) {
        record.worldBounds.add(vec3(record.worldFromModel * vec4(vertex.position, 1.0f)));
    }
    out.vertices.insert(out.vertices.end(), out.batchVertices.begin(), out.batchVertices.end());
    for (const uint32_t index : out.batchIndices) {
        out.indices.push_back(surface.firstVertex + index);
    }
}

/// How a mesh model is seen, if triangles may be left out by it.
struct MeshView {
    const AnimatedMesh& mesh;
    FramePair frames;
    TriangleView triangles; ///< its cull mode is each surface's own
    bool judged = false;    ///< what no pixel shows is left out
};

MeshView makeMeshView(const ViewBuild& build, const SceneEntity& entity, const AnimatedMesh& mesh,
                      const FramePair& frames, const mat4& worldFromModel) {
    const PictureOfView& picture = build.settings.picture;
    MeshView result{mesh, frames, {}, picture.sizePx.x > 0 && build.settings.shadows != Shadows::Volume};
    if (!result.judged) return result;
    const mat4& clip = entityFlag::isHeld(entity.flags) ? picture.clipFromWorldHeld : picture.clipFromWorld;
    result.triangles.clipFromModel = mat4(glm::dmat4(clip) * glm::dmat4(worldFromModel));
    result.triangles.sizePx = picture.sizePx;
    result.triangles.mirrored = build.settings.mirrored;
    return result;
}

/// Appends the triangles that may show, and only their vertices; false where the mesh can't say where they are first.
bool appendShown(const ViewBuild& build, const MeshView& view, size_t surface, CullMode cull) {
    ViewGeometry& out = build.out;
    if (!view.mesh.findPositions(surface, view.frames, out.positions)) return false;
    TriangleView triangles = view.triangles;
    triangles.cull = cull;
    const std::span<const uint32_t> indices = view.mesh.indices(surface);
    out.batchIndices.assign(indices.begin(), indices.end());
    out.culler.cull(triangles, out.positions, out.batchIndices, 0);
    constexpr uint32_t kNone = ~0u;
    out.numberInShown.assign(out.positions.size(), kNone);
    out.shownNumbers.clear();
    const auto firstVertex = static_cast<uint32_t>(out.vertices.size());
    for (const uint32_t index : out.batchIndices) {
        uint32_t& number = out.numberInShown[index];
        if (number == kNone) {
            number = firstVertex + static_cast<uint32_t>(out.shownNumbers.size());
            out.shownNumbers.push_back(index);
        }
        out.indices.push_back(number);
    }
    view.mesh.appendSome(surface, view.frames, out.shownNumbers, out.vertices);
    return true;
}

void appendWhole(const ViewBuild& build, const MeshView& view, const EntitySurface& surface) {
    const size_t source = surface.source->surface;
    view.mesh.appendVertices(source, view.frames, build.out.bones, build.out.vertices);
    for (const uint32_t index : view.mesh.indices(source))
        build.out.indices.push_back(surface.firstVertex + index);
}

void addMeshSurface(const ViewBuild& build, const SceneEntity& entity, const MeshView& view, const ModelSurface& source,
                    MaterialId material, uint32_t record, int fog) {
    EntitySurface& surface = openSurface(build, material, record);
    surface.fog = fog;
    surface.source = &source;
    surface.singleFrame = view.mesh.frameCount() == 1;
    surface.frame = view.frames.frame;
    surface.oldFrame = view.frames.oldFrame;
    surface.backLerp = view.frames.backLerp;
    const Material& drawn = build.materials.drawn(material);
    surface.deformed = !drawn.deforms.empty();
    if (surface.deformed) {
        const EntityRecord& of = build.out.entities[record];
        DeformContext context =
            makeDeformContext(build, entity.orientation, entity.nonNormalizedAxes, of.stage.shaderTimeSeconds);
        context.lightDirection = of.light.direction;
        context.heightAboveShadowPlane = entity.orientation.origin.z - entity.shadowPlane;
        appendDeformed(build, drawn, context, view.mesh, surface);
    } else {
        surface.partly = view.judged && appendShown(build, view, source.surface, drawn.cull);
        if (!surface.partly) appendWhole(build, view, surface);
    }
    closeSurface(build, surface);
}

/// Left out are only surfaces that nothing else depends on: no shadow, nor what their batch looks like.
bool mayShow(const ViewBuild& build, const MeshView& view, size_t surface, MaterialId material) {
    const bool judged =
        view.judged && build.materials.drawn(material).deforms.empty() && !build.materials.get(material).entityMergable;
    if (!judged) return true;
    const Bounds box = view.mesh.surfaceBox(surface, view.frames);
    return box.empty() || boxShows(view.triangles.clipFromModel, view.triangles.sizePx, box);
}

void addMesh(const ViewBuild& build, const SceneEntity& entity, int sceneIndex, const Model& model) {
    const AnimatedMesh& finest = *model.lods[0].mesh;
    FramePair frames{entity.frame, entity.oldFrame, entity.backLerp};
    resolveFrames(finest.frameCount(), (entity.flags & entityFlag::kWrapFrames) != 0, frames.frame, frames.oldFrame);
    if (frames.frame == frames.oldFrame) frames.backLerp = 0.0f;
    const int level =
        chooseLod(static_cast<int>(model.lods.size()), finest.frameBox(frames.frame).box, entity.orientation.origin,
                  build.eye, glm::radians(build.view.fovYDegrees), build.settings.lodScale, build.settings.lodBias);
    const ModelLod& lod = model.lods[static_cast<size_t>(level)];
    // Frames are valid for the finest level; a coarser file may have fewer.
    const int last = static_cast<int>(lod.mesh->frameCount()) - 1;
    frames.frame = std::min(frames.frame, last);
    frames.oldFrame = std::min(frames.oldFrame, last);
    const FrameBox extent = lod.mesh->frameBox(frames.frame);
    const int fog = fogOfSphere(build, entity.orientation.origin + extent.centre, extent.radius); // unrotated by design
    const uint32_t record = addRecord(build, entity, sceneIndex);
    for (const int frame : {frames.frame, frames.oldFrame}) {
        const Bounds box = lod.mesh->frameBox(frame).box;
        EntityRecord& of = build.out.entities[record];
        if (!box.empty()) addTransformedBox(of.worldFromModel, box.mins, box.maxs, of.worldBounds);
    }
    if (isOutside(build.settings.cullPlanes, build.out.entities[record].worldBounds)) return;
    lod.mesh->pose(frames, build.out.bones);
    const bool isSeen =
        build.settings.isPortalView || build.settings.keepHiddenEntities || !(entity.flags & entityFlag::kThirdPerson);
    const MeshView view = makeMeshView(build, entity, *lod.mesh, frames, build.out.entities[record].worldFromModel);
    constexpr float kOpaqueSort = 3;
    for (const ModelSurface& source : lod.surfaces) {
        const MaterialId material =
            surfaceMaterial(build.models, source, entity.customShader, entity.customSkin, entity.skinNumber);
        const bool casts = fog == 0 && build.materials.get(material).sort == kOpaqueSort;
        if (isSeen && mayShow(build, view, source.surface, material)) {
            addMeshSurface(build, entity, view, source, material, record, fog);
            build.out.surfaces.back().castsVolume = casts && build.settings.shadows == Shadows::Volume &&
                                                    !(entity.flags & (entityFlag::kNoShadow | entityFlag::kDepthHack));
        }
        if (casts && build.settings.shadows == Shadows::Projected && (entity.flags & entityFlag::kShadowPlane))
            addMeshSurface(build, entity, view, source, build.settings.projectionShadow, record, 0);
    }
}

} // namespace

void addModelEntity(const ViewBuild& build, const SceneEntity& entity, int sceneIndex) {
    const Model& model = build.models.get(entity.model);
    switch (model.kind) {
    case Model::Kind::Bad:
        addBadModelAxes(build, entity, sceneIndex);
        break;
    case Model::Kind::Inline:
        addInlineModel(build, entity, sceneIndex, model.inlineModel);
        break;
    case Model::Kind::Mesh:
        addMesh(build, entity, sceneIndex, model);
        break;
    }
}

} // namespace q3rt
