// What is seen through a surface of water, against Snell's law and Schlick's share in double precision.

#include <cmath>
#include <gtest/gtest.h>

#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 96, kHeight = 72; ///< pixels
constexpr double kIndex = 1.333, kSurfaceZ = 128;
/// Under the surface, with the room's light above it.
const Camera kCamera{.eye = {0, -80, 40}, .pitch = -52, .yaw = 90};

/// Water without a colour of its own: what it shows is refraction and reflection alone.
constexpr const char* kClearWater = "clearwater\n{\nsurfaceparm water\nsurfaceparm trans\ncull none\n{\nmap "
                                    "$whiteimage\nblendFunc GL_ZERO GL_ONE\n}\n}\n";

/// Larger than the room, at kSurfaceZ.
TraceHarness::Quad makeSurface(qhandle_t shader, bool facesDown) {
    TraceHarness::Quad quad{.shader = shader};
    const float corners[4][2] = {{-300, -300}, {-300, 300}, {300, 300}, {300, -300}};
    for (int i = 0; i < 4; ++i) {
        polyVert_t& vertex = quad.vertices[facesDown ? 3 - i : i];
        vertex.xyz[0] = corners[i][0];
        vertex.xyz[1] = corners[i][1];
        vertex.xyz[2] = kSurfaceZ;
        for (byte& channel : vertex.modulate)
            channel = 255;
    }
    return quad;
}

struct Seen {
    double value = 0;
    bool nearEdge = false; ///< of the light, of a wall, or of total reflection
};

/// Plain colours: the light is 1, walls 0.6. `ratio`: index on the eye's side over the one behind the surface.
Seen lookThrough(const dvec3& eye, const dvec3& direction, double ratio) {
    const dvec3 at = eye + direction * ((kSurfaceZ - eye.z) / direction.z);
    const double cosine = direction.z, sine2 = ratio * ratio * (1 - cosine * cosine);
    Seen seen{.value = kTestWallAlbedo, .nearEdge = std::abs(sine2 - 1) < 0.05};
    if (sine2 >= 1) return seen; // the floor in the surface
    const dvec3 bent(direction.x * ratio, direction.y * ratio, std::sqrt(1 - sine2));
    const dvec3 top = at + bent * ((squareLightRoom::kRoom.maxs.z - kSurfaceZ) / bent.z);
    const double outside = std::max(std::abs(top.x), std::abs(top.y)) - squareLightRoom::kLight.maxs.x;
    seen.nearEdge |= std::abs(outside) < 6;
    const double steepest = ratio > 1 ? bent.z : cosine, base = (kIndex - 1) / (kIndex + 1);
    const double share = base * base + (1 - base * base) * std::pow(1 - steepest, 5);
    if (outside < 0) seen.value = share * kTestWallAlbedo + (1 - share);
    return seen;
}

void compareThroughSurface(bool facesDown) {
    TestGame game;
    game.addText("scripts/water.shader", kClearWater);
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness.set("rt_illumination", "0");
    harness.set("rt_backend", "compute");
    prepareHarness(harness, squareLightRoom::kName, {});
    qhandle_t shader = 0;
    harness.engine().enter([&](const refexport_t& module) { shader = module.RegisterShader("clearwater"); });
    harness.setQuads({makeSurface(shader, facesDown)});
    const FloatImage image = harness.radiance(kCamera, 1);
    int compared = 0, light = 0;
    double worst = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const dvec3 direction = rayDirection(kCamera, kWidth, kHeight, x + 0.5, y + 0.5);
            if (direction.z < 0.2) continue; // meets a wall first
            const Seen seen = lookThrough(dvec3(kCamera.eye), direction, facesDown ? 1 / kIndex : kIndex);
            if (seen.nearEdge) continue;
            ++compared;
            if (seen.value > kTestWallAlbedo) ++light;
            worst =
                std::max(worst, std::abs(double(image.rgb[static_cast<size_t>(3 * (y * kWidth + x))]) - seen.value));
        }
    EXPECT_GT(compared, 3000);
    EXPECT_GT(light, 200);
    EXPECT_LT(worst, 1e-3);
    std::printf("%d pixels, %d of the light, worst difference %.1e\n", compared, light, worst);
}

TEST(Refraction, IntoWaterFollowsSnell) { compareThroughSurface(true); }

TEST(Refraction, OutOfWaterFollowsSnellAndReflectsAll) { compareThroughSurface(false); }

} // namespace
} // namespace q3rt::test
