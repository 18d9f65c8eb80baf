// Writes the seed corpus: one folder a fuzz target. The tiny files always; small pieces of the game's own data where
// that is installed. Usage: make_corpus FOLDER

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "formats/bsp.hpp"
#include "formats/image.hpp"
#include "formats/pk3.hpp"
#include "formats/text_case.hpp"
#include "support/bone_models.hpp"
#include "support/game_data.hpp"
#include "support/tiny_files.hpp"
#include "trace/recording_writer.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

constexpr size_t kSeedsOfAKind = 12;
constexpr size_t kMaxSeedBytes = 24000; ///< larger ones make a fuzzer slow without showing it anything new

Bytes toBytes(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

class Corpus {
  public:
    explicit Corpus(fs::path folder)
        : m_folder(std::move(folder)) {}

    void add(const std::string& target, const Bytes& seed) {
        fs::create_directories(m_folder / target);
        const std::string name = formatText("seed%03zu", m_count++);
        std::ofstream file(m_folder / target / name, std::ios::binary);
        if (!file.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size())))
            throw ContentError((m_folder / target / name).string() + ": can't be written; is the folder writable?");
    }

    size_t count() const { return m_count; }
    const fs::path& folder() const { return m_folder; }

  private:
    fs::path m_folder;
    size_t m_count = 0;
};

void addTinyFiles(Corpus& corpus) {
    corpus.add("bsp", TinyBsp().build());
    corpus.add("md3", makeTinyMd3());
    BarOptions bar;
    corpus.add("mdr", makeBarMdr(bar));
    corpus.add("iqm", makeBarIqm(bar));
    bar.compressed = bar.colors = bar.floatWeights = true;
    bar.lods = 2;
    corpus.add("mdr", makeBarMdr(bar));
    corpus.add("iqm", makeBarIqm(bar));
    corpus.add("font", makeFont());
    corpus.add("skin", toBytes("h_head,models/a.tga\ntag_weapon,\n\"l legs\" , \"b\" // c\n"));
    corpus.add("entities",
               toBytes("{ \"classname\" \"light\" \"origin\" \"1 -2 3e4\" /* c */ \"light\" \"300\" }\n{ }"));
    corpus.add(
        "lost_lights",
        toBytes("// c\n{ \"classname\" \"worldspawn\" \"_lightmap\" \"0123\" \"_compensate\" \"2.5\" \"_bounce\" "
                "\"0.5\" \"_stage\" \"2 64\" \"ambient\" \"4\" \"_color\" \"1 .5 0\"\n\"q3map_surfacelight a/b\" "
                "\"400 1 .5 0\" \"q3map_skylight c\" \"90 1 1 1\" \"q3map_sun\" \"1 1 .5 90 30 60 2\" }\n"
                "{ \"classname\" \"light\" \"origin\" \"1 -2 3e4\" \"light\" \"300\" \"target\" \"t\" \"radius\" "
                "\"64\" }\n{ \"targetname\" \"t\" \"origin\" \"0 0 0\" }\n"));
    corpus.add("script",
               toBytes("a/b\n{\n surfaceparm fog\n fogparms ( 1 .5 0 ) 300\n deformVertexes wave 100 sin 0 1 0 2\n"
                       " skyparms env/a 512 -\n q3map_sun 1 1 1 100 90 45\n {\n map $lightmap\n blendFunc GL_ONE "
                       "GL_ZERO\n rgbGen wave sin 0 1 0 1\n tcMod turb 0 1 0 1\n alphaGen const .5\n tcGen vector "
                       "( 1 0 0 ) ( 0 1 0 )\n animMap 10 a b c\n }\n}\n"));
    corpus.add("tga", makeTga(2, 2, 2, 24, std::vector<uint8_t>(12, 7)));
    corpus.add("tga", makeTga(2, 1, 2, 32, std::vector<uint8_t>(8, 7), 0x20));
    corpus.add("tga", makeTga(3, 2, 2, 8, {1, 2, 3, 4}));
    corpus.add("tga", makeTga(10, 2, 2, 24, {0x82, 1, 2, 3, 0x03, 4, 5, 6, 7, 8, 9}));
    corpus.add("pcx", makePcx(2, 2, {5, 0xC3, 200}));
    corpus.add("bmp", makeBmp(1, 2, 24, {1, 2, 3, 0, 4, 5, 6, 0}));
    corpus.add("bmp", makeBmp(1, 1, 32, {1, 2, 3, 4}));
    corpus.add("bmp", makeBmp(2, 2, 8, std::vector<uint8_t>(1024 + 8, 3)));
    const std::vector<uint8_t> pixels(16 * 16 * 3, 90);
    corpus.add("jpg", encodeJpeg(16, 16, pixels, 90));
    corpus.add("jpg", encodeJpeg(16, 16, pixels, 50));
    corpus.add("png", encodePng(16, 16, 3, pixels));
    corpus.add("png", encodePng(12, 16, 4, pixels));
    corpus.add("pfm", encodePfm(1, 2, std::vector<float>{1, 2, 3, 4, 5, 6}));
}

void addArchive(Corpus& corpus) {
    const fs::path path = corpus.folder() / "seed.pk3";
    writePk3(path,
             {{"scripts/a.shader", toBytes("a { { map b } }")}, {"empty", {}}, {"large", Bytes(20000, std::byte{65})}});
    std::ifstream file(path, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    corpus.add("pk3", toBytes(text));
    fs::remove(path);
}

/// A map without the lumps that only hold plain bytes: small enough for a fuzzer, with real cross-references.
Bytes cutMap(const Bytes& file) {
    constexpr size_t kLumpCount = 17;
    TinyBsp cut;
    uint32_t directory[kLumpCount][2];
    std::memcpy(directory, file.data() + 8, sizeof(directory));
    for (size_t i = 0; i < kLumpCount; ++i) {
        const auto first = file.begin() + directory[i][0];
        cut.lumps[i].assign(first, first + directory[i][1]);
    }
    for (const size_t lump : {size_t{14}, size_t{15}})
        cut.lumps[lump].clear();
    return cut.build();
}

/// The smallest files of a type, no two of one size.
void addSmallest(Corpus& corpus, Pk3FileSource& files, const std::string& extension, const std::string& target) {
    std::set<uint64_t> sizes;
    std::vector<std::tuple<uint64_t, const Pk3*, size_t>> found;
    for (const Pk3* archive : files.archives()) {
        for (size_t i = 0; i < archive->entries().size(); ++i) {
            const Pk3Entry& entry = archive->entries()[i];
            if (toLowerAscii(entry.name).ends_with(extension) && entry.size <= kMaxSeedBytes &&
                sizes.insert(entry.size).second)
                found.emplace_back(entry.size, archive, i);
        }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
    // Spread over the sizes: the smallest alone would all be of one sort.
    const size_t step = std::max<size_t>(1, found.size() / kSeedsOfAKind);
    for (size_t i = 0; i < found.size(); i += step)
        corpus.add(target, std::get<1>(found[i])->read(std::get<2>(found[i])));
}

void addGameData(Corpus& corpus, Pk3FileSource& files) {
    const std::pair<const char*, const char*> kinds[] = {{".md3", "md3"}, {".shader", "script"}, {".skin", "skin"},
                                                         {".tga", "tga"}, {".jpg", "jpg"},       {".png", "png"},
                                                         {".pcx", "pcx"}};
    for (const auto& [extension, target] : kinds)
        addSmallest(corpus, files, extension, target);
    for (const char* map : {"maps/fan.bsp", "maps/oa_bases3cl.bsp"}) {
        const auto file = files.read(map);
        if (!file) continue;
        corpus.add("bsp", cutMap(*file));
        const std::string entities = parseBsp(*file, map).entities;
        corpus.add("entities", toBytes(std::string_view(entities).substr(0, kMaxSeedBytes)));
    }
}

/// A whole small recording, and its events bare: the target reads either.
void addRecording(Corpus& corpus, const fs::path& folder) {
    const fs::path path = folder / "seed.q3t";
    fs::create_directories(folder);
    std::vector<std::byte> bare;
    {
        RecordingWriter writer(path);
        const auto add = [&](TraceEvent event) {
            encodeEvent(event, bare);
            writer.add(std::move(event));
        };
        add(event::BeginRegistration{640, 480, 1});
        add(event::Register{event::HandleKind::Model, "models/m.md3", 1});
        add(event::LoadWorld{"maps/a.bsp"});
        add(event::EndRegistration{});
        add(event::AddEntity{});
        add(event::AddPolys{1, 3, std::vector<polyVert_t>(3)});
        add(event::MarkFragments{{{}, {}, {}}, {0, 0, -1}, 384, 128, {{}}, {{0, 1}}});
        add(event::Cinematic{1, 0, 0, 8, 8, 1, 1, 0, 1, -1, std::vector<uint8_t>(4)});
        add(event::RenderScene{});
        add(event::EndFrame{});
        writer.addFile({"maps/a.bsp", 1, 2});
        writer.finish();
    }
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    corpus.add("recording", toBytes(bytes));
    corpus.add("recording", bare);
    file.close();
    fs::remove(path);
}

int run(const fs::path& folder) {
    try {
        fs::remove_all(folder);
        Corpus corpus(folder);
        addTinyFiles(corpus);
        addArchive(corpus);
        addRecording(corpus, folder);
        if (const auto files = openGameData()) addGameData(corpus, *files);
        std::printf("%zu seeds in %s\n", corpus.count(), folder.c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}

} // namespace
} // namespace q3rt::test

int main(int argumentCount, char** arguments) {
    if (argumentCount != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", arguments[0]);
        return 2;
    }
    return q3rt::test::run(arguments[1]);
}
