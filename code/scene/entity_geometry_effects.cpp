// Sprites, beams, rails and lightning in world space, and the axes of missing models (spec of models 2.11 and 4).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/deform_stamp.hpp"
#include "scene/entity_geometry_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kTextureLengthQu = 256.0f; // a rail's texture repeats after this
constexpr int kBeamSides = 6;
constexpr float kBeamRadiusQu = 4.0f;
constexpr int kLightningWidthQu = 8; // half the width of each of its quads
constexpr int kLightningQuads = 4;
constexpr float kRingScale = 0.25f;         // corner distance of a rail ring, of r_railWidth
constexpr float kLongestRailQu = 262144.0f; // no map is larger; bounds the rings of a broken entity
constexpr float kAxisLengthQu = 16.0f;
constexpr float kAxisWidthPixels = 3.0f;
constexpr U8vec4 kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255};

vec3 rotateAbout(const vec3& v, const vec3& unitAxis, float radians) {
    const float c = std::cos(radians), s = std::sin(radians);
    return v * c + glm::cross(unitAxis, v) * s + unitAxis * (glm::dot(unitAxis, v) * (1.0f - c));
}

/// A unit vector across `v`: its smallest component's axis, projected.
vec3 perpendicularTo(const vec3& v) {
    int smallest = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::abs(v[i]) < std::abs(v[smallest])) smallest = i;
    }
    vec3 axis(0.0f);
    axis[smallest] = 1.0f;
    return normalizeOrZero(axis - v * glm::dot(axis, v));
}

void appendQuad(ViewGeometry& out, const vec3 corners[4], const vec2 st[4], const uint32_t color[4],
                const vec3& normal) {
    const auto first = static_cast<uint32_t>(out.vertices.size());
    for (int i = 0; i < 4; ++i) {
        out.vertices.push_back({corners[i], normal, st[i], vec2(0.0f), color[i], 0});
    }
    for (const uint32_t offset : {0u, 1u, 2u, 2u, 1u, 3u}) {
        out.indices.push_back(first + offset);
    }
}

void addSprite(const ViewBuild& build, const SceneEntity& entity) {
    const float angle = glm::radians(entity.rotationDegrees);
    const float c = std::cos(angle) * entity.radius, s = std::sin(angle) * entity.radius;
    Stamp stamp;
    stamp.centre = entity.orientation.origin;
    stamp.left = build.eye.axis[1] * c - build.eye.axis[2] * s;
    stamp.up = build.eye.axis[2] * c + build.eye.axis[1] * s;
    if (build.settings.mirrored) stamp.left = -stamp.left;
    stamp.normal = -build.eye.axis[0];
    stamp.color = packColor(entity.color);
    appendStamp(stamp, build.out.vertices, build.out.indices);
}

/// The tube starts at the world's origin, not at the entity's: what the game's beams look like in the original.
void addBeam(const ViewBuild& build, const SceneEntity& entity) {
    const vec3 along = entity.oldOrigin - entity.orientation.origin;
    const vec3 direction = normalizeOrZero(along);
    if (direction == vec3(0.0f)) return;
    const vec3 side = perpendicularTo(direction) * kBeamRadiusQu;
    const vec2 st[4] = {};
    const uint32_t red = packColor(kRed);
    const uint32_t color[4] = {red, red, red, red};
    for (int i = 0; i < kBeamSides; ++i) {
        const float step = 2.0f * std::numbers::pi_v<float> / kBeamSides;
        const vec3 a = rotateAbout(side, direction, step * static_cast<float>(i));
        const vec3 b = rotateAbout(side, direction, step * static_cast<float>(i + 1));
        const vec3 corners[4] = {a, a + along, b, b + along};
        appendQuad(build.out, corners, st, color, normalizeOrZero(a + b));
    }
}

/// A ribbon of half width `width` along a line. Its first vertex has a quarter of the colour, as in the original.
void addRibbon(const ViewBuild& build, const SceneEntity& entity, const vec3& start, const vec3& end, const vec3& side,
               float width) {
    const float length = std::floor(glm::length(end - start)) / kTextureLengthQu;
    const U8vec4 full(entity.color.r, entity.color.g, entity.color.b, 255);
    const U8vec4 quarter(full.r / 4, full.g / 4, full.b / 4, 255);
    const vec3 corners[4] = {start + side * width, start - side * width, end + side * width, end - side * width};
    const vec2 st[4] = {{0, 0}, {0, 1}, {length, 0}, {length, 1}};
    const uint32_t color[4] = {packColor(quarter), packColor(full), packColor(full), packColor(full)};
    appendQuad(build.out, corners, st, color, -build.eye.axis[0]);
}

/// Across the line and toward neither end, as the eye sees it.
vec3 ribbonSide(const ViewBuild& build, const vec3& start, const vec3& end) {
    const vec3 toStart = normalizeOrZero(start - build.eye.origin), toEnd = normalizeOrZero(end - build.eye.origin);
    return normalizeOrZero(glm::cross(toStart, toEnd));
}

void addRailCore(const ViewBuild& build, const SceneEntity& entity) {
    const vec3 &start = entity.oldOrigin, &end = entity.orientation.origin;
    addRibbon(build, entity, start, end, ribbonSide(build, start, end),
              static_cast<float>(build.settings.railCoreWidth));
}

void addLightning(const ViewBuild& build, const SceneEntity& entity) {
    const vec3 &start = entity.orientation.origin, &end = entity.oldOrigin;
    const vec3 direction = normalizeOrZero(end - start);
    vec3 side = ribbonSide(build, start, end);
    for (int i = 0; i < kLightningQuads; ++i) {
        addRibbon(build, entity, start, end, side, kLightningWidthQu);
        side = rotateAbout(side, direction, std::numbers::pi_v<float> / kLightningQuads);
    }
}

void addRailRings(const ViewBuild& build, const SceneEntity& entity) {
    const vec3 along = entity.orientation.origin - entity.oldOrigin;
    const vec3 direction = normalizeOrZero(along);
    const auto segmentLength = static_cast<float>(std::max(1, build.settings.railSegmentLength));
    const float length = std::min(std::floor(glm::length(along)), kLongestRailQu);
    int count = std::max(1, static_cast<int>(length / segmentLength));
    vec3 centre = entity.oldOrigin;
    if (count > 1) { // the first segment is dropped
        --count;
        centre += direction * segmentLength;
    }
    vec3 right(direction.z, -direction.x, direction.y);
    right = normalizeOrZero(right - direction * glm::dot(right, direction));
    const vec3 up = glm::cross(right, direction);
    const float radius = kRingScale * static_cast<float>(build.settings.railWidth);
    const uint32_t color = packColor({entity.color.r, entity.color.g, entity.color.b, 255});
    constexpr vec2 kSt[4] = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};
    for (int ring = 0; ring < count; ++ring, centre += direction * segmentLength) {
        const auto first = static_cast<uint32_t>(build.out.vertices.size());
        for (int i = 0; i < 4; ++i) {
            const float angle = std::numbers::pi_v<float> * (0.25f + 0.5f * static_cast<float>(i));
            const vec3 corner = (right * std::cos(angle) + up * std::sin(angle)) * radius;
            build.out.vertices.push_back({centre + corner, -direction, kSt[i], vec2(0.0f), color, 0});
        }
        for (const uint32_t offset : {0u, 1u, 3u, 3u, 1u, 2u}) {
            build.out.indices.push_back(first + offset);
        }
    }
}

/// World width of one pixel at a point in front of the eye.
float pixelWidthAt(const ViewBuild& build, const vec3& point) {
    const float depth = std::max(0.0f, glm::dot(point - build.eye.origin, build.eye.axis[0]));
    const float pixels = static_cast<float>(std::max(1, build.view.height));
    return 2.0f * depth * std::tan(glm::radians(build.view.fovYDegrees) * 0.5f) / pixels;
}

} // namespace

void addEffectEntity(const ViewBuild& build, const SceneEntity& entity, int sceneIndex) {
    const uint32_t record = addRecord(build, entity, sceneIndex);
    const bool isBeam = entity.kind == EntityKind::Beam; // drawn in its own colour, whatever its shader
    const MaterialId material = isBeam ? build.settings.solidMaterial : materialOfHandle(build, entity.customShader);
    EntitySurface& surface = openSurface(build, material, record);
    if (!(entity.flags & entityFlag::kCrosshair)) {
        surface.fog = fogOfSphere(build, entity.orientation.origin, entity.radius);
    }
    switch (entity.kind) {
    case EntityKind::Sprite:
        addSprite(build, entity);
        break;
    case EntityKind::Beam:
        addBeam(build, entity);
        break;
    case EntityKind::RailCore:
        addRailCore(build, entity);
        break;
    case EntityKind::RailRings:
        addRailRings(build, entity);
        break;
    case EntityKind::Lightning:
        addLightning(build, entity);
        break;
    default:
        break;
    }
    closeSurface(build, surface);
}

void addBadModelAxes(const ViewBuild& build, const SceneEntity& entity, int sceneIndex) {
    const uint32_t record = addRecord(build, entity, sceneIndex);
    build.out.entities[record].worldFromModel = mat4(1.0f);
    build.out.entities[record].eyeInModel = build.eye.origin;
    EntitySurface& surface = openSurface(build, build.settings.solidMaterial, record);
    const U8vec4 colors[3] = {kRed, kGreen, kBlue};
    for (int i = 0; i < 3; ++i) {
        const vec3& start = entity.orientation.origin;
        const vec3 end = start + entity.orientation.axis[i] * kAxisLengthQu;
        const vec3 half = ribbonSide(build, start, end) * (kAxisWidthPixels * 0.5f);
        const float startWidth = pixelWidthAt(build, start), endWidth = pixelWidthAt(build, end);
        const vec3 corners[4] = {start + half * startWidth, start - half * startWidth, end + half * endWidth,
                                 end - half * endWidth};
        const uint32_t color = packColor(colors[i]);
        const uint32_t color4[4] = {color, color, color, color};
        const vec2 st[4] = {};
        appendQuad(build.out, corners, st, color4, -build.eye.axis[0]);
    }
    closeSurface(build, surface);
}

} // namespace q3rt
