// Every script of OpenArena compiles. Images are replaced by one texel of their own kind, so that only their presence
// matters here.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/log.hpp"
#include "formats/image.hpp"
#include "memory_files.hpp"
#include "scene/material.hpp"
#include "scene/stage_table.hpp"
#include "support/game_data.hpp"

namespace q3rt {
namespace {

/// The game's files, with a stand-in of one texel for each image that exists.
class TinyImages : public FileSource {
  public:
    explicit TinyImages(Pk3FileSource& files)
        : m_files(files) {
        const uint8_t texel[4] = {255, 128, 64, 255};
        m_png = encodePng(1, 1, 4, texel);
        m_jpeg = encodeJpeg(1, 1, std::span(texel).first(3), 90);
        m_tga = test::makeTga(1, 1, [](int, int) { return U8vec4(255, 128, 64, 255); });
    }
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        const std::vector<std::byte>* image = standIn(name);
        if (!image) return m_files.read(name);
        if (!m_files.findOrigin(name)) return std::nullopt;
        return *image;
    }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return m_files.list(directory, extension);
    }

  private:
    const std::vector<std::byte>* standIn(std::string_view name) const {
        if (name.ends_with(".tga")) return &m_tga;
        if (name.ends_with(".jpg") || name.ends_with(".jpeg")) return &m_jpeg;
        return name.ends_with(".png") ? &m_png : nullptr;
    }
    Pk3FileSource& m_files;
    std::vector<std::byte> m_png, m_jpeg, m_tga;
};

class OpenArena : public testing::Test {
  protected:
    void SetUp() override {
        m_files = test::openGameData();
        if (!m_files) GTEST_SKIP() << test::kNoGameData;
        setLogSink([this](LogLevel, std::string_view line) { m_lines.emplace_back(line); });
        m_images.emplace(*m_files);
        m_textures.emplace(*m_images, TextureSettings{});
        m_library.emplace(*m_images, *m_textures, MaterialSettings{});
        m_library->startVideo = [](std::string_view) { return 0; };
    }
    void TearDown() override { setLogSink({}); }

    std::unique_ptr<Pk3FileSource> m_files;
    std::optional<TinyImages> m_images;
    std::optional<TextureLibrary> m_textures;
    std::optional<MaterialLibrary> m_library;
    std::vector<std::string> m_lines;
};

bool isFinite(const StageState& state) {
    const auto finite = [](const auto& v) { return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v)); };
    for (const TextureUnitState& unit : state.unit)
        for (const TexModState& mod : unit.mods)
            if (!finite(mod.matrix) || !finite(mod.translate)) return false;
    return finite(state.color) && glm::all(glm::greaterThanEqual(state.color, vec4(0))) &&
           glm::all(glm::lessThanEqual(state.color, vec4(1)));
}

TEST_F(OpenArena, EveryScriptCompilesAndEvaluates) {
    const auto scripts = m_library->scripts().all();
    std::map<std::string, int> count;
    StageTable table(*m_library, *m_textures, 1.0f);
    for (const ScriptDefinition* script : scripts) {
        const MaterialId id = m_library->find(script->name, lightmapContext::kNone);
        const Material& material = m_library->get(id);
        ++count[script->failed ? "failed text" : material.isDefault ? "failed image" : "good"];
        count["emitters"] += material.light.surfaceLight > 0 ? 1 : 0;
        count["stages"] += static_cast<int>(material.stages.size());
        count["merged"] += !material.stages.empty() && material.stages[0].combine != Combine::Single;
        count["sky"] += material.isSky;
        for (const double time : {0.0, 0.013, 7.7, 3600.5, 1e6}) {
            StageInputs inputs;
            inputs.shaderTimeSeconds = time;
            table.beginFrame();
            const StageRange range = table.evaluate(id, inputs);
            ASSERT_EQ(range.count, material.stages.size());
            for (uint32_t i = 0; i < range.count; ++i) {
                EXPECT_TRUE(isFinite(table.states()[range.first + i])) << script->name << " at " << time;
                ++count["evaluated"];
            }
        }
    }
    for (const auto& [what, number] : count) {
        RecordProperty(what, number);
        printf("  %s: %d\n", what.c_str(), number);
    }
    printf("  messages: %zu\n", m_lines.size());
    EXPECT_EQ(scripts.size(), 2228u);
    EXPECT_EQ(count["good"] + count["failed text"] + count["failed image"], 2228);
    EXPECT_EQ(count["emitters"], 681);
}

} // namespace
} // namespace q3rt
