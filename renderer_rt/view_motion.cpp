#include "renderer_rt/view_motion.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <tuple>

namespace q3rt {

namespace {

/// An eye or an entity that moves farther in one frame has been put somewhere else: the fastest player (knocked about,
/// 1,000 qu/s) needs a quarter of a second for it, the fastest missile (2,500 qu/s) a tenth.
constexpr float kCutDistanceQu = 256.0f;

/// Equal for things that may be one and the same.
auto kindOf(const EntityPlace& place) {
    return std::tuple(place.moves, place.kind, place.inlineModel, place.model, place.skin, place.skinNumber,
                      place.shader, place.flags, std::bit_cast<uint32_t>(place.startSeconds));
}

void setRows(vec4 (&rows)[3], const glm::dmat4& matrix) {
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            rows[row][column] = static_cast<float>(matrix[column][row]);
}

/// World there from world here, of surfaces that keep their shape.
RtMotion makeMotion(const mat4& here, const mat4& there) {
    RtMotion motion{};
    motion.kind = kMotionNone;
    if (here == there) return motion;
    const glm::dmat4 source(here);
    if (glm::determinant(source) == 0) {
        motion.kind = kMotionUnknown;
        return motion;
    }
    setRows(motion.rows, glm::dmat4(there) * glm::inverse(source));
    motion.kind = kMotionRigid;
    return motion;
}

/// One corner after the other; triangles are those of the current frame.
RtMotion makeShapeMotion(const mat4& here, const mat4& there, VkDeviceAddress corners, VkDeviceAddress indices) {
    RtMotion motion = makeMotion(here, there);
    if (motion.kind == kMotionUnknown) return motion;
    if (motion.kind == kMotionNone) setRows(motion.rows, glm::dmat4(1.0));
    setRows(motion.shapeRows, glm::dmat4(there));
    motion.corners = corners;
    motion.indices = indices;
    motion.kind = kMotionShape;
    return motion;
}

/// Where it should be after a time, if it goes on as it did.
vec3 expectedAnchor(const EntityPlace& place, int elapsedMs) {
    return place.anchor + place.velocity * static_cast<float>(elapsedMs);
}

/// Places of one kind, by number, and what has become of them.
struct KindRun {
    std::span<const size_t> places;
    const std::vector<vec3>& anchors; ///< of all kinds, by number
    std::vector<bool>& taken;         ///< so too
};

/// The nearest among those not taken; the lowest number if several are as near.
std::optional<size_t> findNearest(const vec3& at, const KindRun& among) {
    std::optional<size_t> best;
    float bestDistance2 = kCutDistanceQu * kCutDistanceQu;
    for (const size_t i : among.places) {
        if (among.taken[i]) continue;
        const vec3 apart = among.anchors[i] - at;
        const float distance2 = glm::dot(apart, apart);
        if (!(distance2 <= bestDistance2) || (best && distance2 == bestDistance2)) continue;
        best = i;
        bestDistance2 = distance2;
    }
    return best;
}

/// Two that are each other's nearest belong together; then the rest. The first round that finds none is the last.
void matchKind(const KindRun& now, const KindRun& before, std::vector<std::optional<size_t>>& found) {
    for (bool again = true; again;) {
        again = false;
        for (const size_t i : now.places) {
            if (now.taken[i]) continue;
            const std::optional<size_t> there = findNearest(now.anchors[i], before);
            if (!there || findNearest(before.anchors[*there], now) != i) continue;
            found[i] = there;
            now.taken[i] = before.taken[*there] = again = true;
        }
    }
}

/// All numbers, those of a kind together and in order.
std::vector<size_t> sortByKind(const std::vector<EntityPlace>& places) {
    std::vector<size_t> order(places.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, {}, [&](size_t i) { return kindOf(places[i]); });
    return order;
}

} // namespace

RtCamera cameraOf(const RtFrame& frame) {
    return {.eye = frame.eye,
            .forward = frame.forward,
            .left = frame.left,
            .up = frame.up,
            .forwardUnit = frame.forwardUnit};
}

std::vector<std::optional<size_t>> matchEntities(const std::vector<EntityPlace>& now,
                                                 const std::vector<EntityPlace>& before, int elapsedMs) {
    std::vector<std::optional<size_t>> found(now.size());
    std::vector<bool> matched(now.size(), false), taken(before.size(), false);
    std::vector<vec3> anchors, expected;
    for (const EntityPlace& place : now)
        anchors.push_back(place.anchor);
    for (const EntityPlace& place : before)
        expected.push_back(expectedAnchor(place, elapsedMs));
    const std::vector<size_t> nowOrder = sortByKind(now), beforeOrder = sortByKind(before);
    for (auto first = nowOrder.begin(); first != nowOrder.end();) {
        const auto kind = kindOf(now[*first]);
        const auto end = std::find_if(first, nowOrder.end(), [&](size_t i) { return kindOf(now[i]) != kind; });
        const auto there = std::ranges::equal_range(beforeOrder, kind, {}, [&](size_t i) { return kindOf(before[i]); });
        matchKind({{first, end}, anchors, matched}, {{there.begin(), there.end()}, expected, taken}, found);
        first = end;
    }
    return found;
}

void ViewMotion::advance(ViewInstant now) {
    m_previous = std::move(m_current);
    m_current = std::move(now);
    m_continuous = m_started && m_current.pictureNumber == m_previous.pictureNumber + 1 &&
                   m_current.timeMs >= m_previous.timeMs && m_current.settingsKey == m_previous.settingsKey &&
                   glm::distance(m_current.camera.eye, m_previous.camera.eye) <= kCutDistanceQu;
    m_started = true;
    m_previousOf.assign(m_current.instances.size(), std::nullopt);
    if (m_continuous) matchInstances();
}

void ViewMotion::matchInstances() {
    const int elapsedMs = m_current.timeMs - m_previous.timeMs;
    const auto entityBefore = matchEntities(m_current.entities, m_previous.entities, elapsedMs);
    for (size_t e = 0; e < m_current.entities.size(); ++e) {
        EntityPlace& place = m_current.entities[e];
        if (!entityBefore[e]) continue;
        const EntityPlace& old = m_previous.entities[*entityBefore[e]];
        place.velocity = elapsedMs > 0 ? (place.anchor - old.anchor) / static_cast<float>(elapsedMs) : old.velocity;
    }
    std::vector<std::tuple<size_t, uint64_t, size_t>> before; // entity, key, number
    for (size_t i = 0; i < m_previous.instances.size(); ++i)
        before.emplace_back(m_previous.instances[i].entity, m_previous.instances[i].key, i);
    std::ranges::sort(before);
    for (size_t i = 0; i < m_current.instances.size(); ++i) {
        const InstancePlace& place = m_current.instances[i];
        if (!entityBefore[place.entity]) continue;
        const auto found =
            std::ranges::lower_bound(before, std::tuple(*entityBefore[place.entity], place.key, size_t{0}));
        if (found == before.end()) continue;
        const auto [entity, key, number] = *found;
        if (entity == *entityBefore[place.entity] && key == place.key) m_previousOf[i] = number;
    }
}

std::vector<RtMotion> ViewMotion::toPrevious(VkDeviceAddress corners) const {
    std::vector<RtMotion> out(m_current.instances.size());
    for (size_t i = 0; i < out.size(); ++i) {
        if (!m_previousOf[i]) continue;
        const InstancePlace &here = m_current.instances[i], &there = m_previous.instances[*m_previousOf[i]];
        const mat4& from = m_current.entities[here.entity].worldFromModel;
        const mat4& to = m_previous.entities[there.entity].worldFromModel;
        out[i] = here.changesShape
                     ? makeShapeMotion(from, to, corners + there.firstCorner * sizeof(vec3), m_current.indexAddress[i])
                     : makeMotion(from, to);
        out[i].inverseError = m_current.inverseError;
    }
    return out;
}

std::vector<RtMotion> ViewMotion::toCurrent(VkDeviceAddress corners) const {
    std::vector<RtMotion> out(m_previous.instances.size());
    for (size_t i = 0; i < m_previousOf.size(); ++i) {
        if (!m_previousOf[i]) continue;
        const InstancePlace &there = m_current.instances[i], &here = m_previous.instances[*m_previousOf[i]];
        const mat4& from = m_previous.entities[here.entity].worldFromModel;
        const mat4& to = m_current.entities[there.entity].worldFromModel;
        RtMotion& motion = out[*m_previousOf[i]];
        if (!there.changesShape)
            motion = makeMotion(from, to);
        else if (there.keepsOrder)
            motion = makeShapeMotion(from, to, corners + there.firstCorner * sizeof(vec3), m_current.indexAddress[i]);
        motion.inverseError = m_current.inverseError;
    }
    return out;
}

} // namespace q3rt
