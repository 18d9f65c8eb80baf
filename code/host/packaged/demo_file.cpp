#include <cstring>

#include "base/error.hpp"
#include "host/packaged/engine_process.hpp"

namespace q3rt {
namespace {

/// A demo is a row of messages: a sequence number, a length, the bytes. Length -1 ends it. The first message is the
/// game state, each later one a snapshot.
size_t countSnapshots(const std::vector<std::byte>& demo) {
    size_t count = 0;
    for (size_t at = 0; at + 8 <= demo.size(); ++count) {
        int32_t length = 0;
        std::memcpy(&length, demo.data() + at + 4, sizeof length);
        if (length < 0) break;
        at += 8 + static_cast<size_t>(length);
    }
    return count > 0 ? count - 1 : 0;
}

} // namespace

DemoFile findDemo(Pk3FileSource& files, const std::string& name) {
    const std::string stem = name.substr(0, name.rfind(".dm_"));
    for (const int protocol : {71, 70})
        if (const auto bytes = files.readIntact("demos/" + stem + ".dm_" + std::to_string(protocol)))
            return {stem, protocol, countSnapshots(*bytes)};
    std::string known;
    for (const char* extension : {".dm_71", ".dm_70"})
        for (const std::string& demo : files.list("demos", extension))
            known += (known.empty() ? "" : ", ") + demo.substr(0, demo.rfind('.'));
    throw ContentError("demo '" + stem +
                       "' is not in the game's archives; there are: " + (known.empty() ? "none" : known));
}

} // namespace q3rt
