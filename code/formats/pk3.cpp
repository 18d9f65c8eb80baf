#include "formats/pk3.hpp"

#include <minizip/unzip.h>
#include <minizip/zip.h>

#include <algorithm>
#include <system_error>

#include "base/error.hpp"

namespace q3rt {
namespace {

/// Deflate can't expand a byte to more than this many: a larger claim is a lie, found before memory is taken.
constexpr uint64_t kMaxDeflateRatio = 1032;

/// 1 January 1980, the earliest date a zip can hold: the same entries give the same archive on any day.
constexpr uLong kEarliestZipDate = (1UL << 21) | (1UL << 16);

[[noreturn]] void failArchive(const std::filesystem::path& path, const std::string& what) {
    throw ContentError(path.string() + ": " + what + "; the archive is damaged, get it again");
}

} // namespace

struct Pk3::Archive {
    unzFile file = nullptr;
    std::vector<unz64_file_pos> positions;

    ~Archive() {
        if (file) unzClose(file);
    }
};

Pk3::Pk3(const std::filesystem::path& path)
    : m_path(path)
    , m_archive(std::make_unique<Archive>()) {
    std::error_code error;
    const uint64_t archiveBytes = std::filesystem::file_size(path, error);
    if (error) throw ContentError(path.string() + ": can't be read (" + error.message() + ")");
    m_archive->file = unzOpen64(path.c_str());
    if (!m_archive->file) failArchive(path, "is no zip archive");
    for (int status = unzGoToFirstFile(m_archive->file); status != UNZ_END_OF_LIST_OF_FILE;
         status = unzGoToNextFile(m_archive->file)) {
        unz_file_info64 info{};
        if (status != UNZ_OK ||
            unzGetCurrentFileInfo64(m_archive->file, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
            failArchive(path, "its directory can't be read");
        std::string name(info.size_filename, '\0');
        if (unzGetCurrentFileInfo64(m_archive->file, nullptr, name.data(), name.size() + 1, nullptr, 0, nullptr, 0) !=
            UNZ_OK)
            failArchive(path, "its directory can't be read");
        if (info.compressed_size > archiveBytes || info.uncompressed_size / kMaxDeflateRatio > info.compressed_size)
            failArchive(path, "the sizes of " + name + " can't be true");
        unz64_file_pos position{};
        if (unzGetFilePos64(m_archive->file, &position) != UNZ_OK) failArchive(path, "its directory can't be read");
        m_entries.push_back({std::move(name), static_cast<uint32_t>(info.crc), info.uncompressed_size});
        m_archive->positions.push_back(position);
    }
}

Pk3::~Pk3() = default;
Pk3::Pk3(Pk3&&) noexcept = default;
Pk3& Pk3::operator=(Pk3&&) noexcept = default;

std::vector<std::byte> Pk3::read(size_t entryIndex) const {
    const Pk3Entry& entry = m_entries.at(entryIndex);
    const unzFile file = m_archive->file;
    if (unzGoToFilePos64(file, &m_archive->positions[entryIndex]) != UNZ_OK || unzOpenCurrentFile(file) != UNZ_OK)
        failArchive(m_path, entry.name + " can't be opened");
    std::vector<std::byte> bytes(static_cast<size_t>(entry.size));
    size_t done = 0;
    int status = 0;
    while (done < bytes.size()) {
        constexpr size_t kMaxPiece = size_t{1} << 30; // the library counts in int
        status = unzReadCurrentFile(file, bytes.data() + done,
                                    static_cast<unsigned>(std::min(bytes.size() - done, kMaxPiece)));
        if (status <= 0) break;
        done += static_cast<size_t>(status);
    }
    const int closed = unzCloseCurrentFile(file); // compares the checksum
    if (status < 0 || done != bytes.size() || closed != UNZ_OK)
        failArchive(m_path, entry.name + " can't be unpacked or fails its checksum");
    return bytes;
}

namespace {

void writeEntries(zipFile zip, const std::string& name,
                  const std::vector<std::pair<std::string, std::vector<std::byte>>>& entries) {
    for (const auto& [entry, bytes] : entries) {
        zip_fileinfo info{};
        info.dosDate = kEarliestZipDate;
        bool good = zipOpenNewFileInZip64(zip, entry.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                          Z_BEST_COMPRESSION, bytes.size() > 0xFFFFFFFEU) == ZIP_OK;
        for (size_t done = 0; good && done < bytes.size();) {
            const size_t piece = std::min(bytes.size() - done, size_t{1} << 30);
            good = zipWriteInFileInZip(zip, bytes.data() + done, static_cast<unsigned>(piece)) == ZIP_OK;
            done += piece;
        }
        if (!good || zipCloseFileInZip(zip) != ZIP_OK)
            throw ContentError(name + ": can't be written; is the disk full?");
    }
}

} // namespace

void writePk3(const std::filesystem::path& path,
              const std::vector<std::pair<std::string, std::vector<std::byte>>>& entries) {
    const std::string name = path.string();
    const zipFile zip = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
    if (!zip) throw ContentError(name + ": can't be written; is the folder writable?");
    try {
        writeEntries(zip, name, entries);
    } catch (...) {
        zipClose(zip, nullptr);
        throw;
    }
    if (zipClose(zip, nullptr) != ZIP_OK) throw ContentError(name + ": can't be written; is the disk full?");
}

} // namespace q3rt
