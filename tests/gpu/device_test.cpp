// Choice of device, capabilities, errors in words.

#include <cstdlib>

#include "gpu_test.hpp"

namespace q3rt {
namespace {

class DeviceTest : public GpuTest {};

TEST_F(DeviceTest, DescribesItself) {
    const Capabilities& can = device().capabilities();
    EXPECT_TRUE(can.usable());
    EXPECT_FALSE(can.deviceName.empty());
    EXPECT_FALSE(can.driverName.empty());
    EXPECT_GE(can.apiVersion, VK_API_VERSION_1_2);
    EXPECT_GE(can.maxBindlessTextures, 1024u);
    if (can.rayTracingPipeline) {
        EXPECT_GE(can.rayTracing.shaderGroupHandleSize, 32u);
        EXPECT_GE(can.acceleration.minAccelerationStructureScratchOffsetAlignment, 1u);
    }
    EXPECT_NE(describeCapabilities(can).find(can.deviceName), std::string::npos);
    RecordProperty("device", describeCapabilities(can));
}

TEST_F(DeviceTest, WantedNameChooses) {
    const std::string name = device().capabilities().deviceName;
    const Device again({.wanted = name.substr(1, 4)});
    EXPECT_EQ(again.capabilities().deviceName, name);
}

TEST_F(DeviceTest, UnknownNameListsWhatThereIs) {
    try {
        const Device none({.wanted = "no such card"});
        FAIL() << "a device of that name was found";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("no such card"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find(device().capabilities().deviceName), std::string::npos);
    }
}

TEST_F(DeviceTest, ListingLeavesALivingDeviceAlone) {
    const std::vector<Capabilities> all = listDevices();
    EXPECT_GE(all.size(), 1u);
    device().submitAndWait([&](VkCommandBuffer commands) {
        device().beginLabel(commands, "label");
        device().endLabel(commands);
    });
}

TEST_F(DeviceTest, PipelineCacheGoesRound) {
    const std::vector<std::byte> cache = device().pipelineCacheData();
    const Device again({.pipelineCache = cache});
    const Device foreign({.pipelineCache = std::vector<std::byte>(64, std::byte{0x5a})});
    EXPECT_TRUE(foreign.capabilities().usable());
}

TEST_F(DeviceTest, RetiredObjectsWaitForImmediateWork) {
    bool destroyed = false;
    device().submitAndWait([&](VkCommandBuffer) {
        device().retire([&] { destroyed = true; });
        EXPECT_FALSE(destroyed);
    });
    EXPECT_TRUE(destroyed);
    EXPECT_THROW(device().submitAndWait([&](VkCommandBuffer) { throw UsageError("stop"); }), UsageError);
}

TEST(VulkanErrors, ChecksNameCallResultAndPlace) {
    try {
        vkCheck(VK_ERROR_DEVICE_LOST, "vkQueueSubmit");
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_EQ(
            std::string(error.what()).find("vkQueueSubmit returned VK_ERROR_DEVICE_LOST (-4) at device_test.cpp:"), 0u);
    }
}

} // namespace
} // namespace q3rt
