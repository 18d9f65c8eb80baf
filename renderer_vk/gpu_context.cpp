#include "renderer_vk/gpu_context.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/graphics_pipeline.hpp"
#include "gpu/readback.hpp"
#include "gpu/software_driver.hpp"
#include "renderer_vk/window.hpp"

namespace q3rt {

namespace {

/// As many samples a pixel as asked for or, as OpenGL's windows do it, the next larger number; else the most there are.
VkSampleCountFlagBits chooseSamples(const Capabilities& can, int wanted) {
    if (wanted <= 1) return VK_SAMPLE_COUNT_1_BIT;
    const VkSampleCountFlags offered = can.limits.framebufferColorSampleCounts &
                                       can.limits.framebufferDepthSampleCounts &
                                       can.limits.framebufferStencilSampleCounts;
    VkSampleCountFlagBits chosen = VK_SAMPLE_COUNT_1_BIT;
    for (int count = 2; count <= VK_SAMPLE_COUNT_64_BIT && chosen < wanted; count *= 2)
        if (offered & static_cast<VkSampleCountFlags>(count)) chosen = static_cast<VkSampleCountFlagBits>(count);
    if (chosen < wanted)
        logLine(LogLevel::Warning, "r_ext_multisample %d: %s has at most %d samples a pixel", wanted,
                can.deviceName.c_str(), static_cast<int>(chosen));
    return chosen;
}

VkExtent2D scaledExtent(VkExtent2D extent, int percent) {
    const auto scale = [&](uint32_t size) { return std::max(size * static_cast<uint32_t>(percent) / 100, 1u); };
    return {scale(extent.width), scale(extent.height)};
}

/// Scaled if the sizes differ.
void blit(PassContext& pass, ImageId from, ImageId to) {
    const VkExtent2D size = pass.extent(from), wanted = pass.extent(to);
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<int>(size.width), static_cast<int>(size.height), 1};
    region.dstOffsets[1] = {static_cast<int>(wanted.width), static_cast<int>(wanted.height), 1};
    const bool same = size.width == wanted.width && size.height == wanted.height;
    vkCmdBlitImage(pass.commands(), pass.image(from), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pass.image(to),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

/// Whatever the formats say.
void copyBytes(PassContext& pass, ImageId from, ImageId to) {
    const VkExtent2D size = pass.extent(to);
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {size.width, size.height, 1};
    vkCmdCopyImage(pass.commands(), pass.image(from), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pass.image(to),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

} // namespace

GpuContext::GpuContext(EngineServices& engine, const RasterSettings& settings, bool rasterizer)
    : m_engine(engine) {
    VideoMode mode = kFallbackMode;
    DeviceOptions options;
    options.wanted = settings.r_device;
    offerFetchedDriver(); // before SDL makes a window for Vulkan: it asks the loader
    if (engine.wantsWindow()) {
        m_window = std::make_unique<Window>(engine, settings);
        mode = m_window->mode();
        m_fullscreen = m_window->fullscreen();
        options.instanceExtensions = m_window->instanceExtensions();
        if (m_window->presents())
            options.createSurface = [this](VkInstance instance) { return m_window->createSurface(instance); };
    } else {
        // A picture without a window fills its display if it may.
        m_fullscreen = settings.r_fullscreen != 0;
        if (const auto found = findVideoMode(settings, {kFallbackMode.width, kFallbackMode.height})) mode = *found;
    }
    m_extent = {static_cast<uint32_t>(mode.width), static_cast<uint32_t>(mode.height)};
    m_aspect = mode.windowAspect();
    m_device = std::make_unique<Device>(options);
    m_ring = std::make_unique<FrameRing>(*m_device);
    m_executor = std::make_unique<FrameExecutor>(*m_device);
    m_uploader = std::make_unique<Uploader>(*m_device);
    m_textures = std::make_unique<TextureStore>(*m_device);
    if (m_device->surface() != VK_NULL_HANDLE)
        m_swapchain = std::make_unique<Swapchain>(*m_device, m_window->drawableExtent(), settings.r_swapInterval);
    m_blueFirst = rasterizer && m_swapchain && m_device->capabilities().software &&
                  m_swapchain->format() == VK_FORMAT_B8G8R8A8_UNORM;
    if (rasterizer) m_samples = chooseSamples(m_device->capabilities(), settings.r_ext_multisample);
    m_main = makeTargets(m_extent, "target");
    if (rasterizer && settings.r_renderScale != 100)
        m_scaledWorld = makeTargets(scaledExtent(m_extent, settings.r_renderScale), "scaled world");
    m_ramp = std::make_unique<DisplayRamp>(*m_device, m_extent, m_swapchain ? m_swapchain->format() : kTargetFormat);
}

GpuContext::~GpuContext() {
    if (m_device) m_device->waitIdle();
}

TargetImages GpuContext::makeTargets(VkExtent2D extent, const std::string& name) {
    TargetImages made;
    made.color = GpuImage(*m_device, {.extent = extent,
                                      .format = kTargetFormat,
                                      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                               VK_IMAGE_USAGE_STORAGE_BIT,
                                      .name = name});
    made.depth = GpuImage(*m_device, {.extent = extent,
                                      .format = depthStencilFormat(*m_device),
                                      .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                      .samples = m_samples,
                                      .name = name + " depth"});
    if (m_samples != VK_SAMPLE_COUNT_1_BIT)
        made.samples = GpuImage(*m_device, {.extent = extent,
                                            .format = kTargetFormat,
                                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                            .samples = m_samples,
                                            .name = name + " samples"});
    // Black with alpha 1, which nothing ever overwrites; depth far.
    m_device->submitAndWait([&](VkCommandBuffer commands) {
        const auto become = [&](GpuImage& image, const Access& how) {
            if (image) image.transition(commands, {how.stages, how.access, how.layout});
        };
        become(made.color, access::kColorAttachment);
        become(made.samples, access::kColorAttachment);
        become(made.depth, access::kDepthAttachment);
        Attachment color{.view = made.color.view(),
                         .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
                         .clear = {.color = {.float32 = {0, 0, 0, 1}}}};
        if (made.samples) {
            color.view = made.samples.view();
            color.resolve = made.color.view();
        }
        const Attachment depth{.view = made.depth.view(),
                               .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
                               .clear = {.depthStencil = {1.0f, 0}},
                               .stencil = true};
        beginRendering(commands, extent, color, depth);
        vkCmdEndRenderingKHR(commands);
    });
    return made;
}

DisplayInfo GpuContext::displayInfo() const {
    const Capabilities& can = m_device->capabilities();
    DisplayInfo info;
    info.rendererText = can.deviceName;
    info.vendorText = can.driverName;
    info.versionText =
        formatText("Vulkan %u.%u.%u %s", VK_API_VERSION_MAJOR(can.apiVersion), VK_API_VERSION_MINOR(can.apiVersion),
                   VK_API_VERSION_PATCH(can.apiVersion), can.driverInfo.c_str());
    info.maxTextureSize = static_cast<int>(std::min<uint32_t>(can.limits.maxImageDimension2D, 16384));
    info.width = static_cast<int>(m_extent.width);
    info.height = static_cast<int>(m_extent.height);
    info.aspect = m_aspect;
    info.fullscreen = m_fullscreen;
    info.frequency = m_window ? m_window->refreshHz() : 0;
    return info;
}

std::string GpuContext::describePresentation() const {
    if (!m_swapchain) return "nowhere, the picture stays in memory";
    const VkExtent2D size = m_swapchain->extent();
    return formatText("in a window of %ux%u pixels on display %d, %s", size.width, size.height, m_window->display(),
                      m_swapchain->describeMode());
}

void GpuContext::beginFrame() {
    m_frameMemory.reset();
    m_ring->begin();
}

void GpuContext::abandonFrame() {
    if (m_ring->recording()) m_ring->abandon();
    if (m_swapchain) m_swapchain->abandonImage();
}

ImageId GpuContext::addScaling(FrameGraph& graph, ImageId picture, VkExtent2D extent) {
    return graph.addPass(
        "scale to window",
        [&](PassBuilder& pass) {
            pass.read(picture, access::kTransferRead);
            return pass.create("scaled picture", {.extent = extent, .format = kTargetFormat}, access::kTransferWrite);
        },
        [picture](PassContext& pass, ImageId scaled) { blit(pass, picture, scaled); });
}

void GpuContext::addPresent(FrameGraph& graph, ImageId target) {
    if (!m_swapchain || !m_swapchain->acquire(m_window->drawableExtent())) return;
    target = m_ramp->addTable(graph, target);
    ImageId screen = graph.importForeign("screen", m_swapchain->image(), m_swapchain->view(),
                                         {.extent = m_swapchain->extent(), .format = m_swapchain->format()});
    const VkExtent2D size = m_swapchain->extent();
    if (m_blueFirst && (size.width != m_extent.width || size.height != m_extent.height))
        target = addScaling(graph, target, size);
    graph.addPass(
        "present copy",
        [&](PassBuilder& pass) {
            pass.read(target, access::kTransferRead);
            screen = pass.write(screen, access::kTransferWrite);
        },
        [target, screen, bytes = m_blueFirst](PassContext& pass) {
            if (bytes)
                copyBytes(pass, target, screen);
            else
                blit(pass, target, screen);
        });
    screen = m_ramp->addDoublings(graph, screen);
    graph.addPass(
        "present",
        [&](PassBuilder& pass) {
            pass.read(screen, access::kPresent);
            pass.keep();
        },
        [](PassContext&) {});
}

void GpuContext::endFrame(FrameGraph& graph, FrameImage* capture, Show show) {
    m_executor->run(graph, *m_ring);
    m_ring->submit(m_swapchain.get(), show);
    if (!capture) return;
    const std::vector<std::byte> rgba = readImage(*m_device, m_main.color);
    capture->width = static_cast<int>(m_extent.width);
    capture->height = static_cast<int>(m_extent.height);
    const size_t pixels = static_cast<size_t>(m_extent.width) * m_extent.height;
    capture->rgb.resize(pixels * 3);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            capture->rgb[i * 3 + c] = (*m_ramp)[static_cast<uint8_t>(rgba[i * 4 + (m_blueFirst ? 2 - c : c)])];
}

void GpuContext::followWindow(const RasterSettings& settings) {
    if (!m_window || !m_window->presents()) return;
    if (m_window->setFullscreen(settings.r_fullscreen != 0)) {
        m_fullscreen = m_window->fullscreen();
        return;
    }
    logLineOnce(LogLevel::Warning, "full screen could not be switched; restarting the renderer");
    m_engine.executeText("vid_restart\n");
}

void GpuContext::minimize() {
    if (m_window) m_window->minimize();
}

} // namespace q3rt
