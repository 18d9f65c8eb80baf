#include "renderer_rt/view_buffers.hpp"

#include <algorithm>

#include "gpu/device.hpp"

namespace q3rt {

Buffer makeViewBuffer(Device& device, VkExtent2D extent, size_t bytes, const char* name) {
    return Buffer(device, {.size = VkDeviceSize{extent.width} * extent.height * bytes,
                           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                           .name = name});
}

VkExtent2D strataOf(VkExtent2D extent) {
    return {(extent.width + kStratumPixels - 1) / kStratumPixels,
            (extent.height + kStratumPixels - 1) / kStratumPixels};
}

GuideBuffers::GuideBuffers(Device& device, VkExtent2D extent)
    : guides(makeViewBuffer(device, extent, sizeof(RtGuide), "guides"))
    , previousGuides(makeViewBuffer(device, extent, sizeof(RtGuide), "previous guides"))
    , pasts(makeViewBuffer(device, extent, sizeof(RtPast), "pasts")) {}

DenoiseBuffers::DenoiseBuffers(Device& device, VkExtent2D extent)
    : previousPixels(makeViewBuffer(device, extent, sizeof(RtPixel), "previous pixels"))
    , previousIrradiance(makeViewBuffer(device, extent, sizeof(vec4), "previous irradiance"))
    , light(makeViewBuffer(device, extent, sizeof(vec4), "light"))
    , previousLight(makeViewBuffer(device, extent, sizeof(vec4), "previous light"))
    , moments(makeViewBuffer(device, extent, sizeof(vec2), "moments"))
    , previousMoments(makeViewBuffer(device, extent, sizeof(vec2), "previous moments"))
    , winners(makeViewBuffer(device, strataOf(extent), sizeof(uint32_t), "winners"))
    , gradients{makeViewBuffer(device, strataOf(extent), sizeof(vec2), "gradients 0"),
                makeViewBuffer(device, strataOf(extent), sizeof(vec2), "gradients 1")}
    , filtered{makeViewBuffer(device, extent, sizeof(vec4), "filtered 0"),
               makeViewBuffer(device, extent, sizeof(vec4), "filtered 1")} {}

ViewBuffers::ViewBuffers(Device& device, const VkRect2D& viewArea)
    : area(viewArea)
    , pixels(makeViewBuffer(device, viewArea.extent, sizeof(RtPixel), "pixels"))
    , irradiance(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "irradiance"))
    , radiance(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "radiance"))
    , means(makeViewBuffer(device, viewArea.extent, sizeof(RtMean), "means"))
    , picture(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "picture")) {}

TaaBuffers::TaaBuffers(Device& device, VkExtent2D extent)
    : history(makeViewBuffer(device, extent, sizeof(vec4), "taa history"))
    , previousHistory(makeViewBuffer(device, extent, sizeof(vec4), "taa previous history")) {}

void ViewBuffers::turnHistory(Device& device, bool denoised, bool antialiased) {
    const VkExtent2D extent = area.extent;
    if (denoised != (denoise != nullptr) || antialiased != (taa != nullptr)) motion = ViewMotion();
    if (denoised != (denoise != nullptr))
        denoise = denoised ? std::make_unique<DenoiseBuffers>(device, extent) : nullptr;
    if (antialiased != (taa != nullptr)) taa = antialiased ? std::make_unique<TaaBuffers>(device, extent) : nullptr;
    const bool guided = denoised || antialiased;
    if (guided != (guides != nullptr)) guides = guided ? std::make_unique<GuideBuffers>(device, extent) : nullptr;
    if (guides) std::swap(guides->guides, guides->previousGuides);
    if (taa) std::swap(taa->history, taa->previousHistory);
    if (!denoise) return;
    std::swap(pixels, denoise->previousPixels);
    std::swap(irradiance, denoise->previousIrradiance);
    std::swap(denoise->light, denoise->previousLight);
    std::swap(denoise->moments, denoise->previousMoments);
}

RtDenoise describeDenoise(const ViewBuffers& buffers, VkDeviceAddress motionToCurrent) {
    const DenoiseBuffers& denoise = *buffers.denoise;
    const ViewMotion& motion = buffers.motion;
    RtDenoise table{};
    table.pixels = buffers.pixels.address();
    table.previousPixels = denoise.previousPixels.address();
    table.irradiance = buffers.irradiance.address();
    table.previousIrradiance = denoise.previousIrradiance.address();
    table.guides = buffers.guides->guides.address();
    table.previousGuides = buffers.guides->previousGuides.address();
    table.pasts = buffers.guides->pasts.address();
    table.light = denoise.light.address();
    table.previousLight = denoise.previousLight.address();
    table.moments = denoise.moments.address();
    table.previousMoments = denoise.previousMoments.address();
    table.winners = denoise.winners.address();
    for (size_t i = 0; i < 2; ++i) {
        table.gradients[i] = denoise.gradients[i].address();
        table.filtered[i] = denoise.filtered[i].address();
    }
    table.motionToCurrent = motionToCurrent;
    table.camera = motion.current().camera;
    table.previousCamera = motion.previous().camera;
    const VkExtent2D size = buffers.area.extent, strata = strataOf(size);
    table.size = {size.width, size.height};
    table.strata = {strata.width, strata.height};
    table.frame = motion.current().sampleFrame;
    table.previousFrame = motion.previous().sampleFrame;
    table.pixelTangent = std::max(2.0f * glm::length(table.camera.left) / static_cast<float>(size.width),
                                  2.0f * glm::length(table.camera.up) / static_cast<float>(size.height));
    table.flags = motion.isContinuous() ? kDenoiseHistory : 0;
    return table;
}

RtTaa describeTaa(const ViewBuffers& buffers) {
    RtTaa table{};
    table.guides = buffers.guides->guides.address();
    table.pasts = buffers.guides->pasts.address();
    table.picture = buffers.picture.address();
    table.history = buffers.taa->history.address();
    table.previousHistory = buffers.taa->previousHistory.address();
    table.camera = buffers.motion.current().camera;
    table.previousCamera = buffers.motion.previous().camera;
    table.size = {buffers.area.extent.width, buffers.area.extent.height};
    const VkExtent2D strata = strataOf(buffers.area.extent);
    table.strata = {strata.width, strata.height};
    table.hasHistory = buffers.motion.isContinuous() ? 1 : 0;
    if (buffers.denoise && buffers.motion.isContinuous())
        table.gradients = buffers.denoise->gradients[kGradientLevels & 1].address();
    return table;
}

} // namespace q3rt
