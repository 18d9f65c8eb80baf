#pragma once
// Buffers of one view, kept between frames: what the stages hand on, the running mean, and the histories of the
// denoiser and of temporal anti-aliasing if they are on.

#include <memory>

#include "gpu/buffer.hpp"
#include "renderer_rt/denoiser.hpp"
#include "renderer_rt/view_motion.hpp"
#include "shaders/shared/rt_denoise.h"
#include "shaders/shared/rt_taa.h"

namespace q3rt {

/// Storage that shaders reach by address; `bytes` for each of width x height.
Buffer makeViewBuffer(Device& device, VkExtent2D extent, size_t bytes, const char* name);

/// Strata of a picture, those at the right and lower edges perhaps cut.
VkExtent2D strataOf(VkExtent2D extent);

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

struct ViewBuffers {
    VkRect2D area{}; ///< on the target
    Buffer pixels, irradiance, ambient, radiance, means, picture;
    ViewMotion motion;
    std::unique_ptr<GuideBuffers> guides; ///< null: there is no history of any kind
    std::unique_ptr<Denoiser> denoiser;   ///< null: none
    std::unique_ptr<TaaBuffers> taa;      ///< null: no temporal anti-aliasing
    uint32_t lastPicture = 0;             ///< number of the last drawn frame that used it
    ViewBuffers(Device& device, const VkRect2D& viewArea);
    /// Makes or drops what is kept from frame to frame; what the last frame left becomes its history.
    /// `pipelines` may be null if nothing is denoised.
    void turnHistory(Device& device, const DenoisePipelines* pipelines, DenoiserKind denoised, bool antialiased);
    DenoiserKind denoiserKind() const { return denoiser ? denoiser->kind() : DenoiserKind::None; }
    /// What the output curve is put on.
    const Buffer& shown() const { return taa ? taa->history : picture; }
};

RtTaa describeTaa(const ViewBuffers& buffers);

} // namespace q3rt
