#pragma once
// Stereo for coloured glasses (r_anaglyphMode): each eye has a picture of its own, and each colour shows one of them.

#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "renderer_vk/gpu_context.hpp"

namespace q3rt {

struct FrameTargets;

class Anaglyph {
  public:
    /// Makes its pipeline, which software drivers compile now.
    explicit Anaglyph(GpuContext& context);
    /// r_anaglyphMode. A change of it begins with black.
    void follow(int mode);
    bool enabled() const { return m_mode != 0; }
    /// What the left eye is drawn into; it shares the depth of `main`.
    FrameTargets leftEye(FrameGraph& graph, const FrameTargets& main);
    /// A pass that takes the left eye's colours over into the picture of the right one.
    void addPass(FrameGraph& graph, ImageId left, FrameTargets& main);

  private:
    void warm();
    void record(PassContext& pass, ImageId left, ImageId picture) const;

    GpuContext& m_context;
    DescriptorLayout m_layout;
    ComputePipeline m_pipeline;
    TargetImages m_left; ///< made when first needed
    int m_mode = 0;
};

} // namespace q3rt
