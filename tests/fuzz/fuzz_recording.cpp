#include <memory>
#include <sstream>

#include "fuzz_input.hpp"
#include "trace/recording.hpp"

using namespace q3rt;

// Checksums keep most damage out of the events, so the same bytes are also taken for a row of events.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    fuzz::runParser([&] {
        const auto bytes = fuzz::asBytes(data, size);
        const std::vector<std::byte> events(bytes.begin(), bytes.end());
        for (size_t offset = 0; offset < events.size();)
            decodeEvent(events, offset, "input");
    });
    return fuzz::runParser([&] {
        Recording recording(std::make_unique<std::istringstream>(std::string(fuzz::asText(data, size))), "input.q3t");
        for (size_t i = 0; i < recording.frameCount(); ++i) {
            const Recording::Frame frame = recording.readFrame(i);
            fuzz::require(frame.isLoading == (frame.number < 0));
        }
    });
}
