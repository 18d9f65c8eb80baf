#include "renderer_rt/backend.hpp"

#include <string>

#include "base/error.hpp"
#include "gpu/capabilities.hpp"

namespace q3rt {

const char* nameOf(Backend backend) {
    if (backend == Backend::Pipeline) return "pipeline";
    return backend == Backend::Query ? "query" : "compute";
}

bool isAvailable(Backend backend, const Capabilities& can) {
    if (backend == Backend::Compute) return true;
    return can.accelerationStructure && (backend == Backend::Pipeline ? can.rayTracingPipeline : can.rayQuery);
}

Backend chooseBackend(std::string_view wanted, const Capabilities& can) {
    const bool pipeline = isAvailable(Backend::Pipeline, can), query = isAvailable(Backend::Query, can);
    // Measured: on software devices our own trees are 2 to 3 times faster than the driver's, and they need nothing.
    if (wanted == "auto") return pipeline && !can.software ? Backend::Pipeline : Backend::Compute;
    if (wanted == "compute") return Backend::Compute;
    const std::string lacks = can.deviceName + " has no ";
    if (wanted == "pipeline") {
        if (pipeline) return Backend::Pipeline;
        throw DeviceError(lacks + "ray-tracing pipelines (VK_KHR_ray_tracing_pipeline): set rt_backend to auto");
    }
    if (wanted == "query") {
        if (query) return Backend::Query;
        throw DeviceError(lacks + "ray queries (VK_KHR_ray_query): set rt_backend to auto");
    }
    throw UsageError("rt_backend \"" + std::string(wanted) + "\" is unknown: use auto, pipeline, query or compute");
}

std::vector<uint32_t> traversalConstants(const Capabilities& can, bool stagedCover) {
    const bool descends = !can.software;
    return {descends ? 1u : 0u, stagedCover ? 1u : 0u};
}

} // namespace q3rt
