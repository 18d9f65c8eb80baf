#pragma once
// The renderer module in the headless engine: a map, a camera, and the picture or its radiance.

#include <filesystem>
#include <string>
#include <vector>

#include "formats/image.hpp"
#include "host/headless/headless_engine.hpp"
#include "math/vector.hpp"
#include "support/backend_time.hpp"

namespace q3rt::test {

/// What the harness draws: eye in qu, angles in degrees (pitch positive looks down, as the engine's).
struct Camera {
    vec3 eye{0};
    float pitch = 0, yaw = 0;
    float fovX = 90;
    int timeMs = 0;
};

class TraceHarness {
  public:
    /// `files` outlives this. Throws if the module can't start (no device).
    TraceHarness(FileSource& files, const std::filesystem::path& module, int width, int height);
    void set(const std::string& cvar, const std::string& value);
    void loadMap(const std::string& name);
    /// Of every view drawn from now on.
    void setEntities(std::vector<refEntity_t> entities) { m_entities = std::move(entities); }
    /// A quadrilateral as cgame sends it.
    struct Quad {
        qhandle_t shader = 0;
        polyVert_t vertices[4] = {};
    };
    /// Of every view drawn from now on, in this order.
    void setQuads(std::vector<Quad> quads) { m_quads = std::move(quads); }
    /// A white dynamic light; qu.
    struct Light {
        vec3_t origin = {};
        float radius = 0;
    };
    /// Of every view drawn from now on.
    void setLights(std::vector<Light> lights) { m_lights = std::move(lights); }
    /// Draws the view `frames` times.
    void draw(const Camera& camera, int frames);
    /// The last of `frames` draws as shown.
    HostFrame picture(const Camera& camera, int frames);
    /// Radiance after `frames` draws (rt_accumulate decides whether it is their mean).
    FloatImage radiance(const Camera& camera, int frames);
    HeadlessEngine& engine() { return m_engine; }

  private:
    void submit(const Camera& camera);

    BackendTime m_time{"compute"};
    HeadlessEngine m_engine;
    std::vector<refEntity_t> m_entities;
    std::vector<Quad> m_quads;
    std::vector<Light> m_lights;
    int m_width, m_height;
};

} // namespace q3rt::test
