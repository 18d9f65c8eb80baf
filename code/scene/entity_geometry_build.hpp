#pragma once
// What the parts of buildViewGeometry share.

#include "scene/entity_geometry.hpp"

namespace q3rt {

struct ViewBuild {
    const FrameCommands& frame;
    const SceneView& view;
    const Orientation& eye;
    const World* world; ///< null: menus
    const ModelLibrary& models;
    const MaterialLibrary& materials;
    const ViewGeometrySettings& settings;
    ViewGeometry& out;

    bool drawsWorld() const { return world && !(view.flags & viewFlag::kNoWorldModel); }
};

/// Appends a record; geometry in world space unless the caller sets a transform.
uint32_t addRecord(const ViewBuild& build, const SceneEntity& entity, int sceneIndex);
/// Opens a surface at the current ends of the arrays; closeSurface counts what was appended since.
EntitySurface& openSurface(const ViewBuild& build, MaterialId material, uint32_t record);
void closeSurface(const ViewBuild& build, EntitySurface& surface);
/// A shader handle of the engine as a material: out of range is the default one.
MaterialId materialOfHandle(const ViewBuild& build, int handle);
/// Deform set-up for geometry in the space `axis` (unit or scaled axes of the model in the world).
DeformContext makeDeformContext(const ViewBuild& build, const Orientation& model, bool nonNormalizedAxes,
                                double shaderTimeSeconds);
/// Fog of a sphere; 0 without a world in the view.
int fogOfSphere(const ViewBuild& build, const vec3& centre, float radius);

/// RT_MODEL of any kind.
void addModelEntity(const ViewBuild& build, const SceneEntity& entity, int sceneIndex);
/// Sprites, beams, rails, lightning.
void addEffectEntity(const ViewBuild& build, const SceneEntity& entity, int sceneIndex);
/// Axes of an entity whose model is missing.
void addBadModelAxes(const ViewBuild& build, const SceneEntity& entity, int sceneIndex);
void addPolys(const ViewBuild& build);
/// Deformed copies of world and inline-model surfaces; after all entities.
void addDeformedWorld(const ViewBuild& build);

} // namespace q3rt
