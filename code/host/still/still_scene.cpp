#include "host/still/still_scene.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

namespace q3rt {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;
/// Of maps that have no info_player_deathmatch.
constexpr std::string_view kOtherStarts[] = {"info_player_start", "team_CTF_redspawn", "team_CTF_bluespawn",
                                             "team_CTF_redplayer", "team_CTF_blueplayer"};
/// Of a standing player above the spawn point, in qu.
constexpr float kEyeHeight = 26.0f;
/// Part of a door or platform that stays in view when it is open, in qu, where the map gives none.
constexpr float kDefaultLip = 8.0f;

/// Axes of a view: forward, left, up.
void storeAxes(float pitchDegrees, float yawDegrees, vec3_t (&axis)[3]) {
    const float sp = std::sin(pitchDegrees * kDegrees), cp = std::cos(pitchDegrees * kDegrees);
    const float sy = std::sin(yawDegrees * kDegrees), cy = std::cos(yawDegrees * kDegrees);
    const float rows[3][3] = {{cp * cy, cp * sy, -sp}, {-sy, cy, 0}, {sp * cy, sp * sy, cp}};
    std::memcpy(axis, rows, sizeof rows);
}

void storeVector(const vec3& from, vec3_t& to) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

/// Direction of the "angle" key: -1 is up, -2 down, else a yaw in degrees.
vec3 moveDirection(const MapEntity& entity) {
    const float angle = entity.number("angle", 0);
    if (angle == -1) return {0, 0, 1};
    if (angle == -2) return {0, 0, -1};
    return {std::cos(angle * kDegrees), std::sin(angle * kDegrees), 0};
}

vec3 directionOf(const MapEntity& entity) {
    const vec3 angles = entity.vector("angles").value_or(vec3(0, entity.number("angle", 0), 0));
    vec3_t axis[3];
    storeAxes(angles.x, angles.y, axis);
    return {axis[0][0], axis[0][1], axis[0][2]};
}

const MapEntity* findTarget(const std::vector<MapEntity>& entities, const MapEntity& entity) {
    const auto target = entity.value("target");
    if (!target) return nullptr;
    for (const MapEntity& candidate : entities)
        if (candidate.value("targetname") == target) return &candidate;
    return nullptr;
}

/// Where a brush model waits before anyone moves it.
vec3 restOrigin(const MapEntity& entity, const BspModel& model, const std::vector<MapEntity>& entities) {
    const vec3 origin = entity.vector("origin").value_or(vec3(0));
    const vec3 size = model.maxs - model.mins;
    const float lip = entity.number("lip", kDefaultLip);
    const std::string_view kind = entity.className();
    constexpr int kStartOpen = 1;
    if (kind == "func_plat") {
        const float height = entity.number("height", 0);
        return origin - vec3(0, 0, height != 0 ? height : size.z - lip);
    }
    if (kind == "func_door" && (static_cast<int>(entity.number("spawnflags", 0)) & kStartOpen)) {
        const vec3 direction = moveDirection(entity);
        return origin + direction * (glm::dot(glm::abs(direction), size) - lip);
    }
    if (kind == "func_train")
        if (const MapEntity* corner = findTarget(entities, entity)) return corner->vector("origin").value_or(origin);
    return origin;
}

refEntity_t plainEntity(const vec3& origin) {
    refEntity_t entity{};
    entity.reType = RT_MODEL;
    storeVector(origin, entity.origin);
    storeVector(origin, entity.oldorigin);
    storeVector(origin, entity.lightingOrigin);
    storeAxes(0, 0, entity.axis);
    std::memset(entity.shaderRGBA, 255, sizeof entity.shaderRGBA);
    return entity;
}

/// A mirror shows its own place; a portal with a camera shows what the camera sees.
refEntity_t portalEntity(const MapEntity& surface, const std::vector<MapEntity>& entities) {
    refEntity_t entity = plainEntity(surface.vector("origin").value_or(vec3(0)));
    entity.reType = RT_PORTALSURFACE;
    const MapEntity* camera = findTarget(entities, surface);
    if (!camera) return entity;
    const vec3 eye = camera->vector("origin").value_or(vec3(0));
    storeVector(eye, entity.oldorigin);
    const MapEntity* aim = findTarget(entities, *camera);
    vec3 forward = aim ? aim->vector("origin").value_or(eye) - eye : directionOf(*camera);
    forward = glm::length(forward) > 0 ? glm::normalize(forward) : vec3(1, 0, 0);
    // The camera stands upright; looking straight up or down, any side will do.
    const vec3 up = std::abs(forward.z) < 0.999f ? vec3(0, 0, 1) : vec3(1, 0, 0);
    const vec3 left = glm::normalize(glm::cross(up, forward));
    storeVector(forward, entity.axis[0]);
    storeVector(left, entity.axis[1]);
    storeVector(glm::cross(forward, left), entity.axis[2]);
    return entity;
}

/// The number of "*N", or nullopt.
std::optional<size_t> inlineModel(std::string_view name) {
    size_t number = 0;
    if (name.size() < 2 || name[0] != '*') return std::nullopt;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
    return number;
}

} // namespace

std::vector<StillEntity> buildStillScene(const Bsp& bsp, const std::vector<MapEntity>& entities) {
    std::vector<StillEntity> scene;
    for (const MapEntity& entity : entities) {
        const std::string_view kind = entity.className();
        if (kind == "misc_portal_surface") {
            scene.push_back({"", portalEntity(entity, entities)});
            continue;
        }
        const std::string_view model = entity.value("model").value_or("");
        const auto number = inlineModel(model);
        // Triggers and their like have brushes but are never shown.
        if (!number || *number == 0 || *number >= bsp.models.size() || !kind.starts_with("func_")) continue;
        const refEntity_t placed = plainEntity(restOrigin(entity, bsp.models[*number], entities));
        scene.push_back({std::string(model), placed});
        if (const auto second = entity.value("model2")) scene.push_back({std::string(*second), placed});
    }
    return scene;
}

std::vector<EyePoint> findSpawnPoints(const std::vector<MapEntity>& entities) {
    std::vector<EyePoint> points;
    const auto addAll = [&](std::string_view className) {
        for (const MapEntity& entity : entities)
            if (entity.className() == className)
                points.push_back(
                    {entity.vector("origin").value_or(vec3(0)) + vec3(0, 0, kEyeHeight), 0, entity.number("angle", 0)});
    };
    addAll("info_player_deathmatch");
    if (!points.empty()) return points;
    for (const std::string_view className : kOtherStarts)
        addAll(className);
    return points;
}

refdef_t makeView(const EyePoint& eye, float fovXDegrees, int width, int height, int timeMs) {
    refdef_t view{};
    view.width = width;
    view.height = height;
    view.fov_x = fovXDegrees;
    const float shape = static_cast<float>(height) / static_cast<float>(width);
    view.fov_y = 2 * std::atan(std::tan(fovXDegrees * kDegrees / 2) * shape) / kDegrees;
    storeVector(eye.origin, view.vieworg);
    storeAxes(eye.pitchDegrees, eye.yawDegrees, view.viewaxis);
    view.time = timeMs;
    return view;
}

} // namespace q3rt
