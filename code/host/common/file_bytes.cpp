#include "host/common/file_bytes.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/error.hpp"
#include "host/common/output_file.hpp"

namespace q3rt {

namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void failToRead(const std::filesystem::path& path, const char* reason) {
    throw ContentError(formatText("%s: can't be read: %s; check the path", path.c_str(), reason));
}

[[noreturn]] void failToWrite(const std::filesystem::path& path, int error) {
    throw UsageError(formatText("%s: can't be written: %s; choose a folder with space and write permission",
                                path.c_str(), std::strerror(error)));
}

} // namespace

std::vector<std::byte> readFileBytes(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) failToRead(path, std::strerror(EISDIR));
    if (std::filesystem::is_character_file(path)) failToRead(path, "Is a device"); // which may have no end
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) failToRead(path, std::strerror(errno));
    std::vector<std::byte> bytes;
    for (size_t count = 1; count > 0;) {
        const size_t before = bytes.size();
        bytes.resize(before + (size_t(1) << 20));
        count = std::fread(bytes.data() + before, 1, bytes.size() - before, file.get());
        bytes.resize(before + count);
    }
    if (std::ferror(file.get()) != 0) failToRead(path, std::strerror(errno));
    return bytes;
}

void writeFileBytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    OutputFile output(path);
    File file(std::fopen(output.temporary().c_str(), "wb"));
    if (!file) failToWrite(path, errno);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    const bool closed = std::fclose(file.release()) == 0;
    if (!written || !closed) failToWrite(path, errno);
    output.commit();
}

} // namespace q3rt
