#include "renderer_rt/calibration.hpp"

#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/measured_choices.hpp"
#include "base/measured_rounds.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/trace_renderer.hpp"
#include "tracing_code.hpp"

namespace q3rt {

namespace {

constexpr double kBudgetMs = 180; ///< wall time of all runs together, once everything is compiled
constexpr VkExtent2D kSoftwareExtent{96, 54}, kDeviceExtent{1280, 720}; ///< pixels
constexpr float kEyeHeightQu = 26;                                      ///< of a player above the start
constexpr double kRadians = 3.14159265358979323846 / 180;

} // namespace

std::string calibrationKey(const Capabilities& can) {
    return formatText("rt_backend %s, %s %s, shaders %s", can.deviceName.c_str(), can.driverName.c_str(),
                      can.driverInfo.c_str(), kShaderHash);
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
    /// A back end with its scene, while another one draws. Empty: the one that stands already.
    struct Rival {
        Backend backend;
        std::unique_ptr<StagePipelines> pipelines;
        std::unique_ptr<TracedScene> scene;
    };
    std::vector<Rival> rivals;
    for (const Backend backend : {Backend::Pipeline, Backend::Query, Backend::Compute}) {
        if (!isAvailable(backend, can)) continue;
        Rival& rival = rivals.emplace_back(Rival{backend, nullptr, nullptr});
        if (backend == m_pipelines->backend()) continue;
        rival.pipelines = std::make_unique<StagePipelines>(context().device(), backend, context().textures().layout());
        rival.scene = std::make_unique<TracedScene>(context(), backend);
        loadScene(*rival.scene);
    }
    // A complete pair stands at any moment: an error of the engine may end this function anywhere.
    const auto exchange = [&](Rival& rival) {
        if (!rival.scene) return;
        std::swap(m_pipelines, rival.pipelines);
        std::swap(m_scene, rival.scene);
    };
    std::vector<std::function<RunTime()>> runs;
    for (Rival& rival : rivals) {
        exchange(rival);
        warmPipelines();
        exchange(rival);
        runs.emplace_back([&] {
            exchange(rival);
            RunTime time = runStill(extent, false);
            exchange(rival);
            // A software device works on the processors that other programs share.
            if (!can.software) time.costMs = time.wallMs;
            return time;
        });
    }
    const RoundsResult result = measureInRounds(runs, kBudgetMs);
    exchange(rivals[result.fastest]);
    std::string reason;
    for (size_t i = 0; i < rivals.size(); ++i)
        reason += formatText("%s %.2f ms, ", nameOf(rivals[i].backend), result.leastMs[i]);
    reason += formatText("%s, least of %zu rounds at %ux%u", can.software ? "processor time" : "wall time",
                         result.roundCount, extent.width, extent.height);
    if (result.repeatable)
        keepMeasuredChoice(measuredChoicesFile(), {m_calibrationKey, backendName(), reason});
    else
        reason += "; not kept, the machine is too busy now";
    logLine(LogLevel::Info, "rt_backend auto: %s (%s)", backendName(), reason.c_str());
    m_backendReason = "measured: " + reason;
    m_calibrationKey.clear();
}

} // namespace q3rt
