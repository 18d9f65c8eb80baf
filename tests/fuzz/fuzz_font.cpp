#include <cmath>

#include "formats/font.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Font font = parseFont(fuzz::asBytes(data, size), "fonts/input.dat");
        for (const FontGlyph& glyph : font.glyphs)
            fuzz::require(std::isfinite(glyph.s) && glyph.shaderName.size() <= 32);
    });
}
