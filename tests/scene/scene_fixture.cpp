#include "scene_fixture.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/log.hpp"
#include "formats/image.hpp"

namespace q3rt::test {
namespace {

std::vector<std::byte> makeTga(U8vec4 color) {
    constexpr int kSide = 2;
    std::vector<uint8_t> rgb(3 * kSide * kSide);
    for (size_t i = 0; i < rgb.size(); ++i) {
        rgb[i] = color[static_cast<int>(i % 3)];
    }
    return encodeTga24(kSide, kSide, rgb);
}

std::vector<std::byte> makeJpeg() {
    const std::vector<uint8_t> rgb(2 * 2 * 3, 128);
    return encodeJpeg(2, 2, rgb, 90);
}

bool endsWith(std::string_view text, std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

} // namespace

void MemoryFiles::addText(const std::string& name, std::string_view text) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    files[name].assign(bytes, bytes + text.size());
}

void MemoryFiles::addImage(const std::string& name, U8vec4 color) { files[name] = makeTga(color); }

std::optional<std::vector<std::byte>> MemoryFiles::read(std::string_view name) {
    const auto found = files.find(std::string(name));
    if (found == files.end()) return {};
    return found->second;
}

std::vector<std::string> MemoryFiles::list(std::string_view directory, std::string_view extension) {
    std::vector<std::string> names;
    const std::string prefix = std::string(directory) + "/";
    for (const auto& [name, bytes] : files) {
        if (name.compare(0, prefix.size(), prefix) == 0 && endsWith(name, extension)) {
            names.push_back(name.substr(prefix.size()));
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::optional<std::vector<std::byte>> TinyImageFiles::read(std::string_view name) {
    static const std::vector<std::byte> tga = makeTga({128, 128, 128, 255}), jpeg = makeJpeg();
    auto bytes = m_source.read(name);
    if (bytes && endsWith(name, ".tga")) return tga;
    if (bytes && endsWith(name, ".jpg")) return jpeg;
    return bytes;
}

std::vector<CensusRow> readSceneCensus() {
    std::ifstream file(Q3RT_SOURCE_DIR "/tests/scene/scene_census.csv");
    const auto readCells = [](const std::string& line) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) {
            cells.push_back(cell);
        }
        return cells;
    };
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> names = readCells(line);
    std::vector<CensusRow> rows;
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = readCells(line);
        CensusRow row;
        for (size_t i = 0; i < std::min(names.size(), cells.size()); ++i) {
            row[names[i]] = cells[i];
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

int censusNumber(const CensusRow& row, const std::string& column) { return std::stoi(row.at(column)); }

LogCapture::LogCapture() {
    clearLoggedOnce();
    setLogSink([this](LogLevel, std::string_view line) { m_lines.emplace_back(line); });
}

LogCapture::~LogCapture() { setLogSink({}); }

size_t LogCapture::count(std::string_view part) const {
    return static_cast<size_t>(std::count_if(
        m_lines.begin(), m_lines.end(), [&](const std::string& line) { return line.find(part) != std::string::npos; }));
}

} // namespace q3rt::test
