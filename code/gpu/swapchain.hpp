#pragma once
// Presentation to the device's surface.

#include <optional>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

/// When a submitted frame is handed to the display.
enum class Show {
    AtOnce,
    /// Just before the next frame is submitted, where handing over waits for the drawing (a software driver): the
    /// processor prepares that frame meanwhile. Only for frames that another one is sure to follow.
    WithNextFrame
};

class Swapchain {
  public:
    /// `extent` in pixels, used where the surface leaves the size to us. `swapInterval`: r_swapInterval; 0 tears
    /// (mailbox or immediate where offered), 1 waits for the display, -1 waits unless late.
    Swapchain(Device& device, VkExtent2D extent, int swapInterval);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Takes the next image for the frame being recorded. False: there is none now (minimised), skip presenting.
    /// An out-of-date swapchain is made anew first.
    bool acquire(VkExtent2D extent);
    /// Valid between acquire() and FrameRing::submit(). Its layout is undefined at first; leave it in PRESENT_SRC.
    VkImage image() const { return m_images[m_current]; }
    VkImageView view() const { return m_views[m_current]; }
    VkExtent2D extent() const { return m_extent; }
    VkFormat format() const { return m_format; } // 8-bit UNORM: the engine's bytes go out as they are
    bool acquired() const { return m_acquired; }
    /// The frame of an acquired image never comes: a swapchain whose images aren't given back runs out of them.
    void abandonImage();
    /// The window system took the surface: another one is made at the next acquire().
    void loseSurface() { m_lost = true; }
    /// When an image is shown, for people.
    const char* describeMode() const;

  private:
    friend class FrameRing;
    void create(VkExtent2D extent);
    bool recoverSurface();
    void fetchImages();
    void destroyImages();
    void chooseFormat();
    VkSemaphore makeSemaphore() const;
    void choosePresentMode(int swapInterval);
    VkSemaphore imageReady() const { return m_readySemaphores[m_readyIndex]; }
    VkSemaphore drawn() const { return m_drawnSemaphores[m_current]; }
    void noteSubmitted(Show show);
    void showSubmitted();

    Device& m_device;
    VkSwapchainKHR m_handle = VK_NULL_HANDLE;
    VkFormat m_format = VK_FORMAT_UNDEFINED;
    VkColorSpaceKHR m_colorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    VkPresentModeKHR m_presentMode = VK_PRESENT_MODE_FIFO_KHR;
    VkExtent2D m_extent{};
    VkExtent2D m_requested{}; // what the caller last asked for
    std::vector<VkImage> m_images;
    std::vector<VkImageView> m_views;
    std::vector<VkSemaphore> m_readySemaphores; // one a frame in flight and a spare, used in turn
    std::vector<VkSemaphore> m_drawnSemaphores; // one an image
    uint32_t m_readyIndex = 0;
    uint32_t m_current = 0;
    std::optional<uint32_t> m_submitted; // image that is drawn and not yet handed over
    bool m_mayHoldBack = false;          // one image may be held while the next is acquired, and it pays
    bool m_acquired = false;
    bool m_lost = false;  // so is its surface
    bool m_stale = false; // out of date or suboptimal: made anew at the next acquire()
};

} // namespace q3rt
