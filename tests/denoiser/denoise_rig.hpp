#pragma once
// The denoiser's passes alone on a device: surfaces and traced light are made by the test, so that what must come out
// is known.

#include <functional>

#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "gpu/frame_ring.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/uploader.hpp"
#include "renderer_rt/passes/denoise.hpp"

namespace q3rt::test {

inline constexpr VkExtent2D kRigExtent{64, 48}; ///< pixels
inline constexpr size_t kRigPixelCount = size_t{kRigExtent.width} * kRigExtent.height;

/// Traced light of a pixel.
using LightFunction = std::function<vec3(const RtPixel& pixel)>;

struct RigFrame {
    std::vector<RtPixel> pixels; ///< after projection
    std::vector<vec3> traced, shown;
    uint32_t carriedCount = 0; ///< pixels that show a sample of the frame before
};

/// A corner of a room: floor z = 0, wall x = 200, and the empty sky above the wall's edge at z = 150.
class DenoiseRig {
  public:
    explicit DenoiseRig(Device& device, DenoiserKind kind = DenoiserKind::Asvgf);
    /// Draws one frame from `eye`, looking along x and down a little.
    RigFrame draw(const vec3& eye, const LightFunction& light);
    /// What rt_checkFinite counts in these.
    uint64_t countNonFinite(const std::vector<RtGuide>& guides);
    /// Leaves out one frame's number: the next one starts anew.
    void cut() { ++m_number; }

  private:
    RtFrame describeCamera(const vec3& eye) const;
    std::vector<RtPixel> findSurfaces(const RtFrame& camera) const;
    void uploadSurfaces(const std::vector<RtPixel>& pixels);
    void run(const std::function<void(FrameGraph& graph)>& addPasses);

    Device& m_device;
    DenoiserKind m_kind;
    FrameRing m_ring;
    FrameExecutor m_executor;
    Uploader m_uploader;
    GrowingBuffer m_stream;
    DenoisePipelines m_pipelines;
    ViewBuffers m_buffers;
    uint32_t m_number = 0;
};

/// Mean luminance of lit pixels.
double meanLuminance(const RigFrame& frame, const std::vector<vec3>& light);

} // namespace q3rt::test
