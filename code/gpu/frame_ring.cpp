#include "gpu/frame_ring.hpp"

#include "base/error.hpp"
#include "gpu/device.hpp"
#include "gpu/swapchain.hpp"

namespace q3rt {

FrameRing::FrameRing(Device& device, uint32_t framesInFlight)
    : m_device(device)
    , m_timers(device, framesInFlight) {
    m_slots.resize(framesInFlight);
    for (Slot& slot : m_slots) {
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pool.queueFamilyIndex = device.queueFamily();
        vkCheck(vkCreateCommandPool(device.handle(), &pool, slot.memory->callbacks(), &slot.pool),
                "vkCreateCommandPool");
        VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocate.commandPool = slot.pool;
        allocate.commandBufferCount = 1;
        vkCheck(vkAllocateCommandBuffers(device.handle(), &allocate, &slot.commands), "vkAllocateCommandBuffers");
        VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        vkCheck(vkCreateFence(device.handle(), &fence, nullptr, &slot.fence), "vkCreateFence");
        slot.descriptors = std::make_unique<DescriptorArena>(device);
    }
}

FrameRing::~FrameRing() {
    if (m_recording) m_device.m_frameOpen = false;
    for (Slot& slot : m_slots)
        m_device.retire([device = m_device.handle(), memory = slot.memory, pool = slot.pool, fence = slot.fence] {
            vkDestroyFence(device, fence, nullptr);
            vkDestroyCommandPool(device, pool, memory->callbacks());
        });
}

void FrameRing::waitFor(Slot& slot) {
    if (slot.frame == 0) return;
    vkCheck(vkWaitForFences(m_device.handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    m_device.noteFramesFinished(slot.frame);
}

VkCommandBuffer FrameRing::begin() {
    if (m_recording) throw UsageError("FrameRing::begin is called inside a frame");
    m_slot = (m_slot + 1) % framesInFlight();
    Slot& slot = m_slots[m_slot];
    waitFor(slot);
    slot.descriptors->reset();
    vkCheck(vkResetCommandPool(m_device.handle(), slot.pool, 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkCheck(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
    m_recording = true;
    m_device.m_frameOpen = true;
    m_frameNumber = m_device.m_framesSubmitted + 1;
    m_timers.beginFrame(slot.commands, m_slot, m_frameNumber);
    return slot.commands;
}

void FrameRing::submit(Swapchain* swapchain, Show show) {
    if (!m_recording) throw UsageError("FrameRing::submit is called outside a frame");
    Slot& slot = m_slots[m_slot];
    const bool presents = swapchain && swapchain->acquired();
    vkCheck(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
    vkCheck(vkResetFences(m_device.handle(), 1, &slot.fence), "vkResetFences");
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot.commands;
    VkSemaphoreSubmitInfo ready{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    VkSemaphoreSubmitInfo drawn{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    if (presents) {
        ready.semaphore = swapchain->imageReady();
        ready.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        drawn.semaphore = swapchain->drawn();
        drawn.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        submit.waitSemaphoreInfoCount = 1;
        submit.pWaitSemaphoreInfos = &ready;
        submit.signalSemaphoreInfoCount = 1;
        submit.pSignalSemaphoreInfos = &drawn;
    }
    m_recording = false;
    m_device.m_frameOpen = false;
    slot.frame = 0;                            // if the submission fails, nothing will ever signal the fence
    if (swapchain) swapchain->showSubmitted(); // before: the driver would wait for these commands too
    vkCheck(vkQueueSubmit2KHR(m_device.queue(), 1, &submit, slot.fence), "vkQueueSubmit2KHR");
    slot.frame = ++m_device.m_framesSubmitted;
    if (presents) swapchain->noteSubmitted(show);
}

void FrameRing::abandon() {
    if (!m_recording) return;
    m_recording = false;
    m_device.m_frameOpen = false;
    --m_frameNumber;
    m_timers.abandonFrame();
    // The commands never run; the slot's fence and frame stay those of the last submit.
    vkEndCommandBuffer(m_slots[m_slot].commands);
}

void FrameRing::wait(uint64_t number) {
    for (Slot& slot : m_slots)
        if (slot.frame == number) waitFor(slot);
}

} // namespace q3rt
