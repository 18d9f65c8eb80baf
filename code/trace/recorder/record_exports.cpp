// What the engine asks of the recorded module: passed on, and noted with its result. See recorder.hpp for the order.

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

#include "trace/recorder/recorder.hpp"
#include "trace/recorder/watch.hpp"

namespace q3rt {
namespace {

template <size_t Count>
void copyFloats(float (&to)[Count], const float* from) {
    std::memcpy(to, from, sizeof to);
}

template <class Event>
void noteEvent(const Event& event) {
    note([&](Recorder& recorder) { recorder.writer.add(event); });
}

void shutDown(qboolean destroyWindow) {
    recording.inFrame = false;
    watchMapState(false);
    recording.inner.Shutdown(destroyWindow);
    noteEvent(event::Shutdown{destroyWindow});
    note([](Recorder& recorder) {
        recorder.models.clear();
        recorder.skins.clear();
        recorder.shaders.clear();
    });
    if (!destroyWindow) return;
    if (recording.recorder) {
        note([](Recorder& recorder) { recorder.writer.finish(); });
        delete recording.recorder;
        recording.recorder = nullptr;
    }
    stopWatching();
    if (recording.innerLibrary) dlclose(recording.innerLibrary);
    recording.innerLibrary = nullptr;
    recording.inner = {};
}

void beginRegistration(glconfig_t* config) {
    std::srand(1); // renderers fill noise tables from rand(): the host that replays does the same
    recording.inner.BeginRegistration(config);
    watchRegistered(*config);
    note([=](Recorder& recorder) {
        recorder.writer.setRenderer(config->renderer_string);
        recorder.writer.add(event::BeginRegistration{config->vidWidth, config->vidHeight, config->windowAspect});
    });
}

int registered(event::HandleKind kind, const char* name, int handle) {
    note([=](Recorder& recorder) {
        HandleNumbers& numbers = kind == event::HandleKind::Model  ? recorder.models
                                 : kind == event::HandleKind::Skin ? recorder.skins
                                                                   : recorder.shaders;
        recorder.writer.add(event::Register{kind, name, numbers.add(handle)});
    });
    return handle;
}

int registerModel(const char* name) {
    return registered(event::HandleKind::Model, name, recording.inner.RegisterModel(name));
}
int registerSkin(const char* name) {
    return registered(event::HandleKind::Skin, name, recording.inner.RegisterSkin(name));
}
int registerShader(const char* name) {
    return registered(event::HandleKind::Shader, name, recording.inner.RegisterShader(name));
}
int registerShaderNoMip(const char* name) {
    return registered(event::HandleKind::ShaderNoMip, name, recording.inner.RegisterShaderNoMip(name));
}

void loadWorld(const char* name) {
    recording.inner.LoadWorld(name);
    note([=](Recorder& recorder) { recorder.writer.add(event::LoadWorld{name}); });
}

void setWorldVisData(const byte* vis) { recording.inner.SetWorldVisData(vis); }

void endRegistration() {
    recording.inner.EndRegistration();
    watchMapState(true);
    noteEvent(event::EndRegistration{});
}

void clearScene() {
    recording.inner.ClearScene();
    noteEvent(event::ClearScene{});
}

void addEntity(const refEntity_t* entity) {
    recording.inner.AddRefEntityToScene(entity);
    note([=](Recorder& recorder) {
        event::AddEntity noted{*entity};
        noted.entity.hModel = recorder.models.find(entity->hModel);
        noted.entity.customSkin = recorder.skins.find(entity->customSkin);
        noted.entity.customShader = recorder.shaders.find(entity->customShader);
        recorder.writer.add(noted);
    });
}

void addPolys(qhandle_t shader, int vertexCount, const polyVert_t* vertices, int polyCount) {
    recording.inner.AddPolyToScene(shader, vertexCount, vertices, polyCount);
    if (vertexCount <= 0 || polyCount <= 0) return;
    note([=](Recorder& recorder) {
        const size_t total = static_cast<size_t>(vertexCount) * static_cast<size_t>(polyCount);
        recorder.writer.add(event::AddPolys{recorder.shaders.find(shader), vertexCount, {vertices, vertices + total}});
    });
}

int lightForPoint(vec3_t point, vec3_t ambient, vec3_t directed, vec3_t direction) {
    const int found = recording.inner.LightForPoint(point, ambient, directed, direction);
    event::LightForPoint noted;
    copyFloats(noted.point, point);
    noted.found = found;
    if (found) {
        copyFloats(noted.ambient, ambient);
        copyFloats(noted.directed, directed);
        copyFloats(noted.direction, direction);
    }
    noteEvent(noted);
    return found;
}

void noteLight(const float* origin, float radius, float r, float g, float b, uint8_t additive) {
    noteEvent(event::AddLight{{origin[0], origin[1], origin[2]}, radius, {r, g, b}, additive});
}

void addLight(const vec3_t origin, float radius, float r, float g, float b) {
    recording.inner.AddLightToScene(origin, radius, r, g, b);
    noteLight(origin, radius, r, g, b, 0);
}

void addAdditiveLight(const vec3_t origin, float radius, float r, float g, float b) {
    recording.inner.AddAdditiveLightToScene(origin, radius, r, g, b);
    noteLight(origin, radius, r, g, b, 1);
}

void renderScene(const refdef_t* view) {
    recording.inner.RenderScene(view);
    noteEvent(event::RenderScene{*view});
}

void setColor(const float* rgba) {
    recording.inner.SetColor(rgba);
    event::SetColor noted;
    noted.given = rgba != nullptr;
    if (rgba) copyFloats(noted.rgba, rgba);
    noteEvent(noted);
}

void drawPicture(float x, float y, float w, float h, float s1, float t1, float s2, float t2, qhandle_t shader) {
    recording.inner.DrawStretchPic(x, y, w, h, s1, t1, s2, t2, shader);
    note([=](Recorder& recorder) {
        recorder.writer.add(event::DrawPicture{x, y, w, h, s1, t1, s2, t2, recorder.shaders.find(shader)});
    });
}

void noteCinematic(event::Cinematic noted, const byte* rgba) {
    if (noted.columns <= 0 || noted.rows <= 0) return;
    const size_t bytes = static_cast<size_t>(noted.columns) * static_cast<size_t>(noted.rows) * 4;
    if (noted.dirty && rgba) noted.rgba.assign(rgba, rgba + bytes);
    noted.dirty = !noted.rgba.empty();
    noteEvent(noted);
}

void drawCinematic(int x, int y, int w, int h, int columns, int rows, const byte* rgba, int client, qboolean dirty) {
    recording.inner.DrawStretchRaw(x, y, w, h, columns, rows, rgba, client, dirty);
    note([=](Recorder&) { noteCinematic({1, x, y, w, h, columns, rows, client, dirty, -1, {}}, rgba); });
}

void uploadCinematic(int w, int h, int columns, int rows, const byte* rgba, int client, qboolean dirty) {
    recording.inner.UploadCinematic(w, h, columns, rows, rgba, client, dirty);
    note([=](Recorder& recorder) {
        noteCinematic({0, 0, 0, w, h, columns, rows, client, dirty, recorder.uploadingCinematic, {}}, rgba);
    });
}

void beginFrame(int stereoFrame) {
    watchFrameBegin();
    recording.frameClockMs = recording.engine.Milliseconds();
    recording.inFrame = recording.recorder != nullptr;
    note([](Recorder& recorder) {
        recorder.noteCvarChanges();
        recorder.noteClock(recording.frameClockMs);
    });
    recording.inner.BeginFrame(stereoFrame);
    noteEvent(event::BeginFrame{stereoFrame});
}

void endFrame(int* frontMs, int* backMs) {
    watchFrameEnding();
    recording.inner.EndFrame(frontMs, backMs);
    recording.inFrame = false;
    noteEvent(event::EndFrame{});
    watchFrameEnded();
    note([](Recorder& recorder) {
        if (recorder.lastFrame != 0 && recorder.writer.worldFramesSeen() == recorder.lastFrame)
            recording.engine.Cmd_ExecuteText(Q3_EXEC_APPEND, "quit\n");
    });
}

int markFragments(int pointCount, const vec3_t* points, const vec3_t projection, int maxPoints, vec3_t outPoints,
                  int maxFragments, markFragment_t* outFragments) {
    const int count =
        recording.inner.MarkFragments(pointCount, points, projection, maxPoints, outPoints, maxFragments, outFragments);
    note([=](Recorder& recorder) {
        event::MarkFragments noted;
        const auto* polygon = reinterpret_cast<const event::Point*>(points);
        noted.polygon.assign(polygon, polygon + pointCount);
        copyFloats(noted.projection, projection);
        noted.maxPoints = maxPoints;
        noted.maxFragments = maxFragments;
        noted.fragments.assign(outFragments, outFragments + count);
        int pointTotal = 0;
        for (const markFragment_t& fragment : noted.fragments)
            pointTotal = std::max(pointTotal, fragment.firstPoint + fragment.numPoints);
        const auto* clipped = reinterpret_cast<const event::Point*>(outPoints);
        noted.points.assign(clipped, clipped + pointTotal);
        recorder.writer.add(std::move(noted));
    });
    return count;
}

int lerpTag(orientation_t* out, qhandle_t model, int startFrame, int endFrame, float fraction, const char* tag) {
    const int found = recording.inner.LerpTag(out, model, startFrame, endFrame, fraction, tag);
    note([=](Recorder& recorder) {
        recorder.writer.add(
            event::LerpTag{recorder.models.find(model), startFrame, endFrame, fraction, tag, found, *out});
    });
    return found;
}

void modelBounds(qhandle_t model, vec3_t mins, vec3_t maxs) {
    recording.inner.ModelBounds(model, mins, maxs);
    note([=](Recorder& recorder) {
        event::ModelBounds noted;
        noted.model = recorder.models.find(model);
        copyFloats(noted.mins, mins);
        copyFloats(noted.maxs, maxs);
        recorder.writer.add(noted);
    });
}

void registerFont(const char* name, int pointSize, fontInfo_t* font) {
    recording.inner.RegisterFont(name, pointSize, font);
    note([=](Recorder& recorder) {
        event::RegisterFont noted{name, pointSize, std::make_shared<fontInfo_t>(*font)};
        for (glyphInfo_t& glyph : noted.font->glyphs)
            glyph.glyph = recorder.shaders.add(glyph.glyph);
        recorder.writer.add(std::move(noted));
    });
}

void remapShader(const char* from, const char* to, const char* timeOffset) {
    recording.inner.RemapShader(from, to, timeOffset);
    note([=](Recorder& recorder) {
        const bool hasOffset = timeOffset != nullptr;
        recorder.writer.add(event::RemapShader{from, to, hasOffset ? timeOffset : "", hasOffset});
    });
}

qboolean getEntityToken(char* buffer, int size) {
    const qboolean found = recording.inner.GetEntityToken(buffer, size);
    note([=](Recorder& recorder) { recorder.writer.add(event::EntityToken{found, found ? buffer : ""}); });
    return found;
}

qboolean inPvs(const vec3_t from, const vec3_t to) {
    const qboolean visible = recording.inner.inPVS(from, to);
    event::InPvs noted;
    copyFloats(noted.from, from);
    copyFloats(noted.to, to);
    noted.visible = visible;
    noteEvent(noted);
    return visible;
}

void takeVideoFrame(int width, int height, byte* capture, byte* encode, qboolean motionJpeg) {
    recording.inner.TakeVideoFrame(width, height, capture, encode, motionJpeg);
}

} // namespace

refexport_t makeRecordingExports() {
    return {.Shutdown = shutDown,
            .BeginRegistration = beginRegistration,
            .RegisterModel = registerModel,
            .RegisterSkin = registerSkin,
            .RegisterShader = registerShader,
            .RegisterShaderNoMip = registerShaderNoMip,
            .LoadWorld = loadWorld,
            .SetWorldVisData = setWorldVisData,
            .EndRegistration = endRegistration,
            .ClearScene = clearScene,
            .AddRefEntityToScene = addEntity,
            .AddPolyToScene = addPolys,
            .LightForPoint = lightForPoint,
            .AddLightToScene = addLight,
            .AddAdditiveLightToScene = addAdditiveLight,
            .RenderScene = renderScene,
            .SetColor = setColor,
            .DrawStretchPic = drawPicture,
            .DrawStretchRaw = drawCinematic,
            .UploadCinematic = uploadCinematic,
            .BeginFrame = beginFrame,
            .EndFrame = endFrame,
            .MarkFragments = markFragments,
            .LerpTag = lerpTag,
            .ModelBounds = modelBounds,
            .RegisterFont = registerFont,
            .RemapShader = remapShader,
            .GetEntityToken = getEntityToken,
            .inPVS = inPvs,
            .TakeVideoFrame = takeVideoFrame};
}

} // namespace q3rt
