// The headless engine with the stub module: a whole life of a module, and an error raised in each import of it.

#include <gtest/gtest.h>
#include <map>

#include "base/error.hpp"
#include "base/log.hpp"
#include "host/headless/headless_engine.hpp"

namespace q3rt {
namespace {

class MemoryFiles : public FileSource {
  public:
    std::map<std::string, std::string> files;
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        const auto found = files.find(std::string(name));
        if (found == files.end()) return std::nullopt;
        const auto* first = reinterpret_cast<const std::byte*>(found->second.data());
        return std::vector<std::byte>(first, first + found->second.size());
    }
    std::vector<std::string> list(std::string_view directory, std::string_view) override {
        std::vector<std::string> names;
        for (const auto& [name, text] : files)
            if (name.starts_with(std::string(directory) + "/")) names.push_back(name.substr(directory.size() + 1));
        return names;
    }
};

class HeadlessTest : public testing::Test {
  protected:
    void SetUp() override {
        setLogSink([](LogLevel, std::string_view) {});
        files.files = {{"maps/a.bsp", "map"}, {"models/m.md3", "model"}, {"scripts/s.shader", ""}};
        engine.cvars.preset("r_mode", "0");
        engine.loadModule(Q3RT_BUILD_DIR "/renderer_q3stub_x86_64.so");
    }
    void TearDown() override { setLogSink({}); }

    void loadMap() {
        engine.enter([](const refexport_t& module) {
            module.RegisterShaderNoMip("gfx/2d/bigchars");
            module.LoadWorld("maps/a.bsp");
            module.RegisterModel("models/m.md3");
            module.EndRegistration();
        });
    }
    std::optional<HostFrame> drawFrame(bool capture) {
        engine.enter([](const refexport_t& module) {
            refdef_t view{};
            refEntity_t entity{};
            module.BeginFrame(0);
            module.ClearScene();
            module.AddRefEntityToScene(&entity);
            module.RenderScene(&view);
            module.DrawStretchPic(0, 0, 640, 480, 0, 0, 1, 1, 1);
        });
        return engine.endFrame(capture);
    }

    MemoryFiles files;
    HeadlessEngine engine{files};
};

TEST_F(HeadlessTest, WholeLifeOfAModule) {
    const glconfig_t& config = engine.beginRegistration();
    EXPECT_EQ(config.vidWidth, 320);
    EXPECT_STREQ(config.vendor_string, "q3rt");
    loadMap();
    const std::optional<HostFrame> frame = drawFrame(true);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->rgb.size(), 320u * 240 * 3);
    EXPECT_EQ(engine.filesRead(), (std::set<std::string>{"maps/a.bsp", "models/m.md3"}));
    EXPECT_TRUE(engine.runCommand({"stubinfo"}));
    EXPECT_EQ(engine.cvars.value("stub_started"), "1");
    engine.shutdown(false);
    engine.shutdown(false);
    engine.beginRegistration();
    loadMap();
    engine.shutdown(true);
    EXPECT_EQ(engine.heldResources(), "");
}

TEST_F(HeadlessTest, CallsOutsideARegistrationAreIgnored) {
    drawFrame(false);
    loadMap();
    engine.shutdown(false);
    engine.beginRegistration();
    engine.shutdown(false);
    drawFrame(false);
    engine.shutdown(true);
    engine.shutdown(true);
    drawFrame(false);
}

TEST_F(HeadlessTest, ErrorsOfTheModuleAreExceptions) {
    engine.beginRegistration();
    EXPECT_THROW(engine.enter([](const refexport_t& module) { module.LoadWorld("maps/none.bsp"); }), ContentError);
    loadMap();
    refEntity_t entity{};
    entity.reType = 8;
    EXPECT_THROW(engine.enter([&](const refexport_t& module) { module.AddRefEntityToScene(&entity); }), ContentError);
    entity.reType = RT_MODEL;
    entity.origin[1] = std::numeric_limits<float>::quiet_NaN();
    engine.enter([&](const refexport_t& module) { module.AddRefEntityToScene(&entity); });
}

TEST_F(HeadlessTest, AnErrorInEveryImportOfALifeLeavesNothingBehind) {
    int injected = 0;
    for (int n = 1;; ++n) {
        engine.beginRegistration();
        engine.shutdown(true);
        engine.beginRegistration();
        engine.raiseErrorAtImport(n);
        bool failed = false;
        try {
            loadMap();
            drawFrame(true);
        } catch (const ContentError& error) {
            failed = true;
            EXPECT_NE(std::string(error.what()).find("injected"), std::string::npos);
        }
        engine.raiseErrorAtImport(0);
        if (!failed) break;
        ++injected;
        loadMap(); // the next map loads
        drawFrame(false);
        engine.shutdown(true);
        EXPECT_EQ(engine.heldResources(), "") << "after import " << n;
    }
    EXPECT_GE(injected, 5);
    RecordProperty("importsThatFailed", injected);
}

TEST(CvarTable, SaysWhyAValueIsNotInForce) {
    CvarTable cvars;
    cvars.preset("Rt_Lights", "abc");
    EXPECT_NE(cvars.complaint("rt_lights").find("no setting"), std::string::npos);
    cvar_t* lights = cvars.get("rt_lights", "2", 0);
    cvars.setRange(lights, 0, 64, true);
    EXPECT_EQ(lights->integer, 2) << "what is no number gives the default";
    EXPECT_NE(cvars.complaint("rt_lights").find("from 0 to 64, not 'abc'"), std::string::npos);
    for (const auto& [given, taken] : std::map<std::string, std::string>{
             {"-5", "0"}, {"65", "64"}, {"1e30", "64"}, {"3.5", "3"}, {"nan", "2"}, {"7x", "2"}, {"", "2"}}) {
        cvars.set("rt_lights", given);
        EXPECT_EQ(cvars.value("rt_lights"), taken) << given;
        EXPECT_NE(cvars.complaint("rt_lights"), "") << given;
    }
    cvars.set("rt_lights", "16");
    EXPECT_EQ(cvars.complaint("rt_lights"), "");
    EXPECT_EQ(lights->integer, 16);
}

TEST_F(HeadlessTest, WhatIsNoModuleIsRefusedWithItsName) {
    HeadlessEngine* other = &engine;
    EXPECT_THROW(other->loadModule(Q3RT_BUILD_DIR "/absent.so"), UsageError);
    EXPECT_THROW(other->loadModule(Q3RT_SOURCE_DIR "/CMakeLists.txt"), UsageError);
}

} // namespace
} // namespace q3rt
