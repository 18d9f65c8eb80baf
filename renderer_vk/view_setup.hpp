#pragma once
// A camera of the frame: the engine's view, or the view out of a portal or mirror in it.

#include <array>

#include "scene/scene_types.hpp"

namespace q3rt {

struct RasterView {
    const SceneView* scene = nullptr;
    Orientation eye;       ///< origin, forward, left, up
    vec3 pvsOrigin{0};     ///< whose cluster decides what is visible
    bool portal = false;   ///< seen through a portal or mirror
    int portalDepth = 0;   ///< how many of them one after the other
    bool mirrored = false; ///< handedness flipped: the culled side swaps
    Plane clip;            ///< portal views: what lies behind is not drawn
    float tanHalfX = 1, tanHalfY = 1;
    float nearQu = 4, farQu = 2048;
    float eyeShiftQu = 0;         ///< to the left, of one eye of a stereo picture
    float projectionQu = 64;      ///< distance at which both eyes see the same
    float stereoDivisor = 0;      ///< projectionQu over the shift; 0: no stereo
    std::array<Plane, 4> frustum; ///< side planes through the eye, normals inward
    mat4 clipFromWorld{1.0f};     ///< Vulkan clip space: y down, depth 0 to 1
    mat4 clipFromWorldNear{1.0f}; ///< of weapons: both eyes see the same at the near plane
};

/// Far plane of a view without a world (spec of world 4.2).
inline constexpr float kNoWorldFarQu = 2048.0f;

RasterView makeMainView(const SceneView& scene, float nearQu);
/// Moves the view to its scene's eye: r_zproj, r_stereoSeparation.
void separateEye(RasterView& view, float projectionQu, float divisor);
/// Side planes from the eye and the field of view.
void updateFrustum(RasterView& view);
/// Projection from the near and far distances.
void updateProjection(RasterView& view);
/// Largest distance from `eye` to a corner of `bounds`.
float farthestCornerQu(const vec3& eye, const Bounds& bounds);

enum class CullResult { Inside, Clipped, Outside };
CullResult cullSphere(const RasterView& view, const vec3& center, float radius);
CullResult cullBox(const RasterView& view, const Bounds& box);
/// Box given in model space.
CullResult cullBox(const RasterView& view, const Bounds& box, const mat4& worldFromModel);

} // namespace q3rt
