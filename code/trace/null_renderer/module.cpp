// renderer_null: everything of a renderer but the picture. It answers the game's questions (tags, marks, light) exactly
// as the drawing modules do, so a recording made around it holds the same calls, in a fraction of the time.

#include "engine/export_table.hpp"
#include "engine/front_end.hpp"
#include "scene/lights.hpp"
#include "scene/lost_light_file.hpp"
#include "trace/null_renderer/null_display.hpp"

namespace q3rt {
namespace {

class NullRenderer : public FrontEnd {
  public:
    explicit NullRenderer(EngineServices& engine)
        : FrontEnd(engine)
        , m_display(engine) {}

  protected:
    DisplayInfo openDisplay() override { return m_size = m_display.open(); }
    /// Reads what the ray tracer reads beyond what is drawn: light images, and the light that the map lost.
    void onWorldLoaded() override {
        extractLights(*world(), materials());
        findLostLights(engine(), world()->bsp, mapName(*world()));
    }
    void onFrame(const FrameCommands&, FrameImage* capture) override {
        if (!capture) return;
        *capture = {m_size.width, m_size.height, {}};
        capture->rgb.resize(static_cast<size_t>(m_size.width) * static_cast<size_t>(m_size.height) * 3);
    }

  private:
    NullDisplay m_display;
    DisplayInfo m_size;
};

} // namespace

std::unique_ptr<Renderer> createRenderer(EngineServices& engine) { return std::make_unique<NullRenderer>(engine); }

} // namespace q3rt

Q3RT_EXPORT_MODULE
