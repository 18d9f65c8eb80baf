#pragma once
// Buffers of one view, kept between frames: what the stages hand on, the running mean, and the denoiser's history if
// there is a denoiser.

#include <memory>

#include "gpu/buffer.hpp"
#include "renderer_rt/view_motion.hpp"

namespace q3rt {

/// Storage that shaders reach by address; `bytes` for each of width x height.
Buffer makeViewBuffer(Device& device, VkExtent2D extent, size_t bytes, const char* name);

/// Strata of a picture, those at the right and lower edges perhaps cut.
VkExtent2D strataOf(VkExtent2D extent);

struct DenoiseBuffers {
    Buffer previousPixels, previousIrradiance;
    Buffer guides, previousGuides;
    Buffer light, previousLight;
    Buffer moments, previousMoments;
    Buffer winners;
    Buffer gradients[2];
    Buffer filtered[2];
    VkDeviceAddress table = 0; ///< RtDenoise of the frame
    DenoiseBuffers(Device& device, VkExtent2D extent);
    /// Where the filtered light of the frame lies.
    Buffer& result() { return filtered[kFilterLevels & 1]; }
};

struct ViewBuffers {
    VkRect2D area{}; ///< on the target
    Buffer pixels, irradiance, radiance;
    ViewMotion motion;
    std::unique_ptr<DenoiseBuffers> denoise; ///< null: no denoiser
    uint32_t lastPicture = 0;                ///< number of the last drawn frame that used it
    ViewBuffers(Device& device, const VkRect2D& viewArea);
    /// Makes or drops the denoiser's buffers; what the last frame left becomes its history.
    void turnHistory(Device& device, bool denoised);
};

/// The denoiser's table for the frame. The motion's tables are where `toCurrent` and `toPrevious` say.
RtDenoise describeDenoise(const ViewBuffers& buffers, VkDeviceAddress toCurrent, VkDeviceAddress toPrevious);

} // namespace q3rt
