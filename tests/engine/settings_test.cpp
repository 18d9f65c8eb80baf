// A text setting takes its words in any letter case; of another text the log says once what it takes.

#include "engine/settings.hpp"

#include <gtest/gtest.h>

#include "base/file_source.hpp"
#include "engine/setting_words.hpp"
#include "raster/test_services.hpp"

namespace q3rt::test {
namespace {

struct NoFiles : FileSource {
    std::optional<std::vector<std::byte>> read(std::string_view) override { return std::nullopt; }
    std::vector<std::string> list(std::string_view, std::string_view) override { return {}; }
};

class TextSetting : public testing::Test {
  protected:
    TextSetting() {
        clearLoggedOnce();
        setLogSink([this](LogLevel, std::string_view line) { m_lines.emplace_back(line); });
        m_binding.bind({"x_look", "plain", 0, 0, 0, "plain|bright|dark"}, &m_look);
        m_binding.bind({"x_name", "", 0, 0, 0, ""}, &m_name);
        m_binding.registerAll(m_engine);
    }
    ~TextSetting() override { setLogSink({}); }
    const std::string& lookOf(const char* text) {
        m_engine.setCvar("x_look", text);
        m_binding.refresh();
        return m_look;
    }
    NoFiles m_files;
    TestServices m_engine{m_files};
    SettingsBinding m_binding;
    std::string m_look, m_name;
    std::vector<std::string> m_lines;
};

TEST_F(TextSetting, IsAWordAsTheListSpellsIt) {
    EXPECT_EQ(m_look, "plain");
    EXPECT_EQ(lookOf("bright"), "bright");
    EXPECT_EQ(lookOf("DARK"), "dark");
    EXPECT_TRUE(m_lines.empty()) << m_lines.front();
}

TEST_F(TextSetting, OfAnotherTextIsTheDefaultAndIsNamedOnce) {
    EXPECT_EQ(lookOf("bright"), "bright");
    EXPECT_EQ(lookOf("shiny"), "plain");
    EXPECT_EQ(lookOf("shiny"), "plain");
    ASSERT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(m_lines[0], "x_look takes plain, bright or dark, not 'shiny'; as if it were plain");
    EXPECT_EQ(lookOf(""), "plain");
    EXPECT_EQ(m_lines.size(), 2u);
}

// The engine's own check of ranges lets this one through.
TEST_F(TextSetting, BesideItANumberIsOne) {
    float size = 0;
    m_binding.bind({"x_size", "2.5", 1, 4}, &size);
    m_binding.registerAll(m_engine);
    m_engine.setCvar("x_size", "nan");
    m_binding.refresh();
    EXPECT_EQ(size, 2.5f);
    ASSERT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(m_lines[0], "x_size takes numbers from 1 to 4, not 'nan'; as if it were 2.5");
}

TEST_F(TextSetting, WithoutWordsTakesAnyText) {
    m_engine.setCvar("x_name", "H200 | 2");
    m_binding.refresh();
    EXPECT_EQ(m_name, "H200 | 2");
    EXPECT_TRUE(m_lines.empty());
    EXPECT_EQ(complainOfWord("x_name", "", "anything"), "");
}

} // namespace
} // namespace q3rt::test
