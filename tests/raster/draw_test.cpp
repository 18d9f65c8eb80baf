// The rasteriser on a real device: a map's picture is there, repeats exactly, and the validation layer has nothing to
// say.

#include <gtest/gtest.h>

#include <cstdlib>

#include "raster/raster_rig.hpp"
#include "scene/texture_upload.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

SceneView spawnView(const World& world, size_t number) {
    size_t found = 0;
    SceneView view;
    for (const MapEntity& entity : world.entities) {
        if (entity.className() != "info_player_deathmatch" || found++ != number) continue;
        view.view.origin = entity.vector("origin").value_or(vec3(0)) + vec3(0, 0, 26);
        const float yaw = glm::radians(entity.number("angle", 0));
        view.view.axis[0] = vec3(std::cos(yaw), std::sin(yaw), 0);
        view.view.axis[1] = vec3(-std::sin(yaw), std::cos(yaw), 0);
        view.view.axis[2] = vec3(0, 0, 1);
    }
    view.width = kWidth;
    view.height = kHeight;
    view.fovXDegrees = 90;
    view.fovYDegrees = 73.74f; // 4:3
    return view;
}

/// Those that act at once, on a view whose picture is `first`; they are taken back.
void checkSettingsOfPlay(TestRenderer& renderer, TestServices& services, const SceneView& view, int shader,
                         const std::vector<uint8_t>& first) {
    for (const char* setting : {"r_showtris", "r_shownormals"}) {
        services.setCvar(setting, "1");
        EXPECT_NE(first, drawFrame(renderer, services, view, shader)) << setting << " shows nothing";
        services.setCvar(setting, "0");
    }
    services.setCvar("r_flares", "1");
    services.setCvar("r_speeds", "6");
    drawFrame(renderer, services, view, shader);
    EXPECT_EQ(services.printed.back().find("flares: "), 0u) << services.printed.back();
    services.setCvar("r_flares", "0");
    services.setCvar("r_speeds", "0");
    services.setCvar("r_gamma", "1.5");
    std::vector<uint8_t> brighter = first;
    const auto ramp = buildGammaTable(1.5f, 0);
    for (uint8_t& value : brighter)
        value = ramp[value];
    EXPECT_EQ(brighter, drawFrame(renderer, services, view, shader)) << "the ramp is a table over the picture";
    services.setCvar("r_gamma", "1");
    services.setCvar("r_anaglyphMode", "1");
    EXPECT_NE(first, drawFrame(renderer, services, view, shader, {1, 2})) << "both eyes see the same";
    services.setCvar("r_stereoSeparation", "0");
    EXPECT_EQ(first, drawFrame(renderer, services, view, shader, {1, 2})) << "eyes at one place, through glasses";
    services.setCvar("r_anaglyphMode", "0");
    services.setCvar("r_stereoSeparation", "64");
}

int largestDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    int largest = 0;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, std::abs(int{a[i]} - int{b[i]}));
    return largest;
}

TEST(RasterDraw, MapIsDrawnWithoutValidationMessages) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    setenv("Q3RT_VALIDATION", "1", 1);
    TestServices services(*files);
    setPictureSize(services);
    services.setCvar("r_picmip", "0");
    services.setCvar("q3rt_wantStats", "1");
    TestRenderer renderer(services);
    try {
        renderer.beginRegistration();
    } catch (const DeviceError& error) {
        GTEST_SKIP() << "no Vulkan device: " << error.what();
    }
    // As the engine does it: a menu first, then everything anew for the map.
    renderer.endRegistration();
    renderer.beginFrame(0);
    renderer.drawPicture(0, 0, kWidth, kHeight, 0, 0, 1, 1, renderer.registerShader("menuback", false));
    renderer.endFrame();
    renderer.shutdownRegistration();
    renderer.shutdownRegistration();
    renderer.beginRegistration();
    const char* map = std::getenv("Q3RT_TEST_MAP");
    renderer.loadWorld(map ? map : "maps/oa_dm1.bsp");
    const int shader = renderer.registerShader("gfx/2d/bigchars", false);
    renderer.endRegistration();
    const SceneView view = spawnView(*renderer.map(), 0);
    const size_t warmed = renderer.pipelineCount();
    const std::vector<uint8_t> first = drawFrame(renderer, services, view, shader);
    const std::vector<uint8_t> second = drawFrame(renderer, services, view, shader);
    drawFrame(renderer, services, view, shader); // times are known when their frame's slot comes round
    keepImage("spawn0", first);
    checkSettingsOfPlay(renderer, services, view, shader, first);
    EXPECT_EQ(renderer.pipelineCount(), warmed) << "a pipeline was made during play";
    size_t bright = 0;
    for (const uint8_t value : first)
        bright += value > 16 ? 1u : 0u;
    EXPECT_GT(bright, first.size() / 4) << "the picture is mostly black";
    EXPECT_EQ(first, second) << "the same frame twice gives two pictures";
    for (const char* setting : {"cg_shadows", "r_drawSun", "r_clear"}) {
        services.setCvar(setting, setting == std::string("cg_shadows") ? "2" : "1");
        EXPECT_EQ(first, drawFrame(renderer, services, view, shader)) << setting << ": no model, no sky, nothing bare";
        services.setCvar(setting, "0");
    }
    services.setCvar("r_depthFirst", "0");
    EXPECT_EQ(first, drawFrame(renderer, services, view, shader)) << "depth first changes the picture";
    for (const char* choice : {"0", "2"}) {
        services.setCvar("r_cullTriangles", choice);
        EXPECT_TRUE(first == drawFrame(renderer, services, view, shader)) << "triangles that show are left out";
    }
    services.setCvar("r_mergeStages", "0");
    const std::vector<uint8_t> apart = drawFrame(renderer, services, view, shader);
    EXPECT_GT(renderer.pipelineCount(), warmed) << "no stages in view that share a pass";
    EXPECT_LE(largestDifference(first, apart), 1) << "stages in one pass change the picture";
    EXPECT_NE(services.cvar("q3rt_stats", "", 0).string().find("\"world view\""), std::string_view::npos);
    for (const std::string& message : renderer.messages())
        ADD_FAILURE() << message;
    renderer.shutdownRegistration();
    for (const std::string& message : renderer.messages())
        ADD_FAILURE() << message;
}

/// Mean difference of two pictures, bytes.
double meanDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += std::abs(a[i] - b[i]);
    return sum / static_cast<double>(a.size());
}

TEST(RasterDraw, SamplesAndScaleGiveTheSameViewWithoutValidationMessages) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    setenv("Q3RT_VALIDATION", "1", 1);
    std::vector<uint8_t> plain;
    for (const auto& [samples, scale] : {std::pair("0", "100"), {"4", "100"}, {"0", "200"}, {"4", "50"}}) {
        TestServices services(*files);
        setPictureSize(services);
        services.setCvar("r_ext_multisample", samples);
        services.setCvar("r_renderScale", scale);
        TestRenderer renderer(services);
        try {
            renderer.beginRegistration();
        } catch (const DeviceError& error) {
            GTEST_SKIP() << "no Vulkan device: " << error.what();
        }
        renderer.loadWorld("maps/oa_dm1.bsp");
        const int shader = renderer.registerShader("gfx/2d/bigchars", false);
        renderer.endRegistration();
        const SceneView view = spawnView(*renderer.map(), 0);
        const std::vector<uint8_t> picture = drawFrame(renderer, services, view, shader);
        keepImage(std::string("samples") + samples + "scale" + scale, picture);
        if (plain.empty()) plain = picture;
        constexpr double kSmoothedEdges = 3; // bytes, mean: what filters change of a picture with fine textures
        EXPECT_LT(meanDifference(plain, picture), kSmoothedEdges) << samples << " samples, " << scale << " %";
        EXPECT_EQ(plain == picture, samples == std::string("0") && scale == std::string("100"));
        services.commands.at("gfxinfo")();
        EXPECT_NE(services.printed.back().find("shown: "), std::string::npos);
        for (const std::string& message : renderer.messages())
            ADD_FAILURE() << message;
    }
}

TEST(RasterDraw, NearestSurfacesTakeFromTheCountOfShadowVolumes) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    setenv("Q3RT_VALIDATION", "1", 1);
    TestServices services(*files);
    setPictureSize(services);
    TestRenderer renderer(services);
    try {
        renderer.beginRegistration();
    } catch (const DeviceError& error) {
        GTEST_SKIP() << "no Vulkan device: " << error.what();
    }
    renderer.loadWorld("maps/oa_dm1.bsp");
    SceneEntity caster;
    caster.model = renderer.registerModel("models/powerups/armor/armor_yel.md3");
    const int blood = renderer.registerShader("viewBloodBlend", true); // sort nearest, alpha of its vertices
    renderer.endRegistration();
    const SceneView view = spawnView(*renderer.map(), 0);
    caster.orientation.origin = caster.lightingOrigin = view.view.origin + 96.0f * view.view.axis[0];
    const size_t warmed = renderer.pipelineCount();
    const auto draw = [&](const char* shadows, int sheets) {
        services.setCvar("cg_shadows", shadows);
        renderer.beginFrame(0);
        renderer.clearScene();
        renderer.addEntity(caster);
        for (int i = 0; i < sheets; ++i) { // a clear sheet over all of the view
            std::array<PolyVertex, 4> corners{};
            for (size_t k = 0; k < corners.size(); ++k) {
                const float side = k == 0 || k == 3 ? 1.0f : -1.0f, up = k < 2 ? 1.0f : -1.0f;
                corners[k].position = view.view.origin + 12.0f * view.view.axis[0] + 48.0f * side * view.view.axis[1] +
                                      48.0f * up * view.view.axis[2];
                corners[k].color = U8vec4(255, 255, 255, 0);
            }
            renderer.addPolys(blood, corners.size(), corners);
        }
        renderer.renderScene(view);
        return endFrame(renderer, services);
    };
    const std::vector<uint8_t> plain = draw("0", 0), shaded = draw("2", 0), erased = draw("2", 8);
    keepImage("shadow_volume", shaded);
    keepImage("shadow_volume_erased", erased);
    EXPECT_NE(plain, shaded) << "no shadow in view";
    EXPECT_EQ(plain, erased) << "what is nearest leaves shadows";
    EXPECT_EQ(plain, draw("0", 8)) << "the sheet shows";
    EXPECT_EQ(renderer.pipelineCount(), warmed) << "a pipeline was made during play";
    for (const std::string& message : renderer.messages())
        ADD_FAILURE() << message;
}

} // namespace
} // namespace q3rt::test
