#pragma once
// What a view shows, reduced to what finds it again in the next frame: entities by what they are and where, instances
// by the part of the entity that they show. The engine numbers entities for itself only. Pure CPU.

#include <vector>

#include "renderer_rt/traced_view.hpp"
#include "scene/entity_geometry.hpp"

namespace q3rt {

/// One entity of a view, with what tells it from others.
struct EntityPlace {
    bool moves = true; ///< false: the world
    EntityKind kind = EntityKind::Model;
    int inlineModel = -1; ///< such models are in a view once
    int model = 0, skin = 0, skinNumber = 0, shader = 0;
    uint32_t flags = 0;
    float startSeconds = 0; ///< of effects: when they began
    vec3 anchor{0};         ///< world; what moves with it
    vec3 velocity{0};       ///< qu/ms, of the last frame; 0 for what has just appeared
    mat4 worldFromModel{1.0f};
};

/// One instance of a view.
struct InstancePlace {
    uint32_t entity = 0;
    uint64_t key = 0;          ///< equal keys of the same entity show the same surfaces in any two frames
    bool changesShape = false; ///< corners move one by one
    bool keepsOrder = true;    ///< triangles have the same numbers in each frame with this key
    uint32_t firstCorner = 0;  ///< of a changing shape, in ViewInstant::corners
};

std::vector<EntityPlace> findEntities(const FrameCommands& frame, const SceneView& scene, const ViewGeometry& geometry);
/// `corners` becomes the model-space corners of all changing shapes.
std::vector<InstancePlace> findInstances(const ViewTables& tables, const ViewGeometry& geometry,
                                         std::vector<vec3>& corners);

} // namespace q3rt
