#include "host/common/orphans.hpp"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <unistd.h>

namespace q3rt {

namespace fs = std::filesystem;

std::string nameOfProcess(const std::string& prefix) { return prefix + std::to_string(getpid()); }

std::vector<fs::path> listOrphans(const fs::path& folder, const std::string& prefix) {
    std::vector<fs::path> orphans;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(prefix)) continue;
        pid_t owner = 0;
        std::from_chars(name.data() + prefix.size(), name.data() + name.size(), owner);
        if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) orphans.push_back(entry->path());
    }
    return orphans;
}

} // namespace q3rt
