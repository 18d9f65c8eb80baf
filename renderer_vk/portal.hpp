#pragma once
// Portals and mirrors: from a visible portal surface to the camera behind it (spec of world 4.5). Pure.

#include <optional>
#include <span>

#include "renderer_vk/view_setup.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Triangles of one portal surface in world space.
struct PortalShape {
    std::span<const vec3> positions;
    std::span<const vec3> normals;
    std::span<const uint32_t> indices;
    Plane plane; ///< world space
};

/// Largest distance of a portal entity from the plane of its surface.
inline constexpr float kPortalEntityReachQu = 64.0f;

/// A vector perpendicular to unit vector `normal`: the axis of its smallest component laid onto the plane.
vec3 perpendicularTo(const vec3& normal);
/// Rotates `vector` about unit `axis` by an angle in degrees, right-handed.
vec3 rotateAbout(const vec3& axis, const vec3& vector, float degrees);

/// Can any of the surface be seen: not off one side of the screen, not facing away, and near enough (`rangeQu`; mirrors
/// have no range)?
bool portalVisible(const RasterView& view, const PortalShape& shape, float rangeQu, bool isMirror);

/// A portal surface and the camera behind it: what lies along an axis of `surface` is seen along that of `camera`.
struct PortalFrames {
    Orientation surface, camera;
    vec3 pvsOrigin{0};
    bool mirror = false;
};
/// nullopt if no portal entity belongs to the plane `match`.
std::optional<PortalFrames> findPortalFrames(const Plane& plane, const Plane& match,
                                             std::span<const SceneEntity> entities, int timeMs);

/// The view out of the portal, or nullopt if no portal entity belongs to the plane. `match` is the plane used to find
/// the entity (differs from `plane` on moved brush models only).
std::optional<RasterView> makePortalView(const RasterView& view, const Plane& plane, const Plane& match,
                                         std::span<const SceneEntity> entities);
/// Is there a portal entity for the plane, and is it a mirror?
std::optional<bool> portalIsMirror(const Plane& match, std::span<const SceneEntity> entities);

} // namespace q3rt
