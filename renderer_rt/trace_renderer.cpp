#include "renderer_rt/trace_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/measured_choices.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/calibration.hpp"
#include "spirv/rt_taa_comp.hpp"

namespace q3rt {

namespace {

/// Buffers of a view that has not been drawn for so many pictures are let go.
constexpr uint32_t kKeptPictures = 8;

/// Radiance that the filmic curve shows as full white.
constexpr float kFilmicWhite = 4.0f;

float tangentOfHalf(float degrees) {
    return static_cast<float>(std::tan(static_cast<double>(degrees) * 3.14159265358979323846 / 360.0));
}

/// Point n of the R2 sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"): steps by the
/// powers of 1/g, g^3 = g + 1. In [0, 1).
vec2 spreadOverSquare(uint32_t n) {
    const double x = n * 0.75487766624669276, y = n * 0.56984029099805327;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

template <typename T>
void appendBits(std::vector<uint32_t>& key, const T& value) {
    static_assert(sizeof(T) % sizeof(uint32_t) == 0 && std::is_trivially_copyable_v<T>);
    const size_t at = key.size();
    key.resize(at + sizeof(T) / sizeof(uint32_t));
    std::memcpy(&key[at], &value, sizeof(T));
}

} // namespace

TraceRenderer::TraceRenderer(EngineServices& engine)
    : GpuRenderer(engine) {
    bindTraceSettings(settingsBinding(), m_settings);
}

TraceRenderer::~TraceRenderer() {
    removeScreenshotCommand();
    if (hasDevice()) context().device().waitIdle();
}

const char* TraceRenderer::backendName() const {
    return m_pipelines ? nameOf(m_pipelines->backend()) : m_settings.rt_backend.c_str();
}

void TraceRenderer::onDeviceCreated() {
    const Capabilities& can = context().device().capabilities();
    Backend backend = chooseBackend(m_settings.rt_backend, can);
    m_backendReason = "as set";
    m_calibrationKey.clear();
    if (m_settings.rt_backend == "auto") {
        const std::string key = calibrationKey(can);
        if (const auto known = findMeasuredChoice(measuredChoicesFile(), key)) {
            backend = chooseBackend(known->choice, can);
            m_backendReason = "measured before: " + known->reason;
        } else {
            m_calibrationKey = key;
        }
    }
    useBackend(backend);
}

void TraceRenderer::useBackend(Backend backend) {
    m_scene.reset();
    m_pipelines = std::make_unique<StagePipelines>(context().device(), backend, context().textures().layout());
    m_scene = std::make_unique<TracedScene>(context(), backend);
}

void TraceRenderer::loadScene(TracedScene& scene) {
    scene.setContent(materials(), textures());
    scene.loadWorld(*world());
}

void TraceRenderer::onGpuWorldLoaded() {
    loadScene(*m_scene);
    m_frameNumber = 0;
    m_lastViewKey.clear();
    const StaticGeometry& statics = *m_scene->statics();
    logLine(LogLevel::Info, "%u world triangles in %zu structures (%.1f MiB), %zu triangle lights, %zu others",
            statics.triangleCount(), statics.parts().size(), static_cast<double>(statics.bytes()) / (1 << 20),
            m_scene->lights()->triangleCount(), m_scene->lights()->others().size());
}

void TraceRenderer::onGpuReady() {
    addScreenshotCommand();
    if (!m_scene->hasWorld()) return;
    if (!m_calibrationKey.empty()) calibrate();
    warmPipelines();
    // Whatever was drawn while the map was loaded, the first picture of the world is the same.
    m_pictureNumber = 0;
    m_buffers.clear();
    m_lastBuffers = nullptr;
}

void TraceRenderer::onGpuContentDropped() {
    removeScreenshotCommand();
    m_views.clear();
    m_buffers.clear();
    m_lastBuffers = nullptr;
    if (m_scene) m_scene->dropContent();
}

void TraceRenderer::onGpuFrameBegin(const FrameCommands&) {
    m_views.clear();
    m_scene->beginFrame();
    ++m_pictureNumber;
    dropUnusedBuffers();
}

std::optional<VkRect2D> TraceRenderer::visibleArea(const SceneView& scene) {
    // A view that reaches beyond the target is traced where it shows only; its rays are those of the whole view.
    const VkExtent2D target = context().extent();
    const int left = std::clamp(scene.x, 0, static_cast<int>(target.width));
    const int top = std::clamp(scene.y, 0, static_cast<int>(target.height));
    const int right = std::clamp(scene.x + scene.width, left, static_cast<int>(target.width));
    const int bottom = std::clamp(scene.y + scene.height, top, static_cast<int>(target.height));
    if (right == left || bottom == top) return std::nullopt;
    return VkRect2D{{left, top}, {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
}

void TraceRenderer::describeView(const SceneView& scene, VkExtent2D extent, RtFrame& out) const {
    out.eye = scene.view.origin;
    // Rays through the visible part of the view: its centre is off the view's axis where the view is cut.
    const float tanX = tangentOfHalf(scene.fovXDegrees), tanY = tangentOfHalf(scene.fovYDegrees);
    const vec2 whole(static_cast<float>(scene.width), static_cast<float>(scene.height));
    const vec2 part(static_cast<float>(extent.width), static_cast<float>(extent.height));
    const vec2 corner(static_cast<float>(std::max(0, -scene.x)), static_cast<float>(std::max(0, -scene.y)));
    const vec2 center = (corner * 2.0f + part) / whole - 1.0f;
    out.forward = scene.view.axis[0] - scene.view.axis[1] * (tanX * center.x) - scene.view.axis[2] * (tanY * center.y);
    out.left = scene.view.axis[1] * (tanX * part.x / whole.x);
    out.up = scene.view.axis[2] * (tanY * part.y / whole.y);
    out.forwardUnit = scene.view.axis[0];
    const Bounds& bounds = m_scene->world()->bounds;
    // From the eye to the farthest corner, wherever the eye is.
    const vec3 reach = glm::max(glm::abs(bounds.mins - out.eye), glm::abs(bounds.maxs - out.eye));
    out.farQu = 2.0f * glm::length(reach);
    out.size = {extent.width, extent.height};
}

void TraceRenderer::describeSettings(RtFrame& out) const {
    out.seed = static_cast<uint32_t>(m_settings.rt_seed);
    out.lightsPerPixel = static_cast<uint32_t>(m_settings.rt_numRandomDL);
    out.candidatesPerChoice = static_cast<uint32_t>(m_settings.rt_lightCandidates);
    out.ambient = m_settings.rt_ambient;
    out.reflectionDepth = static_cast<uint32_t>(m_settings.rt_reflectionDepth);
    out.cullLights = static_cast<uint32_t>(m_settings.rt_cullLights);
    if (m_settings.rt_illumination) out.flags |= kFrameIllumination;
    if (m_settings.rt_softshadows) out.flags |= kFrameSoftShadows;
    if (m_settings.rt_antialiasing) out.flags |= kFrameAntialiasing;
    if (m_settings.rt_tonemap == 0) out.flags |= kFrameClampLight;
    out.exposure = m_settings.rt_exposure;
}

std::vector<uint32_t> TraceRenderer::settingsKey() const {
    std::vector<uint32_t> key;
    appendBits(key, std::array{m_settings.rt_illumination, m_settings.rt_cullLights, m_settings.rt_numRandomDL,
                               m_settings.rt_softshadows, m_settings.rt_antialiasing, m_settings.rt_seed,
                               m_settings.rt_tonemap, m_settings.rt_reflectionDepth});
    appendBits(key, std::array{m_settings.rt_ambient, m_settings.rt_exposure});
    return key;
}

uint32_t TraceRenderer::countSample(const FrameCommands& frame, const SceneView& scene) {
    std::vector<uint32_t> key;
    if (m_settings.rt_accumulate != 0) key = viewKey(frame, scene);
    const bool same = !key.empty() && key == m_lastViewKey;
    m_lastViewKey = std::move(key);
    m_sampleNumber = same ? m_sampleNumber + 1 : 0;
    return m_sampleNumber;
}

std::vector<uint32_t> TraceRenderer::viewKey(const FrameCommands& frame, const SceneView& scene) const {
    std::vector<uint32_t> key = settingsKey();
    for (const vec3& v : {scene.view.origin, scene.view.axis[0], scene.view.axis[1], scene.view.axis[2]})
        appendBits(key, v);
    appendBits(key, std::array{scene.fovXDegrees, scene.fovYDegrees});
    appendBits(key, std::array{scene.x, scene.y, scene.width, scene.height, scene.timeMs});
    for (uint32_t i = 0; i < scene.lightCount; ++i) {
        const SceneLight& light = frame.lights[scene.firstLight + i];
        appendBits(key, std::array{light.origin, light.color});
        appendBits(key, light.radius);
    }
    for (const EntityRecord& entity : m_geometry.entities) {
        appendBits(key, entity.worldFromModel);
        appendBits(key, entity.stage.entityColor);
    }
    // Animated models and polys: their points say all.
    const auto bytes = std::as_bytes(std::span(m_geometry.vertices));
    appendBits(key, std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
    return key;
}

const TracedView& TraceRenderer::prepareView(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers) {
    buildViewGeometry(frame, scene, scene.view, world(), models(), materials(), viewGeometrySettings(), m_geometry);
    const std::span<const SceneLight> lights(frame.lights.data() + scene.firstLight, scene.lightCount);
    const std::span<const SceneEntity> entities(frame.entities.data() + scene.firstEntity, scene.entityCount);
    m_views.push_back(m_scene->prepare(m_geometry, lights, {entities, scene.timeMs}));
    TracedView& view = m_views.back();
    describeView(scene, buffers.area.extent, view.frame);
    describeSettings(view.frame);
    view.frame.sampleNumber = countSample(frame, scene);
    view.frame.frame = m_frameNumber++;
    prepareHistory(frame, scene, buffers, view.frame);
    view.frame.pixels = buffers.pixels.address();
    view.frame.irradiance = buffers.irradiance.address();
    view.frame.ambientL = buffers.ambient.address();
    view.frame.lighting = buffers.denoiser ? buffers.denoiser->lighting().address() : view.frame.irradiance;
    view.frame.radiance = buffers.radiance.address();
    view.frame.means = buffers.means.address();
    view.frame.picture = buffers.picture.address();
    m_scene->finish(view);
    m_movingTriangleCount = view.movingTriangleCount;
    m_instanceCount = view.instanceCount;
    m_classCounts = view.counts;
    return view;
}

void TraceRenderer::prepareHistory(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers,
                                   RtFrame& out) {
    const bool denoised = m_settings.rt_illumination && !m_settings.rt_accumulate;
    const bool antialiased = m_settings.rt_taa && !m_settings.rt_accumulate;
    const auto kind = denoised ? static_cast<DenoiserKind>(m_settings.rt_denoiser) : DenoiserKind::None;
    if (kind != DenoiserKind::None && !m_denoisePipelines)
        m_denoisePipelines = std::make_unique<DenoisePipelines>(context().device());
    buffers.turnHistory(context().device(), m_denoisePipelines.get(), kind, antialiased);
    if (!buffers.guides) return;
    ViewInstant now{.camera = cameraOf(out),
                    .timeMs = scene.timeMs,
                    .sampleFrame = out.frame,
                    .pictureNumber = m_pictureNumber,
                    .inverseError = out.inverseError,
                    .settingsKey = settingsKey(),
                    .entities = findEntities(frame, scene, m_geometry)};
    now.instances = findInstances(m_scene->tables(), m_geometry, now.corners);
    for (const RtInstance& instance : m_scene->tables().instances)
        now.indexAddress.push_back(instance.indices);
    ViewMotion& motion = buffers.motion;
    motion.advance(std::move(now));
    GrowingBuffer& stream = m_scene->stream();
    const VkDeviceAddress previousCorners = stream.append(std::span<const vec3>(motion.previous().corners)).address;
    out.flags |= kFrameHistory;
    out.motionToPrevious = stream.append(std::span<const RtMotion>(motion.toPrevious(previousCorners))).address;
    out.guides = buffers.guides->guides.address();
    out.pasts = buffers.guides->pasts.address();
    out.previousEye = motion.previous().camera.eye;
    if (buffers.denoiser) buffers.denoiser->prepare(buffers, stream);
    if (antialiased) {
        if (!m_taaPipeline)
            m_taaPipeline =
                ComputePipeline(context().device(), {"taa", {shaders::rt_taa_comp, {}}, {{}, sizeof(RtTaaPush)}});
        const RtTaa table = describeTaa(buffers);
        buffers.taa->table = stream.append(table).address;
        // The mean over frames wants one jitter for the whole picture, evenly spread over the frames.
        out.flags |= kFrameSharedJitter;
        out.jitter = spreadOverSquare(m_pictureNumber);
    }
}

ViewBuffers& TraceRenderer::buffersOf(const VkRect2D& area) {
    const auto found = std::find_if(m_buffers.begin(), m_buffers.end(), [&](const ViewBuffers& buffers) {
        return buffers.area.offset.x == area.offset.x && buffers.area.offset.y == area.offset.y &&
               buffers.area.extent.width == area.extent.width && buffers.area.extent.height == area.extent.height &&
               buffers.lastPicture != m_pictureNumber;
    });
    if (found == m_buffers.end()) m_lastViewKey.clear();
    m_lastBuffers = found != m_buffers.end() ? &*found : &m_buffers.emplace_back(context().device(), area);
    m_lastBuffers->lastPicture = m_pictureNumber;
    return *m_lastBuffers;
}

void TraceRenderer::dropUnusedBuffers() {
    m_buffers.remove_if([&](const ViewBuffers& buffers) {
        const bool unused = buffers.lastPicture + kKeptPictures < m_pictureNumber;
        if (unused && m_lastBuffers == &buffers) m_lastBuffers = nullptr;
        return unused;
    });
}

RtOutput TraceRenderer::describeOutput(const ViewBuffers& buffers, const VkRect2D& area) const {
    RtOutput output{};
    output.picture = buffers.shown().address();
    output.corner = {static_cast<uint32_t>(area.offset.x), static_cast<uint32_t>(area.offset.y)};
    output.width = area.extent.width;
    output.curve = m_settings.rt_tonemap != 0 ? kCurveFilmic : kCurveClamp;
    output.white = kFilmicWhite;
    return output;
}

std::string TraceRenderer::extraStats() const {
    std::string text =
        formatText(",\"instances\":%u,\"moving_triangles\":%u,\"lights\":%zu,\"classes\":{", m_instanceCount,
                   m_movingTriangleCount, m_scene && m_scene->hasWorld() ? m_scene->lights()->triangleCount() : 0);
    for (size_t i = 0; i < kStructureClassCount; ++i)
        text += formatText("%s\"%s\":{\"surfaces\":%u,\"triangles\":%u,\"builds\":%u}", i == 0 ? "" : ",",
                           kStructureClassNames[i], m_classCounts[i].surfaces, m_classCounts[i].triangles,
                           m_classCounts[i].builds);
    return text + "}";
}

} // namespace q3rt
