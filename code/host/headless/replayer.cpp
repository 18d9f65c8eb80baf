#include "host/headless/replayer.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

/// What a recording says about these belongs to the machine it was made on.
constexpr const char* kMachineCvars[] = {"r_mode",        "r_customwidth",  "r_customheight",   "r_custompixelaspect",
                                         "r_fullscreen",  "r_noborder",     "r_centerwindow",   "r_allowresize",
                                         "r_sdldriver",   "r_swapinterval", "r_availablemodes", "r_displayrefresh",
                                         "q3rt_wantstats"};

int lookUp(const std::unordered_map<int, int>& handles, int number) {
    const auto found = handles.find(number);
    return found == handles.end() ? 0 : found->second;
}

/// Both edges of a span are scaled and rounded, so that neighbours stay neighbours.
void scaleSpan(int& start, int& length, float scale) {
    const auto first = static_cast<int>(std::lround(static_cast<float>(start) * scale));
    const auto end = static_cast<int>(std::lround(static_cast<float>(start + length) * scale));
    start = first;
    length = end - first;
}

} // namespace

/// One overload an event: what it does to the module.
struct Replayer::Player {
    Replayer& replayer;
    Draw draw;
    bool stateful; ///< false: only what draws

    template <class Call>
    void enter(Call&& call) const {
        replayer.m_engine.enter(std::forward<Call>(call));
    }
    bool drawing() const { return draw != Draw::Nothing; }

    void operator()(const event::Shutdown& e) const {
        if (!stateful) return;
        replayer.m_engine.shutdown(e.destroyWindow != 0);
        for (auto* handles : {&replayer.m_models, &replayer.m_skins, &replayer.m_shaders})
            handles->clear();
    }
    void operator()(const event::BeginRegistration& e) const {
        if (!stateful) return;
        const glconfig_t& config = replayer.m_engine.beginRegistration();
        if (replayer.m_onStarted) replayer.m_onStarted();
        replayer.m_scaleX = static_cast<float>(config.vidWidth) / static_cast<float>(e.width);
        replayer.m_scaleY = static_cast<float>(config.vidHeight) / static_cast<float>(e.height);
    }
    void operator()(const event::Register& e) const {
        if (!stateful) return;
        int handle = 0;
        enter([&](const refexport_t& module) {
            const char* name = e.name.c_str();
            switch (e.kind) {
            case event::HandleKind::Model:
                handle = module.RegisterModel(name);
                break;
            case event::HandleKind::Skin:
                handle = module.RegisterSkin(name);
                break;
            case event::HandleKind::Shader:
                handle = module.RegisterShader(name);
                break;
            case event::HandleKind::ShaderNoMip:
                handle = module.RegisterShaderNoMip(name);
                break;
            }
        });
        if (e.handle == 0) return;
        auto& handles = e.kind == event::HandleKind::Model  ? replayer.m_models
                        : e.kind == event::HandleKind::Skin ? replayer.m_skins
                                                            : replayer.m_shaders;
        handles[e.handle] = handle;
    }
    void operator()(const event::LoadWorld& e) const {
        if (stateful) enter([&](const refexport_t& module) { module.LoadWorld(e.name.c_str()); });
    }
    void operator()(const event::EndRegistration&) const {
        if (stateful) enter([](const refexport_t& module) { module.EndRegistration(); });
    }
    void operator()(const event::RegisterFont& e) const {
        if (!stateful) return;
        fontInfo_t font{};
        enter([&](const refexport_t& module) { module.RegisterFont(e.name.c_str(), e.pointSize, &font); });
        for (int i = 0; i < Q3_GLYPH_COUNT; ++i)
            replayer.m_shaders[e.font->glyphs[i].glyph] = font.glyphs[i].glyph;
        replayer.m_shaders.erase(0);
    }
    void operator()(const event::RemapShader& e) const {
        if (!stateful) return;
        const char* offset = e.hasOffset ? e.timeOffset.c_str() : nullptr;
        enter([&](const refexport_t& module) { module.RemapShader(e.from.c_str(), e.to.c_str(), offset); });
    }
    void operator()(const event::CvarValue& e) const {
        if (!stateful || e.isDefault || replayer.m_fixedCvars.contains(toLowerAscii(e.name))) return;
        replayer.m_engine.cvars.preset(e.name, e.value);
    }
    void operator()(const event::Clock& e) const { replayer.m_engine.clockMs = e.ms; }
    void operator()(const event::CinematicPlay&) const {}
    void operator()(const event::CinematicRun&) const {}
    void operator()(const event::Cinematic& e) const {
        // With a handle, it answers an import: the module asks for it itself.
        if (e.handle >= 0) return;
        const byte* rgba = e.rgba.empty() ? nullptr : e.rgba.data();
        int x = e.x, y = e.y, width = e.width, height = e.height;
        scaleSpan(x, width, replayer.m_scaleX);
        scaleSpan(y, height, replayer.m_scaleY);
        if (e.drawn && drawing())
            enter([&](const refexport_t& module) {
                module.DrawStretchRaw(x, y, width, height, e.columns, e.rows, rgba, e.client, e.dirty);
            });
        else if (stateful && e.dirty)
            enter([&](const refexport_t& module) {
                module.UploadCinematic(width, height, e.columns, e.rows, rgba, e.client, e.dirty);
            });
    }
    void operator()(const event::SetColor& e) const {
        enter([&](const refexport_t& module) { module.SetColor(e.given ? e.rgba : nullptr); });
    }
    void operator()(const event::ClearScene&) const {
        if (drawing()) enter([](const refexport_t& module) { module.ClearScene(); });
    }
    void operator()(const event::AddEntity& e) const {
        if (!drawing()) return;
        refEntity_t entity = e.entity;
        entity.hModel = lookUp(replayer.m_models, entity.hModel);
        entity.customSkin = lookUp(replayer.m_skins, entity.customSkin);
        entity.customShader = lookUp(replayer.m_shaders, entity.customShader);
        enter([&](const refexport_t& module) { module.AddRefEntityToScene(&entity); });
    }
    void operator()(const event::AddPolys& e) const {
        if (!drawing()) return;
        const int shader = lookUp(replayer.m_shaders, e.shader);
        const int polyCount = static_cast<int>(e.vertices.size()) / e.vertexCount;
        enter([&](const refexport_t& module) {
            module.AddPolyToScene(shader, e.vertexCount, e.vertices.data(), polyCount);
        });
    }
    void operator()(const event::AddLight& e) const {
        if (!drawing()) return;
        enter([&](const refexport_t& module) {
            (e.additive ? module.AddAdditiveLightToScene : module.AddLightToScene)(e.origin, e.radius, e.color[0],
                                                                                   e.color[1], e.color[2]);
        });
    }
    void operator()(const event::RenderScene& e) const {
        if (!drawing()) return;
        refdef_t view = e.view;
        scaleSpan(view.x, view.width, replayer.m_scaleX);
        scaleSpan(view.y, view.height, replayer.m_scaleY);
        if (replayer.m_scaleX != replayer.m_scaleY) {
            // The game keeps the horizontal angle and fits the vertical one to the picture's shape.
            constexpr float kHalfRadians = std::numbers::pi_v<float> / 360.0f;
            const float tangent = std::tan(view.fov_y * kHalfRadians) * replayer.m_scaleY / replayer.m_scaleX;
            view.fov_y = std::atan(tangent) / kHalfRadians;
        }
        enter([&](const refexport_t& module) { module.RenderScene(&view); });
    }
    void operator()(const event::DrawPicture& e) const {
        if (!drawing()) return;
        const float sx = replayer.m_scaleX, sy = replayer.m_scaleY;
        const int shader = lookUp(replayer.m_shaders, e.shader);
        enter([&](const refexport_t& module) {
            module.DrawStretchPic(e.x * sx, e.y * sy, e.width * sx, e.height * sy, e.s1, e.t1, e.s2, e.t2, shader);
        });
    }
    void operator()(const event::BeginFrame& e) const {
        if (drawing()) enter([&](const refexport_t& module) { module.BeginFrame(e.stereo); });
    }
    void operator()(const event::EndFrame&) const {} // the replayer ends the frame itself
    void operator()(const event::MarkFragments& e) const {
        if (!drawing()) return;
        std::vector<event::Point>& points = replayer.m_markPoints;
        std::vector<markFragment_t>& fragments = replayer.m_markFragments;
        points.resize(static_cast<size_t>(e.maxPoints));
        fragments.resize(static_cast<size_t>(e.maxFragments));
        const auto* polygon = reinterpret_cast<const vec3_t*>(e.polygon.data());
        auto* out = reinterpret_cast<float*>(points.data());
        enter([&](const refexport_t& module) {
            module.MarkFragments(static_cast<int>(e.polygon.size()), polygon, e.projection, e.maxPoints, out,
                                 e.maxFragments, fragments.data());
        });
    }
    void operator()(const event::LerpTag& e) const {
        if (!drawing()) return;
        orientation_t out{};
        const int model = lookUp(replayer.m_models, e.model);
        enter([&](const refexport_t& module) {
            module.LerpTag(&out, model, e.startFrame, e.endFrame, e.fraction, e.tag.c_str());
        });
    }
    void operator()(const event::ModelBounds& e) const {
        if (!drawing()) return;
        vec3_t mins, maxs;
        const int model = lookUp(replayer.m_models, e.model);
        enter([&](const refexport_t& module) { module.ModelBounds(model, mins, maxs); });
    }
    void operator()(const event::LightForPoint& e) const {
        if (!drawing()) return;
        vec3_t point = {e.point[0], e.point[1], e.point[2]}, ambient, directed, direction;
        enter([&](const refexport_t& module) { module.LightForPoint(point, ambient, directed, direction); });
    }
    void operator()(const event::EntityToken& e) const {
        if (!stateful) return;
        std::vector<char> token(e.token.size() + 1);
        enter([&](const refexport_t& module) { module.GetEntityToken(token.data(), static_cast<int>(token.size())); });
    }
    void operator()(const event::InPvs& e) const {
        if (drawing()) enter([&](const refexport_t& module) { module.inPVS(e.from, e.to); });
    }
};

Replayer::Replayer(const Recording& recording, HeadlessEngine& engine, const Options& options)
    : m_engine(engine)
    , m_onStarted(options.onStarted) {
    const int width = options.width > 0 ? options.width : recording.info().width;
    const int height = options.height > 0 ? options.height : recording.info().height;
    const std::pair<const char*, std::string> size[] = {{"r_mode", "-1"},
                                                        {"r_customwidth", std::to_string(width)},
                                                        {"r_customheight", std::to_string(height)},
                                                        {"r_fullscreen", "0"},
                                                        {"r_swapInterval", "0"}};
    for (const auto& [name, value] : size)
        engine.cvars.preset(name, value);
    m_fixedCvars.insert(std::begin(kMachineCvars), std::end(kMachineCvars));
    for (const auto& [name, value] : options.cvars) {
        engine.cvars.preset(name, value);
        m_fixedCvars.insert(toLowerAscii(name));
    }
    engine.cinematics.play = [this](std::string_view name) {
        const auto found = m_cinematicHandles.find(toLowerAscii(name));
        return found == m_cinematicHandles.end() ? -1 : found->second;
    };
    engine.cinematics.run = [this](int handle) { return m_cinematicStatus[handle]; };
    engine.cinematics.upload = [this](int handle) {
        const auto found = m_cinematicPixels.find(handle);
        if (found == m_cinematicPixels.end()) return;
        const event::Cinematic& e = found->second;
        const byte* rgba = e.rgba.empty() ? nullptr : e.rgba.data();
        m_engine.moduleTable().UploadCinematic(e.width, e.height, e.columns, e.rows, rgba, e.client, e.dirty);
    };
}

/// The module asks for these while it handles the frame's calls, at moments of its own: they must be known before.
void Replayer::prepareCinematics(const Recording::Frame& frame) {
    for (const TraceEvent& event : frame.events) {
        if (const auto* play = std::get_if<event::CinematicPlay>(&event))
            m_cinematicHandles[toLowerAscii(play->name)] = play->handle;
        else if (const auto* run = std::get_if<event::CinematicRun>(&event))
            m_cinematicStatus[run->handle] = run->status;
        else if (const auto* pixels = std::get_if<event::Cinematic>(&event))
            if (pixels->handle >= 0) m_cinematicPixels[pixels->handle] = *pixels;
    }
}

Replayer::Result Replayer::run(const Recording::Frame& frame, Draw draw, bool stateful) {
    prepareCinematics(frame);
    const auto start = std::chrono::steady_clock::now();
    const Player player{*this, draw, stateful};
    for (const TraceEvent& event : frame.events)
        std::visit(player, event);
    Result result;
    if (draw != Draw::Nothing) result.picture = m_engine.endFrame(draw == Draw::Capture);
    result.wallMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return result;
}

Replayer::Result Replayer::play(const Recording::Frame& frame, Draw draw) { return run(frame, draw, true); }
Replayer::Result Replayer::redraw(const Recording::Frame& frame, Draw draw) { return run(frame, draw, false); }

} // namespace q3rt
