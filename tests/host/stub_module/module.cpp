// The smallest renderer that the engine accepts: it registers everything, draws nothing, and touches each kind of
// import. The host's tests load it where the real modules would only add time.

#include <map>
#include <string>

#include "base/error.hpp"
#include "engine/export_table.hpp"
#include "engine/renderer.hpp"
#include "trace/null_renderer/null_display.hpp"

namespace q3rt {
namespace {

void stubInfo() { logLine(LogLevel::Info, "stub renderer"); }

class StubRenderer : public Renderer {
  public:
    explicit StubRenderer(EngineServices& engine)
        : m_engine(engine)
        , m_display(engine) {}

    DisplayInfo beginRegistration() override {
        m_engine.addCommand("stubinfo", stubInfo);
        m_engine.setCvar("stub_started", "1");
        m_scripts = m_engine.list("scripts", ".shader");
        DisplayInfo display = m_display.open();
        m_width = display.width;
        m_height = display.height;
        return display;
    }
    void shutdownRegistration() override {
        m_handles.clear();
        m_world.clear();
    }
    void endRegistration() override { logLine(LogLevel::Info, "stub: %zu names registered", m_handles.size()); }
    int registerModel(std::string_view name) override { return handleOf(name, true); }
    int registerSkin(std::string_view name) override { return handleOf(name, true); }
    int registerShader(std::string_view name, bool) override { return handleOf(name, false); }
    std::optional<RegisteredFont> registerFont(std::string_view, int) override { return std::nullopt; }
    void loadWorld(std::string_view name) override {
        if (!m_world.empty()) throw UsageError("a second world");
        const auto file = m_engine.read(name);
        if (!file) throw ContentError(std::string(name) + ": not found");
        m_world = name;
    }
    void clearScene() override {}
    void addEntity(const SceneEntity&) override {}
    void addPolys(int, size_t, std::span<const PolyVertex>) override {}
    void addLight(const SceneLight&) override {}
    void renderScene(const SceneView&) override { m_sceneTimeMs = m_engine.milliseconds(); }
    void setColor(const std::optional<vec4>&) override {}
    void drawPicture(float, float, float, float, float, float, float, float, int) override {}
    void drawCinematic(int, int, int, int, int, int, const uint8_t*, int, bool) override {}
    void uploadCinematic(int, int, const uint8_t*, int, bool) override {}
    void beginFrame(int) override {}
    FrameTimes endFrame() override {
        // Rows are padded to 4 bytes; the shade tells frames apart.
        if (m_captureWanted) {
            const size_t rowBytes = (static_cast<size_t>(m_width) * 3 + 3) & ~size_t{3};
            m_engine.writeVideoFrame(std::vector<uint8_t>(rowBytes * static_cast<size_t>(m_height), m_shade++));
        }
        m_captureWanted = false;
        return {};
    }
    int markFragments(const std::vector<vec3>&, const vec3&, size_t, std::vector<vec3>&, size_t,
                      std::vector<MarkFragment>&) override {
        return 0;
    }
    bool lightForPoint(const vec3&, GridLight&) override { return false; }
    bool lerpTag(int, int, int, float, std::string_view, Orientation&) override { return true; }
    Bounds modelBounds(int) override { return {vec3(-16), vec3(16)}; }
    void remapShader(std::string_view, std::string_view, const char*) override {}
    std::optional<std::string> entityToken() override { return std::nullopt; }
    bool inPvs(const vec3&, const vec3&) override { return true; }
    void takeVideoFrame(int, int, uint8_t*, uint8_t*, bool) override { m_captureWanted = true; }

  private:
    int handleOf(std::string_view name, bool mustExist) {
        const auto known = m_handles.find(std::string(name));
        if (known != m_handles.end()) return known->second;
        if (mustExist && name.find('.') != std::string_view::npos && !m_engine.read(name)) return 0;
        return m_handles.emplace(name, static_cast<int>(m_handles.size()) + 1).first->second;
    }

    EngineServices& m_engine;
    NullDisplay m_display;
    std::vector<std::string> m_scripts;
    std::map<std::string, int> m_handles;
    std::string m_world;
    int m_width = 0, m_height = 0, m_sceneTimeMs = 0;
    bool m_captureWanted = false;
    uint8_t m_shade = 0;
};

} // namespace

std::unique_ptr<Renderer> createRenderer(EngineServices& engine) { return std::make_unique<StubRenderer>(engine); }

} // namespace q3rt

Q3RT_EXPORT_MODULE
