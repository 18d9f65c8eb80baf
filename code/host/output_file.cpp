#include "host/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <vector>

#include "base/error.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* reason) {
    throw UsageError(
        formatText("%s: can't be written: %s; choose a folder with space and write permission", path.c_str(), reason));
}

} // namespace

OutputFile::OutputFile(fs::path path)
    : m_path(std::move(path))
    , m_temporary(m_path.string() + formatText(".%d.tmp", static_cast<int>(getpid()))) {
    std::error_code ignored; // what follows says what is wrong
    if (m_path.has_parent_path()) fs::create_directories(m_path.parent_path(), ignored);
    if (fs::is_directory(m_path, ignored)) fail(m_path, std::strerror(EISDIR));
    const int file = open(m_temporary.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) fail(m_path, std::strerror(errno));
    close(file);
}

OutputFile::~OutputFile() {
    if (m_committed) return;
    const fs::path folder = m_temporary.has_parent_path() ? m_temporary.parent_path() : fs::path(".");
    const std::string name = m_temporary.filename().string();
    std::error_code error;
    std::vector<fs::path> left;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().filename().string().starts_with(name)) left.push_back(entry->path());
    for (const fs::path& file : left)
        fs::remove(file, error);
}

void OutputFile::commit() {
    if (std::rename(m_temporary.c_str(), m_path.c_str()) != 0) fail(m_path, std::strerror(errno));
    m_committed = true;
}

void checkWritable(const fs::path& file) { const OutputFile trial(file); }

OutputFolder::OutputFolder(fs::path path)
    : m_path(std::move(path)) {
    if (m_path.empty()) return;
    std::error_code error;
    m_isNew = fs::create_directories(m_path, error);
    if (error) fail(m_path, error.message().c_str());
    checkWritable(m_path / "q3rt");
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    if (m_isNew) fs::remove(m_path, ignored); // fails where something is in it
}

LineFile::LineFile(fs::path path)
    : m_path(std::move(path)) {
    if (m_path.empty()) return;
    m_stream.open(m_path);
    if (!m_stream) fail(m_path, std::strerror(errno));
}

void LineFile::append(const std::string& line) {
    if (isWanted() && !(m_stream << line << '\n')) fail(m_path, std::strerror(errno));
}

} // namespace q3rt
