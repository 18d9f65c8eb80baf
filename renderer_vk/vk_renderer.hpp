#pragma once
// The rasteriser as a renderer.

#include "renderer_vk/gpu_renderer.hpp"

namespace q3rt {

class VkRenderer final : public GpuRenderer {
  public:
    using GpuRenderer::GpuRenderer;

  private:
    void drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                       const SceneView& scene) override {
        raster().addView(graph, targets, frame, scene, drawListSettings(), "world view");
    }
    bool readsTexels() const override { return false; }
    bool wantsTimes() const override { return settings().q3rt_wantStats != 0; }
    const char* backendName() const override { return "raster"; }
    const char* rendererName() const override { return "q3rt renderer_vk"; }
};

} // namespace q3rt
