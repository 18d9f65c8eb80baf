// The engine raises an error in the n-th import call of a map load and a frame, in its real order: the module is shut
// down and registered again while the failed call is still live, then the engine jumps over its frames. Nothing may be
// left behind, no validation message may appear, and the next map loads. Every n with Q3RT_LONG_TESTS=1, a few of each
// module otherwise; in a build with Q3RT_SANITIZE a leak or a use after free ends the program.

#include <array>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "host/headless/headless_engine.hpp"
#include "support/tiny_files.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;

struct Subject {
    const char* module;
    const char* backend; ///< of the ray tracer
    int fewCount;        ///< numbers tried in a short run
};

bool wantsAll() { return std::getenv("Q3RT_LONG_TESTS") != nullptr; }

/// What a game folder has of everything: a room, a model with its skin, a font, scripts.
class SmallGame : public TestGame {
  public:
    SmallGame() {
        add("models/m.md3", makeTinyMd3());
        addText("models/m.skin", "H_Part_1,textures/injection\n");
        addText("scripts/injection.shader", "textures/injection\n{\n{\nmap $whiteimage\nrgbGen entity\n}\n}\n");
        add("fonts/fontImage_16.dat", makeFontOfOneShader());
    }

  private:
    /// The same shader for every glyph: 256 that are looked for in files would only repeat each other.
    static std::vector<std::byte> makeFontOfOneShader() {
        constexpr size_t kGlyphCount = 256, kGlyphBytes = 80, kNameAt = 48;
        std::vector<std::byte> font = makeFont();
        for (size_t i = 0; i < kGlyphCount; ++i)
            overwrite(font, i * kGlyphBytes + kNameAt, std::array<char, 8>{"white"});
        return font;
    }
};

struct Handles {
    qhandle_t white = 0, effect = 0, model = 0, skin = 0;
};

void registerAll(HeadlessEngine& engine, Handles& handles) {
    fontInfo_t font;
    engine.enter([&](const refexport_t& module) {
        handles.white = module.RegisterShaderNoMip("white");
        module.LoadWorld("maps/room_square_light.bsp");
        handles.effect = module.RegisterShader("textures/injection");
        handles.model = module.RegisterModel("models/m.md3");
        handles.skin = module.RegisterSkin("models/m.skin");
        module.RegisterFont("font", 16, &font);
        module.EndRegistration();
    });
}

void drawScene(HeadlessEngine& engine, const Handles& handles) {
    static const byte kCinematic[2 * 2 * 4] = {};
    engine.enter([&](const refexport_t& module) {
        refdef_t view{};
        refEntity_t entity{};
        polyVert_t poly[3] = {};
        vec3_t light = {0, 0, 100};
        view.width = kWidth;
        view.height = kHeight;
        view.fov_x = view.fov_y = 90;
        view.vieworg[2] = 64;
        for (int i = 0; i < 3; ++i)
            view.viewaxis[i][i] = entity.axis[i][i] = 1;
        entity.hModel = handles.model;
        entity.customSkin = handles.skin;
        entity.origin[0] = 100;
        poly[1].xyz[1] = poly[2].xyz[2] = 50;
        module.BeginFrame(0);
        module.DrawStretchRaw(0, 0, kWidth, kHeight, 2, 2, kCinematic, 0, 1);
        module.ClearScene();
        module.AddRefEntityToScene(&entity);
        module.AddPolyToScene(handles.effect, 3, poly, 1);
        module.AddLightToScene(light, 200, 1, 1, 1);
        module.RenderScene(&view);
        module.DrawStretchPic(0, 0, 8, 8, 0, 0, 1, 1, handles.white);
    });
}

/// The engine's way from one map to the next, and a frame of it with all that is written at its end.
void playMap(HeadlessEngine& engine) {
    Handles handles;
    engine.shutdown(false);
    engine.beginRegistration();
    registerAll(engine, handles);
    drawScene(engine, handles);
    engine.runCommand({"screenshotJPEG", "injection"});
    engine.endFrame(true);
}

/// The sanitizer reports leaks at the program's end, and by function names only in libraries that are still there.
void keepMapped(const std::string& library) {
    if (Q3RT_SANITIZED) dlopen(library.c_str(), RTLD_NOW | RTLD_NODELETE);
}

/// Numbers in [1, count]: all of them, or `few` of them evenly spread.
std::vector<int> chooseNumbers(int count, int few) {
    std::vector<int> numbers;
    for (int n = 1; n <= count; ++n)
        if (wantsAll() || n == count || n * few / count != (n - 1) * few / count) numbers.push_back(n);
    return numbers;
}

class Injection : public testing::TestWithParam<Subject> {
  protected:
    void SetUp() override {
        setenv("Q3RT_VALIDATION", "1", 1);
        keepMapped("libVkLayer_khronos_validation.so");
        if (const char* icd = std::getenv("VK_DRIVER_FILES"))
            keepMapped(std::filesystem::path(icd).replace_filename("libvulkan_lvp.so"));
        setLogSink([this](LogLevel, std::string_view line) {
            if (line.find("Vulkan validation") != std::string_view::npos) m_complaints.emplace_back(line);
        });
    }
    void TearDown() override {
        unsetenv("Q3RT_VALIDATION");
        setLogSink({});
        EXPECT_TRUE(m_complaints.empty()) << m_complaints.size() << " messages, the first: " << m_complaints.front();
    }
    /// Loads the module. False: this machine has no device for it.
    bool start(HeadlessEngine& engine) {
        const std::string path = formatText("%s/renderer_%s_x86_64.so", Q3RT_BUILD_DIR, GetParam().module);
        keepMapped(path);
        for (const auto& [name, value] : {std::pair{"r_mode", std::string("-1")},
                                          {"r_customwidth", std::to_string(kWidth)},
                                          {"r_customheight", std::to_string(kHeight)},
                                          {"rt_backend", std::string(GetParam().backend)}})
            engine.cvars.preset(name, value);
        engine.loadModule(path);
        try {
            engine.beginRegistration();
            return true;
        } catch (const DeviceError& error) {
            m_reason = error.what();
            return false;
        }
    }
    std::vector<std::string> m_complaints;
    std::string m_reason;
};

TEST_P(Injection, AMapLoadAndAFrameMayFailAnywhere) {
    SmallGame files;
    HeadlessEngine engine(files);
    if (!start(engine)) GTEST_SKIP() << m_reason;
    playMap(engine);
    engine.raiseErrorAtImport(0);
    playMap(engine);
    const int count = engine.importCount();
    const std::vector<int> numbers = chooseNumbers(count, GetParam().fewCount);
    for (const int n : numbers) {
        engine.raiseErrorAtImport(n);
        try {
            playMap(engine);
            ADD_FAILURE() << "import " << n << " of " << count << " never came";
        } catch (const ContentError& error) {
            EXPECT_TRUE(std::strstr(error.what(), "injected")) << "after import " << n << ": " << error.what();
        }
        engine.raiseErrorAtImport(0);
        ASSERT_NO_THROW(playMap(engine)) << "after import " << n;
    }
    std::printf("%zu of %d imports failed in turn\n", numbers.size(), count);
    EXPECT_GT(count, 30);
    engine.unloadModule();
    EXPECT_EQ(engine.heldResources(), "");
}

TEST_P(Injection, TheStartMayFailAnywhere) {
    int count = 0;
    {
        SmallGame files;
        HeadlessEngine engine(files);
        engine.raiseErrorAtImport(0);
        if (!start(engine)) GTEST_SKIP() << m_reason;
        count = engine.importCount();
    }
    const std::vector<int> numbers = chooseNumbers(count, GetParam().fewCount / 4);
    for (const int n : numbers) {
        SmallGame files;
        HeadlessEngine engine(files);
        engine.raiseErrorAtImport(n);
        EXPECT_THROW(start(engine), ContentError) << "import " << n << " of " << count;
        engine.raiseErrorAtImport(0);
        ASSERT_NO_THROW(playMap(engine)) << "after import " << n;
        engine.unloadModule();
        EXPECT_EQ(engine.heldResources(), "") << "after import " << n;
    }
    std::printf("%zu of %d imports failed in turn\n", numbers.size(), count);
}

INSTANTIATE_TEST_SUITE_P(Modules, Injection,
                         testing::Values(Subject{"null", "", 100}, Subject{"vk", "", 24}, Subject{"rt", "compute", 16},
                                         Subject{"rt", "pipeline", 8}, Subject{"rt", "query", 8}),
                         [](const auto& info) { return std::string(info.param.module) + info.param.backend; });

} // namespace
} // namespace q3rt::test
