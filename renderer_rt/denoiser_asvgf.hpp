#pragma once
// A-SVGF (Schied, Peters, Dachsbacher 2018, "Gradient Estimation for Real-Time Adaptive Temporal Filtering"): SVGF
// whose mean forgets what has changed. Samples of the last frame are lit again as then; the difference is the change.

#include "renderer_rt/denoiser_svgf.hpp"

namespace q3rt {

class Asvgf final : public Svgf {
  public:
    Asvgf(Device& device, const DenoisePipelines& pipelines, VkExtent2D extent);
    DenoiserKind kind() const override { return DenoiserKind::Asvgf; }
    void turn(ViewBuffers& view) override;
    void prepare(ViewBuffers& view, GrowingBuffer& stream) override;
    void import(FrameGraph& graph) override;
    void addBeforeDirect(FrameGraph& graph, ViewResources& resources) override;
    void addAfterDirect(FrameGraph& graph, ViewResources& resources) override;
    const Buffer* gradients() const override { return &m_gradients[kGradientLevels & 1]; }

  private:
    RtDenoise describe(const ViewBuffers& view) const override;

    Buffer m_previousPixels;     ///< RtPixel[]
    Buffer m_previousIrradiance; ///< vec4[]
    Buffer m_winners;            ///< uint32_t[], a stratum
    Buffer m_gradients[2];       ///< vec4[], a stratum
};

} // namespace q3rt
