// An error of the engine in every import of a map load and a frame, with the real modules: nothing is left behind and
// the next map loads. Runs under AddressSanitizer too (Q3RT_SANITIZE), where a leak or a use after free ends it.

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>

#include "base/error.hpp"
#include "host/headless/headless_engine.hpp"
#include "support/tiny_files.hpp"

namespace q3rt {
namespace {

class TinyGame : public FileSource {
  public:
    TinyGame() {
        m_files["maps/tiny.bsp"] = test::TinyBsp().build();
        m_files["models/m.md3"] = test::makeTinyMd3();
        const std::string script = "textures/a\n{\n{\nmap $lightmap\n}\n}\n";
        const auto* first = reinterpret_cast<const std::byte*>(script.data());
        m_files["scripts/a.shader"] = {first, first + script.size()};
    }
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        const auto found = m_files.find(std::string(name));
        return found == m_files.end() ? std::nullopt : std::optional(found->second);
    }
    std::vector<std::string> list(std::string_view directory, std::string_view) override {
        return directory == "scripts" ? std::vector<std::string>{"a.shader"} : std::vector<std::string>();
    }

  private:
    std::map<std::string, std::vector<std::byte>> m_files;
};

void loadAndDraw(HeadlessEngine& engine) {
    engine.enter([](const refexport_t& module) {
        refdef_t view{};
        refEntity_t entity{};
        view.width = 64;
        view.height = 48;
        view.fov_x = view.fov_y = 90;
        for (int i = 0; i < 3; ++i)
            view.viewaxis[i][i] = entity.axis[i][i] = 1;
        const int white = module.RegisterShaderNoMip("white");
        module.LoadWorld("maps/tiny.bsp");
        entity.hModel = module.RegisterModel("models/m.md3");
        module.EndRegistration();
        module.BeginFrame(0);
        module.ClearScene();
        module.AddRefEntityToScene(&entity);
        module.RenderScene(&view);
        module.DrawStretchPic(0, 0, 64, 48, 0, 0, 1, 1, white);
    });
    engine.endFrame(true);
}

/// The engine between two maps.
void restart(HeadlessEngine& engine) {
    engine.shutdown(false);
    engine.beginRegistration();
}

class MapInjection : public testing::TestWithParam<const char*> {};

TEST_P(MapInjection, EveryImportMayFail) {
    const std::string path = std::string(Q3RT_BUILD_DIR) + "/renderer_" + GetParam() + "_x86_64.so";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not built";
    if (std::strcmp(GetParam(), "null") != 0 && !std::getenv("Q3RT_LONG_TESTS"))
        GTEST_SKIP() << "takes minutes on a software driver: set Q3RT_LONG_TESTS=1";
    TinyGame files;
    HeadlessEngine engine(files);
    engine.showsMessages = false;
    engine.cvars.preset("r_mode", "-1");
    engine.cvars.preset("r_customwidth", "64");
    engine.cvars.preset("r_customheight", "48");
    engine.loadModule(path);
    try {
        engine.beginRegistration();
    } catch (const DeviceError& error) {
        GTEST_SKIP() << "no device for this module: " << error.what();
    }
    loadAndDraw(engine);
    int injected = 0;
    for (int n = 1;; ++n) {
        restart(engine);
        engine.raiseErrorAtImport(n);
        bool failed = false;
        try {
            loadAndDraw(engine);
        } catch (const ContentError& error) {
            failed = true;
            EXPECT_TRUE(std::strstr(error.what(), "injected")) << error.what();
        }
        engine.raiseErrorAtImport(0);
        if (!failed) break;
        ++injected;
        // The engine has registered again within the error: the next map loads at once.
        ASSERT_NO_THROW(loadAndDraw(engine)) << "after import " << n;
    }
    EXPECT_GE(injected, 5);
    std::printf("%s: %d imports failed in turn\n", GetParam(), injected);
    engine.unloadModule();
    EXPECT_EQ(engine.heldResources(), "");
}

INSTANTIATE_TEST_SUITE_P(Modules, MapInjection, testing::Values("null", "vk", "rt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace q3rt
