#include "bad_input.hpp"

#include <algorithm>
#include <map>

#include "baseq3-test/test_maps.hpp"
#include "formats/image.hpp"
#include "formats/pk3.hpp"
#include "support/run_program.hpp"
#include "support/tiny_files.hpp"
#include "trace/recording_writer.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;
using Files = std::map<std::string, Bytes>;

const std::string kMapFile = std::string("maps/") + kBadMap + ".bsp";

Bytes halfOf(const Bytes& bytes) { return {bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(bytes.size() / 2)}; }

Bytes bytesOf(const std::string& text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

/// Returns the archive.
fs::path makeGame(const fs::path& base, const Files& files) {
    const fs::path archive = base / "baseoa" / "pak0.pk3";
    fs::create_directories(archive.parent_path());
    writePk3(archive, {files.begin(), files.end()});
    return archive;
}

/// Bytes in the middle become others: packed data that unpacks to something else, or not at all.
Bytes spoiled(Bytes bytes, size_t at) {
    for (size_t i = at; i < std::min(at + 64, bytes.size()); ++i)
        bytes[i] ^= std::byte{0x5a};
    return bytes;
}

void makeGames(const fs::path& folder) {
    Files good;
    for (auto& [name, bytes] : buildTestGameFiles())
        good[name] = std::move(bytes);
    const Bytes archive = readFile(makeGame(folder / "good", good));
    fs::create_directories(folder / "none" / "baseoa");
    writeFile(folder / "cut_archive" / "baseoa" / "pak0.pk3", halfOf(archive));
    const Bytes name = bytesOf(kMapFile);
    const auto entry = std::search(archive.begin(), archive.end(), name.begin(), name.end());
    writeFile(folder / "spoiled_entry" / "baseoa" / "pak0.pk3",
              spoiled(archive, static_cast<size_t>(entry - archive.begin()) + name.size() + 100));
    Files files = good;
    files[kMapFile] = halfOf(good[kMapFile]);
    makeGame(folder / "cut_map", files);
    // The surface lump claims two gigabytes.
    files[kMapFile] = good[kMapFile];
    overwrite(files[kMapFile], 8 + 13 * 8 + 4, int32_t{0x7fffffff});
    makeGame(folder / "hostile_map", files);
    files[kMapFile] = {};
    makeGame(folder / "empty_map", files);
    files = good;
    files["textures/baseq3test/grey.tga"] = halfOf(good["textures/baseq3test/grey.tga"]);
    files["scripts/zz.shader"] = bytesOf("textures/zz\n{\n{\nmap\n{ { {\nunknownKeyword 1e999 \"");
    files["models/bad.md3"] = halfOf(makeTinyMd3());
    makeGame(folder / "spoiled_content", files);
}

void makeRecordings(const fs::path& folder) {
    {
        RecordingWriter writer(folder / "good.q3t");
        writer.add(event::BeginRegistration{64, 48, 4.0f / 3.0f});
        writer.add(event::LoadWorld{kMapFile});
        writer.add(event::EndRegistration{});
        for (int i = 0; i < 4; ++i) {
            writer.add(event::BeginFrame{0});
            writer.add(event::SetColor{1, {0.1f * static_cast<float>(i), 0, 0, 1}});
            writer.add(event::EndFrame{});
        }
        writer.finish();
    }
    const Bytes good = readFile(folder / "good.q3t");
    writeFile(folder / "cut.q3t", halfOf(good));
    writeFile(folder / "spoiled.q3t", spoiled(good, 60));
    writeFile(folder / "empty.q3t", {});
    writeFile(folder / "text.q3t", bytesOf(std::string(500, 'x')));
}

void makePictures(const fs::path& folder) {
    const std::vector<uint8_t> rgb(32 * 24 * 3, 90);
    const std::vector<float> floats(32 * 24 * 3, 0.5f);
    writeFile(folder / "good.png", encodePng(32, 24, 3, rgb));
    writeFile(folder / "small.png", encodePng(16, 24, 3, std::vector<uint8_t>(16 * 24 * 3)));
    writeFile(folder / "cut.png", halfOf(encodePng(32, 24, 3, rgb)));
    writeFile(folder / "cut.tga", halfOf(encodeTga24(32, 24, rgb)));
    writeFile(folder / "cut.pfm", halfOf(encodePfm(32, 24, floats)));
    Bytes jpeg = encodeJpeg(32, 24, rgb, 90);
    jpeg.resize(40);
    writeFile(folder / "cut.jpg", jpeg);
    writeFile(folder / "text.exr", bytesOf("no picture"));
}

} // namespace

void makeBadInput(const fs::path& folder) {
    makeGames(folder);
    makeRecordings(folder);
    makePictures(folder);
}

} // namespace q3rt::test
