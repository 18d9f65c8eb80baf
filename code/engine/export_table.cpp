#include "engine/export_table.hpp"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "engine/conversions.hpp"
#include "engine/engine_imports.hpp"
#include "engine/guard.hpp"
#include "scene/busy_frame.hpp"

namespace q3rt {
namespace {

// Statics here are trivially destructible: the library may be unmapped, or the program end, while a body is cut off by
// a signal, and then nothing may be torn down.
refimport_t theImports;
refexport_t theExports;

void raiseError(Severity severity, const char* text) {
    theImports.Error(severity == Severity::Fatal ? Q3_ERR_FATAL : Q3_ERR_DROP, "%s", text);
}

void runEngineCommand();

/// What calls hand over, kept from call to call for its memory.
struct CallBuffers {
    CallBuffers() {
        polyVertices.reserve(busyFrame::kWorkVertices);
        markPolygon.reserve(busyFrame::kSmall);
        markPoints.reserve(busyFrame::kWorkVertices);
        markFragments.reserve(busyFrame::kWorkVertices);
    }
    std::vector<PolyVertex> polyVertices;
    std::vector<vec3> markPolygon, markPoints;
    std::vector<MarkFragment> markFragments;
};

/// Alive from the first BeginRegistration to the end of Shutdown(1).
struct Module {
    Guard guard{&raiseError};
    EngineImports services{theImports, guard, &runEngineCommand};
    std::unique_ptr<Renderer> renderer;
    CallBuffers buffers;
    bool registered = false; ///< between BeginRegistration and Shutdown: other calls are ignored outside
};
Module* theModule = nullptr;

/// Runs `body(renderer)` unless nothing is registered.
template <class Body>
void guarded(Body&& body, EntryKind kind = EntryKind::TopLevel) {
    if (!theModule || !theModule->registered) return;
    theModule->guard.run([&] { body(*theModule->renderer); }, kind);
}

void runEngineCommand() {
    guarded([](Renderer&) { theModule->services.runCommand(); });
}

/// Keeps the code mapped after the engine unloads the module: frames of it lie beneath the signal handler.
void pinModule() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&pinModule), &info) && info.dli_fname)
        dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
}

void dropRegistration() {
    try {
        theModule->renderer->shutdownRegistration();
    } catch (const std::exception& error) {
        // An Error raised from within Shutdown would recurse without end: start anew from nothing instead.
        logLine(LogLevel::Error, "the renderer restarts: %s", error.what());
        theModule->renderer.reset();
    }
}

void shutDown(qboolean destroyWindow) {
    if (!theModule) return;
    const bool done = theModule->guard.run([destroyWindow] {
        theModule->registered = false;
        if (!destroyWindow) {
            if (theModule->renderer) dropRegistration();
            return;
        }
        theModule->services.removeAllCommands();
        theModule->renderer.reset();
        theModule->services.printDeferred();
        setLogSink({});
    });
    if (!done) {
        theModule->registered = false;
        pinModule();
    } else if (destroyWindow) {
        delete theModule;
        theModule = nullptr;
    }
}

void beginRegistration(glconfig_t* config) {
    if (!theModule) theModule = new Module;
    const bool done = theModule->guard.runOrDie([config] {
        Module& module = *theModule;
        setLogSink([](LogLevel level, std::string_view line) { theModule->services.print(level, line); });
        clearLoggedOnce();
        if (!module.renderer) module.renderer = createRenderer(module.services);
        storeDisplay(module.renderer->beginRegistration(), *config);
        module.registered = true;
    });
    if (!done) std::memset(config, 0, sizeof *config);
}

void endRegistration() {
    guarded([](Renderer& renderer) {
        renderer.endRegistration();
        theModule->services.printDeferred();
    });
}

std::string_view textOf(const char* text) { return text ? text : ""; }

int registerModel(const char* name) {
    int handle = 0;
    guarded([&](Renderer& renderer) { handle = renderer.registerModel(textOf(name)); });
    return handle;
}

int registerSkin(const char* name) {
    int handle = 0;
    guarded([&](Renderer& renderer) { handle = renderer.registerSkin(textOf(name)); });
    return handle;
}

int registerShader(const char* name) {
    int handle = 0;
    guarded([&](Renderer& renderer) { handle = renderer.registerShader(textOf(name), true); });
    return handle;
}

int registerShaderNoMip(const char* name) {
    int handle = 0;
    guarded([&](Renderer& renderer) { handle = renderer.registerShader(textOf(name), false); });
    return handle;
}

void registerFont(const char* name, int pointSize, fontInfo_t* font) {
    guarded([&](Renderer& renderer) {
        std::memset(font, 0, sizeof *font);
        if (const auto registered = renderer.registerFont(textOf(name), pointSize)) storeFont(*registered, *font);
    });
}

void loadWorld(const char* name) {
    guarded([&](Renderer& renderer) { renderer.loadWorld(textOf(name)); });
}

/// The client never calls it: visibility comes from the map file.
void setWorldVisData(const byte*) {}

void clearScene() {
    guarded([](Renderer& renderer) { renderer.clearScene(); });
}

void addEntity(const refEntity_t* entity) {
    guarded([&](Renderer& renderer) {
        if (const auto converted = entityFrom(*entity))
            renderer.addEntity(*converted);
        else
            logLineOnce(LogLevel::Warning, "an entity whose place is not a number is left out");
    });
}

void addPolys(qhandle_t shader, int vertexCount, const polyVert_t* vertices, int polyCount) {
    guarded([&](Renderer& renderer) {
        if (vertexCount <= 0 || polyCount <= 0 || !vertices) return;
        const size_t total = static_cast<size_t>(vertexCount) * static_cast<size_t>(polyCount);
        std::vector<PolyVertex>& converted = theModule->buffers.polyVertices;
        storePolyVertices({vertices, total}, converted);
        renderer.addPolys(shader, static_cast<size_t>(vertexCount), converted);
    });
}

void addSceneLight(const float* origin, float radius, const vec3& color, bool additive) {
    guarded([&](Renderer& renderer) {
        if (radius > 0) renderer.addLight({vectorFrom(origin), radius, color, additive});
    });
}

void addLight(const vec3_t origin, float radius, float r, float g, float b) {
    addSceneLight(origin, radius, {r, g, b}, false);
}

void addAdditiveLight(const vec3_t origin, float radius, float r, float g, float b) {
    addSceneLight(origin, radius, {r, g, b}, true);
}

int lightForPoint(vec3_t point, vec3_t ambient, vec3_t directed, vec3_t direction) {
    int found = 0;
    guarded([&](Renderer& renderer) {
        GridLight light;
        if (!renderer.lightForPoint(vectorFrom(point), light)) return;
        storeVector(light.ambient, ambient);
        storeVector(light.directed, directed);
        storeVector(light.direction, direction);
        found = 1;
    });
    return found;
}

void renderScene(const refdef_t* view) {
    guarded([&](Renderer& renderer) { renderer.renderScene(viewFrom(*view)); });
}

void setColor(const float* rgba) {
    guarded([&](Renderer& renderer) {
        renderer.setColor(rgba ? std::optional(vec4(rgba[0], rgba[1], rgba[2], rgba[3])) : std::nullopt);
    });
}

void drawPicture(float x, float y, float w, float h, float s1, float t1, float s2, float t2, qhandle_t shader) {
    guarded([&](Renderer& renderer) { renderer.drawPicture(x, y, w, h, s1, t1, s2, t2, shader); });
}

void checkCinematic(int columns, int rows, const byte* rgba, qboolean dirty) {
    if (columns <= 0 || rows <= 0 || (dirty && !rgba))
        throw UsageError(formatText("a cinematic frame of %d x %d pixels can't be drawn", columns, rows));
}

void drawCinematic(int x, int y, int w, int h, int columns, int rows, const byte* rgba, int client, qboolean dirty) {
    guarded([&](Renderer& renderer) {
        checkCinematic(columns, rows, rgba, dirty);
        renderer.drawCinematic(x, y, w, h, columns, rows, rgba, client, dirty != 0);
    });
}

void uploadCinematic(int, int, int columns, int rows, const byte* rgba, int client, qboolean dirty) {
    guarded(
        [&](Renderer& renderer) {
            checkCinematic(columns, rows, rgba, dirty);
            renderer.uploadCinematic(columns, rows, rgba, client, dirty != 0);
        },
        EntryKind::Nested);
}

void beginFrame(int stereoFrame) {
    guarded([&](Renderer& renderer) { renderer.beginFrame(stereoFrame); });
}

void endFrame(int* frontMs, int* backMs) {
    guarded([&](Renderer& renderer) {
        const Renderer::FrameTimes times = renderer.endFrame();
        if (frontMs) *frontMs = times.frontMs;
        if (backMs) *backMs = times.backMs;
        theModule->services.printDeferred();
    });
}

int markFragments(int pointCount, const vec3_t* points, const vec3_t projection, int maxPoints, vec3_t outPoints,
                  int maxFragments, markFragment_t* outFragments) {
    int count = 0;
    guarded([&](Renderer& renderer) {
        if (pointCount < 3 || maxPoints <= 0 || maxFragments <= 0) return;
        auto& [unused, polygon, clipped, fragments] = theModule->buffers;
        polygon.clear();
        clipped.clear();
        fragments.clear();
        for (int i = 0; i < pointCount; ++i)
            polygon.push_back(vectorFrom(points[i]));
        renderer.markFragments(polygon, vectorFrom(projection), static_cast<size_t>(maxPoints), clipped,
                               static_cast<size_t>(maxFragments), fragments);
        const size_t pointTotal = std::min(clipped.size(), static_cast<size_t>(maxPoints));
        for (size_t i = 0; i < pointTotal; ++i)
            storeVector(clipped[i], outPoints + 3 * i);
        for (const MarkFragment& fragment : fragments) {
            const bool fits = static_cast<size_t>(fragment.firstPoint + fragment.pointCount) <= pointTotal;
            if (fits && count < maxFragments) outFragments[count++] = {fragment.firstPoint, fragment.pointCount};
        }
    });
    return count;
}

int lerpTag(orientation_t* out, qhandle_t model, int startFrame, int endFrame, float fraction, const char* tag) {
    int found = 0;
    guarded([&](Renderer& renderer) {
        Orientation orientation;
        found = renderer.lerpTag(model, startFrame, endFrame, fraction, textOf(tag), orientation);
        storeOrientation(found ? orientation : Orientation{}, *out);
    });
    return found;
}

void modelBounds(qhandle_t model, vec3_t mins, vec3_t maxs) {
    guarded([&](Renderer& renderer) {
        Bounds bounds = renderer.modelBounds(model);
        if (bounds.empty()) bounds = {vec3(0), vec3(0)};
        storeVector(bounds.mins, mins);
        storeVector(bounds.maxs, maxs);
    });
}

void remapShader(const char* from, const char* to, const char* timeOffset) {
    guarded([&](Renderer& renderer) { renderer.remapShader(textOf(from), textOf(to), timeOffset); });
}

qboolean getEntityToken(char* buffer, int size) {
    qboolean found = 0;
    if (!buffer || size <= 0) return found;
    buffer[0] = 0;
    guarded([&](Renderer& renderer) {
        const std::optional<std::string> token = renderer.entityToken();
        if (!token) return;
        const size_t length = std::min(token->size(), static_cast<size_t>(size) - 1);
        std::memcpy(buffer, token->data(), length);
        buffer[length] = 0;
        found = 1;
    });
    return found;
}

qboolean inPvs(const vec3_t from, const vec3_t to) {
    qboolean visible = 0;
    guarded([&](Renderer& renderer) { visible = renderer.inPvs(vectorFrom(from), vectorFrom(to)); });
    return visible;
}

void takeVideoFrame(int width, int height, byte* capture, byte* encode, qboolean motionJpeg) {
    guarded([&](Renderer& renderer) { renderer.takeVideoFrame(width, height, capture, encode, motionJpeg != 0); });
}

} // namespace

refexport_t* makeExportTable(int apiVersion, const refimport_t* imports) {
    if (apiVersion != REF_API_VERSION) {
        imports->Printf(Q3_PRINT_ERROR, "this renderer speaks version %d of the interface, the engine version %d\n",
                        REF_API_VERSION, apiVersion);
        return nullptr;
    }
    theImports = *imports;
    theExports = {.Shutdown = shutDown,
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
    return &theExports;
}

} // namespace q3rt
