#pragma once
// The ray tracer's scene on the GPU: static structures of the map, structures and tables of each view.

#include <memory>

#include "gpu/growing_buffer.hpp"
#include "renderer_rt/frame_structures.hpp"
#include "renderer_rt/moving_trees.hpp"
#include "renderer_rt/traced_view.hpp"
#include "renderer_rt/world_lights.hpp"
#include "renderer_vk/gpu_context.hpp"

namespace q3rt {

/// A view ready to be traced. Everything in it lives as long as the frame.
struct TracedView {
    RtFrame frame{}; ///< completed by the caller, then given to finish()
    BufferSlice frameSlice;
    AccelerationStructure* top = nullptr; ///< null: the back end has its own trees
    BufferSlice topInstances;
    uint32_t instanceCount = 0;
    std::vector<BottomBuild> builds;
    bool stagedCover = false; ///< some surface's holes take its stages to tell
    uint32_t movingTriangleCount = 0;
    ClassCounts counts{};
};

class TracedScene {
  public:
    TracedScene(GpuContext& context, Backend backend);
    void setContent(const MaterialLibrary& materials, const TextureLibrary& textures);
    void loadWorld(const World& world, const PreparedLights& lights);
    /// Other lights for the same world. The device is idle.
    void loadLights(const PreparedLights& lights);
    void dropContent();
    bool hasWorld() const { return m_statics != nullptr; }

    void beginFrame();
    /// Tables of one view; nothing is recorded yet. `camera` is the view's frame as far as it is known; `geometry`
    /// loses what of effects shows nothing. `lights` are the view's dynamic ones.
    TracedView prepare(const RtFrame& camera, ViewGeometry& geometry, std::span<const SceneLight> lights,
                       const PortalScene& portals);
    /// Of the view prepared last.
    const ViewTables& tables() const { return m_tables; }
    /// Writes `view.frame` where the shaders find it.
    void finish(const TracedView& view);
    /// What the shaders read in this frame alone, by address.
    GrowingBuffer& stream() { return m_stream; }
    /// Bottom levels, then the top level, with the barriers between and after them.
    void recordBuilds(VkCommandBuffer commands, const TracedView& view);

    const StaticGeometry* statics() const { return m_statics.get(); }
    const WorldLights* lights() const { return m_lights.get(); }
    const World* world() const { return m_world; }

  private:
    template <typename T>
    VkDeviceAddress send(const std::vector<T>& items);
    void resolveDynamic(const ViewGeometry& geometry, TracedView& view);
    /// Instances in the order of a tree over them: drivers that follow the order given make a better one.
    std::vector<uint32_t> instanceOrder(const ViewGeometry& geometry) const;
    void makeInstances(const ViewGeometry& geometry, TracedView& view);
    TreePart dynamicTreePart(const ViewGeometry& geometry, int number) const;
    /// Of the run of dynamic parts of one entity that begins at source `first`; returns how many they are.
    size_t makeMovingTree(const ViewGeometry& geometry, size_t first, TracedView& view, TreeInstance& instance);
    void makeTrees(const ViewGeometry& geometry, TracedView& view);
    void sendFogs(RtFrame& frame);
    void sendLights(std::span<const SceneLight> lights, RtFrame& frame);

    GpuContext& m_context;
    Backend m_backend;
    const World* m_world = nullptr;
    std::unique_ptr<StageTable> m_stages;
    std::unique_ptr<ViewTableBuilder> m_builder;
    std::unique_ptr<StaticGeometry> m_statics;
    std::unique_ptr<WorldLights> m_lights;
    std::unique_ptr<ModelGeometry> m_models;
    Buffer m_noise; ///< the blue-noise masks
    FrameStructures m_structures;
    GrowingBuffer m_stream;
    ViewTables m_tables;
    std::vector<AccelerationStructure*> m_dynamicStructures;
    MovingTrees m_movingTrees;
    std::vector<TreePart> m_treeParts; ///< work space, as the next two
    std::vector<uint64_t> m_treeKey;
    std::vector<TreeInstance> m_treeInstances;
};

} // namespace q3rt
