// The files that are installed with the modules belong to the maps of the packages as they are.

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "scene/lost_lights.hpp"
#include "support/game_data.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

TEST(InstalledLights, AreWholeAndOfTheMapsThatAreThere) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    size_t checked = 0;
    for (const auto& entry : fs::directory_iterator(Q3RT_SOURCE_DIR "/renderer_rt/lights/baseoa")) {
        SCOPED_TRACE(entry.path());
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const LostLights lights = parseLostLights(text, entry.path().filename().string());
        EXPECT_EQ(lights.stage, 0u);
        const auto bytes = files->read("maps/" + entry.path().stem().string() + ".bsp");
        if (!bytes) continue; // other versions of the packages hold other maps
        EXPECT_EQ(lights.lightmap, lightmapFingerprint(parseBsp(*bytes, entry.path().stem().string())));
        ++checked;
    }
    EXPECT_GE(checked, 10u);
}

} // namespace
} // namespace q3rt
