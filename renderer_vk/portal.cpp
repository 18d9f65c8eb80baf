#include "renderer_vk/portal.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace q3rt {

namespace {

const SceneEntity* findPortalEntity(const Plane& match, std::span<const SceneEntity> entities) {
    for (const SceneEntity& entity : entities) {
        if (entity.kind != EntityKind::PortalSurface) continue;
        const float distance = glm::dot(match.normal, entity.orientation.origin) - match.distance;
        if (std::abs(distance) <= kPortalEntityReachQu) return &entity;
    }
    return nullptr;
}

bool isMirror(const SceneEntity& entity) { return entity.oldOrigin == entity.orientation.origin; }

/// Roll of the camera about its own forward axis, degrees (the entity's fields say how; spec of world 4.5).
float rollDegrees(const SceneEntity& entity, int timeMs) {
    if (entity.oldFrame == 0) return static_cast<float>(entity.skinNumber);
    if (entity.frame != 0) {
        const double seconds = timeMs * 0.001;
        return static_cast<float>(std::fmod(seconds * entity.frame, 360.0));
    }
    return static_cast<float>(entity.skinNumber) + 4.0f * static_cast<float>(std::sin(timeMs * 0.003));
}

vec3 toCamera(const vec3& vector, const Orientation& surface, const Orientation& camera) {
    vec3 result(0.0f);
    for (int i = 0; i < 3; ++i)
        result += glm::dot(vector, surface.axis[i]) * camera.axis[i];
    return result;
}

} // namespace

vec3 perpendicularTo(const vec3& normal) {
    int smallest = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) < std::abs(normal[smallest])) smallest = i;
    vec3 axis(0.0f);
    axis[smallest] = 1.0f;
    return glm::normalize(axis - normal * glm::dot(normal, axis));
}

vec3 rotateAbout(const vec3& axis, const vec3& vector, float degrees) {
    const float radians = degrees * (std::numbers::pi_v<float> / 180.0f);
    const float c = std::cos(radians), s = std::sin(radians);
    return vector * c + glm::cross(axis, vector) * s + axis * (glm::dot(axis, vector) * (1.0f - c));
}

bool portalVisible(const RasterView& view, const PortalShape& shape, float rangeQu, bool mirror) {
    unsigned outsideAll = ~0u;
    for (const vec3& position : shape.positions) {
        const vec4 clip = view.clipFromWorld * vec4(position, 1.0f);
        // The depth test of the original is in a clip space of -w to w.
        const float values[3] = {clip.x, clip.y, clip.z * 2.0f - clip.w};
        unsigned outside = 0;
        for (unsigned i = 0; i < 3; ++i) {
            if (values[i] >= clip.w) outside |= 1u << (i * 2);
            if (values[i] <= -clip.w) outside |= 2u << (i * 2);
        }
        outsideAll &= outside;
    }
    if (shape.positions.empty() || outsideAll != 0) return false;
    size_t facing = 0;
    float nearest = std::numeric_limits<float>::max();
    for (size_t i = 0; i + 2 < shape.indices.size(); i += 3) {
        const vec3 toVertex = shape.positions[shape.indices[i]] - view.eye.origin;
        nearest = std::min(nearest, glm::length(toVertex));
        if (glm::dot(toVertex, shape.normals[shape.indices[i]]) < 0) ++facing;
    }
    if (facing == 0) return false;
    return mirror || nearest <= rangeQu;
}

std::optional<bool> portalIsMirror(const Plane& match, std::span<const SceneEntity> entities) {
    const SceneEntity* entity = findPortalEntity(match, entities);
    if (!entity) return std::nullopt;
    return isMirror(*entity);
}

std::optional<PortalFrames> findPortalFrames(const Plane& plane, const Plane& match,
                                             std::span<const SceneEntity> entities, int timeMs) {
    const SceneEntity* entity = findPortalEntity(match, entities);
    if (!entity) return std::nullopt;
    PortalFrames frames;
    frames.pvsOrigin = entity->oldOrigin;
    frames.mirror = isMirror(*entity);
    Orientation& surface = frames.surface;
    Orientation& camera = frames.camera;
    surface.axis[0] = plane.normal;
    surface.axis[1] = perpendicularTo(plane.normal);
    surface.axis[2] = glm::cross(surface.axis[0], surface.axis[1]);
    if (frames.mirror) {
        surface.origin = camera.origin = plane.normal * plane.distance;
        camera.axis[0] = -surface.axis[0];
        camera.axis[1] = surface.axis[1];
        camera.axis[2] = surface.axis[2];
        return frames;
    }
    const vec3& at = entity->orientation.origin;
    surface.origin = at - plane.normal * (glm::dot(plane.normal, at) - plane.distance);
    camera.origin = entity->oldOrigin;
    camera.axis[0] = -entity->orientation.axis[0];
    camera.axis[1] = -entity->orientation.axis[1];
    camera.axis[2] = entity->orientation.axis[2];
    if (const float roll = rollDegrees(*entity, timeMs); roll != 0) {
        camera.axis[1] = rotateAbout(camera.axis[0], camera.axis[1], roll);
        camera.axis[2] = glm::cross(camera.axis[0], camera.axis[1]);
    }
    return frames;
}

std::optional<RasterView> makePortalView(const RasterView& view, const Plane& plane, const Plane& match,
                                         std::span<const SceneEntity> entities) {
    const auto frames = findPortalFrames(plane, match, entities, view.scene->timeMs);
    if (!frames) return std::nullopt;
    const auto& [surface, camera, pvsOrigin, mirror] = *frames;
    RasterView out = view;
    out.portal = true;
    ++out.portalDepth;
    out.mirrored = view.mirrored != mirror;
    out.pvsOrigin = pvsOrigin;
    out.eye.origin = camera.origin + toCamera(view.eye.origin - surface.origin, surface, camera);
    for (int i = 0; i < 3; ++i)
        out.eye.axis[i] = toCamera(view.eye.axis[i], surface, camera);
    out.clip.normal = -camera.axis[0];
    out.clip.distance = glm::dot(out.clip.normal, camera.origin);
    updateFrustum(out);
    return out;
}

} // namespace q3rt
