#include "denoise_rig.hpp"

#include <cstring>

#include "frame/frame_graph.hpp"
#include "gpu/readback.hpp"
#include "renderer_rt/frame_report.hpp"
#include "renderer_rt/passes/check.hpp"
#include "shader_text.hpp"

namespace q3rt::test {

namespace {

template <typename T>
std::vector<T> readItems(Device& device, const Buffer& buffer) {
    const std::vector<std::byte> bytes = readBuffer(device, buffer);
    std::vector<T> items(bytes.size() / sizeof(T));
    std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
    return items;
}

} // namespace

DenoiseRig::DenoiseRig(Device& device, DenoiserKind kind)
    : m_device(device)
    , m_kind(kind)
    , m_ring(device)
    , m_executor(device)
    , m_uploader(device)
    , m_stream(device, {.size = 4096,
                        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                        .domain = MemoryDomain::Upload,
                        .name = "rig tables"})
    , m_pipelines(device)
    , m_buffers(device, {{0, 0}, kRigExtent}, kRigExtent) {}

RtFrame DenoiseRig::describeCamera(const vec3& eye) const {
    RtFrame out{};
    const float tanX = 1.0f, tanY = tanX * kRigExtent.height / kRigExtent.width;
    const vec3 forward = glm::normalize(vec3(1, 0, -0.3f)), left(0, 1, 0), up = glm::cross(forward, left);
    out.eye = eye;
    out.forward = out.forwardUnit = forward;
    out.left = left * tanX;
    out.up = up * tanY;
    return out;
}

std::vector<RtPixel> DenoiseRig::findSurfaces(const RtFrame& camera) const {
    std::vector<RtPixel> pixels;
    for (uint32_t y = 0; y < kRigExtent.height; ++y)
        for (uint32_t x = 0; x < kRigExtent.width; ++x) {
            const vec2 place((static_cast<float>(x) + 0.5f) / kRigExtent.width,
                             (static_cast<float>(y) + 0.5f) / kRigExtent.height);
            const vec3 direction = shader::cameraDirection(camera.forward, camera.left, camera.up, place);
            const float toFloor = direction.z < 0 ? -camera.eye.z / direction.z : 1e9f;
            const float toWall = direction.x > 0 ? (200 - camera.eye.x) / direction.x : 1e9f;
            RtPixel& pixel = pixels.emplace_back();
            pixel.position = camera.eye + direction * std::min(toFloor, toWall);
            pixel.normal = pixel.geometricNormal = toFloor < toWall ? vec3(0, 0, 1) : vec3(-1, 0, 0);
            pixel.lit = pixel.position.z <= 150 ? kLitStraight : 0;
            pixel.albedo = vec3(1);
            pixel.keyPixel = x | y << 16;
            pixel.keyFrame = m_number;
        }
    return pixels;
}

void DenoiseRig::uploadSurfaces(const std::vector<RtPixel>& pixels) {
    std::vector<RtGuide> guides;
    std::vector<RtPast> pasts;
    for (const RtPixel& pixel : pixels) {
        const uint32_t normal = pixel.lit ? shader::packNormal(pixel.normal) : shader::kNoNormal;
        guides.push_back({pixel.position, normal});
        pasts.push_back({pixel.position, normal});
    }
    m_uploader.upload(m_buffers.pixels, std::span<const RtPixel>(pixels));
    m_uploader.upload(m_buffers.guides->guides, std::span<const RtGuide>(guides));
    m_uploader.upload(m_buffers.guides->pasts, std::span<const RtPast>(pasts));
    m_uploader.flush();
}

void DenoiseRig::run(const std::function<void(FrameGraph& graph)>& addPasses) {
    FrameGraph graph;
    m_ring.begin();
    addPasses(graph);
    m_executor.run(graph, m_ring);
    m_ring.submit();
    m_device.waitIdle();
}

RigFrame DenoiseRig::draw(const vec3& eye, const LightFunction& light) {
    ++m_number;
    m_buffers.turnHistory(m_device, m_pipelines, m_kind, false);
    const RtFrame camera = describeCamera(eye);
    EntityPlace world;
    world.moves = false;
    m_buffers.motion.advance({.camera = cameraOf(camera),
                              .timeMs = static_cast<int>(m_number),
                              .sampleFrame = m_number,
                              .pictureNumber = m_number,
                              .settingsKey = {},
                              .entities = {world},
                              .instances = {InstancePlace{}},
                              .corners = {},
                              .indexAddress = {0}});
    m_stream.beginFrame(0);
    m_buffers.denoiser->prepare(m_buffers, m_stream);

    uploadSurfaces(findSurfaces(camera));
    run([&](FrameGraph& graph) {
        ViewResources resources = importView(graph, m_buffers);
        m_buffers.denoiser->addBeforeDirect(graph, resources);
    });

    RigFrame out;
    out.pixels = readItems<RtPixel>(m_device, m_buffers.pixels);
    std::vector<vec4> irradiance;
    for (const RtPixel& pixel : out.pixels) {
        out.carriedCount += pixel.keyFrame != m_number ? 1 : 0;
        out.traced.push_back(pixel.lit ? light(pixel) : vec3(1));
        irradiance.emplace_back(out.traced.back(), 1.0f);
    }
    m_uploader.upload(m_buffers.irradiance, std::span<const vec4>(irradiance));
    m_uploader.flush();
    run([&](FrameGraph& graph) {
        ViewResources resources = importView(graph, m_buffers);
        m_buffers.denoiser->addAfterDirect(graph, resources);
    });
    for (const vec4& shown : readItems<vec4>(m_device, m_buffers.denoiser->lighting()))
        out.shown.emplace_back(shown);
    return out;
}

uint64_t DenoiseRig::countNonFinite(const std::vector<RtGuide>& guides) {
    m_buffers.turnHistory(m_device, m_pipelines, m_kind, false);
    m_uploader.upload(m_buffers.guides->guides, std::span<const RtGuide>(guides));
    m_uploader.flush();
    const PicturePipelines pictures(m_device);
    FrameReport report(m_device, m_ring.framesInFlight());
    const FiniteCheck check{report, pictures};
    run([&](FrameGraph& graph) {
        report.beginFrame(m_ring.slot());
        ViewResources resources = importView(graph, m_buffers);
        resources.report = report.addClear(graph);
        resources.check = &check;
        checkFinite(graph, resources, "guides", resources.guides, kGuideItem, kRigExtent);
        report.addCopy(graph, resources.report);
    });
    report.beginFrame(m_ring.slot());
    return report.latest().counts.at(0).nonFinite;
}

double meanLuminance(const RigFrame& frame, const std::vector<vec3>& light) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < light.size(); ++i) {
        if (frame.pixels[i].lit == 0) continue;
        sum += shader::luminanceOf(light[i]);
        ++count;
    }
    return sum / static_cast<double>(count);
}

} // namespace q3rt::test
