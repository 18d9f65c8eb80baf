// A recording replayed into the same module is recorded again with the same calls: nothing is lost on the way.

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <unistd.h>

#include "host/headless/replayer.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

class OneMap : public FileSource {
  public:
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        if (name != "maps/a.bsp" && name != "models/m.md3") return std::nullopt;
        return std::vector<std::byte>(10, std::byte{1});
    }
    std::vector<std::string> list(std::string_view, std::string_view) override { return {}; }
};

class ReplayTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("q3rt_replay_test_" + std::to_string(getpid()));
        fs::create_directories(folder);
        setenv(kRecordInner, Q3RT_BUILD_DIR "/renderer_q3stub_x86_64.so", 1);
    }
    void TearDown() override {
        fs::remove_all(folder);
        unsetenv(kRecordOut);
        unsetenv("Q3RT_RECORD_STARTED");
    }
    /// Loads the interposer around the stub; what follows goes into `file`.
    void startRecording(HeadlessEngine& engine, const fs::path& file) {
        setenv(kRecordOut, file.c_str(), 1);
        unsetenv("Q3RT_RECORD_STARTED");
        engine.showsMessages = false;
        engine.loadModule(Q3RT_BUILD_DIR "/renderer_q3trecord_x86_64.so");
    }
    fs::path folder;
    OneMap files;
};

void drawFrame(HeadlessEngine& engine, int number) {
    engine.clockMs = 100 + 50 * number;
    engine.enter([number](const refexport_t& module) {
        refEntity_t entity{};
        entity.hModel = 1;
        entity.customShader = 3;
        entity.origin[0] = static_cast<float>(number);
        polyVert_t poly[6] = {};
        refdef_t view{};
        view.x = 10;
        view.width = 300;
        view.height = 200;
        const float color[4] = {1, 0.5f, 0.25f, 1};
        vec3_t point = {1, 2, 3}, a, b, c;
        const vec3_t polygon[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        vec3_t points[16];
        markFragment_t fragments[4];
        orientation_t tag;
        module.BeginFrame(0);
        module.ClearScene();
        module.AddRefEntityToScene(&entity);
        module.AddPolyToScene(2, 3, poly, 2);
        module.AddLightToScene(point, 200, 1, 1, 1);
        module.AddAdditiveLightToScene(point, 100, 1, 0, 1);
        module.LightForPoint(point, a, b, c);
        module.MarkFragments(3, polygon, point, 16, points[0], 4, fragments);
        module.LerpTag(&tag, 1, 0, 1, 0.5f, "tag_head");
        module.ModelBounds(1, a, b);
        module.inPVS(a, b);
        module.RenderScene(&view);
        module.SetColor(color);
        module.DrawStretchPic(1, 2, 3, 4, 0, 0, 1, 1, 2);
        module.SetColor(nullptr);
    });
    engine.endFrame(false);
}

void playSession(HeadlessEngine& engine) {
    engine.beginRegistration();
    engine.enter([](const refexport_t& module) { module.RegisterShaderNoMip("white"); });
    drawFrame(engine, 0);
    engine.shutdown(false);
    engine.beginRegistration();
    engine.enter([](const refexport_t& module) {
        module.RegisterModel("models/m.md3");
        module.RegisterModel("models/absent.md3");
        module.RegisterSkin("models/m.skin");
        module.RegisterShader("gfx/a");
        module.RegisterShader("gfx/b");
        module.LoadWorld("maps/a.bsp");
        module.RemapShader("gfx/a", "gfx/b", nullptr);
        module.EndRegistration();
    });
    for (int i = 1; i <= 20; ++i)
        drawFrame(engine, i);
    engine.unloadModule();
}

/// The bytes of every frame's calls; cvars are the host's business and left out.
std::vector<std::vector<std::byte>> callsOf(const fs::path& path) {
    Recording recording(path);
    std::vector<std::vector<std::byte>> frames;
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        std::vector<std::byte>& bytes = frames.emplace_back();
        for (TraceEvent& event : recording.readFrame(i).events)
            if (!std::holds_alternative<event::CvarValue>(event)) encodeEvent(event, bytes);
    }
    return frames;
}

void replayAll(HeadlessEngine& engine, const fs::path& path, const Replayer::Options& options) {
    Recording recording(path);
    Replayer replayer(recording, engine, options);
    for (size_t i = 0; i < recording.frameCount(); ++i)
        replayer.play(recording.readFrame(i), Replayer::Draw::Frame);
    engine.unloadModule();
}

TEST_F(ReplayTest, RecordedAgainItIsTheSame) {
    const fs::path first = folder / "first.q3t", second = folder / "second.q3t";
    {
        HeadlessEngine engine(files);
        startRecording(engine, first);
        playSession(engine);
    }
    {
        HeadlessEngine engine(files);
        startRecording(engine, second);
        replayAll(engine, first, {});
    }
    const auto expected = callsOf(first), actual = callsOf(second);
    ASSERT_EQ(expected.size(), 21u);
    EXPECT_EQ(actual, expected);
    EXPECT_EQ(Recording(first).info().frameCount, 20u);
}

TEST_F(ReplayTest, PixelsScaleWithThePicture) {
    const fs::path first = folder / "first.q3t", second = folder / "second.q3t";
    {
        HeadlessEngine engine(files);
        startRecording(engine, first);
        playSession(engine);
    }
    {
        HeadlessEngine engine(files);
        startRecording(engine, second);
        replayAll(engine, first, {1280, 960, {}});
    }
    Recording recording(second);
    int views = 0;
    for (const TraceEvent& event : recording.readFrame(recording.frameCount() - 1).events) {
        if (const auto* scene = std::get_if<event::RenderScene>(&event)) {
            ++views;
            EXPECT_EQ(scene->view.x, 20);
            EXPECT_EQ(scene->view.width, 600);
            EXPECT_EQ(scene->view.height, 400);
        } else if (const auto* picture = std::get_if<event::DrawPicture>(&event)) {
            EXPECT_FLOAT_EQ(picture->x, 2);
            EXPECT_FLOAT_EQ(picture->height, 8);
        }
    }
    EXPECT_EQ(views, 1);
    EXPECT_EQ(recording.info().width, 1280);
}

TEST_F(ReplayTest, AnErrorInEveryImportWhileRecordingLeavesTheFileReadable) {
    int injected = 0;
    for (int n = 1;; ++n) {
        const fs::path file = folder / "broken.q3t";
        HeadlessEngine engine(files);
        startRecording(engine, file);
        engine.raiseErrorAtImport(n);
        bool failed = false;
        try {
            playSession(engine);
        } catch (const std::exception&) {
            failed = true;
        }
        engine.raiseErrorAtImport(0);
        engine.unloadModule();
        EXPECT_EQ(engine.heldResources(), "") << "after import " << n;
        EXPECT_NO_THROW(callsOf(file)) << "after import " << n;
        if (!failed) break;
        ++injected;
    }
    EXPECT_GE(injected, 20);
}

} // namespace
} // namespace q3rt
