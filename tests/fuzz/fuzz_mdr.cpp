#include "formats/mdr.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Mdr model = parseMdr(fuzz::asBytes(data, size), "input.mdr");
        fuzz::require(!model.frames.empty() && model.bones.size() == model.frames.size() * model.boneCount);
        for (const auto& lod : model.lods)
            for (const MdrSurface& surface : lod) {
                for (const uint32_t index : surface.indices)
                    fuzz::require(index < surface.vertices.size());
                for (const MdrVertex& vertex : surface.vertices)
                    fuzz::require(vertex.firstWeight + vertex.weightCount <= surface.weights.size());
                for (const MdrWeight& weight : surface.weights)
                    fuzz::require(weight.bone < model.boneCount);
            }
        for (const MdrTag& tag : model.tags)
            fuzz::require(tag.bone < model.boneCount);
    });
}
