#include "renderer_vk/view_setup.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace q3rt {

RasterView makeMainView(const SceneView& scene, float nearQu) {
    constexpr float kHalfDegree = std::numbers::pi_v<float> / 360.0f; // half the angle, in radians
    RasterView view;
    view.scene = &scene;
    view.eye = scene.view;
    view.pvsOrigin = scene.view.origin;
    view.tanHalfX = std::tan(scene.fovXDegrees * kHalfDegree);
    view.tanHalfY = std::tan(scene.fovYDegrees * kHalfDegree);
    view.nearQu = nearQu;
    updateFrustum(view);
    return view;
}

void separateEye(RasterView& view, float projectionQu, float divisor) {
    if (view.scene->eye == Eye::Both || divisor == 0) return;
    view.projectionQu = projectionQu;
    view.stereoDivisor = view.scene->eye == Eye::Left ? divisor : -divisor;
    view.eyeShiftQu = projectionQu / view.stereoDivisor;
    updateFrustum(view);
}

void updateFrustum(RasterView& view) {
    const vec3 &forward = view.eye.axis[0], &left = view.eye.axis[1], &up = view.eye.axis[2];
    const float tx = view.tanHalfX, ty = view.tanHalfY, shift = view.eyeShiftQu;
    // The eye moves, and the side planes slope so that they still meet the edges of the plane where both eyes agree.
    const vec3 apex = view.eye.origin + left * shift;
    const float slope = shift / view.projectionQu;
    const vec3 normals[4] = {glm::normalize(forward * (tx + slope) + left),
                             glm::normalize(forward * (tx - slope) - left), glm::normalize(forward * ty + up),
                             glm::normalize(forward * ty - up)};
    for (size_t i = 0; i < 4; ++i)
        view.frustum[i] = {normals[i], glm::dot(normals[i], apex)};
}

namespace {

mat4 projectionOf(const RasterView& view, double eyeShiftQu, double projectionQu) {
    const dvec3 eye(view.eye.origin);
    const dvec3 forward(view.eye.axis[0]), left(view.eye.axis[1]), up(view.eye.axis[2]);
    const double n = view.nearQu, f = std::max(view.farQu, view.nearQu * 2.0f), tx = view.tanHalfX;
    const dvec3 x = (-left - forward * (eyeShiftQu / projectionQu)) / tx, y = -up / static_cast<double>(view.tanHalfY);
    const dvec3 z = forward * (f / (f - n));
    glm::dmat4 m(0.0);
    for (int c = 0; c < 3; ++c)
        m[c] = glm::dvec4(x[c], y[c], z[c], forward[c]);
    m[3] = glm::dvec4(eyeShiftQu / tx - glm::dot(x, eye), -glm::dot(y, eye), -glm::dot(z, eye) - f * n / (f - n),
                      -glm::dot(forward, eye));
    return mat4(m);
}

} // namespace

void updateProjection(RasterView& view) {
    view.clipFromWorld = view.clipFromWorldNear = projectionOf(view, view.eyeShiftQu, view.projectionQu);
    if (view.stereoDivisor != 0)
        view.clipFromWorldNear = projectionOf(view, view.nearQu / view.stereoDivisor, view.nearQu);
}

float farthestCornerQu(const vec3& eye, const Bounds& bounds) {
    const vec3 reach = glm::max(glm::abs(bounds.mins - eye), glm::abs(bounds.maxs - eye));
    return glm::length(reach);
}

CullResult cullSphere(const RasterView& view, const vec3& center, float radius) {
    bool clipped = false;
    for (const Plane& plane : view.frustum) {
        const float distance = glm::dot(plane.normal, center) - plane.distance;
        if (distance < -radius) return CullResult::Outside;
        if (distance <= radius) clipped = true;
    }
    return clipped ? CullResult::Clipped : CullResult::Inside;
}

CullResult cullBox(const RasterView& view, const Bounds& box) { return cullBox(view, box, mat4(1.0f)); }

CullResult cullBox(const RasterView& view, const Bounds& box, const mat4& worldFromModel) {
    std::array<vec3, 8> corners;
    for (size_t i = 0; i < 8; ++i) {
        const vec3 corner((i & 1) ? box.maxs.x : box.mins.x, (i & 2) ? box.maxs.y : box.mins.y,
                          (i & 4) ? box.maxs.z : box.mins.z);
        corners[i] = vec3(worldFromModel * vec4(corner, 1.0f));
    }
    bool clipped = false;
    for (const Plane& plane : view.frustum) {
        size_t front = 0;
        for (const vec3& corner : corners)
            front += glm::dot(plane.normal, corner) > plane.distance ? 1u : 0u;
        if (front == 0) return CullResult::Outside;
        if (front < corners.size()) clipped = true;
    }
    return clipped ? CullResult::Clipped : CullResult::Inside;
}

} // namespace q3rt
