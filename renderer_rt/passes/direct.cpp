#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addDirect(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "direct",
        [&](PassBuilder& pass) {
            pass.read(resources.structures, work.pipelines.structureRead());
            if (resources.countsWork) resources.report = pass.write(resources.report, work.pipelines.bufferWrite());
            pass.read(resources.pixels, work.pipelines.bufferRead());
            resources.irradiance = pass.write(resources.irradiance, work.pipelines.bufferWrite());
            resources.ambient = pass.write(resources.ambient, work.pipelines.bufferWrite());
            resources.lighting = resources.irradiance;
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), TraceStage::Direct, makeStageInput(pass, work));
        });
    checkFinite(graph, resources, "direct", resources.irradiance, kColorItem, work.extent);
    checkFinite(graph, resources, "direct", resources.ambient, kColorItem, work.extent);
}

} // namespace q3rt
