#pragma once
// Where commands put their results: files that appear only when they are complete, in folders that are tried before the
// long work begins.

#include <filesystem>
#include <fstream>
#include <string>

namespace q3rt {

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
    void commit();

  private:
    std::filesystem::path m_path, m_temporary;
    bool m_committed = false;
};

/// Throws the UsageError that OutputFile would, and leaves nothing behind.
void checkWritable(const std::filesystem::path& file);

/// A folder for many files. If nothing was put into it and it wasn't there before, it goes with its owner.
class OutputFolder {
  public:
    /// Empty: none. Throws UsageError if it can't be made or written to.
    explicit OutputFolder(std::filesystem::path path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return m_path; }
    bool isWanted() const { return !m_path.empty(); }

  private:
    std::filesystem::path m_path;
    bool m_isNew = false;
};

/// A text file that is of use however long it got: a line a frame.
class LineFile {
  public:
    /// Empty: none. Throws UsageError if it can't be written.
    explicit LineFile(std::filesystem::path path);
    bool isWanted() const { return !m_path.empty(); }
    void append(const std::string& line);

  private:
    std::filesystem::path m_path;
    std::ofstream m_stream;
};

} // namespace q3rt
