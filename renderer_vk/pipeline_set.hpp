#pragma once
// All raster pipelines, by the state they differ in. Cull side, winding and depth bias are set while recording.

#include <map>
#include <span>

#include "gpu/graphics_pipeline.hpp"
#include "renderer_vk/stage_passes.hpp"

namespace q3rt {

enum class StencilUse : uint8_t { None, CountUp, CountDown, WhereCounted, Clear };

struct StateKey {
    bool blended = false;
    BlendFactor source = BlendFactor::One, destination = BlendFactor::Zero;
    DepthFunc depthFunc = DepthFunc::LessEqual;
    bool depthWrite = true;
    AlphaTest alphaTest = AlphaTest::None;
    Combine combine = Combine::Single;
    uint8_t pass = 0;       ///< kPass*
    uint8_t layerCount = 1; ///< stages in the pass
    LayerStates layers;     ///< those after the first
    StencilUse stencil = StencilUse::None;
    bool lines = false;    ///< edges of the triangles
    bool segments = false; ///< pairs of vertices
    bool clipped = false;  ///< portal views
    auto operator<=>(const StateKey&) const = default;
};

StateKey stageKey(const Stage& stage, bool clipped);
/// Of a material's stages that share a pass.
StateKey passKey(const std::vector<Stage>& stages, const StagePass& pass, bool clipped);
StateKey lightKey(bool additive, bool clipped);
StateKey fogKey(bool depthEqual, bool clipped);
/// Alpha-blended picture without depth: cinematics.
StateKey overlayKey();
/// Depth alone: what hides other things goes first, so that nothing hidden is shaded.
StateKey depthKey();
/// Depth and stencil of all pixels as they were at first.
StateKey depthClearKey();
/// Sides of shadow volumes before what is drawn already.
StateKey shadowVolumeKey(bool up, bool clipped);
/// Multiplies what lies in a shadow volume.
StateKey shadowShadeKey();
/// The same, and counts down in the stencil.
StateKey erasingShadows(StateKey key);
/// A stage of a flare: whatever its depth.
StateKey flareKey(const Stage& stage);
/// Asks whether a flare is seen.
StateKey flareTestKey();
/// White edges over everything: r_showtris.
StateKey edgesKey(bool clipped);
/// White lines over everything: r_shownormals.
StateKey normalsKey(bool clipped);
/// Opaque, no depth write: sky boxes, with the clouds that share their pass.
StateKey skyBoxKey(bool clipped, const std::vector<Stage>& clouds = {});

class PipelineSet {
  public:
    PipelineSet(Device& device, VkDescriptorSetLayout frameLayout, VkDescriptorSetLayout textureLayout,
                VkFormat depthFormat, VkSampleCountFlagBits samples, bool blueFirst);
    const GraphicsPipeline& find(const StateKey& key);
    /// r_greyscale of all colours; a change drops every pipeline. The device is idle.
    void setGreyscale(float amount);
    /// Every state that drawing these materials needs; `clipped` also those for portal views, `flare` is that of
    /// flares.
    std::vector<StateKey> statesOf(const MaterialLibrary& materials, bool clipped, MaterialId flare, MaterialId sun,
                                   bool mergeStages) const;
    bool known(const StateKey& key) const { return m_pipelines.contains(key); }
    size_t size() const { return m_pipelines.size(); }

  private:
    Device& m_device;
    VkDescriptorSetLayout m_frameLayout, m_textureLayout;
    VkFormat m_depthFormat;
    VkSampleCountFlagBits m_samples;
    bool m_blueFirst; ///< GpuContext::blueFirst()
    float m_greyscale = 0;
    std::map<StateKey, GraphicsPipeline> m_pipelines;
};

} // namespace q3rt
