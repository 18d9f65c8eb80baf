// Views, places and entities that no game means: nothing stops, nothing that is not a number is ever shown.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "numerics/measured.hpp"
#include "numerics/renderer/rooms.hpp"
#include "scene/md3_builder.hpp"

namespace q3rt::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

std::string modulePath(const char* renderer) {
    return std::string(Q3RT_BUILD_DIR "/renderer_") + renderer + "_x86_64.so";
}

/// A view of the room through a part of the target.
refdef_t makeRoomView(int x, int y, int width, int height, float fovX = 90) {
    refdef_t view{};
    view.x = x, view.y = y, view.width = width, view.height = height;
    view.fov_x = fovX, view.fov_y = 73.74f;
    for (int i = 0; i < 3; ++i) {
        view.vieworg[i] = kRoomCamera.eye[i];
        view.viewaxis[i][i] = 1;
    }
    return view;
}

/// Draws one scene of the view and hands back what is shown.
HostFrame drawView(TraceHarness& harness, const refdef_t& view) {
    const refdef_t* pointer = &view;
    harness.engine().enter([pointer](const refexport_t& module) {
        module.BeginFrame(0);
        module.ClearScene();
        module.RenderScene(pointer);
    });
    const auto frame = harness.engine().endFrame(true);
    return frame ? *frame : HostFrame{};
}

std::unique_ptr<TraceHarness> startRoom(TestGame& game, const char* renderer, int width, int height) {
    auto harness = std::make_unique<TraceHarness>(game, modulePath(renderer), width, height);
    harness->engine().showsMessages = false;
    harness->set("rt_backend", "compute");
    harness->loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
    return harness;
}

/// Mean light of the picture against the closed form: it says whether every ray goes where it should.
TEST(Views, EveryFieldOfViewShowsTheRoom) {
    TestGame game;
    RoomRenderer renderer(game);
    for (const float fov : {1.0f, 10.0f, 90.0f, 150.0f, 179.0f}) {
        Camera camera = kRoomCamera;
        camera.fovX = fov;
        const FloatImage picture = renderer.draw(squareLightRoom::kName, camera, 32);
        EXPECT_TRUE(isFinite(picture));
        double sum = 0, expected = 0;
        for (int y = 0; y < kRoomHeight; ++y)
            for (int x = 0; x < kRoomWidth; ++x) {
                if (!isInsideOneWall(camera, kRoomWidth, kRoomHeight, x, y)) continue;
                const RoomPoint point = findRoomPoint(camera, kRoomWidth, kRoomHeight, x + 0.5, y + 0.5);
                sum += double(picture.rgb[static_cast<size_t>(3 * (y * kRoomWidth + x))]);
                expected += kTestWallAlbedo * squareLightRoom::computeIrradiance(point.position, point.normal) / 63.75;
            }
        ASSERT_GT(expected, 0) << fov;
        char row[64];
        std::snprintf(row, sizeof row, "light of the room, field of view %g degrees", double(fov));
        expectWithin(row, std::abs(sum / expected - 1), 0.01, "relative");
    }
}

TEST(Views, EverySizeIsDrawn) {
    TestGame game;
    for (const char* renderer : {"rt", "vk"}) {
        const auto harness = startRoom(game, renderer, 64, 48);
        // Without an area, beyond the target, of one pixel, and the whole: each after the others.
        for (const auto& [x, y, width, height] : {std::array{0, 0, 0, 0},
                                                  {0, 0, 0, 48},
                                                  {10, 10, -5, -5},
                                                  {64, 48, 10, 10},
                                                  {-100, -100, 50, 50},
                                                  {5, 5, 1, 1},
                                                  {-20, -10, 200, 100},
                                                  {0, 0, 64, 48}}) {
            const HostFrame frame = drawView(*harness, makeRoomView(x, y, width, height));
            EXPECT_EQ(frame.width, 64) << renderer;
            EXPECT_EQ(frame.rgb.size(), 64u * 48 * 3) << renderer;
        }
        const HostFrame pixel = drawView(*harness, makeRoomView(5, 5, 1, 1));
        const size_t at = 3 * (5 * 64 + 5);
        EXPECT_GT(pixel.rgb[at] + pixel.rgb[at + 1] + pixel.rgb[at + 2], 0) << renderer << ": one pixel shows the room";
    }
}

TEST(Views, SixteenThousandPixelsWide) {
    TestGame game;
    for (const char* renderer : {"rt", "vk"}) {
        const auto harness = startRoom(game, renderer, 16384, 8);
        const HostFrame frame = drawView(*harness, makeRoomView(0, 0, 16384, 8));
        ASSERT_EQ(frame.width, 16384) << renderer;
        // Of a row that meets the walls only.
        size_t dark = 0;
        for (size_t x = 0; x < 16384; ++x)
            dark += frame.rgb[3 * (16384 * 4 + x)] == 0;
        EXPECT_EQ(dark, 0u) << renderer << ": the row is drawn to its end";
    }
}

TEST(Views, CamerasWhereNobodyCanBe) {
    TestGame game;
    game.add("models/thing.md3", buildMd3({{}}, "textures/baseq3test/grey"));
    TraceHarness harness(game, modulePath("rt"), kRoomWidth, kRoomHeight);
    harness.engine().showsMessages = false;
    harness.set("rt_backend", "compute");
    harness.loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
    refEntity_t thing{};
    thing.reType = RT_MODEL;
    thing.hModel = harness.engine().moduleTable().RegisterModel("models/thing.md3");
    for (int i = 0; i < 3; ++i)
        thing.axis[i][i] = 1;
    harness.setEntities({thing});
    const vec3 inWall(-300, 0, 100), onWall(-256, 0, 100), inModel(2, 2, 0), outside(5000, -7000, 9000),
        farOutside(1e6f, 1e6f, -1e6f);
    for (const vec3& eye : {inWall, onWall, inModel, outside, farOutside})
        EXPECT_TRUE(isFinite(harness.radiance({.eye = eye, .pitch = 20, .yaw = 30}, 2)))
            << eye.x << " " << eye.y << " " << eye.z;
}

/// An eye that is nowhere shows nothing, and the next frame is as if it had never been.
TEST(Views, EyesThatAreNoPlaceLeaveNoTrace) {
    TestGame game;
    for (const char* renderer : {"rt", "vk"}) {
        const auto harness = startRoom(game, renderer, 64, 48);
        for (int i = 0; i < 3; ++i)
            drawView(*harness, makeRoomView(0, 0, 64, 48));
        const HostFrame before = drawView(*harness, makeRoomView(0, 0, 64, 48));
        for (const float bad : {kNan, kInfinity, -kInfinity, 3e38f}) {
            refdef_t view = makeRoomView(0, 0, 64, 48);
            view.vieworg[1] = bad;
            drawView(*harness, view);
            view = makeRoomView(0, 0, 64, 48);
            view.viewaxis[0][2] = bad;
            drawView(*harness, view);
            view = makeRoomView(0, 0, 64, 48);
            view.fov_x = bad;
            drawView(*harness, view);
        }
        HostFrame after;
        for (int i = 0; i < 8; ++i)
            after = drawView(*harness, makeRoomView(0, 0, 64, 48));
        ASSERT_EQ(after.rgb.size(), before.rgb.size());
        double difference = 0;
        for (size_t i = 0; i < after.rgb.size(); ++i)
            difference += std::abs(double(after.rgb[i]) - double(before.rgb[i])) / double(after.rgb.size());
        expectWithin(std::string("mean difference after views that are no numbers, ") + renderer, difference, 4,
                     "/255");
    }
}

/// Everything that a scene may hold, at places that are no numbers: the picture is that without it.
TEST(Views, EntitiesThatAreNowhereAreNotDrawn) {
    TestGame game;
    game.add("models/thing.md3", buildMd3({{}}, "textures/baseq3test/grey"));
    TraceHarness harness(game, modulePath("rt"), kRoomWidth, kRoomHeight);
    harness.engine().showsMessages = false;
    harness.set("rt_backend", "compute");
    harness.set("rt_accumulate", "1");
    harness.set("rt_illumination", "0"); // without light there is no chance in a picture
    harness.loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
    const FloatImage alone = harness.radiance(kRoomCamera, 1);
    const qhandle_t model = harness.engine().moduleTable().RegisterModel("models/thing.md3");
    const qhandle_t shader = harness.engine().moduleTable().RegisterShader("textures/baseq3test/grey");
    size_t wrong = 0, cases = 0;
    for (const refEntityType_t type : {RT_MODEL, RT_SPRITE, RT_BEAM, RT_RAIL_CORE, RT_LIGHTNING, RT_PORTALSURFACE})
        for (const float bad : {kNan, kInfinity, -kInfinity})
            for (int member = 0; member < 4; ++member) {
                refEntity_t entity{};
                entity.reType = type;
                entity.hModel = model;
                entity.customShader = shader;
                entity.radius = 8;
                for (int i = 0; i < 3; ++i)
                    entity.axis[i][i] = 1;
                if (member == 0) entity.origin[0] = bad;
                if (member == 1) entity.origin[0] = entity.origin[1] = entity.origin[2] = bad;
                if (member == 2) entity.axis[1][1] = bad, entity.oldorigin[1] = bad;
                if (member == 3) entity.radius = bad, entity.backlerp = bad, entity.axis[2][0] = bad;
                harness.setEntities({entity});
                const FloatImage picture = harness.radiance(kRoomCamera, 1);
                ++cases;
                wrong += !isFinite(picture);
                if (type == RT_MODEL && member < 3 && picture.rgb != alone.rgb) ++wrong;
            }
    harness.setEntities({});
    EXPECT_EQ(harness.radiance(kRoomCamera, 1).rgb, alone.rgb) << "nothing is left of them";
    harness.set("rt_illumination", "1");
    for (const float bad : {kNan, kInfinity}) {
        TraceHarness::Light light{{bad, 0, 100}, 200};
        harness.setLights({light});
        wrong += !isFinite(harness.radiance(kRoomCamera, 1));
        harness.setLights({{{0, 0, 100}, bad}});
        wrong += !isFinite(harness.radiance(kRoomCamera, 1));
        harness.setLights({});
        TraceHarness::Quad quad;
        quad.shader = shader;
        for (int i = 0; i < 4; ++i)
            quad.vertices[i] = {{bad, static_cast<float>(i), 50}, {0, bad}, {255, 255, 255, 255}};
        harness.setQuads({quad});
        wrong += !isFinite(harness.radiance(kRoomCamera, 1));
        harness.setQuads({});
        cases += 3;
    }
    expectCount("pictures spoilt by entities, lights and polys at NaN and infinity", wrong, cases);
}

} // namespace
} // namespace q3rt::test
