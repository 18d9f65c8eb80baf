#pragma once
// SVGF (Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering"): a mean over frames that forgets a fixed share
// in each, then a filter in space guided by the mean's variance.

#include "gpu/buffer.hpp"
#include "renderer_rt/denoiser.hpp"
#include "renderer_rt/passes/denoise.hpp"

namespace q3rt {

class Svgf : public Denoiser {
  public:
    Svgf(Device& device, const DenoisePipelines& pipelines, VkExtent2D extent);
    DenoiserKind kind() const override { return DenoiserKind::Svgf; }
    void turn(ViewBuffers& view) override;
    void prepare(ViewBuffers& view, GrowingBuffer& stream) override;
    void import(FrameGraph& graph) override;
    void addBeforeDirect(FrameGraph& graph, ViewResources& resources) override;
    void addAfterDirect(FrameGraph& graph, ViewResources& resources) override;
    const Buffer& lighting() const override { return m_filtered[kFilterLevels & 1]; }

  protected:
    virtual RtDenoise describe(const ViewBuffers& view) const;
    /// Writes the frame's table.
    void keepTable(const RtDenoise& table, GrowingBuffer& stream);

    DenoiseWork m_work;           ///< of the frame
    DenoiseResources m_resources; ///< of the frame

  private:
    Buffer m_light, m_previousLight;     ///< vec4[]
    Buffer m_moments, m_previousMoments; ///< vec2[]
    Buffer m_filtered[2];                ///< vec4[]
};

} // namespace q3rt
