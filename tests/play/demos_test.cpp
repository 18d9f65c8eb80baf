// Every demo that OpenArena brings: recorded to its end, with the number of frames that the engine itself reports; and
// played.

#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine_rig.hpp"

namespace q3rt::test {
namespace {

struct Demo {
    const char* name;
    int frames;
};
constexpr Demo kDemos[] = {{"demo088-test1", 3398}, {"flyby_compromise", 1408}, {"flyby_hydronex", 997},
                           {"flyby_oaspirit", 811}, {"flyby_oa_dm3", 1139},     {"flyby_suspended", 608},
                           {"stress_bases3", 802},  {"stress_sago", 744},       {"stress_q3dm6ishv2", 826}};

class Demos : public testing::TestWithParam<Demo> {};

TEST_P(Demos, IsRecordedToItsEndAndPlayed) {
    if (const std::string why = whyNoEngine(Display::None); !why.empty()) GTEST_SKIP() << why;
    const Demo& demo = GetParam();
    const std::filesystem::path folder = makeScratchFolder("demos");
    const std::string recording = (folder / "a.q3t").string();
    const ProgramResult recorded = runQ3rt({"record", "--demo", demo.name, "--out", recording, "--json"});
    ASSERT_EQ(recorded.exitCode, 0) << recorded.errors;
    EXPECT_EQ(nlohmann::json::parse(recorded.output)["frames"], demo.frames);
    const ProgramResult played =
        runQ3rt({"play", "--demo", demo.name, "--headless", "--renderer", "null", "--frames", "20", "--json"});
    ASSERT_EQ(played.exitCode, 0) << played.errors;
    EXPECT_EQ(nlohmann::json::parse(played.output)["frames"], 20);
}

INSTANTIATE_TEST_SUITE_P(All, Demos, testing::ValuesIn(kDemos), [](const auto& info) {
    std::string name = info.param.name;
    std::erase(name, '-');
    return name;
});

TEST(Demos, ArePlayedInAWindow) {
    if (const std::string why = whyNoEngine(Display::X11); !why.empty()) GTEST_SKIP() << why;
    const std::filesystem::path folder = makeScratchFolder("window");
    const std::string program = std::string(Q3RT_BUILD_DIR) + "/q3rt", out = (folder / "out").string();
    const std::string command = "timeout 300 xvfb-run -a '" + program +
                                "' play --demo demo088-test1 --renderer vk --size 160x120 --frames 5 --every 4 --json" +
                                " --out '" + out + "' --set s_initsound=0 >'" + (folder / "stdout").string() + "' 2>'" +
                                (folder / "stderr").string() + "' </dev/null";
    const int status = std::system(command.c_str());
    const std::vector<std::byte> errors = readFile(folder / "stderr");
    const std::string_view shown(reinterpret_cast<const char*>(errors.data()), errors.size());
    if (shown.find("no Vulkan d") != std::string_view::npos) GTEST_SKIP() << shown;
    ASSERT_EQ(status, 0) << shown;
    const auto summary = nlohmann::json::parse(readFile(folder / "out" / "summary.json"));
    EXPECT_EQ(summary["frames"], 5);
    EXPECT_EQ(summary["pictures"], 2);
}

TEST(Demos, WhoseMapIsMissingFailsInOneLine) {
    if (const std::string why = whyNoEngine(Display::None); !why.empty()) GTEST_SKIP() << why;
    const std::filesystem::path folder = makeScratchFolder("demos");
    const ProgramResult result = runQ3rt({"record", "--demo", "stress_schism", "--out", (folder / "a.q3t").string()});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("schism-b2")) << result.errors;
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Demos, SettingsThatTheRendererRefusesAreSaid) {
    if (const std::string why = whyNoEngine(Display::None); !why.empty()) GTEST_SKIP() << why;
    const ProgramResult result = runQ3rt({"play", "--demo", "demo088-test1", "--headless", "--renderer", "vk", "--size",
                                          "64x48", "--frames", "1", "--set", "r_display=15"});
    if (result.errors.find("no Vulkan d") != std::string::npos) GTEST_SKIP() << result.errors;
    EXPECT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_NE(result.errors.find("q3rt: r_display 15: "), std::string::npos) << result.errors;
}

} // namespace
} // namespace q3rt::test
