// What a module drew in the engine and what it draws from the recording is the same, byte for byte.

#include <gtest/gtest.h>

#include "engine_rig.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

struct Case {
    const char *name, *module, *demo;
    std::vector<std::string> settings;
    int count, every;
};

class LiveReplay : public testing::TestWithParam<Case> {};

TEST_P(LiveReplay, DrawsTheSameFrames) {
    if (const std::string why = whyNoEngine(Display::None); !why.empty()) GTEST_SKIP() << why;
    const Case& c = GetParam();
    const fs::path folder = makeScratchFolder("live replay");
    const std::string recording = (folder / "a.q3t").string(), every = std::to_string(c.every);
    std::vector<std::string> record = {
        "record",  "--demo", c.demo,  "--renderer", c.module,    "--size", "80x60", "--count", std::to_string(c.count),
        "--every", every,    "--out", recording,    "--pictures"};
    record.push_back((folder / "live").string());
    for (const std::string& setting : c.settings)
        record.insert(record.end(), {"--set", setting});
    const ProgramResult live = runQ3rt(record);
    if (live.errors.find("no Vulkan d") != std::string::npos) GTEST_SKIP() << live.errors;
    ASSERT_EQ(live.exitCode, 0) << live.errors;
    // Size and settings are those of the recording.
    const ProgramResult replayed = runQ3rt(
        {"replay", recording, "--renderer", c.module, "--every", every, "--out", (folder / "replayed").string()});
    ASSERT_EQ(replayed.exitCode, 0) << replayed.errors;
    int compared = 0;
    for (const fs::directory_entry& picture : fs::directory_iterator(folder / "live")) {
        const std::string name = picture.path().filename().string();
        EXPECT_EQ(readFile(picture.path()), readFile(folder / "replayed" / name)) << name;
        ++compared;
    }
    EXPECT_EQ(compared, (c.count + c.every - 1) / c.every);
}

// stress_sago's map has noise waves; rt_antialiasing draws upon the number of the picture.
INSTANTIATE_TEST_SUITE_P(
    Modules, LiveReplay,
    testing::Values(Case{"vk", "vk", "demo088-test1", {}, 120, 8}, Case{"vk_noise", "vk", "stress_sago", {}, 30, 5},
                    Case{"rt", "rt", "demo088-test1", {"rt_backend=compute"}, 12, 1},
                    Case{"rt_antialiased", "rt", "demo088-test1", {"rt_antialiasing=1", "rt_numRandomDL=2"}, 6, 1}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace q3rt::test
