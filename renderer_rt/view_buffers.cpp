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

VkExtent2D wholeTiles(VkExtent2D extent) {
    const auto whole = [](uint32_t pixels) { return (pixels + kShadowTile - 1) / kShadowTile * kShadowTile; };
    return {whole(extent.width), whole(extent.height)};
}

GuideBuffers::GuideBuffers(Device& device, VkExtent2D extent)
    : guides(makeViewBuffer(device, extent, sizeof(RtGuide), "guides"))
    , previousGuides(makeViewBuffer(device, extent, sizeof(RtGuide), "previous guides"))
    , pasts(makeViewBuffer(device, extent, sizeof(RtPast), "pasts")) {}

ViewBuffers::ViewBuffers(Device& device, const VkRect2D& viewArea, VkExtent2D tracedExtent)
    : area(viewArea)
    , extent(tracedExtent)
    , looks(makeViewBuffer(device, extent, sizeof(RtLook), "looks"))
    , pixels(makeViewBuffer(device, extent, sizeof(RtPixel), "pixels"))
    , shadowRays(makeViewBuffer(device, extent, sizeof(RtShadowRay), "shadow rays"))
    , shadowBins(makeViewBuffer(device, extent, sizeof(uint32_t), "shadow bins"))
    , shadowOrder(makeViewBuffer(device, wholeTiles(extent), sizeof(uint32_t), "shadow order"))
    , irradiance(makeViewBuffer(device, extent, sizeof(vec4), "irradiance"))
    , ambient(makeViewBuffer(device, extent, sizeof(vec4), "ambient"))
    , radiance(makeViewBuffer(device, extent, sizeof(vec4), "radiance"))
    , picture(makeViewBuffer(device, extent, sizeof(vec4), "picture")) {}

TaaBuffers::TaaBuffers(Device& device, VkExtent2D extent)
    : history(makeViewBuffer(device, extent, sizeof(vec4), "taa history"))
    , previousHistory(makeViewBuffer(device, extent, sizeof(vec4), "taa previous history")) {}

SumBuffers::SumBuffers(Device& device, VkExtent2D extent)
    : sums(makeViewBuffer(device, extent, sizeof(RtSums), "sums"))
    , reference(makeViewBuffer(device, extent, sizeof(vec4), "reference")) {}

void SumBuffers::count(std::vector<uint32_t> key) {
    sampleNumber = key == viewKey ? sampleNumber + 1 : 0;
    viewKey = std::move(key);
}

void ViewBuffers::turnHistory(Device& device, const DenoisePipelines& pipelines, DenoiserKind denoised,
                              bool antialiased) {
    const bool otherDenoiser = denoised != denoiserKind(), otherTaa = antialiased != (taa != nullptr);
    if (otherDenoiser || otherTaa) motion = ViewMotion();
    if (otherDenoiser) denoiser = makeDenoiser(denoised, device, pipelines, extent);
    if (otherTaa) taa = antialiased ? std::make_unique<TaaBuffers>(device, area.extent) : nullptr;
    const bool guided = denoiser || taa;
    if (guided != (guides != nullptr)) guides = guided ? std::make_unique<GuideBuffers>(device, extent) : nullptr;
    if (guides) std::swap(guides->guides, guides->previousGuides);
    if (taa) std::swap(taa->history, taa->previousHistory);
    if (denoiser) denoiser->turn(*this);
}

void ViewBuffers::turnPicture(Device& device, bool accumulated, bool autoExposed) {
    if (accumulated != (sums != nullptr)) sums = accumulated ? std::make_unique<SumBuffers>(device, extent) : nullptr;
    if (autoExposed == (exposure != nullptr)) return;
    exposure = autoExposed ? std::make_unique<Buffer>(makeViewBuffer(device, {1, 1}, sizeof(RtExposure), "exposure"))
                           : nullptr;
    exposureTimeMs.reset();
}

RtTaa describeTaa(const ViewBuffers& buffers, const RtFrame& frame, bool usesHistory) {
    RtTaa table{};
    table.guides = buffers.guides->guides.address();
    table.pasts = buffers.guides->pasts.address();
    table.picture = buffers.picture.address();
    table.history = buffers.taa->history.address();
    table.previousHistory = buffers.taa->previousHistory.address();
    table.camera = buffers.motion.current().camera;
    table.previousCamera = buffers.motion.previous().camera;
    table.size = {buffers.extent.width, buffers.extent.height};
    table.outputSize = {buffers.area.extent.width, buffers.area.extent.height};
    const VkExtent2D strata = strataOf(buffers.extent);
    table.strata = {strata.width, strata.height};
    table.jitter = frame.jitter;
    table.autoExposure = frame.autoExposure;
    table.hasHistory = usesHistory && buffers.motion.isContinuous() ? 1 : 0;
    const Buffer* gradients = buffers.denoiser ? buffers.denoiser->gradients() : nullptr;
    if (gradients && buffers.motion.isContinuous()) table.gradients = gradients->address();
    return table;
}

} // namespace q3rt
