// The tests' own instrument: a hazard, a leak and a wrong call must be noticed, or silence would prove nothing.

#include <cstdlib>

#include "base/log.hpp"
#include "gpu/buffer.hpp"
#include "gpu_test.hpp"

namespace q3rt {
namespace {

/// Messages of what `use` does with a validated device, its destruction included.
template <typename Use>
std::vector<std::string> messagesOf(const Use& use) {
    setLogSink([](LogLevel, std::string_view) {});
    std::shared_ptr<const std::vector<std::string>> messages;
    {
        Device device({.validation = true});
        messages = device.validationMessages();
        use(device);
    }
    setLogSink({});
    return *messages;
}

class ValidationTest : public GpuTest {};

TEST_F(ValidationTest, CleanUseIsSilent) {
    EXPECT_TRUE(messagesOf([](Device& device) { device.waitIdle(); }).empty());
}

TEST_F(ValidationTest, MissingBarrierIsReported) {
    if (!device().validating()) GTEST_SKIP() << "validation is switched off";
    const std::vector<std::string> messages = messagesOf([](Device& device) {
        const Buffer buffer(device, {.size = 64});
        device.submitAndWait([&](VkCommandBuffer commands) {
            vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 1);
            vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 2);
        });
    });
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos) << messages[0];
}

TEST_F(ValidationTest, LeakIsReportedAtDestruction) {
    if (!device().validating()) GTEST_SKIP() << "validation is switched off";
    const std::vector<std::string> messages = messagesOf([](Device& device) {
        VkFenceCreateInfo create{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        VkFence fence = VK_NULL_HANDLE;
        vkCheck(vkCreateFence(device.handle(), &create, nullptr, &fence), "vkCreateFence");
    });
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("VkFence"), std::string::npos) << messages[0];
}

TEST_F(ValidationTest, NoDriverIsSaidInWordsWithTheRemedy) {
    const char* before = std::getenv("VK_DRIVER_FILES");
    const std::string kept = before ? before : "";
    setenv("VK_DRIVER_FILES", "/no/such/driver.json", 1);
    std::string text;
    try {
        const Device none(DeviceOptions{});
    } catch (const DeviceError& error) {
        text = error.what();
    }
    if (before)
        setenv("VK_DRIVER_FILES", kept.c_str(), 1);
    else
        unsetenv("VK_DRIVER_FILES");
    EXPECT_NE(text.find("no Vulkan driver was found"), std::string::npos) << text;
    EXPECT_NE(text.find("VK_DRIVER_FILES=/no/such/driver.json; correct or unset it"), std::string::npos) << text;
}

} // namespace
} // namespace q3rt
