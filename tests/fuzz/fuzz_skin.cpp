#include "formats/skin.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        for (const SkinSurface& surface : parseSkin(fuzz::asText(data, size)))
            fuzz::require(!surface.surface.empty());
    });
}
