#include "host/common/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
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

/// Its former writer took it away between our opening and our lock.
bool isRemoved(int file) {
    struct stat status {};
    return fstat(file, &status) == 0 && status.st_nlink == 0 && S_ISREG(status.st_mode);
}

/// Whatever name leads there: what is printed goes into the same file, behind what is already in it.
bool isStandardOutput(const fs::path& path) {
    struct stat named {
    }, printed{};
    return stat(path.c_str(), &named) == 0 && fstat(STDOUT_FILENO, &printed) == 0 && named.st_dev == printed.st_dev &&
           named.st_ino == printed.st_ino;
}

/// The file that a link names, so that the link stays when the file is replaced.
fs::path followLinks(const fs::path& path) {
    std::error_code error;
    const fs::path target = fs::canonical(path, error);
    return !error && fs::is_symlink(path) ? target : path;
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
    : m_path(followLinks(path))
    , m_temporary(m_path.string() + formatText(".%d.tmp", static_cast<int>(getpid())))
    , m_folders(m_path.parent_path(), m_path) {
    std::error_code ignored; // opening says what is wrong
    if (fs::is_directory(m_path, ignored) || !m_path.has_filename())
        throw UsageError(formatText("%s: is a folder; name a file in it", m_path.c_str()));
    m_isPrinted = isStandardOutput(m_path);
    if (m_isPrinted || (fs::exists(m_path, ignored) && !fs::is_regular_file(m_path, ignored))) {
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
    if (m_isPrinted) lseek(STDOUT_FILENO, 0, SEEK_END); // of a pipe it does nothing
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
    if (isStandardOutput(m_path)) {
        m_file.reset(dup(STDOUT_FILENO)); // one place in the file for both, where it has one
        m_isPrinted = true;
        return;
    }
    do {
        m_file.reset(open(m_path.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0666));
        if (m_file.number < 0) fail(m_path, std::strerror(errno));
        // Where a file system has no locks, or at a terminal, the lines go in all the same.
        if (flock(m_file.number, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            throw UsageError(formatText("%s: another run of q3rt is writing into it; wait for its end, or choose "
                                        "another file",
                                        m_path.c_str()));
    } while (isRemoved(m_file.number));
    m_isOutdated = old == Old::Replace && fs::is_regular_file(m_path);
}

LineFile::~LineFile() {
    std::error_code error;
    // Only its writer may remove it, and while the lock is held nobody else is one.
    if (m_file.number >= 0 && !m_isPrinted && fs::is_regular_file(m_path, error) && fs::file_size(m_path, error) == 0)
        fs::remove(m_path, error);
}

void LineFile::append(const std::string& line) {
    if (!isWanted()) return;
    if (m_isOutdated && ftruncate(m_file.number, 0) != 0) fail(m_path, std::strerror(errno));
    m_isOutdated = false;
    const std::string text = line + '\n';
    for (size_t written = 0; written < text.size();) {
        const ssize_t count = write(m_file.number, text.data() + written, text.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(m_path, std::strerror(errno));
        written += static_cast<size_t>(count);
    }
}

} // namespace q3rt
