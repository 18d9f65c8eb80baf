#include "formats/image.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Image image = decodeImage(fuzz::asBytes(data, size), "input.pcx");
        fuzz::require(image.width > 0 && image.height > 0);
        fuzz::require(image.rgba.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 4);
    });
}
