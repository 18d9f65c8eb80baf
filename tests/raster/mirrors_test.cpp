// Two mirrors that face each other: how many of their pictures follow one another is a setting.

#include <gtest/gtest.h>

#include "baseq3-test/bsp_writer.hpp"
#include "raster/raster_rig.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr const char* kMirror = "textures/baseq3test/mirror";
constexpr const char* kMirrorScript =
    "\n{\nportal\nsurfaceparm nolightmap\n{\nmap $whiteimage\nblendFunc GL_ZERO GL_ONE\ndepthWrite\n}\n}\n";
constexpr float kEyeYDegrees = 4; // the eye looks a little aside: it would only see the middle of all pictures

/// A box with a mirror in each of two walls, from the test maps' materials.
class MirrorRoom : public TestGame {
  public:
    MirrorRoom() {
        BoxMap map = describeSquareLightRoom();
        room = map.air.front().box;
        for (const int x : {room.mins.x, room.maxs.x}) {
            mirrors.push_back({{x, room.mins.y + 64, room.mins.z + 32}, {x, room.maxs.y - 64, room.maxs.z - 64}});
            map.panels.push_back({mirrors.back(), kMirror});
        }
        add("maps/mirrors.bsp", writeBsp(buildBoxMap(map)));
        addText("scripts/mirror.shader", std::string(kMirror) + kMirrorScript);
    }
    IntBox room;
    std::vector<IntBox> mirrors;
};

std::vector<uint8_t> drawMirrors(TestRenderer& renderer, TestServices& services, const MirrorRoom& room) {
    SceneView view;
    view.width = kWidth;
    view.height = kHeight;
    view.fovXDegrees = 90;
    view.fovYDegrees = 73.74f; // 4:3
    view.view.origin = vec3(room.room.mins + room.room.maxs) * 0.5f;
    const float yaw = glm::radians(kEyeYDegrees);
    view.view.axis[0] = {std::cos(yaw), std::sin(yaw), 0};
    view.view.axis[1] = {-std::sin(yaw), std::cos(yaw), 0};
    view.view.axis[2] = {0, 0, 1};
    renderer.beginFrame(0);
    renderer.clearScene();
    for (const IntBox& mirror : room.mirrors) {
        SceneEntity entity;
        entity.kind = EntityKind::PortalSurface;
        entity.orientation.origin = entity.oldOrigin = vec3(mirror.mins + mirror.maxs) * 0.5f;
        renderer.addEntity(entity);
    }
    renderer.renderScene(view);
    return endFrame(renderer, services);
}

size_t differentPixels(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); i += 3)
        count += a[i] != b[i] || a[i + 1] != b[i + 1] || a[i + 2] != b[i + 2] ? 1u : 0u;
    return count;
}

TEST(RasterMirrors, MoreFollowEachOtherBySetting) {
    MirrorRoom room;
    setenv("Q3RT_VALIDATION", "1", 1);
    TestServices services(room);
    setPictureSize(services);
    services.setCvar("r_clear", "1");
    TestRenderer renderer(services);
    try {
        renderer.beginRegistration();
    } catch (const DeviceError& error) {
        GTEST_SKIP() << "no Vulkan device: " << error.what();
    }
    renderer.loadWorld("maps/mirrors.bsp");
    renderer.endRegistration();
    std::vector<std::vector<uint8_t>> pictures;
    for (const char* depth : {"1", "2", "3"}) {
        services.setCvar("r_portalDepth", depth);
        pictures.push_back(drawMirrors(renderer, services, room));
        keepImage(std::string("mirrors") + depth, pictures.back());
    }
    // Each adds a smaller picture in the middle of the one before.
    const size_t second = differentPixels(pictures[0], pictures[1]), third = differentPixels(pictures[1], pictures[2]);
    EXPECT_GT(second, 200u);
    EXPECT_GT(third, 50u);
    EXPECT_LT(third, second);
    for (const std::string& message : renderer.messages())
        ADD_FAILURE() << message;
}

} // namespace
} // namespace q3rt::test
