#include "renderer_rt/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/measured_choices.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

namespace {

constexpr double kMeasureMs = 60; ///< of each back end, once it is compiled: 180 ms for all three
constexpr int kMostRuns = 5;
constexpr VkExtent2D kSoftwareExtent{192, 108}, kDeviceExtent{1280, 720}; ///< pixels
constexpr float kEyeHeightQu = 26;                                      ///< of a player above the start
constexpr double kRadians = 3.14159265358979323846 / 180;

} // namespace

std::string calibrationKey(const Capabilities& can) {
    return formatText("rt_backend %s, %s %s, shaders %016llx", can.deviceName.c_str(), can.driverName.c_str(),
                      can.driverInfo.c_str(), static_cast<unsigned long long>(StagePipelines::hashOfCode()));
}

SceneView stillOf(const World& world, VkExtent2D extent) {
    SceneView scene;
    scene.width = static_cast<int>(extent.width);
    scene.height = static_cast<int>(extent.height);
    scene.fovYDegrees = static_cast<float>(
        2 * std::atan(static_cast<double>(extent.height) / static_cast<double>(extent.width)) / kRadians);
    scene.view.origin = world.bounds.empty() ? vec3(0.0f) : (world.bounds.mins + world.bounds.maxs) * 0.5f;
    double yaw = 0;
    for (const MapEntity& entity : world.entities) {
        const auto origin = entity.vector("origin");
        if (entity.className() != "info_player_deathmatch" || !origin) continue;
        scene.view.origin = *origin + vec3(0, 0, kEyeHeightQu);
        yaw = static_cast<double>(entity.number("angle", 0)) * kRadians;
        break;
    }
    const auto c = static_cast<float>(std::cos(yaw)), s = static_cast<float>(std::sin(yaw));
    scene.view.axis[0] = {c, s, 0};
    scene.view.axis[1] = {-s, c, 0};
    scene.view.axis[2] = {0, 0, 1};
    return scene;
}

void TraceRenderer::calibrate() {
    const Capabilities& can = context().device().capabilities();
    const VkExtent2D extent = can.software ? kSoftwareExtent : kDeviceExtent;
    Backend fastest = m_pipelines->backend();
    double least = 0;
    std::string reason;
    for (const Backend backend : {Backend::Pipeline, Backend::Query, Backend::Compute}) {
        if (!isAvailable(backend, can)) continue;
        if (m_pipelines->backend() != backend) {
            useBackend(backend);
            loadScene();
        }
        warmPipelines();
        double best = runStill(extent, false), sum = best;
        for (int run = 1; run < kMostRuns && sum < kMeasureMs; ++run) {
            const double ms = runStill(extent, false);
            best = std::min(best, ms);
            sum += ms;
        }
        reason += formatText("%s%s %.2f ms", reason.empty() ? "" : ", ", nameOf(backend), best);
        if (least == 0 || best < least) {
            least = best;
            fastest = backend;
        }
    }
    if (m_pipelines->backend() != fastest) {
        useBackend(fastest);
        loadScene();
    }
    reason += formatText(" at %ux%u", extent.width, extent.height);
    logLine(LogLevel::Info, "rt_backend auto: %s (%s)", nameOf(fastest), reason.c_str());
    keepMeasuredChoice(measuredChoicesFile(), {m_calibrationKey, nameOf(fastest), reason});
    m_backendReason = "measured: " + reason;
    m_calibrationKey.clear();
}

} // namespace q3rt
