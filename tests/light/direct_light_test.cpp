// Form factors against numeric integration, and the extracted lights against what the maps were baked with.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/luxels.hpp"
#include "support/game_data.hpp"

namespace q3rt {
namespace {

float uniform(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

/// The same quantity by its definition, the midpoint rule over n x n cells of the triangle's parameter square.
double integratedFormFactor(const vec3& point, const vec3& normal, const vec3 corner[3], int n) {
    const dvec3 edge1 = dvec3(corner[1]) - dvec3(corner[0]), edge2 = dvec3(corner[2]) - dvec3(corner[0]);
    const dvec3 cross = glm::cross(edge1, edge2), lightNormal = glm::normalize(cross);
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) / n, v = (j + 0.5) / n * (1 - u);
            const dvec3 to = dvec3(corner[0]) + u * edge1 + v * edge2 - dvec3(point);
            const double squared = glm::dot(to, to), cosine = glm::dot(to, dvec3(normal));
            if (cosine > 0)
                sum += cosine * std::abs(glm::dot(to, lightNormal)) / (squared * squared) * glm::length(cross) *
                       (1 - u) / (n * n);
        }
    return sum / std::numbers::pi;
}

TEST(FormFactor, AgreesWithIntegrationAlsoAcrossTheHorizon) {
    std::mt19937 random(11);
    int cases = 0;
    for (int i = 0; i < 50; ++i) {
        vec3 corner[3];
        for (vec3& c : corner)
            c = {uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -0.5f, 2)};
        const vec3 point(uniform(random, -1, 1), uniform(random, -1, 1), -1), normal(0, 0, 1);
        EXPECT_NEAR(triangleFormFactor(point, normal, corner), integratedFormFactor(point, normal, corner, 400), 2e-3);
        ++cases;
    }
    EXPECT_EQ(cases, 50);
}

TEST(FormFactor, HalfSpaceAndDegenerateTriangles) {
    const vec3 huge[3] = {{-1e6f, -1e6f, 1}, {3e6f, -1e6f, 1}, {-1e6f, 3e6f, 1}};
    EXPECT_NEAR(triangleFormFactor(vec3(0), {0, 0, 1}, huge), 1.0, 1e-5);
    EXPECT_EQ(triangleFormFactor(vec3(0), {0, 0, -1}, huge), 0.0);
    const vec3 point[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    EXPECT_EQ(triangleFormFactor(vec3(0), {0, 0, 1}, point), 0.0);
}

TEST(SpotShare, FadesInsideItsCircle) {
    const vec3 axis(0, 0, -1);
    const auto at = [&](float away) { return spotShare(vec3(away, 0, -200), axis, 0.5f); }; // circle of 100 qu
    EXPECT_EQ(at(0), 1);
    EXPECT_EQ(at(100 - kSpotBorderQu), 1);
    EXPECT_NEAR(at(100 - 0.25f * kSpotBorderQu), 0.25f, 1e-5f);
    EXPECT_EQ(at(100), 0);
    EXPECT_EQ(spotShare(vec3(0, 0, 200), axis, 0.5f), 0);
}

TEST(Luxels, FacesWithoutNormalsHaveTheirSides) {
    World world;
    world.vertices.resize(3);
    world.vertices[1].position = vec3(0, 5, 0); // clockwise as seen from above
    world.vertices[2].position = vec3(5, 0, 0);
    world.indices = {0, 1, 2};
    const vec3 weight(0.25f, 0.5f, 0.25f);
    EXPECT_EQ(normalAt(world, 0, weight), vec3(0, 0, 1));
    for (Vertex& vertex : world.vertices)
        vertex.normal = vec3(0, 1, 0);
    EXPECT_EQ(normalAt(world, 0, weight), vec3(0, 1, 0));
    world.vertices[2] = world.vertices[1];
    for (Vertex& vertex : world.vertices)
        vertex.normal = vec3(0);
    EXPECT_EQ(normalAt(world, 0, weight), vec3(0)) << "no area";
}

/// Crates and barrels of this map have no lightmap.
TEST(Luxels, FacesLitAtTheirVerticesCountWhereAsked) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    TextureLibrary textures(*files, {});
    MaterialLibrary materials(*files, textures, {});
    const auto world = loadWorld(*files, "maps/am_lavactfxl.bsp", materials, {});
    const auto countUnmapped = [&](LuxelFaces faces) {
        int count = 0;
        for (const Luxel& luxel : sampleLuxels(*world, materials, faces, 4000, 1)) {
            const BspSurface& surface = world->bsp.surfaces[static_cast<size_t>(luxel.surface)];
            if (surface.lightmap >= 0) continue;
            ++count;
            vec3 least(255), most(0);
            for (int i = 0; i < surface.vertexCount; ++i) {
                const U8vec4& color = world->bsp.vertices[static_cast<size_t>(surface.firstVertex + i)].color;
                least = glm::min(least, vec3(color.x, color.y, color.z));
                most = glm::max(most, vec3(color.x, color.y, color.z));
            }
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(luxel.baked[c], least[c] - 1e-3f);
                EXPECT_LE(luxel.baked[c], most[c] + 1e-3f);
            }
        }
        return count;
    };
    EXPECT_EQ(countUnmapped(LuxelFaces::Lightmapped), 0);
    EXPECT_GT(countUnmapped(LuxelFaces::AllBaked), 40);
    EXPECT_GT(luxelAreaQu2(*world, materials, LuxelFaces::AllBaked),
              luxelAreaQu2(*world, materials, LuxelFaces::Lightmapped));
}

/// Maps whose bake is known to be lit by what their scripts still say: the light model's units are right there.
TEST(Luxels, ExtractedLightsAgreeWithTheBake) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    struct Case {
        const char* map;
        double leastCorrelation;
    };
    for (const Case& c : {Case{"maps/ps9ctf.bsp", 0.55}, Case{"maps/oa_shouse.bsp", 0.7}}) {
        TextureLibrary textures(*files, {});
        MaterialLibrary materials(*files, textures, {});
        const auto world = loadWorld(*files, c.map, materials, {});
        const LightSet lights = extractLights(*world, materials);
        const LuxelReport report = checkLuxels(*world, materials, lights, 1000, 1);
        std::printf("%s: %zu lights, traced %.1f (surfaces %.1f, sun %.1f, sky %.1f, points %.1f), baked %.1f, "
                    "correlation %.2f, "
                    "slope %.2f, explained %.0f %%, median ratio %.2f\n",
                    c.map, lights.triangles.size(), report.meanTraced, report.meanSurfaces, report.meanSun,
                    report.meanSky, report.meanPoints, report.meanBaked, report.correlation, report.slope,
                    100 * report.explainedShare, report.medianRatio);
        EXPECT_GE(report.correlation, c.leastCorrelation) << c.map;
    }
}

} // namespace
} // namespace q3rt
