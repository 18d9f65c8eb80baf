// Recordings: what is written comes back, and no damaged file does more than fail with one line.

#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <unistd.h>

#include "base/error.hpp"
#include "trace/field_archive.hpp"
#include "trace/recording.hpp"
#include "trace/recording_writer.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

class RecordingTest : public testing::Test {
  protected:
    void SetUp() override {
        m_folder = fs::temp_directory_path() / ("q3rt_trace_test_" + std::to_string(getpid()));
        fs::create_directories(m_folder);
        path = m_folder / "a.q3t";
    }
    void TearDown() override { fs::remove_all(m_folder); }

    std::string contents() const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    size_t fileCount() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()));
    }
    fs::path path;

  private:
    fs::path m_folder;
};

void addFrame(RecordingWriter& writer, int clockMs) {
    writer.add(event::Clock{clockMs});
    writer.add(event::BeginFrame{0});
    writer.add(event::AddEntity{});
    event::RenderScene scene;
    scene.view.time = clockMs;
    writer.add(scene);
    writer.add(event::EndFrame{});
}

/// One of each kind of event, two loading frames, `frames` world frames.
void writeSample(const fs::path& path, int frames) {
    RecordingWriter writer(path);
    writer.setRenderer("device");
    writer.addFile({"maps/a.bsp", 7, 1234});
    writer.add(event::CvarValue{"r_gamma", "1.5", 0});
    writer.add(event::BeginRegistration{640, 480, 4.0f / 3});
    writer.add(event::Register{event::HandleKind::Shader, "white", 1});
    addFrame(writer, 0);
    writer.add(event::LoadWorld{"maps/a.bsp"});
    writer.add(event::RegisterFont{"fonts/x", 16});
    addFrame(writer, 1);
    writer.add(event::EndRegistration{});
    writer.add(event::AddPolys{1, 3, std::vector<polyVert_t>(6)});
    writer.add(event::AddLight{{1, 2, 3}, 200, {1, 1, 1}, 0});
    writer.add(event::SetColor{1, {1, 0.5f, 0, 1}});
    writer.add(event::DrawPicture{0, 0, 640, 480, 0, 0, 1, 1, 1});
    writer.add(event::Cinematic{1, 0, 0, 64, 64, 2, 2, 0, 1, -1, std::vector<uint8_t>(16, 9)});
    writer.add(event::MarkFragments{{{}, {}, {}}, {0, 0, -1}, 384, 128, {{}, {}, {}}, {{0, 3}}});
    writer.add(event::LerpTag{1, 0, 1, 0.25f, "tag_head", 1, {}});
    writer.add(event::ModelBounds{});
    writer.add(event::LightForPoint{});
    writer.add(event::RemapShader{"a", "b", "0.5", 1});
    writer.add(event::EntityToken{1, "classname"});
    writer.add(event::InPvs{});
    writer.add(event::CinematicPlay{"video/x.roq", 3});
    writer.add(event::CinematicRun{3, 1});
    writer.add(event::ClearScene{});
    for (int i = 0; i < frames; ++i)
        addFrame(writer, 2 + i);
    writer.add(event::Shutdown{1});
    writer.finish();
}

TEST_F(RecordingTest, EveryEventComesBack) {
    writeSample(path, 3);
    Recording recording(path);
    EXPECT_EQ(recording.info().map, "maps/a.bsp");
    EXPECT_EQ(recording.info().renderer, "device");
    EXPECT_EQ(recording.info().width, 640);
    EXPECT_EQ(recording.info().frameCount, 3u);
    EXPECT_EQ(recording.info().loadingFrameCount, 2u);
    ASSERT_EQ(recording.files().size(), 1u);
    EXPECT_EQ(recording.files()[0].bytes, 1234u);
    ASSERT_EQ(recording.frameCount(), 5u);
    std::set<size_t> kinds;
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        const Recording::Frame frame = recording.readFrame(i);
        EXPECT_EQ(frame.number, static_cast<int>(i) - 2 < 0 ? -1 : static_cast<int>(i) - 2);
        for (const TraceEvent& event : frame.events)
            kinds.insert(event.index());
        EXPECT_TRUE(std::holds_alternative<event::EndFrame>(frame.events.back()));
    }
    // All but Shutdown, which came after the last frame.
    EXPECT_EQ(kinds.size(), std::variant_size_v<TraceEvent> - 1);
    const Recording::Frame first = recording.readFrame(2);
    for (const TraceEvent& event : first.events)
        if (const auto* tag = std::get_if<event::LerpTag>(&event)) {
            EXPECT_EQ(tag->tag, "tag_head");
            EXPECT_EQ(tag->fraction, 0.25f);
        }
}

TEST_F(RecordingTest, ManyFramesSpanChunks) {
    constexpr int kFrames = 20000;
    writeSample(path, kFrames);
    Recording recording(path);
    ASSERT_EQ(recording.info().frameCount, static_cast<uint32_t>(kFrames));
    for (const size_t index : {size_t{2}, size_t{9999}, recording.frameCount() - 1}) {
        const Recording::Frame frame = recording.readFrame(index);
        EXPECT_EQ(std::get<event::Clock>(frame.events[frame.number == 0 ? frame.events.size() - 5 : 0]).ms,
                  2 + frame.number);
    }
}

TEST_F(RecordingTest, AStretchKeepsWhatItBuildsOn) {
    {
        RecordingWriter writer(path);
        writer.keepStretch(2, 3);
        writer.add(event::BeginRegistration{640, 480, 1});
        writer.add(event::LoadWorld{"maps/a.bsp"});
        writer.add(event::EndRegistration{});
        for (int i = 0; i < 10; ++i) {
            writer.add(event::Register{event::HandleKind::Shader, "s" + std::to_string(i), i + 1});
            addFrame(writer, i);
        }
        writer.finish();
    }
    Recording recording(path);
    EXPECT_EQ(recording.info().frameCount, 3u);
    int registered = 0, drawn = 0, firstNumber = -1;
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        const Recording::Frame frame = recording.readFrame(i);
        if (frame.number >= 0 && firstNumber < 0) firstNumber = frame.number;
        for (const TraceEvent& event : frame.events) {
            registered += std::holds_alternative<event::Register>(event);
            drawn += std::holds_alternative<event::RenderScene>(event);
        }
    }
    EXPECT_EQ(firstNumber, 2);
    EXPECT_EQ(registered, 10);
    EXPECT_EQ(drawn, 3);
}

TEST_F(RecordingTest, NothingIsLeftHalfWritten) {
    {
        RecordingWriter writer(path);
        addFrame(writer, 0);
        EXPECT_FALSE(fs::exists(path));
    }
    EXPECT_EQ(fileCount(), 0u);
    EXPECT_THROW(RecordingWriter("/nonexistent/folder/a.q3t"), UsageError);
}

/// All that a recording says; nullopt if its bytes were refused.
std::optional<std::vector<std::byte>> readAll(std::string bytes) {
    try {
        Recording recording(std::make_unique<std::istringstream>(std::move(bytes)), "damaged.q3t");
        std::vector<std::byte> read;
        Encoder encoder(read);
        TraceInfo info = recording.info();
        info.fields(encoder);
        for (TraceFile file : recording.files())
            file.fields(encoder);
        for (size_t i = 0; i < recording.frameCount(); ++i) {
            Recording::Frame frame = recording.readFrame(i);
            encoder(frame.number);
            for (TraceEvent& event : frame.events)
                encodeEvent(event, read);
        }
        return read;
    } catch (const ContentError& error) {
        EXPECT_TRUE(std::string_view(error.what()).starts_with("damaged.q3t: "));
        return std::nullopt;
    }
}

bool isRefused(std::string bytes) { return !readAll(std::move(bytes)); }

TEST_F(RecordingTest, EveryTruncationIsRefused) {
    writeSample(path, 3);
    const std::string whole = contents();
    EXPECT_FALSE(isRefused(whole));
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_TRUE(isRefused(whole.substr(0, length))) << length;
    RecordProperty("truncations", static_cast<int>(whole.size()));
}

// Every single bit. What the unpacker itself ignores changes nothing that is read.
TEST_F(RecordingTest, NoFlippedBitChangesWhatIsReadUnnoticed) {
    writeSample(path, 3);
    const std::string whole = contents();
    const auto read = readAll(whole);
    size_t ignored = 0;
    for (size_t bit = 0; bit < whole.size() * 8; ++bit) {
        std::string bytes = whole;
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
        const auto now = readAll(std::move(bytes));
        if (!now) continue;
        ++ignored;
        EXPECT_GE(bit / 8, sizeof(TraceHeader)) << "bit " << bit % 8;
        EXPECT_TRUE(now == read) << "byte " << bit / 8 << ", bit " << bit % 8;
    }
    EXPECT_LT(ignored, whole.size() * 8 / 100);
    RecordProperty("ignored", static_cast<int>(ignored));
}

TEST_F(RecordingTest, AnotherVersionIsNamed) {
    writeSample(path, 1);
    std::string bytes = contents();
    bytes[8] = 99;
    try {
        Recording recording(std::make_unique<std::istringstream>(bytes), "new.q3t");
        FAIL();
    } catch (const ContentError& error) {
        EXPECT_NE(std::string(error.what()).find("version 99"), std::string::npos);
    }
    EXPECT_THROW(Recording(fs::path("/nonexistent.q3t")), ContentError);
    EXPECT_THROW(Recording(fs::temp_directory_path()), ContentError);
}

TEST(TraceEvents, RandomBytesNeverPassForMoreThanTheyAre) {
    std::mt19937 random(2);
    int decoded = 0, refused = 0;
    constexpr int kCases = 20000;
    for (int i = 0; i < kCases; ++i) {
        std::vector<std::byte> bytes(random() % 200);
        for (std::byte& value : bytes)
            value = static_cast<std::byte>(random() % (i % 2 ? 256 : 28));
        size_t offset = 0;
        try {
            while (offset < bytes.size()) {
                decodeEvent(bytes, offset, "random");
                ++decoded;
            }
        } catch (const ContentError&) {
            ++refused;
        }
        EXPECT_LE(offset, bytes.size());
    }
    EXPECT_GT(decoded, 1000);
    EXPECT_GT(refused, 1000);
}

} // namespace
} // namespace q3rt
