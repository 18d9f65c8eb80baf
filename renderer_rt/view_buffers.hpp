#pragma once
// Buffers of one view, kept between frames: what the stages hand on, the running mean, and the histories of the
// denoiser and of temporal anti-aliasing if they are on.

#include <memory>
#include <optional>

#include "gpu/buffer.hpp"
#include "renderer_rt/denoiser.hpp"
#include "renderer_rt/view_motion.hpp"
#include "shaders/shared/rt_denoise.h"
#include "shaders/shared/rt_exposure.h"
#include "shaders/shared/rt_look.h"
#include "shaders/shared/rt_shadow.h"
#include "shaders/shared/rt_sums.h"
#include "shaders/shared/rt_taa.h"

namespace q3rt {

/// Storage that shaders reach by address; `bytes` for each of width x height.
Buffer makeViewBuffer(Device& device, VkExtent2D extent, size_t bytes, const char* name);

/// Strata of a picture, those at the right and lower edges perhaps cut.
VkExtent2D strataOf(VkExtent2D extent);

/// The least extent of whole tiles of shadow rays that covers the picture.
VkExtent2D wholeTiles(VkExtent2D extent);

/// What finds a pixel's place in the frame before.
struct GuideBuffers {
    Buffer guides, previousGuides; ///< RtGuide[]
    Buffer pasts;                  ///< RtPast[]
    GuideBuffers(Device& device, VkExtent2D extent);
};

struct TaaBuffers {
    Buffer history, previousHistory;
    VkDeviceAddress table = 0; ///< RtTaa of the frame
    TaaBuffers(Device& device, VkExtent2D extent);
};

/// The mean of plain samples.
struct SumBuffers {
    Buffer sums;                   ///< RtSums[]
    Buffer reference;              ///< vec4[]: what is shown of the mean
    uint32_t sampleNumber = 0;     ///< of this frame's sample; 0 starts a new mean
    std::vector<uint32_t> viewKey; ///< of the view that the mean belongs to; empty: of none
    SumBuffers(Device& device, VkExtent2D extent);
    /// This frame's sample belongs to a view of this key.
    void count(std::vector<uint32_t> key);
};

struct ViewBuffers {
    VkRect2D area{};     ///< on the target
    VkExtent2D extent{}; ///< of what is traced, pixels
    Buffer looks, pixels, shadowRays, shadowBins, shadowOrder, irradiance, ambient, radiance, picture;
    ViewMotion motion;
    std::unique_ptr<GuideBuffers> guides; ///< null: there is no history of any kind
    std::unique_ptr<Denoiser> denoiser;   ///< null: none
    std::unique_ptr<TaaBuffers> taa;      ///< null: no temporal anti-aliasing and no scaling
    std::unique_ptr<SumBuffers> sums;     ///< null: nothing is accumulated
    std::unique_ptr<Buffer> exposure;     ///< RtExposure; null: it is not automatic
    std::optional<int> exposureTimeMs;    ///< of the view's clock when it was last adapted; nothing: it is new
    uint32_t lastPicture = 0;             ///< number of the last drawn frame that used it
    ViewBuffers(Device& device, const VkRect2D& viewArea, VkExtent2D tracedExtent);
    /// Makes or drops what is kept from frame to frame; what the last frame left becomes its history.
    void turnHistory(Device& device, const DenoisePipelines& pipelines, DenoiserKind denoised, bool antialiased);
    DenoiserKind denoiserKind() const { return denoiser ? denoiser->kind() : DenoiserKind::None; }
    /// Makes or drops what accumulation and automatic exposure need.
    void turnPicture(Device& device, bool accumulated, bool autoExposed);
};

/// `usesHistory`: not if the view is only scaled.
RtTaa describeTaa(const ViewBuffers& buffers, const RtFrame& frame, bool usesHistory);

} // namespace q3rt
