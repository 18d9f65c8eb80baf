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
                    const Md3Surface& mesh, EntitySurface& surface) {
    ViewGeometry& out = build.out;
    out.batchVertices.clear();
    appendModelVertices(mesh, surface.frame, surface.oldFrame, surface.backLerp, out.batchVertices);
    out.batchIndices.assign(mesh.indices.begin(), mesh.indices.end());
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

struct Pose {
    int frame = 0, oldFrame = 0;
    float backLerp = 0;
    int fog = 0;
};

void addMeshSurface(const ViewBuild& build, const SceneEntity& entity, const ModelLod& lod, const ModelSurface& source,
                    uint32_t record, const Pose& pose) {
    const Md3Surface& mesh = lod.md3.surfaces[source.surface];
    const MaterialId material =
        surfaceMaterial(build.models, source, entity.customShader, entity.customSkin, entity.skinNumber);
    EntitySurface& surface = openSurface(build, material, record);
    surface.fog = pose.fog;
    surface.source = &source;
    surface.singleFrame = lod.md3.frames.size() == 1;
    surface.frame = pose.frame;
    surface.oldFrame = pose.oldFrame;
    surface.backLerp = pose.backLerp;
    const Material& drawn = build.materials.drawn(material);
    surface.deformed = !drawn.deforms.empty();
    if (surface.deformed) {
        const EntityRecord& of = build.out.entities[record];
        DeformContext context =
            makeDeformContext(build, entity.orientation, entity.nonNormalizedAxes, of.stage.shaderTimeSeconds);
        context.lightDirection = of.light.direction;
        context.heightAboveShadowPlane = entity.orientation.origin.z - entity.shadowPlane;
        appendDeformed(build, drawn, context, mesh, surface);
    } else {
        appendModelVertices(mesh, pose.frame, pose.oldFrame, pose.backLerp, build.out.vertices);
        for (const uint32_t index : mesh.indices) {
            build.out.indices.push_back(surface.firstVertex + index);
        }
    }
    closeSurface(build, surface);
}

void addMesh(const ViewBuild& build, const SceneEntity& entity, int sceneIndex, const Model& model) {
    const size_t frameCount = model.lods[0].md3.frames.size();
    if (frameCount == 0) return;
    Pose pose{entity.frame, entity.oldFrame, entity.backLerp, 0};
    resolveFrames(frameCount, (entity.flags & entityFlag::kWrapFrames) != 0, pose.frame, pose.oldFrame);
    if (pose.frame == pose.oldFrame) pose.backLerp = 0.0f;
    const ModelLod& lod = model.lods[static_cast<size_t>(chooseLod(model, pose.frame, entity.orientation.origin,
                                                                   build.eye, glm::radians(build.view.fovYDegrees),
                                                                   build.settings.lodScale, build.settings.lodBias))];
    // Frames are valid for the finest level; a coarser file may have fewer.
    const int last = static_cast<int>(lod.md3.frames.size()) - 1;
    if (last < 0) return;
    pose.frame = std::min(pose.frame, last);
    pose.oldFrame = std::min(pose.oldFrame, last);
    const Md3Frame& box = lod.md3.frames[static_cast<size_t>(pose.frame)];
    pose.fog = fogOfSphere(build, entity.orientation.origin + box.localOrigin, box.radius); // unrotated by design
    const uint32_t record = addRecord(build, entity, sceneIndex);
    for (const int frame : {pose.frame, pose.oldFrame}) {
        const Md3Frame& bounds = lod.md3.frames[static_cast<size_t>(frame)];
        EntityRecord& of = build.out.entities[record];
        addTransformedBox(of.worldFromModel, bounds.mins, bounds.maxs, of.worldBounds);
    }
    for (const ModelSurface& source : lod.surfaces) {
        addMeshSurface(build, entity, lod, source, record, pose);
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
    case Model::Kind::Md3:
        addMesh(build, entity, sceneIndex, model);
        break;
    }
}

} // namespace q3rt
