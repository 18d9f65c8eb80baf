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

MadeFolders::MadeFolders(const fs::path& folder, const fs::path& result) {
    fs::path path;
    for (const fs::path& part : folder) {
        path /= part;
        std::error_code error;
        if (fs::create_directory(path, error)) m_made.push_back(path);
        if (error) fail(result, error.message().c_str());
    }
}

MadeFolders::~MadeFolders() {
    std::error_code ignored; // of folders that something is in
    for (size_t i = m_made.size(); i-- > 0;)
        fs::remove(m_made[i], ignored);
}

OutputFile::OutputFile(fs::path path)
    : m_path(std::move(path))
    , m_temporary(m_path.string() + formatText(".%d.tmp", static_cast<int>(getpid())))
    , m_folders(m_path.parent_path(), m_path) {
    std::error_code ignored; // opening says what is wrong
    if (fs::is_directory(m_path, ignored)) fail(m_path, std::strerror(EISDIR));
    if (fs::exists(m_path, ignored) && !fs::is_regular_file(m_path, ignored)) {
        // A device or a pipe (/dev/null, /dev/stdout) takes what is written and must not be replaced.
        m_temporary = m_path;
        m_committed = true;
        return;
    }
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
    if (m_committed) return;
    if (std::rename(m_temporary.c_str(), m_path.c_str()) != 0) fail(m_path, std::strerror(errno));
    m_committed = true;
}

void checkWritable(const fs::path& file) { const OutputFile trial(file); }

OutputFolder::OutputFolder(fs::path path)
    : m_path(std::move(path))
    , m_folders(m_path, m_path) {
    if (isWanted()) checkWritable(m_path / "q3rt");
}

LineFile::LineFile(fs::path path, Old old)
    : m_path(std::move(path))
    , m_folders(m_path.parent_path(), m_path) {
    if (!isWanted()) return;
    m_stream.open(m_path, old == Old::Continue ? std::ios::app : std::ios::trunc);
    if (!m_stream) fail(m_path, std::strerror(errno));
}

LineFile::~LineFile() {
    std::error_code error;
    if (isWanted() && fs::is_regular_file(m_path, error) && fs::file_size(m_path, error) == 0)
        fs::remove(m_path, error);
}

void LineFile::append(const std::string& line) {
    if (isWanted() && !(m_stream << line << '\n' << std::flush)) fail(m_path, std::strerror(errno));
}

} // namespace q3rt
