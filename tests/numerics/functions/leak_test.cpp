// Closed meshes keep every ray inside, wherever they stand, however large they are, whatever the ray aims at.

#include <cmath>
#include <cstdlib>

#include "accel/bvh.hpp"
#include "numerics/measured.hpp"
#include "numerics/meshes.hpp"

namespace q3rt::test {
namespace {

constexpr float kPlaces[] = {0, 8000, -8000, 65536, -65536, 1e6f, -1e6f};
constexpr float kFar = 1e30f;
constexpr float kScales[] = {1e-3f, 1, 256, 1e3f};

/// Q3RT_LONG_TESTS=1: ten million rays through closed meshes.
size_t raysOfCase() { return std::getenv("Q3RT_LONG_TESTS") ? 1000000 : 20000; }

/// Half of the rays aim at corners, where five or six triangles meet, a quarter at points of edges, a quarter anywhere;
/// directions are 2^-10 to 2^10 long.
vec3 chooseDirection(const Corners& mesh, const vec3& origin, std::mt19937& random, size_t i) {
    const size_t triangle = random() % (mesh.size() / 3);
    const vec3 a = mesh[3 * triangle], b = mesh[3 * triangle + 1];
    const float share = std::uniform_real_distribution<float>(0, 1)(random);
    const float scale = std::exp2(std::uniform_real_distribution<float>(-10, 10)(random));
    if (i % 4 == 3) return randomDirection(random) * scale;
    return ((i % 4 == 2 ? a + (b - a) * share : a) - origin) * scale;
}

/// Rays from within a tenth of the radius of the centre.
size_t countLeaks(const TestScene& scene, const Corners& world, const vec3& centre, float radius, uint32_t seed) {
    std::mt19937 random(seed);
    size_t leaks = 0;
    for (size_t i = 0; i < raysOfCase(); ++i) {
        const vec3 origin = centre + randomDirection(random) * (0.1f * radius);
        const vec3 direction = chooseDirection(world, origin, random, i);
        if (direction == vec3(0)) continue;
        if (!traceShader(scene, origin, direction, 0, kFar).hit) ++leaks;
    }
    return leaks;
}

TEST(Leaks, ClosedMeshesKeepTheirRaysAtEveryPlace) {
    const Corners ball = makeBumpyBall(4, 3);
    size_t leaks = 0, cases = 0;
    for (const float at : kPlaces) {
        const vec3 centre(at, -at, at);
        const Corners mesh = place(ball, 256, centre);
        leaks += countLeaks(makeScene(mesh), mesh, centre, 256, 11);
        cases += raysOfCase();
    }
    expectCount("rays that leave a closed mesh of radius 256 at 0, +-8000, +-65536, +-1e6", leaks, cases);
}

TEST(Leaks, ClosedMeshesKeepTheirRaysAtEveryScale) {
    const Corners ball = makeBumpyBall(4, 4);
    size_t leaks = 0, cases = 0;
    for (const float scale : kScales) {
        const Corners mesh = place(ball, scale, vec3(0));
        leaks += countLeaks(makeScene(mesh), mesh, vec3(0), scale, 12);
        cases += raysOfCase();
    }
    expectCount("rays that leave a closed mesh of radius 1e-3 to 1e3", leaks, cases);
}

TEST(Leaks, InstancesKeepTheirRays) {
    const Corners ball = makeBumpyBall(4, 5);
    size_t leaks = 0, cases = 0;
    for (const float at : {0.0f, 8000.0f, -65536.0f, 1e6f})
        for (const float scale : {1e-3f, 1.0f, 1e3f}) {
            // Where the place has no digits left for the size, the mesh is a point: nothing to keep a ray in.
            if (0.1f * scale < 8 * std::abs(at) * 0x1p-24f) continue;
            const dvec3 centre(at, -at, at);
            const glm::dmat3 rotation = makeRotation(1.1);
            Corners world;
            for (const vec3& corner : ball)
                world.push_back(vec3(rotation * dvec3(corner) * double(scale) + centre));
            leaks += countLeaks(makeInstanceScene(ball, rotation, scale, centre), world, vec3(centre), scale, 13);
            cases += raysOfCase();
        }
    expectCount("rays that leave a rotated instance, scales 1e-3 to 1e3, out to 1e6", leaks, cases);
}

TEST(Leaks, SliversKeepTheirRays) {
    size_t leaks = 0, cases = 0;
    for (const int sides : {1000, 10000}) {
        const Corners tube = makeTube(sides);
        for (const float at : {0.0f, 8000.0f, 65536.0f}) {
            const vec3 centre(at);
            const Corners mesh = place(tube, 1024, centre);
            leaks += countLeaks(makeScene(mesh), mesh, centre, 512, 14);
            cases += raysOfCase();
        }
    }
    expectCount("rays that leave a tube of slivers, 160 and 1600 times longer than wide", leaks, cases);
}

/// The side that a hit names, against double precision, for all directions: seen clockwise is the front.
TEST(Leaks, HitsKnowTheirSide) {
    std::mt19937 random(16);
    size_t wrong = 0, cases = 0;
    for (int i = 0; i < 20000; ++i) {
        Corners triangle;
        for (int k = 0; k < 3; ++k)
            triangle.push_back(randomDirection(random));
        const TestScene scene = makeScene(triangle);
        const vec3 target = (triangle[0] + triangle[1] + triangle[2]) / 3.0f, origin = randomDirection(random) * 4.0f;
        const TestHit hit = traceShader(scene, origin, target - origin, 0, kFar);
        const dvec3 facing =
            glm::cross(dvec3(triangle[2]) - dvec3(triangle[0]), dvec3(triangle[1]) - dvec3(triangle[0]));
        const double side = glm::dot(facing, dvec3(target) - dvec3(origin));
        if (std::abs(side) < 1e-5) continue;
        ++cases;
        if (!hit.hit || hit.frontFace != (side < 0)) ++wrong;
    }
    expectCount("hits that take their front for their back", wrong, cases);
}

/// The mesh and, on one edge of each triangle, a triangle of two corners, one of three points of a line, one of a
/// single point; and each triangle once more.
Corners addFlatTriangles(const Corners& mesh) {
    Corners result = mesh;
    for (size_t i = 0; i < mesh.size(); i += 3) {
        const vec3 a = mesh[i], b = mesh[i + 1];
        for (const vec3& corner : {a, b, b, a, (a + b) * 0.5f, b, a, a, a, a, b, mesh[i + 2]})
            result.push_back(corner);
    }
    return result;
}

TEST(Leaks, FlatAndDoubledTrianglesTakeNothingAway) {
    const vec3 centre(300, 0, 0);
    const Corners ball = place(makeBumpyBall(3, 6), 256, centre);
    const TestScene plain = makeScene(ball), filled = makeScene(addFlatTriangles(ball));
    std::mt19937 random(15);
    size_t lost = 0, moved = 0, movedAtEdges = 0, anywhere = 0;
    for (size_t i = 0; i < raysOfCase(); ++i) {
        const vec3 origin = centre + randomDirection(random) * 20.0f;
        const vec3 direction = chooseDirection(ball, origin, random, i);
        const TestHit one = traceShader(plain, origin, direction, 0, kFar);
        const TestHit other = traceShader(filled, origin, direction, 0, kFar);
        if (!other.hit) ++lost;
        const bool differs = !(std::abs(one.t - other.t) <= 1e-6f * one.t);
        if (i % 4 == 3) ++anywhere, moved += differs;
        if (i % 4 == 2) movedAtEdges += differs;
    }
    expectCount("hits lost by zero-area and doubled triangles", lost, raysOfCase());
    expectCount("hits that they move, rays anywhere", moved, anywhere);
    // The middle of an edge is off it by its rounding: a ray that passes within that meets a triangle without a plane.
    std::printf("numerics | hits that they move, rays at the edges themselves | %zu of %zu\n", movedAtEdges,
                raysOfCase() / 4);
}

constexpr int kGrid = 8; ///< squares along a box's edge

/// A box from -1 to 1 of kGrid x kGrid squares a wall.
Corners makeGridBox() {
    Corners box;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f})
            for (int i = 0; i < kGrid * kGrid; ++i) {
                const auto point = [&](int a, int b) {
                    vec3 p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = 2.0f * static_cast<float>(a) / kGrid - 1;
                    p[(axis + 2) % 3] = 2.0f * static_cast<float>(b) / kGrid - 1;
                    return p;
                };
                const int x = i % kGrid, y = i / kGrid;
                for (const vec3& p : {point(x, y), point(x + 1, y), point(x, y + 1), point(x, y + 1), point(x + 1, y),
                                      point(x + 1, y + 1)})
                    box.push_back(p);
            }
    return box;
}

/// From the last float in front of a wall towards it, at slopes down to 2^-40: they cross a whole wall within rounding
/// of it, along its edges and over its corners, and meet it or the one at its end.
TEST(Leaks, GrazingRaysStayInside) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> within(-255, 255);
    size_t leaks = 0, cases = 0;
    for (const float at : kPlaces) {
        const vec3 centre(at, at, -at);
        const TestScene scene = makeScene(place(makeGridBox(), 256, centre));
        for (size_t i = 0; i < raysOfCase(); ++i, ++cases) {
            const int axis = static_cast<int>(i % 3);
            const float side = i % 2 == 0 ? -1.0f : 1.0f;
            vec3 origin = centre + vec3(within(random), within(random), within(random));
            origin[axis] = std::nextafter(centre[axis] + side * 256, centre[axis]);
            vec3 direction = randomDirection(random);
            direction[axis] = std::ldexp(side, -static_cast<int>(random() % 41));
            if (!traceShader(scene, origin, direction, 0, kFar).hit) ++leaks;
        }
    }
    expectCount("grazing rays, slopes down to 2^-40, that leave a box", leaks, cases);
}

/// In the plane of a wall, along a line of its grid: the wall at the end shares its edge, and is met. Not along the
/// last line: a direction's zero stands for a positive one too small to see, and leaves a box by its upper face.
TEST(Leaks, RaysAlongEdgesMeetTheWallAtTheirEnd) {
    size_t wrong = 0, cases = 0;
    for (const float at : kPlaces) {
        const vec3 centre(at, at, -at);
        const TestScene scene = makeScene(place(makeGridBox(), 256, centre));
        for (int axis = 0; axis < 3; ++axis)
            for (int line = 0; line < kGrid; ++line)
                for (const float towards : {-1.0f, 1.0f}) {
                    vec3 origin(0), direction(0);
                    origin[(axis + 1) % 3] = -256;
                    origin[(axis + 2) % 3] = 64.0f * static_cast<float>(line) - 256;
                    direction[axis] = towards;
                    const TestHit hit = traceShader(scene, centre + origin, direction, 0, kFar);
                    ++cases;
                    if (!hit.hit || std::abs(hit.t - 256) > 256 * 1e-6f + std::abs(at) * 0x1p-22f) ++wrong;
                }
    }
    expectCount("rays in a wall along its edges that miss the wall at their end", wrong, cases);
}

} // namespace
} // namespace q3rt::test
