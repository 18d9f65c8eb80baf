#include "gpu/swapchain.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

// Frames in flight and one more: a semaphore is used again only after its frame's fence was waited for.
constexpr uint32_t kReadySemaphores = 3;

} // namespace

Swapchain::Swapchain(Device& device, VkExtent2D extent, int swapInterval)
    : m_device(device) {
    if (!device.surface()) throw UsageError("a swapchain needs a device that was made with a window's surface");
    chooseFormat();
    choosePresentMode(swapInterval);
    for (uint32_t i = 0; i < kReadySemaphores; ++i)
        m_readySemaphores.push_back(makeSemaphore());
    create(extent);
}

Swapchain::~Swapchain() {
    // Presentation has no fence: only an idle queue proves that its semaphores are free.
    vkDeviceWaitIdle(m_device.handle());
    destroyImages();
    for (const VkSemaphore semaphore : m_readySemaphores)
        vkDestroySemaphore(m_device.handle(), semaphore, nullptr);
    vkDestroySwapchainKHR(m_device.handle(), m_handle, nullptr);
}

VkSemaphore Swapchain::makeSemaphore() const {
    VkSemaphoreCreateInfo create{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    vkCheck(vkCreateSemaphore(m_device.handle(), &create, nullptr, &semaphore), "vkCreateSemaphore");
    return semaphore;
}

void Swapchain::chooseFormat() {
    uint32_t count = 0;
    vkCheck(vkGetPhysicalDeviceSurfaceFormatsKHR(m_device.physical(), m_device.surface(), &count, nullptr),
            "vkGetPhysicalDeviceSurfaceFormatsKHR");
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkCheck(vkGetPhysicalDeviceSurfaceFormatsKHR(m_device.physical(), m_device.surface(), &count, formats.data()),
            "vkGetPhysicalDeviceSurfaceFormatsKHR");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& offered : formats)
            if (offered.format == wanted && m_format == VK_FORMAT_UNDEFINED) {
                m_format = offered.format;
                m_colorSpace = offered.colorSpace;
            }
    if (m_format == VK_FORMAT_UNDEFINED)
        throw DeviceError("the window offers no 8-bit RGB format: run headless or on another display");
}

void Swapchain::choosePresentMode(int swapInterval) {
    uint32_t count = 0;
    vkCheck(vkGetPhysicalDeviceSurfacePresentModesKHR(m_device.physical(), m_device.surface(), &count, nullptr),
            "vkGetPhysicalDeviceSurfacePresentModesKHR");
    std::vector<VkPresentModeKHR> modes(count);
    vkCheck(vkGetPhysicalDeviceSurfacePresentModesKHR(m_device.physical(), m_device.surface(), &count, modes.data()),
            "vkGetPhysicalDeviceSurfacePresentModesKHR");
    std::vector<VkPresentModeKHR> wanted;
    if (swapInterval == 0) wanted = {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR};
    if (swapInterval < 0) wanted = {VK_PRESENT_MODE_FIFO_RELAXED_KHR};
    m_presentMode = VK_PRESENT_MODE_FIFO_KHR; // the one that is always there
    for (const VkPresentModeKHR mode : wanted)
        if (std::find(modes.begin(), modes.end(), mode) != modes.end()) {
            m_presentMode = mode;
            return;
        }
}

const char* Swapchain::describeMode() const {
    switch (m_presentMode) {
    case VK_PRESENT_MODE_IMMEDIATE_KHR:
        return "each frame at once, torn where it comes";
    case VK_PRESENT_MODE_MAILBOX_KHR:
        return "the newest frame at each refresh";
    case VK_PRESENT_MODE_FIFO_RELAXED_KHR:
        return "a frame a refresh, a late one at once";
    default:
        return "a frame a refresh";
    }
}

/// False if the window has no surface any more.
bool Swapchain::recoverSurface() {
    m_device.waitIdle();
    destroyImages();
    vkDestroySwapchainKHR(m_device.handle(), m_handle, nullptr);
    m_handle = VK_NULL_HANDLE;
    m_stale = true;
    try {
        m_device.remakeSurface();
    } catch (const DeviceError& error) {
        logLineOnce(LogLevel::Warning, "%s; no frame is shown until vid_restart", error.what());
        return false;
    }
    m_lost = false;
    return true;
}

void Swapchain::create(VkExtent2D extent) {
    m_requested = extent;
    VkSurfaceCapabilitiesKHR surface;
    const VkResult result =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(m_device.physical(), m_device.surface(), &surface);
    m_stale = true;
    m_lost = result == VK_ERROR_SURFACE_LOST_KHR;
    if (m_lost) return;
    vkCheck(result, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    // 0xffffffff: the surface takes the size that the swapchain has.
    if (surface.currentExtent.width != UINT32_MAX) extent = surface.currentExtent;
    extent.width = std::clamp(extent.width, surface.minImageExtent.width, surface.maxImageExtent.width);
    extent.height = std::clamp(extent.height, surface.minImageExtent.height, surface.maxImageExtent.height);
    m_extent = extent;
    if (extent.width == 0 || extent.height == 0) return; // minimised

    VkSwapchainCreateInfoKHR create{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    create.surface = m_device.surface();
    create.minImageCount = surface.minImageCount + 1;
    if (surface.maxImageCount > 0) create.minImageCount = std::min(create.minImageCount, surface.maxImageCount);
    create.imageFormat = m_format;
    create.imageColorSpace = m_colorSpace;
    create.imageExtent = extent;
    create.imageArrayLayers = 1;
    create.imageUsage =
        (VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT) &
        surface.supportedUsageFlags;
    create.preTransform = surface.currentTransform;
    create.compositeAlpha = (surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR)
                                ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    create.presentMode = m_presentMode;
    create.clipped = VK_TRUE;
    create.oldSwapchain = m_handle;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult creation = vkCreateSwapchainKHR(m_device.handle(), &create, nullptr, &made);
    m_lost = creation == VK_ERROR_SURFACE_LOST_KHR;
    if (m_lost) return;
    vkCheck(creation, "vkCreateSwapchainKHR");
    if (m_handle) {
        m_device.waitIdle();
        destroyImages();
        vkDestroySwapchainKHR(m_device.handle(), m_handle, nullptr);
    }
    m_handle = made;
    fetchImages();
    m_mayHoldBack = m_device.capabilities().software && m_images.size() > surface.minImageCount;
    m_stale = false;
}

void Swapchain::fetchImages() {
    uint32_t count = 0;
    vkCheck(vkGetSwapchainImagesKHR(m_device.handle(), m_handle, &count, nullptr), "vkGetSwapchainImagesKHR");
    m_images.resize(count);
    vkCheck(vkGetSwapchainImagesKHR(m_device.handle(), m_handle, &count, m_images.data()), "vkGetSwapchainImagesKHR");
    for (const VkImage image : m_images) {
        VkImageViewCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        create.image = image;
        create.viewType = VK_IMAGE_VIEW_TYPE_2D;
        create.format = m_format;
        create.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkImageView view = VK_NULL_HANDLE;
        vkCheck(vkCreateImageView(m_device.handle(), &create, nullptr, &view), "vkCreateImageView");
        m_views.push_back(view);
        m_drawnSemaphores.push_back(makeSemaphore());
    }
}

void Swapchain::destroyImages() {
    for (const VkImageView view : m_views)
        vkDestroyImageView(m_device.handle(), view, nullptr);
    for (const VkSemaphore semaphore : m_drawnSemaphores)
        vkDestroySemaphore(m_device.handle(), semaphore, nullptr);
    m_views.clear();
    m_drawnSemaphores.clear();
    m_images.clear();
    m_submitted.reset();
}

bool Swapchain::acquire(VkExtent2D extent) {
    m_acquired = false;
    if (extent.width != m_requested.width || extent.height != m_requested.height) m_stale = true;
    // Again: a swapchain can go out of date between being made and being asked, and be without a surface before.
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (m_lost && !recoverSurface()) return false;
        if (m_stale) create(extent);
        if (m_lost) continue;
        if (m_stale) return false;
        m_readyIndex = (m_readyIndex + 1) % kReadySemaphores;
        const VkResult result =
            vkAcquireNextImageKHR(m_device.handle(), m_handle, UINT64_MAX, imageReady(), VK_NULL_HANDLE, &m_current);
        m_lost = result == VK_ERROR_SURFACE_LOST_KHR;
        if (m_lost) continue;
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            m_stale = true;
            continue;
        }
        m_stale = result == VK_SUBOPTIMAL_KHR;
        if (!m_stale) vkCheck(result, "vkAcquireNextImageKHR");
        m_acquired = true;
        return true;
    }
    return false;
}

void Swapchain::abandonImage() {
    if (!m_acquired) return;
    m_acquired = false;
    m_stale = true; // the next one begins with all its images
    // Nobody waits for this one any more: it stays signalled.
    m_device.waitIdle();
    vkDestroySemaphore(m_device.handle(), imageReady(), nullptr);
    m_readySemaphores[m_readyIndex] = makeSemaphore();
}

void Swapchain::noteSubmitted(Show show) {
    m_acquired = false;
    m_submitted = m_current;
    if (show == Show::AtOnce || !m_mayHoldBack) showSubmitted();
}

void Swapchain::showSubmitted() {
    if (!m_submitted) return;
    const uint32_t image = *m_submitted;
    m_submitted.reset();
    const VkSemaphore waitFor = m_drawnSemaphores[image];
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &waitFor;
    info.swapchainCount = 1;
    info.pSwapchains = &m_handle;
    info.pImageIndices = &image;
    const VkResult result = vkQueuePresentKHR(m_device.queue(), &info);
    if (result == VK_ERROR_SURFACE_LOST_KHR)
        m_lost = true;
    else if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        m_stale = true;
    else
        vkCheck(result, "vkQueuePresentKHR");
}

} // namespace q3rt
