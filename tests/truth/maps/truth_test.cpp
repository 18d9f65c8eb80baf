// The ray tracer's converged pictures against the tracer in double precision: relMSE at most 1e-3 on each camera, the
// pictures' own noise included.
// What is compared is the light: a pixel's own albedo is taken from the plain picture (rt_illumination 0), so that only
// surfaces count whose whole look is albedo x light.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <thread>

#include "metrics/image_metrics.hpp"
#include "scene/light_animation.hpp"
#include "support/game_data.hpp"
#include "truth/double_tracer.hpp"
#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr double kRelativeMse = 1e-3;
constexpr int kSeeds = 4;
constexpr double kLeastAlbedo = 1.0 / 255.0; ///< darker pixels say nothing about light
/// Part of a picture that must be comparable.
constexpr double kLeastShare = 0.25;

struct TruthCase {
    const char* map;
    Camera camera;
    int frames; ///< for each seed
};

/// The map, for the tracer in double precision.
struct LoadedMap {
    TextureLibrary textures;
    MaterialLibrary materials;
    std::unique_ptr<World> world;
    LightSet lights;
    LoadedMap(FileSource& files, const std::string& name)
        : textures(files, {})
        , materials(files, textures, {})
        , world(q3rt::loadWorld(files, "maps/" + name + ".bsp", materials, {})) {
        deformWorld(*world, materials);
        lights = extractLights(*world, materials);
        LightAnimation animation(materials, textures);
        for (TriangleLight& light : lights.triangles) {
            const uint32_t number = animation.find(world->surfaces[static_cast<size_t>(light.surface)].material);
            if (number > 0) light.radiance *= animation.evaluate(0)[number - 1];
        }
    }
};

/// Is the surface's look its albedo times the light, and nothing more? The first stage is lit, later ones only multiply
/// what is there.
bool isPlainlyLit(const WorldSurface& surface, const Material& material) {
    if (surface.fog > 0 || !material.deforms.empty() || material.stages.empty()) return false;
    const Stage& first = material.stages[0];
    const bool lit = first.bakedLight == BakedLight::Lightmap || first.bakedLight == BakedLight::VertexColor;
    if (first.blended || first.alphaTest != AlphaTest::None || first.combine == Combine::Add || !lit) return false;
    return std::all_of(material.stages.begin() + 1, material.stages.end(), [](const Stage& stage) {
        const bool multiplies = stage.source == BlendFactor::Zero || stage.source == BlendFactor::DstColor;
        const bool linear =
            stage.destination != BlendFactor::DstColor && stage.destination != BlendFactor::OneMinusDstColor;
        return stage.blended && multiplies && linear && stage.bakedLight == BakedLight::None;
    });
}

struct Truth {
    std::vector<dvec3> light; ///< 1.0 = irradiance 63.75
    std::vector<char> known;
};

Truth traceTruth(const LoadedMap& map, const Camera& camera, int width, int height) {
    const DoubleTracer tracer(*map.world, map.materials, map.lights);
    Truth truth{std::vector<dvec3>(static_cast<size_t>(width * height), dvec3(0)),
                std::vector<char>(static_cast<size_t>(width * height), 0)};
    const auto traceRow = [&](int y) {
        for (int x = 0; x < width; ++x) {
            const auto p = static_cast<size_t>(y * width + x);
            std::mt19937 random(static_cast<unsigned>(p));
            const auto hit = tracer.look(dvec3(camera.eye), rayDirection(camera, width, height, x + 0.5, y + 0.5));
            if (!hit) continue;
            const WorldSurface& surface = tracer.surfaceOf(*hit);
            if (!isPlainlyLit(surface, map.materials.drawn(surface.material))) continue;
            truth.known[p] = 1;
            truth.light[p] = tracer.irradiance(*hit, random) / 63.75;
        }
    };
    const int threadCount = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> threads;
    for (int t = 0; t < threadCount; ++t)
        threads.emplace_back([&, t] {
            for (int y = t; y < height; y += threadCount)
                traceRow(y);
        });
    for (std::thread& thread : threads)
        thread.join();
    return truth;
}

/// Width of the pictures; Q3RT_TRUTH_WIDTH=160 for the figure of the specification. The shape is 4:3.
int pictureWidth() {
    const char* text = std::getenv("Q3RT_TRUTH_WIDTH");
    const int width = text ? std::atoi(text) : 0;
    return width >= 8 ? width / 4 * 4 : 48;
}

struct Pictures {
    MeasuredPicture lit;
    FloatImage plain;
};

Pictures drawPictures(FileSource& files, const TruthCase& truthCase, int width, int height) {
    TraceHarness harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", width, height);
    prepareHarness(harness, truthCase.map, {{"rt_numRandomDL", "16"}});
    Pictures pictures;
    pictures.lit = measurePicture(harness, truthCase.camera, kSeeds, truthCase.frames);
    harness.set("rt_illumination", "0");
    pictures.plain = harness.radiance(truthCase.camera, 1);
    return pictures;
}

struct Comparison {
    size_t known = 0;
    double relativeMse = 0, noise = 0; ///< of the whole difference; what the picture's own noise explains of it
    double meanTruth = 0, meanPicture = 0;
    std::vector<std::pair<double, size_t>> worst; ///< share of the relMSE, pixel
};

Comparison compare(const Pictures& pictures, const Truth& truth) {
    Comparison result;
    MetricImage reference, test;
    std::vector<size_t> pixels;
    for (size_t p = 0; p < truth.light.size(); ++p) {
        const dvec3 albedo(pictures.plain.rgb[3 * p], pictures.plain.rgb[3 * p + 1], pictures.plain.rgb[3 * p + 2]);
        if (!truth.known[p] || std::max({albedo.r, albedo.g, albedo.b}) < kLeastAlbedo) continue;
        const dvec3 expected = albedo * truth.light[p], got = pictures.lit.mean[p];
        double share = 0;
        for (int c = 0; c < 3; ++c) {
            reference.rgb.push_back(expected[c]);
            test.rgb.push_back(got[c]);
            const double scale = expected[c] * expected[c] + kRelativeMseEpsilon;
            result.noise += pictures.lit.variance[p][c] / scale;
            share += (got[c] - expected[c]) * (got[c] - expected[c]) / scale;
        }
        result.worst.emplace_back(share, p);
        result.meanTruth += (expected.r + expected.g + expected.b) / 3;
        result.meanPicture += (got.r + got.g + got.b) / 3;
        ++result.known;
    }
    reference.width = test.width = static_cast<int>(result.known);
    reference.height = test.height = 1;
    result.relativeMse = computeRelativeMse(reference, test);
    result.noise /= 3.0 * static_cast<double>(result.known);
    result.meanTruth /= static_cast<double>(result.known);
    result.meanPicture /= static_cast<double>(result.known);
    std::sort(result.worst.rbegin(), result.worst.rend());
    return result;
}

void checkTruth(FileSource& files, const TruthCase& truthCase) {
    const int width = pictureWidth(), height = width * 3 / 4;
    const Pictures pictures = drawPictures(files, truthCase, width, height);
    const LoadedMap map(files, truthCase.map);
    const Truth truth = traceTruth(map, truthCase.camera, width, height);
    const Comparison got = compare(pictures, truth);
    const vec3& eye = truthCase.camera.eye;
    std::printf("%s from %.0f %.0f %.0f: %zu of %d pixels, %zu triangle lights, %zu suns, %zu skies, %zu points; mean "
                "%.4f (double %.4f), relMSE %.2e, of it noise %.2e\n",
                truthCase.map, double(eye.x), double(eye.y), double(eye.z), got.known, width * height,
                map.lights.triangles.size(), map.lights.suns.size(), map.lights.skies.size(), map.lights.points.size(),
                got.meanPicture, got.meanTruth, got.relativeMse, got.noise);
    for (size_t i = 0; i < std::min<size_t>(5, got.worst.size()); ++i) {
        const size_t p = got.worst[i].second;
        std::printf("  pixel %zu %zu: share %.1e, light %.4f %.4f %.4f, picture %.4f %.4f %.4f\n",
                    p % static_cast<size_t>(width), p / static_cast<size_t>(width),
                    got.worst[i].first / (3.0 * static_cast<double>(got.known)), truth.light[p].r, truth.light[p].g,
                    truth.light[p].b, pictures.lit.mean[p].r / std::max(1e-9, double(pictures.plain.rgb[3 * p])),
                    pictures.lit.mean[p].g / std::max(1e-9, double(pictures.plain.rgb[3 * p + 1])),
                    pictures.lit.mean[p].b / std::max(1e-9, double(pictures.plain.rgb[3 * p + 2])));
    }
    EXPECT_GT(double(got.known), kLeastShare * width * height);
    EXPECT_GT(got.meanTruth, 0.01) << "a dark picture proves nothing";
    EXPECT_LE(got.relativeMse, kRelativeMse);
}

TEST(Truth, OfTheTestRooms) {
    TestGame game;
    for (const TruthCase& truthCase :
         {TruthCase{squareLightRoom::kName, {.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40}, 4},
          {squareLightRoom::kName, {.eye = {100, 200, 40}, .pitch = -10, .yaw = 260}, 4},
          {threeClusterCorridor::kName, {.eye = {20, 20, 100}, .yaw = 35}, 8},
          {threeClusterCorridor::kName, {.eye = {480, 130, 100}, .yaw = 90}, 8}})
        checkTruth(game, truthCase);
}

class MapTruth : public testing::TestWithParam<TruthCase> {};

TEST_P(MapTruth, AgreesWithThePicture) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    checkTruth(*files, GetParam());
}
INSTANTIATE_TEST_SUITE_P(
    OpenArena, MapTruth,
    testing::Values(TruthCase{"fan", {.eye = {-736, 0, 122}, .pitch = -5, .yaw = 0}, 8},
                    TruthCase{"fan", {.eye = {0, -736, 122}, .pitch = 5, .yaw = 60}, 8},
                    TruthCase{"oa_dm1", {.eye = {104, 1392, 50}, .pitch = 5, .yaw = 270}, 8},
                    TruthCase{"oa_dm1", {.eye = {108.3f, 1380.7f, 49.3f}, .pitch = -6, .yaw = 285}, 8},
                    TruthCase{"oa_dm1", {.eye = {-205, 1394, -98}, .pitch = 5, .yaw = 90}, 8},
                    TruthCase{"oa_shouse", {.eye = {-416, 448, 682}, .pitch = 5, .yaw = 0}, 24},
                    TruthCase{"oa_shouse", {.eye = {0, 512, 362}, .pitch = 5, .yaw = 270}, 24},
                    TruthCase{"oacmpctf3", {.eye = {-2908.3f, -349.1f, 60.7f}, .pitch = 2.3f, .yaw = 3.1f}, 48},
                    TruthCase{"oacmpctf3", {.eye = {-3003.7f, 765.3f, 60.7f}, .pitch = 2.3f, .yaw = 290.9f}, 48}),
    [](const auto& info) { return std::string(info.param.map) + "_" + std::to_string(info.index); });

} // namespace
} // namespace q3rt::test
