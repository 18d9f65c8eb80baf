// Archives and the search path over them.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/pk3_file_source.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;
using Entries = std::vector<std::pair<std::string, std::vector<std::byte>>>;

std::vector<std::byte> toBytes(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

std::string toText(const std::optional<std::vector<std::byte>>& bytes) {
    if (!bytes) return "(none)";
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

class Pk3Test : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "q3rt_pk3_XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        m_base = pattern;
        fs::create_directories(m_base / "game");
        clearLoggedOnce();
        setLogSink([this](LogLevel level, std::string_view line) {
            if (level == LogLevel::Warning) m_warnings.emplace_back(line);
        });
    }
    void TearDown() override {
        setLogSink({});
        fs::remove_all(m_base);
    }

    void writeArchive(const std::string& name, std::initializer_list<std::pair<const char*, const char*>> texts) {
        Entries entries;
        for (const auto& [entry, text] : texts)
            entries.emplace_back(entry, toBytes(text));
        writePk3(m_base / "game" / name, entries);
    }
    void writeFile(const fs::path& relative, std::string_view text) {
        fs::create_directories((m_base / relative).parent_path());
        std::ofstream(m_base / relative, std::ios::binary) << text;
    }
    Pk3FileSource open() const { return Pk3FileSource({m_base}, {"game"}); }

    fs::path m_base;
    std::vector<std::string> m_warnings;
};

TEST_F(Pk3Test, RoundTripKeepsNamesOrderAndBytes) {
    std::vector<std::byte> large(3000000);
    for (size_t i = 0; i < large.size(); ++i)
        large[i] = static_cast<std::byte>(i * i >> 7);
    const Entries entries{{"b/Second.txt", toBytes("two")}, {"a/first.bin", large}, {"empty", {}}};
    writePk3(m_base / "x.pk3", entries);
    const Pk3 archive(m_base / "x.pk3");
    ASSERT_EQ(archive.entries().size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(archive.entries()[i].name, entries[i].first);
        EXPECT_EQ(archive.entries()[i].size, entries[i].second.size());
        EXPECT_EQ(archive.read(i), entries[i].second);
    }
    EXPECT_EQ(archive.entries()[0].crc32, 0x11CA8A66u); // of "two", by zlib's crc32
}

TEST_F(Pk3Test, TheSameEntriesGiveTheSameArchive) {
    writeArchive("a.pk3", {{"x", "1"}, {"y", "2"}});
    writeArchive("b.pk3", {{"x", "1"}, {"y", "2"}});
    const auto read = [&](const char* name) {
        std::ifstream file(m_base / "game" / name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(read("a.pk3"), read("b.pk3"));
}

TEST_F(Pk3Test, AnUnwritableFolderIsNamedAndNothingIsLeft) {
    try {
        writePk3(m_base / "none" / "x.pk3", {});
        FAIL();
    } catch (const ContentError& error) {
        EXPECT_NE(std::string(error.what()).find("none/x.pk3"), std::string::npos);
    }
    EXPECT_FALSE(fs::exists(m_base / "none"));
}

TEST_F(Pk3Test, TheLastNameWinsAndLooseFilesWinOverAll) {
    writeArchive("pak0.pk3", {{"A.txt", "pak0"}, {"b.txt", "pak0"}, {"c.txt", "pak0"}});
    writeArchive("Pak1.pk3", {{"a.txt", "pak1"}, {"B.txt", "pak1"}});
    writeFile("game/a.txt", "loose");
    Pk3FileSource files = open();
    EXPECT_EQ(toText(files.read("a.TXT")), "loose");
    EXPECT_EQ(toText(files.read("/b.txt")), "pak1");
    EXPECT_EQ(toText(files.read("C.txt")), "pak0");
    EXPECT_EQ(files.read("d.txt"), std::nullopt);
    ASSERT_EQ(files.archives().size(), 2u);
    EXPECT_EQ(files.archives()[0]->path().filename(), "Pak1.pk3");
}

TEST_F(Pk3Test, LaterBasesAndGamesWin) {
    writeArchive("z.pk3", {{"a.txt", "z"}, {"b.txt", "z"}});
    writeFile("mod/a.txt", "mod");
    writeFile("home/game/b.txt", "home");
    Pk3FileSource files({m_base, m_base / "home"}, {"game", "mod", "absent"});
    EXPECT_EQ(toText(files.read("a.txt")), "mod");
    EXPECT_EQ(toText(files.read("b.txt")), "home");
}

TEST_F(Pk3Test, ListingIsByPriorityThenArchiveOrderWithoutDoubles) {
    writeArchive(
        "pak0.pk3",
        {{"scripts/z.shader", ""}, {"scripts/a.shader", ""}, {"scripts/x.txt", ""}, {"scripts/d/e.shader", ""}});
    writeArchive("pak1.pk3", {{"scripts/m.shader", ""}, {"SCRIPTS/A.shader", ""}, {"scripts2/n.shader", ""}});
    EXPECT_EQ(open().list("scripts", ".shader"),
              (std::vector<std::string>{"m.shader", "A.shader", "z.shader", "d/e.shader"}));
}

TEST_F(Pk3Test, OriginNamesArchiveAndChecksum) {
    writeArchive("pak0.pk3", {{"a/B.txt", "two"}});
    writeFile("game/loose.txt", "two");
    Pk3FileSource files = open();
    const auto packed = files.findOrigin("A/b.TXT");
    ASSERT_TRUE(packed);
    EXPECT_EQ(packed->container.filename(), "pak0.pk3");
    EXPECT_EQ(packed->name, "a/B.txt");
    EXPECT_EQ(packed->size, 3u);
    EXPECT_FALSE(packed->loose);
    const auto loose = files.findOrigin("loose.txt");
    ASSERT_TRUE(loose);
    EXPECT_TRUE(loose->loose);
    EXPECT_EQ(loose->crc32, packed->crc32);
    EXPECT_EQ(files.findOrigin("none"), std::nullopt);
}

TEST_F(Pk3Test, ADamagedArchiveIsNamedAndPassedOver) {
    writeArchive("pak0.pk3", {{"a.txt", "good"}});
    writeFile("game/pak1.pk3", "this is no zip archive");
    writeFile("game/pak2.pk3", "");
    Pk3FileSource files = open();
    EXPECT_EQ(toText(files.read("a.txt")), "good");
    ASSERT_EQ(files.damages().size(), 2u);
    EXPECT_NE(files.damages()[0].find("pak1.pk3"), std::string::npos);
    EXPECT_NE(files.damages()[1].find("pak2.pk3"), std::string::npos);
    EXPECT_TRUE(m_warnings.empty());
    EXPECT_EQ(files.archives().size(), 1u);
}

TEST_F(Pk3Test, ADamagedEntryFallsBackToTheNextCopy) {
    writeArchive("pak0.pk3", {{"a.txt", "older"}});
    writeArchive("pak1.pk3", {{"a.txt", "newer"}});
    // Behind the 30-byte local header and the name stands the packed text; its first byte is spoiled.
    std::fstream file(m_base / "game" / "pak1.pk3", std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(30 + 5);
    file.put('\xff');
    file.close();
    Pk3FileSource files = open();
    EXPECT_EQ(toText(files.read("a.txt")), "older");
    ASSERT_EQ(m_warnings.size(), 1u);
    EXPECT_NE(m_warnings[0].find("a.txt"), std::string::npos);
    EXPECT_THROW(files.readIntact("a.txt"), ContentError);
}

TEST_F(Pk3Test, ATruncationIsRefusedUnlessNothingIsMissing) {
    writeArchive("whole.pk3", {{"a.txt", "some text"}, {"b.txt", "more text"}});
    std::ifstream source(m_base / "game" / "whole.pk3", std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(source), {});
    size_t refusals = 0;
    for (size_t length = 0; length < whole.size(); ++length) {
        writeFile("cut.pk3", std::string_view(whole).substr(0, length));
        try {
            Pk3 archive(m_base / "cut.pk3");
            // The last bytes of the end record only give the length of a comment: without them nothing is missing.
            ASSERT_EQ(archive.entries().size(), 2u) << length;
            EXPECT_EQ(toText(archive.read(0)), "some text") << length;
            EXPECT_EQ(toText(archive.read(1)), "more text") << length;
        } catch (const ContentError&) {
            ++refusals;
        }
    }
    EXPECT_GE(refusals, whole.size() - 4);
}

} // namespace
} // namespace q3rt
