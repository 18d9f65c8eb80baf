// Settings that change the picture, each beside the original's with the same setting.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "support/game_data.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {

namespace {

struct Case {
    const char* name;     ///< of the test
    const char* map;      ///< that shows the setting's effect
    const char* settings; ///< CVAR=VALUE, parted by spaces
    bool quick = false;   ///< also without Q3RT_LONG_TESTS
};

std::ostream& operator<<(std::ostream& out, const Case& each) { return out << each.settings; }

const Case kCases[] = {
    {"Ramp", "oa_dm1", "r_ignorehwgamma=0 r_gamma=1.6", true},
    {"FullScreen", "oa_dm1", "r_ignorehwgamma=0 r_fullscreen=1", true},
    {"FullScreenTwoBits", "oa_shouse", "r_ignorehwgamma=0 r_fullscreen=1 r_overBrightBits=2 r_gamma=1.3"},
    {"BakedGamma", "oa_dm1", "r_gamma=1.6"},
    {"MapOverBright", "oa_dm1", "r_mapOverBrightBits=1"},
    {"Intensity", "oa_dm1", "r_intensity=2"},
    {"Picmip", "oa_dm1", "r_picmip=3"},
    {"RoundImagesUp", "oa_dm1", "r_roundImagesDown=0"},
    {"Nearest", "oa_dm1", "r_textureMode=GL_NEAREST"},
    {"Grey", "oa_dm1", "r_greyscale=1"},
    {"Lightmap", "oa_dm1", "r_lightmap=1"},
    {"LightmapAsHue", "oa_dm1", "r_lightmap=2 r_ignorehwgamma=1"},
    {"VertexLight", "oa_dm1", "r_vertexLight=1"},
    {"FullBright", "oa_dm1", "r_fullbright=1"},
    {"NoDetail", "oa_dm1", "r_detailtextures=0"},
    {"Subdivisions", "oa_dm1", "r_subdivisions=40"},
    {"NoCurves", "oa_dm1", "r_nocurves=1"},
    {"NoVisibility", "oa_dm1", "r_novis=1"},
    {"FastSky", "oa_dm2", "r_fastsky=1"},
    {"SingleShader", "oa_dm1", "r_singleShader=1"},
    {"Anaglyph", "oa_dm1", "r_anaglyphMode=4", true},
    {"AnaglyphExchanged", "oa_shouse", "r_anaglyphMode=6"},
};

class SettingParity : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(SettingParity, LooksLikeTheOriginal) {
    const Case& each = GetParam();
    if (!each.quick && !std::getenv("Q3RT_LONG_TESTS")) GTEST_SKIP() << "Q3RT_LONG_TESTS=1 compares this setting too";
    if (!findGameFolder()) GTEST_SKIP() << kNoGameData;
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed";
    const std::filesystem::path folder = makeScratchFolder(each.name);
    std::istringstream words(each.settings);
    std::string sets, word;
    while (words >> word)
        sets += " --set " + word;
    // A display of the picture's size: full screen needs no other mode.
    const std::string command = "xvfb-run -a -s '-screen 0 320x240x24' " + std::string(Q3RT_BUILD_DIR) +
                                "/compare_rasters --out '" + folder.string() + "' --map " + each.map +
                                " --cameras 1 --size 320x240" + sets + " >'" + (folder / "log").string() + "' 2>&1";
    if (std::system(command.c_str()) == 0) return;
    std::ifstream log(folder / "log");
    ADD_FAILURE() << command << "\n" << std::string(std::istreambuf_iterator<char>(log), {});
}

INSTANTIATE_TEST_SUITE_P(Settings, SettingParity, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace q3rt::test
