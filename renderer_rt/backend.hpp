#pragma once
// What traces rays. Shading code never knows; see shaders/trace/trace.glsl.

#include <cstdint>
#include <string_view>
#include <vector>

namespace q3rt {

struct Capabilities;

enum class Backend {
    Pipeline, ///< ray-tracing pipelines
    Query,    ///< ray queries in compute shaders
    Compute   ///< our own trees in compute shaders
};
const char* nameOf(Backend backend);

/// The back end for rt_backend on this device; for auto, what is likely the fastest.
/// Throws UsageError or DeviceError with the remedy if there is none.
Backend chooseBackend(std::string_view wanted, const Capabilities& capabilities);

bool isAvailable(Backend backend, const Capabilities& capabilities);

/// Do the driver's acceleration structures hold the scene?
inline bool usesStructures(Backend backend) { return backend != Backend::Compute; }

/// Specialisation of shaders/trace/trace_compute.glsl for a device, and for scenes with or without surfaces whose holes
/// take their stages to tell.
std::vector<uint32_t> traversalConstants(const Capabilities& can, bool stagedCover);

} // namespace q3rt
