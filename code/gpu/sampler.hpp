#pragma once
// Samplers by description: equal descriptions share one, all live as long as the device.

#include <compare>
#include <map>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

struct SamplerInfo {
    VkFilter magFilter = VK_FILTER_LINEAR;
    VkFilter minFilter = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VkSamplerAddressMode addressU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode addressV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    float maxLod = VK_LOD_CLAMP_NONE; // 0: base level only
    float lodBias = 0;
    float maxAnisotropy = 1; // above 1 where the device can; clamped to its limit
    VkBorderColor border = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;

    auto operator<=>(const SamplerInfo&) const = default;
};

class SamplerCache {
  public:
    explicit SamplerCache(Device& device)
        : m_device(device) {}
    ~SamplerCache();
    SamplerCache(const SamplerCache&) = delete;
    SamplerCache& operator=(const SamplerCache&) = delete;
    VkSampler find(const SamplerInfo& info);
    size_t size() const { return m_samplers.size(); }

  private:
    Device& m_device;
    std::map<SamplerInfo, VkSampler> m_samplers;
};

} // namespace q3rt
