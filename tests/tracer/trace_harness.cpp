#include "trace_harness.hpp"

#include <cmath>
#include <stdexcept>

namespace q3rt::test {

namespace {

refdef_t makeView(const Camera& camera, int width, int height) {
    refdef_t view{};
    view.width = width;
    view.height = height;
    view.fov_x = camera.fovX;
    const double tanX = std::tan(camera.fovX * M_PI / 360);
    view.fov_y = static_cast<float>(std::atan(tanX * height / width) * 360 / M_PI);
    const double yaw = camera.yaw * M_PI / 180, pitch = camera.pitch * M_PI / 180;
    const double axes[3][3] = {{std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), -std::sin(pitch)},
                               {-std::sin(yaw), std::cos(yaw), 0},
                               {std::sin(pitch) * std::cos(yaw), std::sin(pitch) * std::sin(yaw), std::cos(pitch)}};
    for (int i = 0; i < 3; ++i) {
        view.vieworg[i] = camera.eye[i];
        for (int k = 0; k < 3; ++k)
            view.viewaxis[i][k] = static_cast<float>(axes[i][k]);
    }
    view.time = camera.timeMs;
    return view;
}

} // namespace

TraceHarness::TraceHarness(FileSource& files, const std::filesystem::path& module, int width, int height)
    : m_engine(files)
    , m_width(width)
    , m_height(height) {
    set("r_mode", "-1");
    set("r_customwidth", std::to_string(width));
    set("r_customheight", std::to_string(height));
    set("r_fullscreen", "0");
    set("rt_backend", "compute");
    set("rt_lostLights", "0"); // light as the scripts say is what tests know
    m_engine.loadModule(module);
}

void TraceHarness::set(const std::string& cvar, const std::string& value) {
    m_engine.cvars.preset(cvar, value);
    if (cvar == "rt_backend") m_time.setBackend(value);
}

void TraceHarness::loadMap(const std::string& name) {
    m_engine.beginRegistration();
    const char* file = name.c_str();
    m_engine.enter([file](const refexport_t& module) {
        module.LoadWorld(file);
        module.EndRegistration();
    });
}

void TraceHarness::submit(const Camera& camera) {
    const refdef_t view = makeView(camera, m_width, m_height);
    m_engine.enter([&](const refexport_t& module) {
        module.BeginFrame(0);
        module.ClearScene();
        for (const refEntity_t& entity : m_entities)
            module.AddRefEntityToScene(&entity);
        for (const Quad& quad : m_quads)
            module.AddPolyToScene(quad.shader, 4, quad.vertices, 1);
        for (const Light& light : m_lights)
            module.AddLightToScene(light.origin, light.radius, 1, 1, 1);
        module.RenderScene(&view);
    });
}

void TraceHarness::draw(const Camera& camera, int frames) {
    for (int i = 0; i < frames; ++i) {
        submit(camera);
        m_engine.endFrame(false);
    }
}

HostFrame TraceHarness::picture(const Camera& camera, int frames) {
    draw(camera, frames - 1);
    submit(camera);
    std::optional<HostFrame> frame = m_engine.endFrame(true);
    if (!frame) throw std::runtime_error("the module gave no picture");
    return *frame;
}

FloatImage TraceHarness::radiance(const Camera& camera, int frames) {
    draw(camera, frames - 1);
    m_engine.runCommand({"screenshotHDR", "harness"});
    draw(camera, 1);
    const auto& written = m_engine.filesWritten();
    const auto found = written.find("screenshots/harness.pfm");
    if (found == written.end()) throw std::runtime_error("the module wrote no radiance");
    return decodePfm(found->second, "harness.pfm");
}

} // namespace q3rt::test
