#include "formats/md3.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Md3 model = parseMd3(fuzz::asBytes(data, size), "input.md3");
        fuzz::require(!model.frames.empty() && model.tags.size() == model.tagCount * model.frames.size());
        for (const Md3Surface& surface : model.surfaces) {
            fuzz::require(surface.vertices.size() == surface.vertexCount * model.frames.size());
            for (const uint32_t index : surface.indices)
                fuzz::require(index < surface.vertexCount);
        }
    });
}
