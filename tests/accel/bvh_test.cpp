// The builders' promises, and the shader's traversal against Embree and against brute force in double precision.

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "accel/bvh_node.hpp"
#include "accel/shader_traversal.hpp"

namespace q3rt {
namespace {

using Random = std::mt19937;

float uniform(Random& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}
vec3 uniformPoint(Random& random, float extent) {
    const float x = uniform(random, -extent, extent), y = uniform(random, -extent, extent);
    return {x, y, uniform(random, -extent, extent)};
}
vec3 uniformDirection(Random& random) {
    for (;;) {
        const vec3 v = uniformPoint(random, 1.0f);
        if (glm::dot(v, v) > 0.01f && glm::dot(v, v) <= 1.0f) return glm::normalize(v);
    }
}

std::vector<vec3> randomTriangles(Random& random, size_t count, float extent, float size) {
    std::vector<vec3> positions;
    for (size_t i = 0; i < count; ++i) {
        const vec3 centre = uniformPoint(random, extent);
        for (int corner = 0; corner < 3; ++corner)
            positions.push_back(centre + uniformPoint(random, size));
    }
    return positions;
}

/// A closed box whose faces are grids of n x n quads: every edge is shared, so no ray from inside may escape.
std::vector<vec3> closedBox(int n, const vec3& centre, float halfSize) {
    std::vector<vec3> positions;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto point = [&](int a, int b) {
                        vec3 p;
                        p[axis] = static_cast<float>(side) * halfSize;
                        p[(axis + 1) % 3] = (2.0f * static_cast<float>(a) / static_cast<float>(n) - 1) * halfSize;
                        p[(axis + 2) % 3] = (2.0f * static_cast<float>(b) / static_cast<float>(n) - 1) * halfSize;
                        return p + centre;
                    };
                    for (const vec3& p : {point(i, j), point(i + 1, j), point(i, j + 1), point(i, j + 1),
                                          point(i + 1, j), point(i + 1, j + 1)})
                        positions.push_back(p);
                }
    return positions;
}

TestScene singleModelScene(const Bvh& bvh, const std::vector<vec3>& positions) {
    TestScene scene;
    scene.instances.push_back(scene.addModel(bvh, positions));
    scene.buildScene({bvh.bounds});
    return scene;
}

void expectValidTree(const Bvh& bvh, size_t itemCount) {
    std::vector<int> seen(itemCount, 0);
    for (const uint32_t index : bvh.order)
        ++seen[index];
    size_t present = 0;
    for (const int count : seen) {
        EXPECT_LE(count, 1);
        present += static_cast<size_t>(count);
    }
    EXPECT_EQ(present + bvh.rejectedCount, itemCount);
    std::vector<int> covered(bvh.order.size(), 0);
    for (const BvhNode& node : bvh.nodes)
        for (const uint32_t child : node.child)
            if (child & kBvhLeafBit)
                for (uint32_t i = 0; i < leafCount(child); ++i)
                    ++covered[leafFirst(child) + i];
    for (const int count : covered)
        EXPECT_EQ(count, 1);
    EXPECT_LE(depthOf(bvh), kBvhMaxDepth);
}

TEST(Bvh, BuildersHoldEveryItemOnce) {
    Random random(1);
    size_t cases = 0;
    for (const size_t count : {0u, 1u, 2u, 3u, 5u, 17u, 1000u}) {
        const auto boxes = triangleBounds(randomTriangles(random, count, 1000, 30));
        for (const Bvh& bvh :
             {buildSah(boxes), buildSah(boxes, {.reinsert = true}), buildMorton(boxes), buildPairing(boxes)}) {
            expectValidTree(bvh, count);
            ++cases;
        }
    }
    EXPECT_EQ(cases, 28u);
}

TEST(Bvh, EqualAndDegenerateItemsStayWithinTheDepthBound) {
    const std::vector<Bounds> same(5000, Bounds{vec3(1), vec3(2)});
    expectValidTree(buildSah(same), same.size());
    expectValidTree(buildMorton(same), same.size());
    // Geometric spacing makes plain SAH chains as long as the exponent range.
    std::vector<Bounds> chain;
    for (int i = 0; i < 250; ++i)
        chain.push_back({vec3(std::ldexp(1.0f, i / 2 - 60)), vec3(std::ldexp(1.0f, i / 2 - 60))});
    expectValidTree(buildSah(chain, {.maxLeafItems = 1}), chain.size());
}

TEST(Bvh, NonFiniteItemsAreRejectedAndCounted) {
    std::vector<vec3> positions(9, vec3(0));
    positions[1] = vec3(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    positions[3] = vec3(std::numeric_limits<float>::infinity(), 0, 0);
    const Bvh bvh = buildSah(triangleBounds(positions));
    EXPECT_EQ(bvh.rejectedCount, 2u);
    EXPECT_EQ(bvh.order.size(), 1u);
    const std::vector<Bounds> far{{vec3(0), vec3(2 * kBvhFarthest)}, {vec3(-kBvhFarthest), vec3(kBvhFarthest)}};
    EXPECT_EQ(buildMorton(far).rejectedCount, 1u);
}

TEST(Bvh, ThreadsGiveTheSameTree) {
    Random random(2);
    const auto boxes = triangleBounds(randomTriangles(random, 20000, 1000, 10));
    for (const bool reinsert : {false, true}) {
        const Bvh one = buildSah(boxes, {.threadCount = 1, .reinsert = reinsert});
        const Bvh four = buildSah(boxes, {.threadCount = 4, .reinsert = reinsert});
        EXPECT_EQ(one.order, four.order);
        EXPECT_EQ(one.nodes.size(), four.nodes.size());
    }
}

TEST(Bvh, SahIsNoWorseThanMortonAndRefitKeepsAStillTree) {
    Random random(3);
    const std::vector<vec3> positions = randomTriangles(random, 4000, 1000, 10);
    const auto boxes = triangleBounds(positions);
    Bvh sah = buildSah(boxes);
    EXPECT_LE(surfaceAreaCost(sah), surfaceAreaCost(buildMorton(boxes)));
    EXPECT_NEAR(refit(sah, leafTriangles(sah, positions)).value_or(0), 1.0f, 1e-5f);
}

TEST(Bvh, RefitHasTheBoxesOfTriangleThatMovedAndRefusesOddCorners) {
    Random random(5);
    std::vector<vec3> positions = randomTriangles(random, 500, 1000, 10);
    Bvh bvh = buildSah(triangleBounds(positions));
    for (vec3& position : positions)
        position = 2.0f * position + vec3(0, 50, 7);
    std::vector<BvhTriangle> triangles = leafTriangles(bvh, positions);
    ASSERT_TRUE(refit(bvh, triangles));
    const std::vector<Bounds> boxes = triangleBounds(positions);
    Bounds all;
    for (const Bounds& box : boxes) {
        all.add(box.mins);
        all.add(box.maxs);
    }
    EXPECT_EQ(bvh.bounds.mins, all.mins);
    EXPECT_EQ(bvh.bounds.maxs, all.maxs);
    for (const BvhNode& node : bvh.nodes)
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            const uint32_t word = node.child[slot];
            if (!(word & kBvhLeafBit) || leafCount(word) == 0) continue;
            Bounds leaf;
            for (uint32_t item = leafFirst(word); item < leafFirst(word) + leafCount(word); ++item) {
                leaf.add(boxes[bvh.order[item]].mins);
                leaf.add(boxes[bvh.order[item]].maxs);
            }
            EXPECT_EQ(childBounds(node, slot).mins, leaf.mins);
            EXPECT_EQ(childBounds(node, slot).maxs, leaf.maxs);
        }
    for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e13f}) {
        std::vector<BvhTriangle> broken = triangles;
        broken[77].corner1.z = odd;
        EXPECT_FALSE(refit(bvh, broken)) << odd;
    }
}

/// Closest hit in double precision over all triangles (Moeller-Trumbore 1997); infinity if none.
double closestInDouble(const std::vector<vec3>& positions, const vec3& origin, const vec3& direction) {
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
        if (u >= 0 && v >= 0 && u + v <= 1 && t > 0) closest = std::min(closest, t);
    }
    return closest;
}

TEST(Traversal, AgreesWithEmbreeAndDoubleDecidesDisagreements) {
    Random random(4);
    const std::vector<vec3> positions = randomTriangles(random, 3000, 500, 60);
    const TestScene scene = singleModelScene(buildSah(triangleBounds(positions)), positions);
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene reference = rtcNewScene(device);
    rtcSetSceneFlags(reference, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                sizeof(vec3), positions.size()));
    std::copy(positions.begin(), positions.end(), vertices);
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), positions.size() / 3));
    for (uint32_t i = 0; i < positions.size(); ++i)
        indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(reference, geometry);
    rtcCommitScene(reference);
    size_t cases = 0, disagreements = 0, oursCloser = 0;
    for (int i = 0; i < 100000; ++i) {
        const vec3 origin = uniformPoint(random, 700), direction = uniformDirection(random);
        const TestHit ours = traceShader(scene, origin, direction, 0, 1e6f);
        RTCRayHit ray{};
        ray.ray = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0, 1e6f, 0xffffffffu, 0, 0};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if __has_include(<embree4/rtcore.h>)
        rtcIntersect1(reference, &ray);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(reference, &context, &ray);
#endif
        const bool theirs = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        ++cases;
        // The origin is subtracted from every corner: half an ulp of the largest coordinate each, whatever t is.
        const float tolerance = 1e-5f * ray.ray.tfar + 2 * 1260 * 0x1p-24f;
        if (ours.hit == theirs && (!theirs || std::abs(ours.t - ray.ray.tfar) <= tolerance)) continue;
        ++disagreements;
        const double truth = closestInDouble(positions, origin, direction);
        const auto relativeError = [truth](bool hit, float t) -> double {
            if (std::isinf(truth)) return hit ? 1.0 : 0.0;
            return hit ? std::abs(t - truth) / truth : 1.0;
        };
        oursCloser += relativeError(ours.hit, ours.t) <= relativeError(theirs, ray.ray.tfar) ? 1 : 0;
    }
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(reference);
    rtcReleaseDevice(device);
    EXPECT_EQ(cases, 100000u);
    // Grazing hits on slivers differ by rounding; double precision decides who is closer.
    RecordProperty("disagreements", static_cast<int>(disagreements));
    EXPECT_LE(disagreements, cases / 10000);
    EXPECT_GE(2 * oursCloser, disagreements);
}

TEST(Traversal, ClosedMeshDoesNotLeakAtAnyDistance) {
    Random random(5);
    size_t cases = 0, leaks = 0;
    for (const float distance : {0.0f, 8000.0f, 65536.0f, 1e6f}) {
        const vec3 centre(distance, -distance, distance);
        const auto positions = closedBox(8, centre, 256);
        const TestScene scene = singleModelScene(buildSah(triangleBounds(positions), {.reinsert = true}), positions);
        for (int i = 0; i < 50000; ++i) {
            // Half of the rays aim exactly at grid vertices, where up to six triangles meet.
            const vec3 origin = centre + uniformPoint(random, 100);
            const vec3 target = positions[random() % positions.size()];
            const vec3 direction = i % 2 ? target - origin : uniformDirection(random);
            leaks += traceShader(scene, origin, direction, 0, 1e9f).hit ? 0 : 1;
            ++cases;
        }
    }
    EXPECT_EQ(cases, 200000u);
    EXPECT_EQ(leaks, 0u);
}

TEST(Traversal, InstancesMasksAcceptAndAnyHit) {
    const std::vector<vec3> triangle{{10, -1, -1}, {10, 1, -1}, {10, 0, 1}};
    const std::vector<TriangleLabel> transparent{{.number = 0, .flags = 0}};
    const Bvh bvh = buildSah(triangleBounds(triangle));
    TestScene scene;
    BvhInstance near = scene.addModel(bvh, triangle, transparent);
    BvhInstance far = near;
    far.modelFromWorld[0].w = 5; // world x = model x + 5
    near.customIndex = 1;
    far.customIndex = 2;
    near.mask = 1;
    far.mask = 2;
    scene.instances = {near, far};
    scene.buildScene({bvh.bounds, {bvh.bounds.mins + vec3(5, 0, 0), bvh.bounds.maxs + vec3(5, 0, 0)}});
    const vec3 eye(0), forward(1, 0, 0);
    EXPECT_EQ(traceShader(scene, eye, forward, 0, 100).customIndex, 1u);
    EXPECT_FLOAT_EQ(traceShader(scene, eye, forward, 0, 100).t, 10);
    EXPECT_EQ(traceShader(scene, eye, forward, 0, 100, 2).customIndex, 2u);
    EXPECT_FLOAT_EQ(traceShader(scene, eye, forward, 0, 100, 2).t, 15);
    EXPECT_FALSE(traceShader(scene, eye, forward, 0, 100, 4).hit);
    EXPECT_TRUE(traceShader(scene, eye, forward, 11, 100, 0xff, true).hit);
    scene.accept = [](uint32_t, uint32_t) { return false; };
    EXPECT_FALSE(traceShader(scene, eye, forward, 0, 100).hit);
}

TEST(Traversal, SubtreesWithoutTheGroupArePassedBy) {
    Random random(6);
    const std::vector<vec3> positions = randomTriangles(random, 4000, 500, 60);
    std::vector<uint8_t> groups(4000, kBvhSolidGroup);
    for (size_t i = 0; i < groups.size(); i += 100)
        groups[i] = kBvhOtherGroup;
    const Bvh mixed = buildSah(triangleBounds(positions), {.maxLeafItems = 1, .groups = groups});
    std::vector<vec3> few;
    for (size_t i = 0; i < groups.size(); i += 100)
        few.insert(few.end(), positions.begin() + 3 * i, positions.begin() + 3 * i + 3);
    const TestScene scene = singleModelScene(mixed, positions);
    const TestScene alone = singleModelScene(buildSah(triangleBounds(few), {.maxLeafItems = 1}), few);
    size_t hits = 0, visits = 0, solidVisits = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin = uniformPoint(random, 700), direction = uniformDirection(random);
        const TestHit found = traceShader(scene, origin, direction, 0, 1e6f, 0xff, false, kBvhOtherGroup);
        const TestHit expected = traceShader(alone, origin, direction, 0, 1e6f);
        ASSERT_EQ(found.hit, expected.hit);
        ASSERT_EQ(found.t, expected.t);
        ASSERT_TRUE(!found.hit || found.triangle == 100 * expected.triangle);
        hits += found.hit ? 1 : 0;
        visits += found.visitCount;
        solidVisits += traceShader(scene, origin, direction, 0, 1e6f).visitCount;
    }
    EXPECT_GT(hits, 100u);
    EXPECT_LT(visits, 2 * solidVisits / 3);
}

TEST(Traversal, NeverVisitsANodeTwice) {
    Random random(7);
    // All boxes overlap, all triangles are missed by a hair or not finite, and instances are singular, huge or flat.
    std::vector<vec3> positions;
    for (int i = 0; i < 3000; ++i)
        for (const vec3& corner : {vec3(-100, -100, 0), vec3(100, -100, 0), vec3(0, 100, 0)})
            positions.push_back(corner + vec3(0, 0, static_cast<float>(i % 3) * 1e-3f));
    for (int i = 0; i < 300; ++i)
        positions[static_cast<size_t>(random() % positions.size())] = vec3(i % 2 ? 0.0f : NAN, INFINITY, 0);
    TestScene scene = singleModelScene(buildSah(triangleBounds(positions)), positions);
    const BvhInstance upright = scene.instances[0];
    std::vector<Bounds> bounds{{vec3(-200), vec3(200)}};
    for (const float scale : {0.0f, 1e-30f, 1e18f, -1.0f}) {
        BvhInstance odd = upright;
        odd.modelFromWorld[2] *= scale;
        scene.instances.push_back(odd);
        bounds.push_back(bounds[0]);
    }
    scene.buildScene(bounds);
    uint64_t most = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 origin = uniformPoint(random, 150);
        vec3 direction = i % 5 == 0 ? vec3(0) : uniformDirection(random);
        if (i % 7 == 0) direction[i % 3] = 0;
        if (i % 11 == 0) direction[i % 3] = i % 2 ? INFINITY : NAN;
        most = std::max(most, traceShader(scene, origin, direction, 0, 1e30f).visitCount);
    }
    EXPECT_GT(most, 1000u) << "the scene is meant to be bad";
    EXPECT_LE(most, scene.mostVisits());
}

TEST(Traversal, TreesInPlaceAreMetAsTurnedOnes) {
    Random random(9);
    std::vector<vec3> positions;
    for (int i = 0; i < 300; ++i)
        positions.push_back(uniformPoint(random, 100));
    const Bvh bvh = buildSah(triangleBounds(positions));
    TestScene turned = singleModelScene(bvh, positions), inPlace = turned;
    // A second one, elsewhere and turned, before and behind: rays come back from it to the first one's space.
    BvhInstance other = turned.instances[0];
    other.modelFromWorld[0] = {0, 1, 0, 50};
    other.modelFromWorld[1] = {-1, 0, 0, -30};
    other.customIndex = 1;
    for (TestScene* scene : {&turned, &inPlace}) {
        scene->instances.push_back(other);
        scene->buildScene({bvh.bounds, {vec3(-200), vec3(200)}});
    }
    inPlace.instances[0].mask |= kBvhInPlace;
    int hits[2] = {};
    for (int i = 0; i < 3000; ++i) {
        const vec3 origin = uniformPoint(random, 150), direction = uniformDirection(random);
        const TestHit a = traceShader(turned, origin, direction, 0, 1e4f);
        const TestHit b = traceShader(inPlace, origin, direction, 0, 1e4f);
        ASSERT_EQ(a.hit, b.hit);
        ASSERT_EQ(a.t, b.t);
        ASSERT_EQ(a.triangle, b.triangle);
        ASSERT_EQ(a.customIndex, b.customIndex);
        if (a.hit) ++hits[a.customIndex];
    }
    EXPECT_GT(hits[0], 100);
    EXPECT_GT(hits[1], 100);
}

TEST(Traversal, TrianglesWithoutAreaOrNumbersHideNothing) {
    std::vector<vec3> positions;
    for (int i = 0; i < 200; ++i) {
        // Points, lines across and along the rays, and what is no place, all in front of the last one.
        const vec3 p(static_cast<float>(i % 7), 0, 0);
        const vec3 end = i % 4 == 1 ? vec3(0, 5, 0) : i % 4 == 2 ? vec3(5, 0, 0) : vec3(0);
        positions.insert(positions.end(), {p, p + end, i % 4 == 3 ? vec3(NAN, 0, INFINITY) : p});
    }
    positions.insert(positions.end(), {vec3(20, -9, -9), vec3(20, 9, -9), vec3(20, 0, 9)});
    for (const Bvh& bvh : {buildSah(triangleBounds(positions)), buildMorton(triangleBounds(positions))}) {
        EXPECT_EQ(bvh.rejectedCount, 50u);
        const TestHit hit = traceShader(singleModelScene(bvh, positions), vec3(-1, 0, 0), {1, 0, 0}, 0, 100);
        EXPECT_TRUE(hit.hit);
        EXPECT_EQ(hit.triangle, 200u);
        EXPECT_FLOAT_EQ(hit.t, 21);
    }
}

TEST(Traversal, FiveThousandInstancesAndEmptyScenes) {
    const std::vector<vec3> triangle{{0, -1, -1}, {0, 1, -1}, {0, 0, 1}};
    const Bvh bvh = buildSah(triangleBounds(triangle));
    TestScene scene;
    std::vector<Bounds> bounds;
    const BvhInstance model = scene.addModel(bvh, triangle);
    for (int i = 0; i < 5000; ++i) {
        BvhInstance instance = model;
        instance.customIndex = static_cast<uint32_t>(i);
        instance.modelFromWorld[0].w = static_cast<float>(i + 1);
        scene.instances.push_back(instance);
        const vec3 offset(static_cast<float>(i + 1), 0, 0);
        bounds.push_back({bvh.bounds.mins + offset, bvh.bounds.maxs + offset});
    }
    scene.buildScene(bounds);
    EXPECT_EQ(traceShader(scene, vec3(0), {1, 0, 0}, 0, 1e4f).customIndex, 0u);
    EXPECT_EQ(traceShader(scene, vec3(6000, 0, 0), {-1, 0, 0}, 0, 1e4f).customIndex, 4999u);
    TestScene empty;
    empty.buildScene({});
    EXPECT_FALSE(traceShader(empty, vec3(0), {1, 0, 0}, 0, 1e4f).hit);
}

} // namespace
} // namespace q3rt
