#include "formats/iqm.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Iqm model = parseIqm(fuzz::asBytes(data, size), "input.iqm");
        for (const IqmMesh& mesh : model.meshes) {
            fuzz::require(mesh.firstVertex + mesh.vertexCount <= model.positions.size());
            for (const uint32_t index : mesh.indices)
                fuzz::require(index < mesh.vertexCount);
        }
        for (size_t i = 0; i < model.joints.size(); ++i)
            fuzz::require(model.joints[i].parent < static_cast<int>(i));
        fuzz::require(model.bounds.empty() || model.bounds.size() == model.frameCount);
        for (size_t frame = 0; frame < std::min<size_t>(model.frameCount, 8); ++frame)
            for (size_t joint = 0; joint < model.poses.size(); ++joint)
                fuzz::require(std::abs(glm::length(model.poseAt(frame, joint).rotate) - 1) < 1e-3f);
    });
}
