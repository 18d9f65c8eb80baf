#include "numerics/shadow_cases.hpp"

#include <algorithm>

#include "numerics/exact_scene.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 320, kHeight = 240; ///< pixels
constexpr float kFar = 1e6f;               ///< longer than any line inside the map, qu
constexpr size_t kLightCount = 48;         ///< the nearest of many points of the map's air
constexpr double kLeastCosine = 0.01;      ///< surfaces seen by their light under less are left out
/// Where the reference's rays start, qu off the surface: the nearer sees all, the farther what an offset may hide. A
/// pixel where they differ has no right answer.
constexpr double kNearStart = 1e-5, kFarStart = 0.02;

struct View {
    vec3 eye{0};
    dvec3 forward{0}, left{0}, up{0};
    std::vector<vec3> lights;
};

View makeView(const WorldTriangles& map) {
    View view;
    view.eye = map.playerStart();
    view.forward = glm::normalize(dvec3(0.8, 0.55, -0.1));
    view.left = glm::normalize(glm::cross(dvec3(0, 0, 1), view.forward));
    view.up = glm::cross(view.forward, view.left) * (double(kHeight) / kWidth);
    view.lights = map.pointsInside(4000, 9);
    std::sort(view.lights.begin(), view.lights.end(),
              [&](const vec3& a, const vec3& b) { return glm::distance(a, view.eye) < glm::distance(b, view.eye); });
    view.lights.resize(kLightCount);
    return view;
}

glm::dmat3 rotationOf(const Placement& placement) { return placement.rotation.value_or(glm::dmat3(1)); }

/// A point of the map at rest, where it stands in single precision.
vec3 moved(const Placement& placement, const vec3& point) {
    return vec3(rotationOf(placement) * dvec3(point) + placement.move);
}

/// The single-precision numbers that the scene is made of, combined in double.
dvec3 inWorld(const Placement& placement, const dvec3& corner) {
    if (!placement.rotation) return corner;
    const glm::dvec4 h(corner, 1.0);
    const vec4* rows = placement.worldFromModel;
    return {glm::dot(glm::dvec4(rows[0]), h), glm::dot(glm::dvec4(rows[1]), h), glm::dot(glm::dvec4(rows[2]), h)};
}

class CaseFinder {
  public:
    explicit CaseFinder(PlacedMap& map)
        : m_map(map)
        , m_exact(exactCorners(map)) {}

    void followPixel(const vec3& eye, const vec3& direction, const vec3& light) {
        const TestHit hit = traceShader(m_map.scene, eye, direction, 0, kFar);
        if (!hit.hit) return;
        dvec3 corner[3];
        for (uint32_t k = 0; k < 3; ++k)
            corner[k] = inWorld(m_map.placement, dvec3(m_map.corners[3 * hit.triangle + k]));
        dvec3 normal = glm::cross(corner[2] - corner[0], corner[1] - corner[0]);
        if (glm::dot(normal, normal) == 0) return;
        normal = glm::normalize(glm::dot(normal, dvec3(direction)) < 0 ? normal : -normal);
        const dvec3 point = corner[0] + (corner[1] - corner[0]) * double(hit.barycentric.x) +
                            (corner[2] - corner[0]) * double(hit.barycentric.y);
        if (glm::dot(normal, glm::normalize(dvec3(light) - point)) <= kLeastCosine) return;
        const auto isHidden = [&](double start) {
            const dvec3 from = point + normal * start;
            return m_exact.isHit(from, dvec3(light) - from, 0, 1);
        };
        const bool hidden = isHidden(kNearStart);
        if (hidden != isHidden(kFarStart))
            ++m_map.undecided;
        else
            m_map.cases.push_back({hit.triangle, hit.barycentric, vec3(normal), light, hidden});
    }

  private:
    static std::vector<dvec3> exactCorners(const PlacedMap& map) {
        std::vector<dvec3> result;
        for (const vec3& corner : map.corners)
            result.push_back(inWorld(map.placement, dvec3(corner)));
        return result;
    }
    PlacedMap& m_map;
    ExactScene m_exact;
};

} // namespace

Placement makePlacement(float distance, bool rotated) {
    Placement result;
    result.move = dvec3(distance, -distance, distance);
    if (rotated) result.rotation = makeRotation(0.7);
    const glm::dmat3 m = rotationOf(result);
    for (int row = 0; row < 3; ++row)
        result.worldFromModel[row] = vec4(m[0][row], m[1][row], m[2][row], result.move[row]);
    return result;
}

PlacedMap makeShadowCases(const WorldTriangles& map, const Placement& placement) {
    PlacedMap result;
    result.placement = placement;
    result.corners = placement.rotation ? map.positions() : place(map.positions(), 1, vec3(placement.move));
    result.scene = placement.rotation ? makeInstanceScene(result.corners, *placement.rotation, 1, placement.move)
                                      : makeScene(result.corners);
    CaseFinder finder(result);
    const View view = makeView(map);
    std::mt19937 random(31);
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const double x = 1 - 2 * (i % kWidth + 0.5) / kWidth, y = 1 - 2 * (i / kWidth + 0.5) / kHeight;
        const dvec3 direction = glm::normalize(view.forward + view.left * x + view.up * y);
        finder.followPixel(moved(placement, view.eye), vec3(rotationOf(placement) * direction),
                           moved(placement, view.lights[random() % view.lights.size()]));
    }
    return result;
}

} // namespace q3rt::test
