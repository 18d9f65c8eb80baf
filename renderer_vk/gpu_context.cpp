#include "renderer_vk/gpu_context.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/readback.hpp"
#include "gpu/software_driver.hpp"
#include "renderer_vk/window.hpp"

namespace q3rt {

GpuContext::GpuContext(EngineServices& engine, const RasterSettings& settings)
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
    } else if (const auto found = findVideoMode(settings, {kFallbackMode.width, kFallbackMode.height})) {
        mode = *found;
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
    createTargets();
}

GpuContext::~GpuContext() {
    if (m_device) m_device->waitIdle();
}

void GpuContext::createTargets() {
    m_target = GpuImage(*m_device, {.extent = m_extent,
                                    .format = kTargetFormat,
                                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_STORAGE_BIT,
                                    .name = "target"});
    m_depth = GpuImage(*m_device, {.extent = m_extent,
                                   .format = depthStencilFormat(*m_device),
                                   .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                   .name = "depth"});
    // Black with alpha 1, which nothing ever overwrites; depth far.
    m_device->submitAndWait([&](VkCommandBuffer commands) {
        const ResourceState written{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
        m_target.transition(commands, written);
        m_depth.transition(commands, written);
        const VkClearColorValue black{.float32 = {0, 0, 0, 1}};
        const VkClearDepthStencilValue far{1.0f, 0};
        const VkImageSubresourceRange color{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        const VkImageSubresourceRange depth{aspectOf(m_depth.info().format), 0, 1, 0, 1};
        vkCmdClearColorImage(commands, m_target.handle(), written.layout, &black, 1, &color);
        vkCmdClearDepthStencilImage(commands, m_depth.handle(), written.layout, &far, 1, &depth);
    });
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

void GpuContext::beginFrame() { m_ring->begin(); }

void GpuContext::abandonFrame() {
    if (m_ring->recording()) m_ring->abandon();
}

void GpuContext::addPresent(FrameGraph& graph, ImageId target) {
    if (!m_swapchain || !m_swapchain->acquire(m_window->drawableExtent())) return;
    ImageId screen = graph.importForeign("screen", m_swapchain->image(), m_swapchain->view(),
                                         {.extent = m_swapchain->extent(), .format = m_swapchain->format()});
    graph.addPass(
        "present copy",
        [&](PassBuilder& pass) {
            pass.read(target, access::kTransferRead);
            screen = pass.write(screen, access::kTransferWrite);
        },
        [target, screen](PassContext& pass) {
            const VkExtent2D from = pass.extent(target), to = pass.extent(screen);
            VkImageBlit region{};
            region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.srcOffsets[1] = {static_cast<int>(from.width), static_cast<int>(from.height), 1};
            region.dstOffsets[1] = {static_cast<int>(to.width), static_cast<int>(to.height), 1};
            const bool same = from.width == to.width && from.height == to.height;
            vkCmdBlitImage(pass.commands(), pass.image(target), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           pass.image(screen), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                           same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
        });
    graph.addPass(
        "present",
        [&](PassBuilder& pass) {
            pass.read(screen, access::kPresent);
            pass.keep();
        },
        [](PassContext&) {});
}

void GpuContext::endFrame(FrameGraph& graph, FrameImage* capture) {
    m_executor->run(graph, *m_ring);
    m_ring->submit(m_swapchain && m_swapchain->acquired() ? m_swapchain.get() : nullptr);
    if (!capture) return;
    const std::vector<std::byte> rgba = readImage(*m_device, m_target);
    capture->width = static_cast<int>(m_extent.width);
    capture->height = static_cast<int>(m_extent.height);
    const size_t pixels = static_cast<size_t>(m_extent.width) * m_extent.height;
    capture->rgb.resize(pixels * 3);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            capture->rgb[i * 3 + c] = static_cast<uint8_t>(rgba[i * 4 + c]);
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
