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

ViewBuffers::ViewBuffers(Device& device, const VkRect2D& viewArea)
    : area(viewArea)
    , pixels(makeViewBuffer(device, viewArea.extent, sizeof(RtPixel), "pixels"))
    , irradiance(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "irradiance"))
    , ambient(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "ambient"))
    , radiance(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "radiance"))
    , means(makeViewBuffer(device, viewArea.extent, sizeof(RtMean), "means"))
    , picture(makeViewBuffer(device, viewArea.extent, sizeof(vec4), "picture")) {}

TaaBuffers::TaaBuffers(Device& device, VkExtent2D extent)
    : history(makeViewBuffer(device, extent, sizeof(vec4), "taa history"))
    , previousHistory(makeViewBuffer(device, extent, sizeof(vec4), "taa previous history")) {}

void ViewBuffers::turnHistory(Device& device, const DenoisePipelines* pipelines, DenoiserKind denoised,
                              bool antialiased) {
    const VkExtent2D extent = area.extent;
    const bool otherDenoiser = denoised != denoiserKind(), otherTaa = antialiased != (taa != nullptr);
    if (otherDenoiser || otherTaa) motion = ViewMotion();
    if (otherDenoiser) denoiser = makeDenoiser(denoised, device, pipelines, extent);
    if (otherTaa) taa = antialiased ? std::make_unique<TaaBuffers>(device, extent) : nullptr;
    const bool guided = denoiser || taa;
    if (guided != (guides != nullptr)) guides = guided ? std::make_unique<GuideBuffers>(device, extent) : nullptr;
    if (guides) std::swap(guides->guides, guides->previousGuides);
    if (taa) std::swap(taa->history, taa->previousHistory);
    if (denoiser) denoiser->turn(*this);
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
    const Buffer* gradients = buffers.denoiser ? buffers.denoiser->gradients() : nullptr;
    if (gradients && buffers.motion.isContinuous()) table.gradients = gradients->address();
    return table;
}

} // namespace q3rt
