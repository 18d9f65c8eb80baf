#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addAcceleration(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "acceleration",
        [&](PassBuilder& pass) { resources.structures = pass.write(resources.structures, access::kBuildWrite); },
        [work](PassContext& pass) { work.scene.recordBuilds(pass.commands(), work.view); });
}

} // namespace q3rt
