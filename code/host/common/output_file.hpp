#pragma once
// Where commands put their results: files that appear only when they are complete, in folders that are tried before the
// long work begins.

#include <filesystem>
#include <string>
#include <vector>

#include "host/common/descriptor.hpp"

namespace q3rt {

/// Makes the missing folders of a path; those that are still empty go with their owner.
class MadeFolders {
  public:
    /// Throws UsageError naming `result`, for which they are made.
    MadeFolders(const std::filesystem::path& folder, const std::filesystem::path& result);
    ~MadeFolders();
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;

  private:
    std::vector<std::filesystem::path> m_made; ///< outermost first
};

/// A place beside a file-to-be. What is there when the owner goes is removed; commit() gives it its name.
class OutputFile {
  public:
    /// Makes missing folders and tries to write. Throws UsageError naming the file and the system's reason.
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Where to write. Files whose names begin with this one are temporary too.
    const std::filesystem::path& temporary() const { return m_temporary; }
    /// A device, a pipe or standard output: what is written there is gone, and can't be read again.
    bool isStream() const { return m_temporary == m_path; }
    void commit();

  private:
    std::filesystem::path m_path, m_temporary;
    MadeFolders m_folders;
    bool m_isPrinted = false; ///< the file is standard output
    bool m_committed = false;
};

/// Throws the UsageError that OutputFile would, and leaves nothing behind.
void checkWritable(const std::filesystem::path& file);

/// A folder for many files.
class OutputFolder {
  public:
    /// Empty: none. Throws UsageError if it can't be made or written to.
    explicit OutputFolder(std::filesystem::path path);
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return m_path; }
    bool isWanted() const { return !m_path.empty(); }

  private:
    std::filesystem::path m_path;
    MadeFolders m_folders;
};

/// A text file that is of use however long it got: a line a frame. Without any line what was there before stays, or
/// nothing.
class LineFile {
  public:
    enum class Old { Replace, Continue };
    /// Empty: none. Throws UsageError if it can't be written, or if another run of q3rt is writing into it.
    explicit LineFile(std::filesystem::path path, Old old = Old::Replace);
    ~LineFile();
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;
    bool isWanted() const { return !m_path.empty(); }
    /// At once in the file, whatever happens to the program next.
    void append(const std::string& line);

  private:
    std::filesystem::path m_path;
    MadeFolders m_folders;
    Descriptor m_file;         ///< locked: two writers would each add the same lines
    bool m_isPrinted = false;  ///< the file is standard output
    bool m_isOutdated = false; ///< what is in it goes when the first line comes
};

} // namespace q3rt
