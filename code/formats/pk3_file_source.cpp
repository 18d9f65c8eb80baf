#include "formats/pk3_file_source.hpp"

#include <algorithm>
#include <fstream>
#include <span>
#include <system_error>
#include <unordered_set>

#include <zlib.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

/// How content names are compared: lower case, forward slashes, no slash in front.
std::string normalizeName(std::string_view name) {
    std::string key = toLowerAscii(name);
    std::replace(key.begin(), key.end(), '\\', '/');
    key.erase(0, std::min(key.find_first_not_of('/'), key.size()));
    return key;
}

std::optional<std::vector<std::byte>> readLooseFile(const fs::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return std::nullopt;
    std::vector<std::byte> bytes(static_cast<size_t>(file.tellg()));
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
        return std::nullopt;
    return bytes;
}

/// Relative paths of all files below `folder`, sorted so that runs on two machines agree.
std::vector<std::string> listLooseFiles(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end;
         !error && entry != end; entry.increment(error)) {
        std::error_code statusError;
        if (entry->is_regular_file(statusError))
            names.push_back(entry->path().lexically_relative(folder).generic_string());
    }
    if (error) logLine(LogLevel::Warning, "%s: can't be listed (%s)", folder.c_str(), error.message().c_str());
    std::sort(names.begin(), names.end());
    return names;
}

uint32_t checksum(std::span<const std::byte> bytes) {
    return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

long slashCount(std::string_view text) { return std::count(text.begin(), text.end(), '/'); }

} // namespace

Pk3FileSource::Pk3FileSource(const std::vector<fs::path>& baseFolders, const std::vector<std::string>& gameFolders) {
    for (const std::string& game : gameFolders) {
        for (const fs::path& base : baseFolders)
            addGameFolder(base / game);
    }
    std::reverse(m_containers.begin(), m_containers.end());
}

void Pk3FileSource::addGameFolder(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    std::vector<std::pair<std::string, fs::path>> archives;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::string name = toLowerAscii(entry->path().filename().string());
        if (name.ends_with(".pk3")) archives.emplace_back(std::move(name), entry->path());
    }
    if (error) logLine(LogLevel::Warning, "%s: can't be listed (%s)", folder.c_str(), error.message().c_str());
    std::sort(archives.begin(), archives.end());
    for (const auto& [name, path] : archives) {
        try {
            Container container{path, Pk3(path), {}, {}};
            for (const Pk3Entry& entry : container.archive->entries())
                container.names.push_back(entry.name);
            addContainer(std::move(container));
        } catch (const ContentError& damage) {
            m_damages.emplace_back(damage.what());
        }
    }
    addContainer({folder, std::nullopt, listLooseFiles(folder), {}});
}

void Pk3FileSource::addFolder(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    Container container{folder.parent_path(), std::nullopt, listLooseFiles(folder), {}};
    for (std::string& name : container.names)
        name = folder.filename().string() + "/" + name;
    addContainer(std::move(container));
    std::rotate(m_containers.begin(), m_containers.end() - 1, m_containers.end());
}

void Pk3FileSource::addContainer(Container container) {
    for (size_t i = 0; i < container.names.size(); ++i) {
        // Of two entries with one name the later one counts.
        if (!container.names[i].ends_with('/')) container.indexOfName[normalizeName(container.names[i])] = i;
    }
    m_containers.push_back(std::move(container));
}

std::optional<std::vector<std::byte>> Pk3FileSource::readFrom(const Container& container, size_t index) const {
    return container.archive ? container.archive->read(index) : readLooseFile(container.path / container.names[index]);
}

std::optional<std::vector<std::byte>> Pk3FileSource::readIntact(std::string_view name) {
    const std::string key = normalizeName(name);
    for (const Container& container : m_containers) {
        const auto found = container.indexOfName.find(key);
        if (found == container.indexOfName.end()) continue;
        if (auto bytes = readFrom(container, found->second)) return bytes;
    }
    return std::nullopt;
}

std::optional<std::vector<std::byte>> Pk3FileSource::read(std::string_view name) {
    const std::string key = normalizeName(name);
    for (const Container& container : m_containers) {
        const auto found = container.indexOfName.find(key);
        if (found == container.indexOfName.end()) continue;
        try {
            if (auto bytes = readFrom(container, found->second)) return bytes;
        } catch (const ContentError& damage) {
            logLineOnce(LogLevel::Warning, "%s; going on without it", damage.what());
        }
    }
    return std::nullopt;
}

std::vector<std::string> Pk3FileSource::list(std::string_view directory, std::string_view extension) {
    constexpr long kDeepestFolder = 2;
    std::string prefix = normalizeName(directory);
    if (!prefix.empty() && !prefix.ends_with('/')) prefix += '/';
    const std::string ending = toLowerAscii(extension);
    std::vector<std::string> names;
    std::unordered_set<std::string> listed;
    for (const Container& container : m_containers) {
        const long deepest = container.archive ? kDeepestFolder : 0;
        for (const std::string& stored : container.names) {
            const std::string key = normalizeName(stored);
            if (!key.starts_with(prefix) || !key.ends_with(ending) || key.ends_with('/')) continue;
            if (slashCount(key) - slashCount(prefix) > deepest) continue;
            if (listed.insert(key).second) names.push_back(stored.substr(stored.size() - (key.size() - prefix.size())));
        }
    }
    return names;
}

std::optional<Pk3FileSource::Origin> Pk3FileSource::findOrigin(std::string_view name) {
    const std::string key = normalizeName(name);
    for (const Container& container : m_containers) {
        const auto found = container.indexOfName.find(key);
        if (found == container.indexOfName.end()) continue;
        if (container.archive) {
            const Pk3Entry& entry = container.archive->entries()[found->second];
            return Origin{container.path, entry.name, entry.crc32, entry.size, false};
        }
        const auto bytes = readFrom(container, found->second);
        if (bytes) return Origin{container.path, container.names[found->second], checksum(*bytes), bytes->size(), true};
    }
    return std::nullopt;
}

std::vector<const Pk3*> Pk3FileSource::archives() const {
    std::vector<const Pk3*> found;
    for (const Container& container : m_containers) {
        if (container.archive) found.push_back(&*container.archive);
    }
    return found;
}

} // namespace q3rt
