#pragma once
// A device with core and synchronisation validation for each test; no message and no leak may be left at the end.

#include <cstdlib>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {

class GpuTest : public testing::Test {
  protected:
    void SetUp() override {
        try {
            DeviceOptions wanted = options();
            // For machines with a GPU and no layers.
            const char* without = std::getenv("Q3RT_TEST_WITHOUT_VALIDATION");
            if (without && std::string(without) == "1") wanted.validation = false;
            m_device = std::make_unique<Device>(wanted);
        } catch (const DeviceError& error) {
            GTEST_SKIP() << "no Vulkan device to test on: " << error.what();
        }
        m_messages = m_device->validationMessages();
    }

    void TearDown() override {
        if (!m_device) return;
        m_device->waitIdle();
        EXPECT_EQ(m_device->memory().measureUse().allocationCount, 0u) << "memory is still held";
        EXPECT_EQ(m_device->retiredCount(), 0u);
        m_device.reset();
        // Read after destruction: the layer lists leaked objects there.
        for (const std::string& message : *m_messages)
            ADD_FAILURE() << message;
    }

    virtual DeviceOptions options() { return {.validation = true}; }
    Device& device() { return *m_device; }

  private:
    std::unique_ptr<Device> m_device;
    std::shared_ptr<const std::vector<std::string>> m_messages;
};

} // namespace q3rt
