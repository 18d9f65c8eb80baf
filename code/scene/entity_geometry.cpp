// buildViewGeometry: which entities of a view are drawn, and the helpers their kinds share.

#include "scene/entity_geometry.hpp"

#include "scene/busy_frame.hpp"
#include "scene/entity_geometry_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

mat4 worldFromModelOf(const Orientation& o) {
    return {vec4(o.axis[0], 0.0f), vec4(o.axis[1], 0.0f), vec4(o.axis[2], 0.0f), vec4(o.origin, 1.0f)};
}

double sceneSeconds(const SceneView& view) { return view.timeMs * 0.001; }

/// Is the entity left out of this view by whom it belongs to? Brush models ignore the third-person flag.
bool isHidden(const ViewBuild& build, const SceneEntity& entity) {
    if (build.settings.keepHiddenEntities) return false;
    if (build.settings.isPortalView) return (entity.flags & entityFlag::kFirstPerson) != 0;
    if (!(entity.flags & entityFlag::kThirdPerson)) return false;
    const Model::Kind kind = entity.kind == EntityKind::Model ? build.models.get(entity.model).kind : Model::Kind::Bad;
    const bool castsShadow = kind == Model::Kind::Mesh && build.settings.shadows == Shadows::Projected;
    return kind != Model::Kind::Inline && !castsShadow;
}

void addWorldRecord(const ViewBuild& build) {
    EntityRecord record;
    record.stage.shaderTimeSeconds = sceneSeconds(build.view);
    record.eyeInModel = build.eye.origin;
    build.out.entities.push_back(record);
}

void addEntity(const ViewBuild& build, const SceneEntity& entity, int sceneIndex) {
    switch (entity.kind) {
    case EntityKind::Model:
        addModelEntity(build, entity, sceneIndex);
        break;
    case EntityKind::Sprite:
    case EntityKind::Beam:
    case EntityKind::RailCore:
    case EntityKind::RailRings:
    case EntityKind::Lightning:
        addEffectEntity(build, entity, sceneIndex);
        break;
    case EntityKind::Poly:          // refused when it is submitted
    case EntityKind::PortalSurface: // only says where a portal looks
        break;
    }
}

} // namespace

void ViewGeometry::reserve() {
    entities.reserve(busyFrame::kEntities);
    surfaces.reserve(busyFrame::kSurfaces);
    vertices.reserve(busyFrame::kVertices);
    indices.reserve(busyFrame::kIndices);
    batchVertices.reserve(busyFrame::kWorkVertices);
    batchIndices.reserve(busyFrame::kWorkVertices * 6);
    bones.reserve(busyFrame::kSmall);
    positions.reserve(busyFrame::kWorkVertices);
    shownNumbers.reserve(busyFrame::kWorkVertices);
    numberInShown.reserve(busyFrame::kWorkVertices);
    recordOfInlineModel.reserve(busyFrame::kSmall);
}

void ViewGeometry::clear() {
    entities.clear();
    surfaces.clear();
    vertices.clear();
    indices.clear();
    batchVertices.clear();
    batchIndices.clear();
    recordOfInlineModel.clear();
}

uint32_t addRecord(const ViewBuild& build, const SceneEntity& entity, int sceneIndex) {
    EntityRecord record;
    record.stage.shaderTimeSeconds = sceneSeconds(build.view) - entity.shaderTimeSeconds;
    record.stage.entityColor = entity.color;
    record.stage.entityTexCoord = entity.texCoord;
    record.stage.hasEntity = true;
    record.flags = entity.flags;
    record.sceneIndex = sceneIndex;
    record.eyeInModel = build.eye.origin;
    if (entity.kind == EntityKind::Model) {
        const Orientation& o = entity.orientation;
        record.worldFromModel = worldFromModelOf(o);
        const float length = glm::length(o.axis[0]);
        const float scale = !entity.nonNormalizedAxes ? 1.0f : length > 0.0f ? 1.0f / length : 0.0f;
        for (int i = 0; i < 3; ++i) {
            record.eyeInModel[i] = glm::dot(build.eye.origin - o.origin, o.axis[i]) * scale;
        }
        record.light = computeEntityLight(build.world, build.materials.sunDirection, entity, build.frame, build.view,
                                          build.settings);
    }
    build.out.entities.push_back(record);
    return static_cast<uint32_t>(build.out.entities.size() - 1);
}

EntitySurface& openSurface(const ViewBuild& build, MaterialId material, uint32_t record) {
    EntitySurface surface;
    surface.material = material;
    surface.entity = record;
    surface.firstVertex = static_cast<uint32_t>(build.out.vertices.size());
    surface.firstIndex = static_cast<uint32_t>(build.out.indices.size());
    build.out.surfaces.push_back(surface);
    return build.out.surfaces.back();
}

void closeSurface(const ViewBuild& build, EntitySurface& surface) {
    surface.vertexCount = static_cast<uint32_t>(build.out.vertices.size()) - surface.firstVertex;
    surface.indexCount = static_cast<uint32_t>(build.out.indices.size()) - surface.firstIndex;
}

MaterialId materialOfHandle(const ViewBuild& build, int handle) {
    const bool valid = handle > 0 && static_cast<size_t>(handle) < build.materials.count();
    return valid ? static_cast<MaterialId>(handle) : 0;
}

DeformContext makeDeformContext(const ViewBuild& build, const Orientation& model, bool nonNormalizedAxes,
                                double shaderTimeSeconds) {
    DeformContext context;
    context.shaderTimeSeconds = shaderTimeSeconds;
    context.sceneTimeMs = build.view.timeMs;
    for (int i = 0; i < 3; ++i) {
        context.viewForward[i] = glm::dot(build.eye.axis[0], model.axis[i]);
        context.viewLeft[i] = glm::dot(build.eye.axis[1], model.axis[i]);
        context.viewUp[i] = glm::dot(build.eye.axis[2], model.axis[i]);
        context.worldUpInModel[i] = model.axis[i].z;
    }
    context.worldForward = build.eye.axis[0];
    context.axisScale = nonNormalizedAxes ? glm::length(model.axis[0]) : 1.0f;
    context.mirrored = build.settings.mirrored;
    context.text = &build.view.text;
    return context;
}

int fogOfSphere(const ViewBuild& build, const vec3& centre, float radius) {
    if (!build.drawsWorld()) return 0;
    return build.world->fogOf({centre - radius, centre + radius});
}

void buildViewGeometry(const FrameCommands& frame, const SceneView& view, const Orientation& eye, const World* world,
                       const ModelLibrary& models, const MaterialLibrary& materials,
                       const ViewGeometrySettings& settings, ViewGeometry& out) {
    out.clear();
    const ViewBuild build{frame, view, eye, world, models, materials, settings, out};
    if (world) out.recordOfInlineModel.assign(world->bsp.models.size(), 0);
    addWorldRecord(build);
    addPolys(build);
    for (uint32_t i = 0; settings.drawEntities && i < view.entityCount; ++i) {
        const SceneEntity& entity = frame.entities[view.firstEntity + i];
        if (!isHidden(build, entity)) addEntity(build, entity, static_cast<int>(i));
    }
    if (settings.deformWorld && world) addDeformedWorld(build);
}

} // namespace q3rt
