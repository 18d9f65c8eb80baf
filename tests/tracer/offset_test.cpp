// Rays that leave a surface never meet it again, near the origin and far from it, and start no farther off than the
// bound.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "shader_text.hpp"
#include "shaders/shared/bvh.h"

namespace q3rt::shader {
#include "lib/intersect.glsl"
}

namespace q3rt {
namespace {

struct Case {
    vec3 corner[3];
    vec2 barycentric;
};

Case makeCase(std::mt19937& generator, float distance) {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f), symmetric(-1.0f, 1.0f);
    std::uniform_real_distribution<float> exponent(0.0f, 10.0f);
    const float size = std::exp2(exponent(generator)); // 1 to 1,024 qu
    const vec3 base = vec3(symmetric(generator), symmetric(generator), symmetric(generator)) * 512.0f +
                      vec3(distance, -distance, distance);
    Case c{};
    for (vec3& corner : c.corner)
        corner = base + vec3(symmetric(generator), symmetric(generator), symmetric(generator)) * size;
    c.barycentric = {unit(generator), unit(generator) * 0.999f};
    if (c.barycentric.x + c.barycentric.y > 1.0f) c.barycentric = 1.0f - c.barycentric;
    return c;
}

/// How many of `count` random rays off random triangles meet their own triangle again.
int countSelfHits(float distance, int count, bool instanced) {
    std::mt19937 generator(static_cast<unsigned>(distance) + (instanced ? 1u : 0u));
    std::normal_distribution<float> gauss;
    int hits = 0;
    for (int i = 0; i < count; ++i) {
        const Case c = makeCase(generator, instanced ? 0.0f : distance);
        shader::HitPoint point = shader::makeHitPoint(c.corner[0], c.corner[1], c.corner[2], c.barycentric);
        vec3 corner[3] = {c.corner[0], c.corner[1], c.corner[2]};
        const vec3 shift(distance, -distance, distance);
        if (instanced)
            point = shader::transformHitPoint(vec4(1, 0, 0, shift.x), vec4(0, 1, 0, shift.y), vec4(0, 0, 1, shift.z),
                                              point, 0.0f);
        const vec3 cross = glm::cross(corner[2] - corner[0], corner[1] - corner[0]);
        if (glm::length(cross) == 0.0f) continue;
        const vec3 normal = glm::normalize(cross);
        vec3 origin = shader::offsetOrigin(point.position, point.error, normal);
        if (instanced) origin -= shift; // what the intersector does to the ray
        vec3 direction(gauss(generator), gauss(generator), gauss(generator));
        if (dot(direction, normal) < 0) direction = -direction;
        const shader::TriangleRay ray = shader::makeTriangleRay(origin, direction, shader::slabReciprocal(direction));
        for (vec3& c : corner)
            c = shader::componentsOf(c, ray.axes);
        hits += shader::intersectTriangle(ray, corner[0], corner[1], corner[2], 0.0f, 1e30f).hit ? 1 : 0;
    }
    return hits;
}

TEST(Offset, RaysNeverMeetTheirOwnTriangle) {
    constexpr int kCount = 200000;
    for (const float distance : {0.0f, 8000.0f, 65536.0f}) {
        EXPECT_EQ(countSelfHits(distance, kCount, false), 0) << "at " << distance;
        EXPECT_EQ(countSelfHits(distance, kCount, true), 0) << "instanced at " << distance;
    }
}

TEST(Offset, StaysWithinTheBound) {
    std::mt19937 generator(9);
    double largest = 0;
    for (int i = 0; i < 100000; ++i) {
        const Case c = makeCase(generator, 0.0f);
        const shader::HitPoint p = shader::makeHitPoint(c.corner[0], c.corner[1], c.corner[2], c.barycentric);
        const vec3 normal = glm::normalize(vec3(1, -2, 3));
        const vec3 moved = shader::offsetOrigin(p.position, p.error, normal);
        const double allowed = shader::clearance(normal, p.error) + 6 * kUnitRoundoff * glm::length(p.position);
        ASSERT_LE(glm::length(moved - p.position), allowed * 1.01);
        largest = std::max(largest, static_cast<double>(glm::length(moved - p.position)));
    }
    EXPECT_LT(largest, 0.01) << "qu, for coordinates up to 1,536";
}

TEST(Offset, PositionErrorBoundHoldsAgainstDouble) {
    std::mt19937 generator(13);
    int checked = 0;
    for (const float distance : {0.0f, 8000.0f, 65536.0f})
        for (int i = 0; i < 100000; ++i, ++checked) {
            const Case c = makeCase(generator, distance);
            const shader::HitPoint p = shader::makeHitPoint(c.corner[0], c.corner[1], c.corner[2], c.barycentric);
            const glm::dvec3 a(c.corner[0]), b(c.corner[1]), d(c.corner[2]);
            const glm::dvec3 exact =
                a + (b - a) * static_cast<double>(c.barycentric.x) + (d - a) * static_cast<double>(c.barycentric.y);
            for (int k = 0; k < 3; ++k)
                ASSERT_LE(std::abs(exact[k] - static_cast<double>(p.position[k])), static_cast<double>(p.error[k]));
        }
    EXPECT_EQ(checked, 300000);
}

} // namespace
} // namespace q3rt
