#include "renderer_rt/view_motion.hpp"

#include <limits>
#include <optional>

namespace q3rt {

namespace {

/// An eye that moves farther in one frame has been put somewhere else: the fastest player (knocked about, 1,000 qu/s)
/// needs a quarter of a second for it.
constexpr float kCutDistanceQu = 256.0f;

bool hasSameIdentity(const EntityPlace& a, const EntityPlace& b) {
    if (!a.moves || !b.moves) return a.moves == b.moves;
    return a.rigid && b.rigid && a.inlineModel == b.inlineModel && a.model == b.model && a.frame == b.frame &&
           a.oldFrame == b.oldFrame && a.backLerp == b.backLerp && a.flags == b.flags;
}

/// Points from one placement to another.
RtMotion makeMotion(const mat4& from, const mat4& to) {
    RtMotion motion{};
    motion.kind = kMotionNone;
    if (from == to) return motion;
    const glm::dmat4 source(from);
    if (glm::determinant(source) == 0) {
        motion.kind = kMotionUnknown;
        return motion;
    }
    const glm::dmat4 moved = glm::dmat4(to) * glm::inverse(source);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            motion.rows[row][column] = static_cast<float>(moved[column][row]);
    motion.kind = kMotionRigid;
    return motion;
}

vec3 originOf(const EntityPlace& place) { return vec3(place.worldFromModel[3]); }

/// The nearest entity of the same identity that nobody has taken yet.
std::optional<size_t> findAgain(const EntityPlace& wanted, const std::vector<EntityPlace>& among,
                                const std::vector<bool>& taken) {
    std::optional<size_t> best;
    float bestDistance = std::numeric_limits<float>::max();
    for (size_t i = 0; i < among.size(); ++i) {
        if (taken[i] || !hasSameIdentity(wanted, among[i])) continue;
        const vec3 apart = originOf(among[i]) - originOf(wanted);
        const float distance = glm::dot(apart, apart);
        if (distance >= bestDistance) continue;
        best = i;
        bestDistance = distance;
    }
    return best;
}

} // namespace

RtCamera cameraOf(const RtFrame& frame) {
    return {.eye = frame.eye,
            .forward = frame.forward,
            .left = frame.left,
            .up = frame.up,
            .forwardUnit = frame.forwardUnit};
}

std::vector<EntityPlace> findPlaces(const FrameCommands& frame, const SceneView& scene, const ViewGeometry& geometry) {
    std::vector<EntityPlace> places;
    for (const EntityRecord& record : geometry.entities) {
        EntityPlace& place = places.emplace_back();
        place.worldFromModel = record.worldFromModel;
        place.inlineModel = record.inlineModel;
        place.flags = record.flags;
        place.moves = record.sceneIndex >= 0;
        if (!place.moves) continue;
        const SceneEntity& entity = frame.entities[scene.firstEntity + static_cast<uint32_t>(record.sceneIndex)];
        place.rigid = entity.kind == EntityKind::Model;
        place.model = entity.model;
        place.frame = entity.frame;
        place.oldFrame = entity.oldFrame;
        place.backLerp = entity.frame == entity.oldFrame ? 0.0f : entity.backLerp;
    }
    for (const EntitySurface& surface : geometry.surfaces)
        if (surface.deformed) places[surface.entity].rigid = false;
    return places;
}

void ViewMotion::advance(ViewInstant now) {
    m_previous = std::move(m_current);
    m_current = std::move(now);
    m_continuous = m_started && m_current.pictureNumber == m_previous.pictureNumber + 1 &&
                   m_current.timeMs >= m_previous.timeMs && m_current.settingsKey == m_previous.settingsKey &&
                   glm::distance(m_current.camera.eye, m_previous.camera.eye) <= kCutDistanceQu;
    m_started = true;
    matchEntities();
}

void ViewMotion::matchEntities() {
    m_toCurrent.assign(m_previous.entities.size(), RtMotion{});
    m_toPrevious.assign(m_current.entities.size(), RtMotion{});
    std::vector<bool> taken(m_previous.entities.size(), false);
    for (size_t i = 0; i < m_current.entities.size(); ++i) {
        const EntityPlace& place = m_current.entities[i];
        const std::optional<size_t> before = findAgain(place, m_previous.entities, taken);
        if (!before) continue;
        taken[*before] = true;
        const mat4& old = m_previous.entities[*before].worldFromModel;
        m_toPrevious[i] = makeMotion(place.worldFromModel, old);
        m_toCurrent[*before] = makeMotion(old, place.worldFromModel);
    }
}

} // namespace q3rt
