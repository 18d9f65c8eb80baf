// One view of the ray tracer on its way to the passes: what the shaders read of it, and what is kept of it.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "gpu/device.hpp"
#include "renderer_rt/near_area.hpp"
#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

namespace {

/// Buffers of a view that has not been drawn for so many pictures are let go.
constexpr uint32_t kKeptPictures = 8;

/// Radiance that the curves show as full white.
constexpr float kCurveWhite = 4.0f;

/// The longest time that automatic exposure makes up for at once.
constexpr int kLongestFrameMs = 250;

/// Overbright bits that irradiance 63.75 stands for: a texture at its own brightness.
constexpr int kWhiteOverbrightBits = 2;

/// What is looked for in scenes without it too, by rt_onlyRequired.
constexpr uint32_t kSoughtAnyway[] = {kFrameLayers | kFrameNearEntities | kFrameSkySurfaces, 0, kFrameLayers,
                                      kFrameNearEntities, kFrameSkySurfaces};

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

void TraceRenderer::describeView(const SceneView& scene, const ViewBuffers& buffers, RtFrame& out) const {
    out.eye = scene.view.origin;
    // Rays through the visible part of the view: its centre is off the view's axis where the view is cut.
    const float tanX = tangentOfHalf(scene.fovXDegrees), tanY = tangentOfHalf(scene.fovYDegrees);
    const vec2 whole(static_cast<float>(scene.width), static_cast<float>(scene.height));
    const VkExtent2D shown = buffers.area.extent;
    const vec2 part(static_cast<float>(shown.width), static_cast<float>(shown.height));
    const vec2 corner(static_cast<float>(std::max(0, -scene.x)), static_cast<float>(std::max(0, -scene.y)));
    const vec2 center = (corner * 2.0f + part) / whole - 1.0f;
    out.forward = scene.view.axis[0] - scene.view.axis[1] * (tanX * center.x) - scene.view.axis[2] * (tanY * center.y);
    out.left = scene.view.axis[1] * (tanX * part.x / whole.x);
    out.up = scene.view.axis[2] * (tanY * part.y / whole.y);
    out.forwardUnit = scene.view.axis[0];
    if (m_settings.rt_dof && m_settings.rt_aperture > 0) {
        out.flags |= kFrameLens;
        out.lens = 0.5f * m_settings.rt_aperture / vec2(glm::length(out.left), glm::length(out.up));
        out.lensTurn = out.lens / m_settings.rt_focallength;
    }
    const Bounds& bounds = m_scene->world()->bounds;
    // From the eye to the farthest corner, wherever the eye is.
    const vec3 reach = glm::max(glm::abs(bounds.mins - out.eye), glm::abs(bounds.maxs - out.eye));
    out.farQu = 2.0f * glm::length(reach);
    out.size = {buffers.extent.width, buffers.extent.height};
    out.footprint = static_cast<float>(buffers.extent.width) / part.x;
}

void TraceRenderer::describeSettings(RtFrame& out) const {
    out.seed = static_cast<uint32_t>(m_settings.rt_seed);
    out.lightsPerPixel = static_cast<uint32_t>(m_settings.rt_numRandomDL);
    out.candidatesPerChoice = static_cast<uint32_t>(m_settings.rt_lightCandidates);
    out.ambient = m_settings.rt_ambient;
    out.reflectionDepth = static_cast<uint32_t>(m_settings.rt_reflectionDepth);
    out.cullLights = static_cast<uint32_t>(m_settings.rt_cullLights);
    if (m_settings.rt_illumination) out.flags |= kFrameIllumination;
    if (m_settings.rt_blueNoise) out.flags |= kFrameBlueNoise;
    if (m_settings.rt_softshadows) out.flags |= kFrameSoftShadows;
    if (m_settings.rt_refraction) out.flags |= kFrameRefraction;
    if (m_settings.rt_antialiasing) out.flags |= kFrameAntialiasing;
    if (m_settings.rt_tonemap == 0) out.flags |= kFrameClampLight;
    if (m_settings.rt_linear) out.flags |= kFrameLinear;
    if (m_settings.rt_countWork) out.flags |= kFrameCountWork;
    if (countsRays()) out.flags |= kFrameCountRays;
    out.flags |= kSoughtAnyway[m_settings.rt_onlyRequired];
    out.exposure = m_settings.rt_exposure;
    out.lightScale = std::exp2(static_cast<float>(settings().r_mapOverBrightBits - kWhiteOverbrightBits));
    out.leastLight = m_settings.rt_minLight;
    out.curve = static_cast<uint32_t>(m_settings.rt_tonemap);
    out.curveWhite = kCurveWhite;
}

std::vector<uint32_t> TraceRenderer::settingsKey() const {
    std::vector<uint32_t> key;
    appendBits(key,
               std::array{m_settings.rt_illumination, m_settings.rt_cullLights, m_settings.rt_softshadows,
                          m_settings.rt_blueNoise, m_settings.rt_antialiasing, m_settings.rt_seed,
                          m_settings.rt_tonemap, m_settings.rt_linear, m_settings.rt_dof, m_settings.rt_refraction});
    appendBits(key, std::array{m_settings.rt_ambient, m_settings.rt_exposure, m_settings.rt_minLight,
                               m_settings.rt_aperture, m_settings.rt_focallength});
    return key;
}

std::vector<uint32_t> TraceRenderer::viewKey(const FrameCommands& frame, const SceneView& scene) const {
    std::vector<uint32_t> key = settingsKey();
    appendBits(key, std::array{m_settings.rt_numRandomDL, m_settings.rt_reflectionDepth});
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

bool TraceRenderer::accumulates() const {
    return m_settings.rt_accumulate != 0 || m_settings.rt_compare == kCompareAccumulated;
}

const TracedView& TraceRenderer::prepareView(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers) {
    buildViewGeometry(frame, scene, scene.view, world(), models(), materials(), viewGeometrySettings(), m_geometry);
    const std::span<const SceneLight> lights(frame.lights.data() + scene.firstLight, scene.lightCount);
    const std::span<const SceneEntity> entities(frame.entities.data() + scene.firstEntity, scene.entityCount);
    RtFrame camera{};
    describeView(scene, buffers, camera);
    m_views.push_back(m_scene->prepare(camera, m_geometry, lights, {entities, scene.timeMs}));
    TracedView& view = m_views.back();
    describeSettings(view.frame);
    constexpr float kEverywhere = std::numeric_limits<float>::max();
    view.frame.nearArea = vec4(-kEverywhere, -kEverywhere, kEverywhere, kEverywhere);
    if (!(kSoughtAnyway[m_settings.rt_onlyRequired] & kFrameNearEntities))
        view.frame.nearArea = findNearArea(m_geometry, view.frame);
    view.frame.frame = m_frameNumber++;
    preparePicture(frame, scene, buffers, view.frame);
    prepareHistory(frame, scene, buffers, view.frame);
    view.frame.looks = buffers.looks.address();
    view.frame.pixels = buffers.pixels.address();
    view.frame.shadowRays = buffers.shadowRays.address();
    view.frame.shadowBins = buffers.shadowBins.address();
    view.frame.shadowOrder = buffers.shadowOrder.address();
    view.frame.irradiance = buffers.irradiance.address();
    view.frame.ambientL = buffers.ambient.address();
    view.frame.lighting = buffers.denoiser ? buffers.denoiser->lighting().address() : view.frame.irradiance;
    view.frame.radiance = buffers.radiance.address();
    view.frame.picture = buffers.picture.address();
    m_scene->finish(view);
    m_movingTriangleCount = view.movingTriangleCount;
    m_instanceCount = view.instanceCount;
    m_classCounts = view.counts;
    return view;
}

void TraceRenderer::preparePicture(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers,
                                   RtFrame& out) {
    buffers.turnPicture(context().device(), accumulates(), m_settings.rt_autoExposure != 0);
    if (buffers.sums) {
        buffers.sums->count(viewKey(frame, scene));
        out.sampleNumber = buffers.sums->sampleNumber;
        out.sums = buffers.sums->sums.address();
        out.reference = buffers.sums->reference.address();
    }
    if (buffers.exposure) {
        out.autoExposure = buffers.exposure->address();
        const int passedMs =
            std::clamp(scene.timeMs - buffers.exposureTimeMs.value_or(scene.timeMs), 0, kLongestFrameMs);
        m_exposureStep = {.first = !buffers.exposureTimeMs,
                          .mostStops = m_settings.rt_exposureSpeed * static_cast<float>(passedMs) / 1000};
        buffers.exposureTimeMs = scene.timeMs;
    }
    if (buffers.exposure || !m_radianceFile.empty()) out.flags |= kFrameKeepRadiance;
    out.report = m_report->address();
}

void TraceRenderer::prepareHistory(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers,
                                   RtFrame& out) {
    const bool filtered = m_settings.rt_accumulate == 0;
    const bool scaled = buffers.extent.width < buffers.area.extent.width;
    const bool antialiased = m_settings.rt_taa != 0 && filtered;
    const auto kind =
        filtered && m_settings.rt_illumination ? static_cast<DenoiserKind>(m_settings.rt_denoiser) : DenoiserKind::None;
    buffers.turnHistory(context().device(), *m_denoisePipelines, kind, antialiased || scaled);
    if (!buffers.guides) return;
    advanceMotion(frame, scene, buffers, out);
    GrowingBuffer& stream = m_scene->stream();
    if (buffers.denoiser) buffers.denoiser->prepare(buffers, stream);
    if (!buffers.taa) return;
    // The mean over frames wants one jitter for the whole picture, evenly spread over the frames; a scaled one always.
    if (scaled) out.flags |= kFrameAntialiasing;
    out.flags |= kFrameSharedJitter;
    out.jitter = out.flags & kFrameAntialiasing ? spreadOverSquare(m_pictureNumber) : vec2(0.5f);
    buffers.taa->table = stream.append(describeTaa(buffers, out, antialiased)).address;
}

void TraceRenderer::advanceMotion(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers,
                                  RtFrame& out) {
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
}

VkExtent2D TraceRenderer::tracedExtent(VkExtent2D shown) const {
    // A reference has all pixels.
    if (accumulates()) return shown;
    const auto scale = [&](uint32_t pixels) {
        return std::max(1u, (pixels * static_cast<uint32_t>(m_settings.rt_scale) + 50) / 100);
    };
    return {scale(shown.width), scale(shown.height)};
}

ViewBuffers& TraceRenderer::buffersOf(const VkRect2D& area) {
    const VkExtent2D traced = tracedExtent(area.extent);
    const auto same = [](VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; };
    const auto found = std::find_if(m_buffers.begin(), m_buffers.end(), [&](const ViewBuffers& buffers) {
        return buffers.area.offset.x == area.offset.x && buffers.area.offset.y == area.offset.y &&
               same(buffers.area.extent, area.extent) && same(buffers.extent, traced) &&
               buffers.lastPicture != m_pictureNumber;
    });
    m_lastBuffers = found != m_buffers.end() ? &*found : &m_buffers.emplace_back(context().device(), area, traced);
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

RtOutput TraceRenderer::describeOutput(const ViewBuffers& buffers, const TracedView& view) const {
    const bool accumulated = m_settings.rt_accumulate != 0;
    const Buffer& filtered = buffers.taa ? buffers.taa->history : buffers.picture;
    const VkRect2D& area = buffers.area;
    const uint32_t middle = area.extent.width / 2;
    RtOutput output{};
    output.frame = view.frameSlice.address;
    output.picture = (accumulated ? buffers.sums->reference : filtered).address();
    output.right = (buffers.sums ? buffers.sums->reference : filtered).address();
    output.corner = {static_cast<uint32_t>(area.offset.x), static_cast<uint32_t>(area.offset.y)};
    output.size = {area.extent.width, area.extent.height};
    output.split = m_settings.rt_compare == kCompareAccumulated ? middle : area.extent.width;
    output.firstColumn = m_settings.rt_compare == kCompareRaster ? middle : 0;
    return output;
}

} // namespace q3rt
