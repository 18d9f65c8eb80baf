// Rays through whole maps: our traversal and Embree's robust mode, every disagreement settled in double precision.

#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "accel/cpu_tracer.hpp"
#include "accel/reference/embree_tracer.hpp"
#include "accel/reference/world_triangles.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

/// Distances that differ by less are the same answer.
constexpr double kSameDistance = 1e-5;

size_t rayCount() { return std::getenv("Q3RT_LONG_TESTS") ? 1000000 : 200000; }

/// Closest hit in (0, tMax) in double precision over all triangles (Moeller and Trumbore 1997); infinity if none.
double closestInDouble(const std::vector<vec3>& positions, const vec3& origin, const vec3& direction, double tMax) {
    double closest = std::numeric_limits<double>::infinity();
    const dvec3 o(origin), d(direction);
    for (size_t i = 0; i < positions.size(); i += 3) {
        const dvec3 a(positions[i]), edge1 = dvec3(positions[i + 1]) - a, edge2 = dvec3(positions[i + 2]) - a;
        const dvec3 p = glm::cross(d, edge2);
        const double determinant = glm::dot(edge1, p);
        if (determinant == 0) continue;
        const dvec3 s = o - a, q = glm::cross(s, edge1);
        const double u = glm::dot(s, p) / determinant, v = glm::dot(d, q) / determinant;
        const double t = glm::dot(edge2, q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < tMax) closest = std::min(closest, t);
    }
    return closest;
}

struct Answer {
    bool hit = false;
    float t = 0;
};

bool isSame(const Answer& a, const Answer& b) {
    return a.hit == b.hit && (!a.hit || std::abs(a.t - b.t) <= kSameDistance * std::abs(b.t));
}

/// Error of an answer: relative in distance; 1 for a hit that isn't one, or one that was missed.
double errorOf(const Answer& answer, double truth) {
    if (std::isinf(truth)) return answer.hit ? 1 : 0;
    return answer.hit ? std::abs(answer.t - truth) / truth : 1;
}

struct Score {
    size_t rays = 0, hits = 0, disagreements = 0, oursRight = 0, theirsRight = 0;
    size_t hitDisagreements = 0; ///< one hit, the other missed
};

class MapTruth : public ::testing::Test {
  protected:
    void settle(Score& score, const Answer& ours, const Answer& theirs, double truth) {
        ++score.disagreements;
        score.hitDisagreements += ours.hit != theirs.hit ? 1 : 0;
        // The nearer one is right; both may be.
        const double ourError = errorOf(ours, truth), theirError = errorOf(theirs, truth);
        score.oursRight += ourError <= std::max(theirError, kSameDistance) ? 1 : 0;
        score.theirsRight += theirError <= std::max(ourError, kSameDistance) ? 1 : 0;
    }
    void judge(const char* map, const char* kind, const Score& score) {
        std::printf("%s %s: %zu rays, %zu hits, %zu disagreements (%zu in hit or miss), right: ours %zu, Embree %zu\n",
                    map, kind, score.rays, score.hits, score.disagreements, score.hitDisagreements, score.oursRight,
                    score.theirsRight);
        EXPECT_EQ(score.rays, rayCount());
        EXPECT_GT(score.hits, rayCount() / 5);
        EXPECT_LE(score.disagreements, score.rays / 10000);
        m_oursRight += score.oursRight;
        m_theirsRight += score.theirsRight;
    }
    void traceMap(FileSource& files, const char* map);

    size_t m_oursRight = 0, m_theirsRight = 0; // in all maps: there are few disagreements in one
};

void MapTruth::traceMap(FileSource& files, const char* map) {
    const WorldTriangles world(files, map);
    const CpuTracer tracer(world.positions());
    const EmbreeTracer embree(world.positions());
    const std::vector<vec3> eyes = world.pointsInside(rayCount(), 1), lights = world.pointsInside(rayCount(), 2);
    const std::vector<vec3> directions = unitDirections(rayCount(), 3);
    const float far = world.farQu();
    Score primary, shadow;
    for (size_t i = 0; i < rayCount(); ++i) {
        CpuHit hit;
        const Answer ours{tracer.closest(eyes[i], directions[i], 0, far, hit), hit.t};
        const EmbreeHit reference = embree.closest(eyes[i], directions[i], far);
        const Answer theirs{reference.hit, reference.t};
        ++primary.rays;
        primary.hits += ours.hit ? 1 : 0;
        if (!isSame(ours, theirs))
            settle(primary, ours, theirs, closestInDouble(world.positions(), eyes[i], directions[i], far));
        // A shadow ray from just before the hit, or from the eye where there is none, to a point of the map.
        const vec3 start = ours.hit ? eyes[i] + directions[i] * (ours.t * (1 - 1e-3f)) : eyes[i];
        const vec3 toLight = lights[i] - start;
        const Answer blocked{tracer.occluded(start, toLight, 1)}, theirBlocked{embree.occluded(start, toLight, 1)};
        ++shadow.rays;
        shadow.hits += blocked.hit ? 1 : 0;
        if (blocked.hit == theirBlocked.hit) continue;
        const bool truth = !std::isinf(closestInDouble(world.positions(), start, toLight, 1));
        ++shadow.disagreements;
        ++shadow.hitDisagreements;
        ++(blocked.hit == truth ? shadow.oursRight : shadow.theirsRight);
    }
    judge(map, "primary", primary);
    judge(map, "shadow", shadow);
}

TEST_F(MapTruth, PrimaryAndShadowRays) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    for (const char* map : {"oa_dm1", "oa_minia", "oacmpctf3", "oa_thor"})
        traceMap(*files, map);
    EXPECT_GE(m_oursRight, m_theirsRight);
}

} // namespace
} // namespace q3rt::test
