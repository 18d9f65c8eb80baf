#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "formats/pk3.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

namespace {

/// A file that lives in memory: archives are opened by path.
class MemoryFile {
  public:
    MemoryFile(const uint8_t* data, size_t size)
        : m_descriptor(memfd_create("input.pk3", 0)) {
        fuzz::require(m_descriptor >= 0);
        fuzz::require(write(m_descriptor, data, size) == static_cast<ssize_t>(size));
    }
    ~MemoryFile() { close(m_descriptor); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(m_descriptor); }

  private:
    int m_descriptor;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const MemoryFile file(data, size);
    return fuzz::runParser([&] {
        const Pk3 archive(file.path());
        for (size_t i = 0; i < archive.entries().size(); ++i) {
            fuzz::require(archive.read(i).size() == archive.entries()[i].size);
        }
    });
}
