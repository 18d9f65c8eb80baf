#include "numerics/meshes.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include "accel/bvh.hpp"

namespace q3rt::test {
namespace {

struct Order {
    bool operator()(const dvec3& a, const dvec3& b) const { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
};

std::vector<dvec3> makeIcosahedron() {
    const double g = 0.5 * (1 + std::sqrt(5.0));
    const dvec3 p[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    constexpr int kFaces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    std::vector<dvec3> corners;
    for (const auto& face : kFaces)
        for (const int i : face)
            corners.push_back(glm::normalize(p[i]));
    return corners;
}

} // namespace

Corners makeBumpyBall(int levels, uint32_t seed) {
    std::vector<dvec3> corners = makeIcosahedron();
    for (int level = 0; level < levels; ++level) {
        std::vector<dvec3> finer;
        for (size_t i = 0; i < corners.size(); i += 3) {
            const dvec3 a = corners[i], b = corners[i + 1], c = corners[i + 2];
            // The sum of two corners does not depend on their order: both neighbours make the same middle.
            const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            for (const dvec3& corner : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
                finer.push_back(corner);
        }
        corners = std::move(finer);
    }
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> radius(0.8, 1.2);
    std::map<dvec3, vec3, Order> placed;
    Corners result;
    for (const dvec3& corner : corners) {
        const auto [entry, isNew] = placed.try_emplace(corner);
        if (isNew) entry->second = vec3(corner * radius(random));
        result.push_back(entry->second);
    }
    return result;
}

Corners makeTube(int sides) {
    Corners result;
    const auto rim = [sides](int i, float x) {
        const double angle = 2 * M_PI * (i % sides) / sides;
        return vec3(x, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
    };
    for (int i = 0; i < sides; ++i) {
        const vec3 a = rim(i, -0.5f), b = rim(i + 1, -0.5f), c = rim(i, 0.5f), d = rim(i + 1, 0.5f);
        for (const vec3& corner : {a, b, c, c, b, d, vec3(-0.5f, 0, 0), b, a, vec3(0.5f, 0, 0), c, d})
            result.push_back(corner);
    }
    return result;
}

Corners place(const Corners& mesh, float scale, const vec3& centre) {
    Corners result;
    for (const vec3& corner : mesh)
        result.push_back(corner * scale + centre);
    return result;
}

TestScene makeScene(const Corners& mesh) {
    const Bvh bvh = buildSah(triangleBounds(mesh));
    TestScene scene;
    scene.instances.push_back(scene.addModel(bvh, mesh));
    scene.buildScene({bvh.bounds});
    return scene;
}

glm::dmat3 makeRotation(double angleRadians) {
    const dvec3 axis = glm::normalize(dvec3(1, -2, 0.7));
    const double s = std::sin(angleRadians), c = std::cos(angleRadians);
    const auto column = [&](const dvec3& v) {
        return v * c + glm::cross(axis, v) * s + axis * glm::dot(axis, v) * (1 - c);
    };
    return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
}

TestScene makeInstanceScene(const Corners& mesh, const glm::dmat3& rotation, double scale, const dvec3& centre) {
    const Bvh bvh = buildSah(triangleBounds(mesh));
    TestScene scene;
    BvhInstance instance = scene.addModel(bvh, mesh);
    // The inverse of a rotation is its transpose.
    const glm::dmat3 modelFromWorld = glm::transpose(rotation) * (1 / scale);
    for (int row = 0; row < 3; ++row)
        instance.modelFromWorld[row] =
            vec4(modelFromWorld[0][row], modelFromWorld[1][row], modelFromWorld[2][row], centre[row]);
    scene.instances.push_back(instance);
    const double reach = 1.3 * scale * static_cast<double>(glm::length(bvh.bounds.maxs - bvh.bounds.mins));
    scene.buildScene({{vec3(centre - reach), vec3(centre + reach)}});
    return scene;
}

vec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<float> gauss;
    for (;;) {
        const vec3 v(gauss(random), gauss(random), gauss(random));
        if (glm::dot(v, v) > 0.01f) return glm::normalize(v);
    }
}

} // namespace q3rt::test
