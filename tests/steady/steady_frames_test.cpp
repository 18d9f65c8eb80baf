// A frame in steady state takes no memory from the heap, and makes no pipeline: the rasteriser's module on the headless
// engine, with everything in the scene that needs work space of its own.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "baseq3-test/bsp_writer.hpp"
#include "host/headless/headless_engine.hpp"
#include "support/allocation_count.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr int kSettleFrames = 60, kCountedFrames = 60;

constexpr const char* kScripts = R"(
textures/steady/mirror
{
    portal
    surfaceparm nolightmap
    {
        map $whiteimage
        blendFunc GL_ZERO GL_ONE
        depthWrite
    }
}
textures/steady/sky
{
    skyParms - 512 -
    {
        map textures/baseq3test/grey.tga
        tcMod scroll 0.1 0.1
    }
}
textures/steady/waving
{
    deformVertexes wave 64 sin 0 4 0 1
    {
        map $whiteimage
        rgbGen wave sin 0.5 0.5 0 1
    }
}
steady/spark
{
    {
        map $whiteimage
        blendFunc add
        rgbGen vertex
    }
}
)";

/// A room with a mirror and a waving panel in its walls and a sky above.
class SteadyRoom : public TestGame {
  public:
    SteadyRoom() {
        BoxMap map = describeSquareLightRoom();
        room = map.air.front().box;
        mirror = {{room.mins.x, room.mins.y + 64, room.mins.z + 32}, {room.mins.x, room.maxs.y - 64, room.maxs.z - 64}};
        map.panels.push_back({mirror, "textures/steady/mirror"});
        map.panels.push_back(
            {{{room.mins.x + 32, room.maxs.y, room.mins.z + 32}, {room.mins.x + 96, room.maxs.y, room.mins.z + 96}},
             "textures/steady/waving"});
        map.panels.front().shader = "textures/steady/sky"; // the room's light
        add("maps/steady.bsp", writeBsp(buildBoxMap(map)));
        addText("scripts/steady.shader", kScripts);
    }
    IntBox room, mirror;
};

class SteadyFrames : public testing::Test {
  protected:
    SteadyFrames()
        : m_engine(m_game) {
        m_engine.showsMessages = false;
        for (const auto& [name, value] : {std::pair("r_mode", "-1"), {"r_fullscreen", "0"}, {"r_swapInterval", "0"}})
            m_engine.cvars.preset(name, value);
        m_engine.cvars.preset("r_customwidth", std::to_string(kWidth));
        m_engine.cvars.preset("r_customheight", std::to_string(kHeight));
    }
    /// False: there is no device.
    bool load() {
        m_engine.loadModule(Q3RT_BUILD_DIR "/renderer_vk_x86_64.so");
        try {
            m_engine.beginRegistration();
        } catch (const DeviceError&) {
            return false;
        }
        m_engine.enter([this](const refexport_t& module) {
            module.LoadWorld("maps/steady.bsp");
            m_spark = module.RegisterShader("steady/spark");
            module.EndRegistration();
        });
        return true;
    }
    void drawFrame(int number) {
        m_engine.clockMs = 1000 + 16 * number;
        m_engine.enter([this, number](const refexport_t& module) {
            module.BeginFrame(0);
            module.ClearScene();
            addEffects(module, number);
            addMirror(module);
            const refdef_t view = viewAt(number);
            module.RenderScene(&view);
            const float color[4] = {1, 1, 0.5f, 1};
            module.SetColor(color);
            for (int i = 0; i < 20; ++i)
                module.DrawStretchPic(static_cast<float>(8 * i), 8, 8, 8, 0, 0, 1, 1, i % 2 == 0 ? m_spark : 0);
            module.SetColor(nullptr);
        });
        m_engine.endFrame(false);
    }

    SteadyRoom m_game;
    HeadlessEngine m_engine;
    int m_spark = 0;

  private:
    vec3 centre() const { return vec3(m_game.room.mins + m_game.room.maxs) * 0.5f; }

    /// Turns round once in the frames that settle, and once in those that count.
    refdef_t viewAt(int number) const {
        refdef_t view{};
        view.width = kWidth;
        view.height = kHeight;
        view.fov_x = 90;
        view.fov_y = 73.74f; // 4:3
        view.time = 1000 + 16 * number;
        const vec3 eye = centre();
        const float yaw = glm::radians(360.0f / kSettleFrames * static_cast<float>(number)), pitch = 0.4f;
        const float axis[3][3] = {
            {std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch)},
            {-std::sin(yaw), std::cos(yaw), 0},
            {-std::cos(yaw) * std::sin(pitch), -std::sin(yaw) * std::sin(pitch), std::cos(pitch)}};
        std::memcpy(view.viewaxis, axis, sizeof axis);
        std::memcpy(view.vieworg, &eye, sizeof view.vieworg);
        return view;
    }

    /// Lights that move, marks on the floor drawn as polygons, a sprite, a beam, a rail.
    void addEffects(const refexport_t& module, int number) const {
        const vec3 middle = centre();
        const float angle = 0.1f * static_cast<float>(number);
        for (int i = 0; i < 3; ++i) {
            const vec3_t origin = {middle.x + 100 * std::cos(angle + static_cast<float>(i)),
                                   middle.y + 100 * std::sin(angle + static_cast<float>(i)), middle.z};
            module.AddLightToScene(origin, 250, 1, 0.5f, 0.25f);
        }
        const auto floorZ = static_cast<float>(m_game.room.mins.z);
        for (int i = 0; i < 8; ++i)
            addMark(module, {middle.x + static_cast<float>(24 * i - 96), middle.y, floorZ});
        for (const int kind : {RT_SPRITE, RT_BEAM, RT_RAIL_CORE, RT_RAIL_RINGS, RT_LIGHTNING}) {
            refEntity_t entity{};
            entity.reType = kind;
            entity.customShader = m_spark;
            entity.radius = 16;
            entity.origin[0] = middle.x + 64;
            entity.origin[1] = middle.y;
            entity.origin[2] = middle.z;
            entity.oldorigin[0] = middle.x - 64;
            entity.oldorigin[1] = middle.y + 64;
            entity.oldorigin[2] = middle.z;
            std::memset(entity.shaderRGBA, 255, sizeof entity.shaderRGBA);
            module.AddRefEntityToScene(&entity);
        }
    }

    void addMark(const refexport_t& module, const vec3& at) const {
        const vec3_t corners[4] = {{at.x - 16, at.y - 16, at.z + 8},
                                   {at.x - 16, at.y + 16, at.z + 8},
                                   {at.x + 16, at.y + 16, at.z + 8},
                                   {at.x + 16, at.y - 16, at.z + 8}};
        const vec3_t projection = {0, 0, -20};
        vec3_t points[384];
        markFragment_t fragments[128];
        const int count = module.MarkFragments(4, corners, projection, 384, points[0], 128, fragments);
        for (int i = 0; i < count; ++i) {
            polyVert_t polygon[16] = {};
            const int corner = std::min(fragments[i].numPoints, 16);
            for (int k = 0; k < corner; ++k) {
                std::memcpy(polygon[k].xyz, points[fragments[i].firstPoint + k], sizeof(vec3_t));
                std::memset(polygon[k].modulate, 200, sizeof polygon[k].modulate);
            }
            module.AddPolyToScene(m_spark, corner, polygon, 1);
        }
    }

    void addMirror(const refexport_t& module) const {
        refEntity_t entity{};
        entity.reType = RT_PORTALSURFACE;
        const vec3 at = vec3(m_game.mirror.mins + m_game.mirror.maxs) * 0.5f;
        std::memcpy(entity.origin, &at, sizeof entity.origin);
        std::memcpy(entity.oldorigin, &at, sizeof entity.oldorigin);
        module.AddRefEntityToScene(&entity);
    }
};

TEST_F(SteadyFrames, TakeNothingFromTheHeap) {
    if (!load()) GTEST_SKIP() << "no Vulkan device";
    const uint64_t beforeLoad = allocationCount();
    ASSERT_GT(beforeLoad, 10000u) << "the module's allocations are not counted";
    for (int i = 0; i < kSettleFrames; ++i)
        drawFrame(i);
    uint64_t total = 0;
    for (int i = kSettleFrames; i < kSettleFrames + kCountedFrames; ++i) {
        const uint64_t before = allocationCount();
        drawFrame(i);
        const uint64_t taken = allocationCount() - before;
        EXPECT_EQ(taken, 0u) << "frame " << i;
        total += taken;
    }
    RecordProperty("allocations", static_cast<int>(total));
}

} // namespace
} // namespace q3rt::test
