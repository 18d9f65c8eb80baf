#include "gpu/sampler.hpp"

#include <algorithm>

#include "gpu/device.hpp"

namespace q3rt {

SamplerCache::~SamplerCache() {
    for (const auto& [info, sampler] : m_samplers)
        vkDestroySampler(m_device.handle(), sampler, nullptr);
}

VkSampler SamplerCache::find(const SamplerInfo& info) {
    const auto known = m_samplers.find(info);
    if (known != m_samplers.end()) return known->second;
    const Capabilities& can = m_device.capabilities();
    VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    create.magFilter = info.magFilter;
    create.minFilter = info.minFilter;
    create.mipmapMode = info.mipmapMode;
    create.addressModeU = info.addressU;
    create.addressModeV = info.addressV;
    create.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    create.mipLodBias = std::clamp(info.lodBias, -can.limits.maxSamplerLodBias, can.limits.maxSamplerLodBias);
    create.anisotropyEnable = can.samplerAnisotropy && info.maxAnisotropy > 1;
    create.maxAnisotropy = create.anisotropyEnable ? std::min(info.maxAnisotropy, can.limits.maxSamplerAnisotropy) : 1;
    create.maxLod = info.maxLod;
    create.borderColor = info.border;
    VkSampler sampler = VK_NULL_HANDLE;
    vkCheck(vkCreateSampler(m_device.handle(), &create, nullptr, &sampler), "vkCreateSampler");
    m_samplers.emplace(info, sampler);
    return sampler;
}

} // namespace q3rt
