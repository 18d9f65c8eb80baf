// Light at its extremes in the whole renderer: far from the origin, faint and strong, from all sides, from none, from
// 20,000 lights.

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "numerics/measured.hpp"
#include "numerics/renderer/rooms.hpp"

namespace q3rt::test {
namespace {

/// Largest relative difference of two pictures of the room at pixels inside one wall.
double largestDifference(const FloatImage& first, const FloatImage& second, double scale = 1) {
    double worst = 0;
    for (int y = 0; y < kRoomHeight; ++y)
        for (int x = 0; x < kRoomWidth; ++x) {
            if (!isInsideOneWall(kRoomCamera, kRoomWidth, kRoomHeight, x, y)) continue;
            const auto p = static_cast<size_t>(3 * (y * kRoomWidth + x));
            const double a = double(first.rgb[p]) * scale, b = second.rgb[p];
            if (a <= 0 && b <= 0) continue;
            const double difference = std::abs(a - b) / std::max(a, b);
            worst = difference <= worst ? worst : difference; // NaN must not hide
        }
    return worst;
}

TEST(Rooms, MovedFarShowTheSamePicture) {
    TestGame game;
    constexpr int kDistances[] = {8000, -8000, 65536, -65536, 1000000};
    for (const int distance : kDistances)
        addMap(game, "moved" + std::to_string(distance), movedRoom(ivec3(distance, -distance, distance)));
    for (const char* backend : {"compute", "query", "pipeline"}) {
        RoomRenderer renderer(game, backend);
        // The first frame after a map's load has the same random numbers.
        const FloatImage atRest = renderer.draw(squareLightRoom::kName, kRoomCamera, 1);
        for (const int distance : kDistances) {
            Camera camera = kRoomCamera;
            camera.eye += vec3(distance, -distance, distance);
            const FloatImage moved = renderer.draw("moved" + std::to_string(distance), camera, 1);
            // Points are known to a few steps of the place (2^-23 of it); the light is 190 qu away or more, and its
            // irradiance changes by less than 6 times the share of that way.
            const double bound = 6 * 4 * std::abs(distance) * 0x1p-23 / 190 + 1e-5;
            expectWithin(std::string("light of a room moved to ") + std::to_string(distance) + ", " + backend,
                         largestDifference(atRest, moved), bound, "relative");
        }
    }
}

constexpr float kStrengths[] = {1e-6f, 1e-3f, 1.0f, 1e6f};

/// By its power of ten: a point in a name would begin an extension.
std::string nameOfStrength(float strength) { return formatText("strength%ld", std::lround(std::log10(strength))); }

/// Rooms whose light has each of the strengths.
void addRooms(TestGame& game) {
    for (const float strength : kStrengths) {
        const std::string name = nameOfStrength(strength), shader = "textures/extremes/" + name;
        addLightShader(game, shader, strength);
        BoxMap map = describeSquareLightRoom();
        map.panels[0].shader = shader;
        map.panels[0].surfaceLight = strength;
        addMap(game, name, map);
    }
}

TEST(Rooms, LightIsLinearFromFaintToStrong) {
    TestGame game;
    addRooms(game);
    RoomRenderer renderer(game);
    const FloatImage reference = renderer.draw(squareLightRoom::kName, kRoomCamera, 1);
    for (const float strength : kStrengths) {
        const FloatImage picture = renderer.draw(nameOfStrength(strength), kRoomCamera, 1);
        EXPECT_TRUE(isFinite(picture));
        const double scale = double(strength) / double(squareLightRoom::kSurfaceLight);
        expectWithin(formatText("light of surface light %g against 1000, scaled", double(strength)),
                     largestDifference(reference, picture, scale), 16 * 0x1p-24, "relative");
    }
}

TEST(Rooms, FaintAndStrongLightPassTheFilters) {
    TestGame game;
    addRooms(game);
    RoomRenderer renderer(game, "compute", {{"rt_accumulate", "0"}, {"rt_numRandomDL", "1"}});
    size_t spoilt = 0, cases = 0;
    for (const float strength : kStrengths)
        for (const char* denoiser : {"0", "1"}) {
            renderer.set("rt_denoiser", denoiser);
            ++cases;
            spoilt += !isFinite(renderer.draw(nameOfStrength(strength), kRoomCamera, 6));
        }
    expectCount("filtered pictures that are not finite, light 1e-6 to 1e6", spoilt, cases);
}

/// Every direction that a point of the floor sees shines alike: irradiance is 0.75 V everywhere, in luxel units.
TEST(Rooms, WhiteFurnaceConvergesToTheClosedForm) {
    TestGame game;
    addMap(game, "furnace", furnaceRoom());
    const Camera camera{.eye = {0, -100, 120}, .pitch = 40, .yaw = 90};
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kRoomWidth, kRoomHeight);
    harness.engine().showsMessages = false;
    prepareHarness(harness, "furnace", {{"rt_backend", "compute"}, {"rt_numRandomDL", "0"}});
    const MeasuredPicture picture = measurePicture(harness, camera, 8, 64);
    const double expected = kTestWallAlbedo * 0.75 * double(squareLightRoom::kSurfaceLight) / 63.75;
    double worst = 0, sum = 0, variance = 0;
    size_t pixels = 0;
    for (int y = 0; y < kRoomHeight; ++y)
        for (int x = 0; x < kRoomWidth; ++x) {
            if (!isInsideOneWall(camera, kRoomWidth, kRoomHeight, x, y) ||
                findRoomPoint(camera, kRoomWidth, kRoomHeight, x + 0.5, y + 0.5).normal.z != 1)
                continue;
            const auto p = static_cast<size_t>(y * kRoomWidth + x);
            const double error = std::sqrt(picture.variance[p].r);
            worst = std::max(worst, std::abs(picture.mean[p].r - expected) - 4 * error);
            sum += picture.mean[p].r, variance += picture.variance[p].r;
            ++pixels;
        }
    ASSERT_GT(pixels, 200u);
    const double mean = sum / double(pixels), meanError = std::sqrt(variance) / double(pixels);
    std::printf("numerics | white furnace | %zu pixels, mean %+.4f %% +- %.4f %%\n", pixels,
                100 * (mean / expected - 1), 100 * meanError / expected);
    expectWithin("white furnace, a pixel beyond 4 standard errors", worst / expected, 0.01, "relative");
    expectWithin("white furnace, mean", std::abs(mean / expected - 1), 4 * meanError / expected, "relative");
}

TEST(Rooms, NoLightIsBlack) {
    TestGame game;
    addMap(game, "dark", darkRoom());
    addMap(game, "beside", roomBesideLights());
    RoomRenderer renderer(game);
    double largest = 0;
    for (const char* map : {"dark", "beside"})
        for (const char* lights : {"0", "1", "16"})
            for (const char* cull : {"0", "1"}) {
                renderer.set("rt_numRandomDL", lights);
                renderer.set("rt_cullLights", cull);
                for (const float value : renderer.draw(map, kRoomCamera, 2).rgb)
                    largest = std::abs(double(value)) <= largest ? largest : std::abs(double(value));
            }
    expectWithin("light where there is no light, or all of it is hidden", largest, 0, "");
}

/// The square light as 100 x 100 squares of two triangles each: together its form factor is known.
TEST(Rooms, TwentyThousandLightsAreTheOneTheyMakeUp) {
    constexpr int kSide = 100;
    TestGame game;
    addMap(game, "many", roomOfManyLights(kSide));
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kRoomWidth, kRoomHeight);
    harness.engine().showsMessages = false;
    prepareHarness(harness, "many", {{"rt_backend", "compute"}, {"rt_numRandomDL", "4"}});
    const MeasuredPicture picture = measurePicture(harness, kRoomCamera, 8, 32);
    double sum = 0, expectedSum = 0, variance = 0;
    for (int y = 0; y < kRoomHeight; ++y)
        for (int x = 0; x < kRoomWidth; ++x) {
            if (!isInsideOneWall(kRoomCamera, kRoomWidth, kRoomHeight, x, y)) continue;
            const RoomPoint point = findRoomPoint(kRoomCamera, kRoomWidth, kRoomHeight, x + 0.5, y + 0.5);
            const auto p = static_cast<size_t>(y * kRoomWidth + x);
            sum += picture.mean[p].r, variance += picture.variance[p].r;
            expectedSum += kTestWallAlbedo * squareLightRoom::computeIrradiance(point.position, point.normal) / 63.75;
        }
    const double error = std::sqrt(variance) / expectedSum;
    std::printf("numerics | %d triangle lights, 4 a pixel | mean %+.4f %% +- %.4f %%\n", 2 * kSide * kSide,
                100 * (sum / expectedSum - 1), 100 * error);
    expectWithin("mean light of 20,000 lights", std::abs(sum / expectedSum - 1), 4 * error, "relative");
    // Every light with a shadow ray of its own: as exact as one light.
    harness.set("rt_numRandomDL", "0");
    const FloatImage all = harness.radiance(kRoomCamera, 1);
    const FloatImage one = RoomRenderer(game).draw(squareLightRoom::kName, kRoomCamera, 64);
    double oneSum = 0, allSum = 0;
    for (size_t i = 0; i < one.rgb.size(); ++i)
        oneSum += double(one.rgb[i]), allSum += double(all.rgb[i]);
    expectWithin("all 20,000 lights against one light", std::abs(allSum / oneSum - 1), 2e-3, "relative");
}

} // namespace
} // namespace q3rt::test
