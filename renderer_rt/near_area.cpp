#include "renderer_rt/near_area.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "scene/scene_types.hpp"
#include "shaders/shared/constants.h"

namespace q3rt {

namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Fractions of the picture from its upper left corner.
struct Area {
    glm::dvec2 low{kEverywhere}, high{-kEverywhere};
    void add(const glm::dvec2& point, const glm::dvec2& error) {
        low = glm::min(low, point - error);
        high = glm::max(high, point + error);
    }
};

class NearCamera {
  public:
    explicit NearCamera(const RtFrame& frame)
        : m_eye(frame.eye)
        , m_amounts(glm::inverse(glm::dmat3(dvec3(frame.forward), dvec3(frame.left), dvec3(frame.up)))) {
        for (int row = 0; row < 3; ++row)
            m_gain[row] = glm::length(dvec3(m_amounts[0][row], m_amounts[1][row], m_amounts[2][row]));
    }

    /// A corner as amounts of the camera's forward, left and up, and the bound of their errors.
    struct Corner {
        dvec3 amounts, error;
        bool inFront() const { return amounts.x > error.x; }
    };
    Corner see(const vec3& world) const {
        const vec3 size = glm::abs(world);
        const double error = static_cast<double>(kHitPointError) * std::max(size.x, std::max(size.y, size.z));
        return {m_amounts * (dvec3(world) - m_eye), m_gain * error};
    }

  private:
    dvec3 m_eye;
    glm::dmat3 m_amounts;
    dvec3 m_gain; ///< most that an error in the world becomes
};

void addPoint(const NearCamera::Corner& corner, Area& area) {
    const dvec3 &a = corner.amounts, &e = corner.error;
    const glm::dvec2 slope = glm::dvec2(a.y, a.z) / a.x;
    const glm::dvec2 error = (glm::dvec2(e.y, e.z) + glm::abs(slope) * e.x) / (a.x - e.x);
    area.add((1.0 - slope) * 0.5, error * 0.5);
}

/// A line that passes the eye's plane goes on for ever on the picture, to the side where it passes.
void addPassage(const NearCamera::Corner& front, const NearCamera::Corner& behind, Area& area) {
    const double share = front.amounts.x / (front.amounts.x - behind.amounts.x);
    const dvec3 at = front.amounts + (behind.amounts - front.amounts) * share;
    const dvec3 error = glm::max(front.error, behind.error);
    for (int axis = 0; axis < 2; ++axis) {
        // Not a number, or too near the eye to tell: to both sides.
        if (!(at[axis + 1] < -error[axis + 1])) area.low[axis] = -kEverywhere;
        if (!(at[axis + 1] > error[axis + 1])) area.high[axis] = kEverywhere;
    }
}

void addTriangle(const std::array<NearCamera::Corner, 3>& corners, Area& area) {
    for (size_t i = 0; i < 3; ++i) {
        const NearCamera::Corner &one = corners[i], &next = corners[(i + 1) % 3];
        if (one.inFront()) addPoint(one, area);
        if (one.inFront() && !next.inFront()) addPassage(one, next, area);
        if (!one.inFront() && next.inFront()) addPassage(next, one, area);
    }
}

} // namespace

vec4 findNearArea(const ViewGeometry& geometry, const RtFrame& frame) {
    const NearCamera camera(frame);
    Area area;
    const auto isNear = [](const EntityRecord& record) { return (record.flags & entityFlag::kDepthHack) != 0; };
    for (const EntityRecord& record : geometry.entities)
        if (isNear(record) && record.inlineModel >= 0) area = {glm::dvec2(-kEverywhere), glm::dvec2(kEverywhere)};
    for (const EntitySurface& surface : geometry.surfaces) {
        const EntityRecord& record = geometry.entities[surface.entity];
        if (!isNear(record)) continue;
        for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3) {
            std::array<NearCamera::Corner, 3> corners;
            for (uint32_t k = 0; k < 3; ++k) {
                const Vertex& vertex = geometry.vertices[geometry.indices[surface.firstIndex + i + k]];
                corners[k] = camera.see(vec3(record.worldFromModel * vec4(vertex.position, 1.0f)));
            }
            addTriangle(corners, area);
        }
    }
    // A pixel more: rays may go through any point of theirs.
    const glm::dvec2 size(frame.size.x, frame.size.y);
    const glm::dvec2 low = area.low * size - 1.0, high = area.high * size + 1.0;
    return {static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(high.x),
            static_cast<float>(high.y)};
}

} // namespace q3rt
