#pragma once
// The rasteriser as a piece that any renderer can use: it adds passes that draw views and 2D onto a target image.
//
// Order in a frame: beginFrame(); addView() and addUi() any number of times, in drawing order, into one FrameGraph;
// uploadFrame(); run the graph.

#include <memory>
#include <span>

#include "frame/frame_executor.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/occlusion_queries.hpp"
#include "renderer_vk/draw_list.hpp"
#include "renderer_vk/gpu_context.hpp"
#include "renderer_vk/pipeline_set.hpp"
#include "renderer_vk/upscaler.hpp"

namespace q3rt {

/// The targets of a frame as the graph's current handles; passes replace them by what they wrote.
struct FrameTargets {
    ImageId color;
    ImageId depth;
    ImageId samples; ///< none: one a pixel
};
FrameTargets importTargets(FrameGraph& graph, TargetImages& images);
/// The colour that a pass draws to.
Attachment colorAttachment(PassContext& pass, const FrameTargets& targets);

class RasterScene {
  public:
    explicit RasterScene(GpuContext& context);
    ~RasterScene();
    RasterScene(const RasterScene&) = delete;
    RasterScene& operator=(const RasterScene&) = delete;

    /// New libraries: everything of the old ones is forgotten. `world` may be null, and may be set later.
    void setContent(const MaterialLibrary& materials, const ModelLibrary& models, StageTable& stages, float greyscale);
    void setWorld(const World* world);
    void dropContent();
    /// Creates and warms the pipelines of all materials known now.
    void warmPipelines(MaterialId flare, MaterialId sun);

    void beginFrame(const DrawListSettings& settings);
    /// A pass "clear" that fills the targets: r_clear.
    void addClear(FrameGraph& graph, FrameTargets& targets);
    /// A pass that draws what is added until another pass comes; the first of them names it. Between two passes the GPU
    /// waits for the one to end.
    ///
    /// Named `pass`: draws the scene (portals first) by rasterising.
    void addView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame, const SceneView& scene,
                 const DrawListSettings& settings, const char* pass);
    /// Named "ui": draws a run of pictures and cinematics.
    void addUi(FrameGraph& graph, FrameTargets& targets, std::span<const FrameCommand> run, int clockMs);
    /// Sends what was gathered to the GPU. Call after the last add, before the graph runs.
    void uploadFrame();

    /// After an error: what was gathered is never drawn.
    void abandonFrame();

    /// A line of what the frame holds (r_speeds, counted if it is set); after uploadFrame().
    std::string describeCounts(int kind) const { return m_builder ? m_builder->describeCounts(kind, m_data) : ""; }

    /// Pipelines that exist; does not rise while drawing what was known at warmPipelines().
    size_t pipelineCount() const { return m_pipelines.size(); }
    /// StageTable of the frame on the GPU (StageState[]); valid after uploadFrame().
    BufferSlice stageSlice() const { return m_stageSlice; }
    /// Static world vertices (Vertex[]) for other users of them.
    const Buffer& worldVertices() const { return m_worldVertices; }

  private:
    void recordViews(PassContext& pass, FrameTargets targets, uint32_t firstView, uint32_t viewCount);
    void recordView(PassContext& pass, const ViewDraw& view, VkExtent2D extent);
    void recordDepthClear(VkCommandBuffer commands, const ViewDraw& view);
    std::span<const DrawBatch> batchesOf(const ViewDraw& view) const;
    DrawBatch depthOf(DrawBatch batch) const;
    bool depthFirstPays(const ViewDraw& view) const;
    void recordDepth(VkCommandBuffer commands, const ViewDraw& view);
    void recordFlares(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch);
    void recordFlareTests(VkCommandBuffer commands, const ViewDraw& view);
    void readFlareTests(uint32_t slot);
    void recordEdges(VkCommandBuffer commands, const ViewDraw& view, DrawBatch batch);
    void recordBatch(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch);
    void recordLights(VkCommandBuffer commands, const ViewDraw& view, DrawBatch batch, RasterDraw constants);
    const std::vector<StagePass>& stagePasses(MaterialId id);
    void recordOwn(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch, RasterDraw constants);
    void draw(VkCommandBuffer commands, const StateKey& key, const RasterDraw& constants, const DrawBatch& batch,
              bool polygonOffset, CullMode cull, const ViewDraw& view);
    void bindFrame(PassContext& pass);
    uint32_t addUiEntity();
    void addUiPicture(const Picture& picture, uint32_t entity, int clockMs, uint32_t firstBatch);
    void addUiCinematic(const CinematicPicture& picture, uint32_t entity);
    void appendQuad(const Picture& quad);
    void recordPass(FrameGraph& graph, FrameTargets& targets, const char* name, uint32_t firstView, uint32_t viewCount);
    void addScaledView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame, const SceneView& scene,
                       const DrawListSettings& settings, const char* pass);

    GpuContext& m_context;
    const MaterialLibrary* m_materials = nullptr;
    const ModelLibrary* m_models = nullptr;
    StageTable* m_stages = nullptr;
    std::unique_ptr<DrawListBuilder> m_builder;
    DescriptorLayout m_frameLayout;
    PipelineSet m_pipelines;
    std::unique_ptr<Upscaler> m_upscaler; ///< if the world is drawn at a scale
    FrameDrawData m_data;
    Buffer m_worldVertices;
    bool m_worldHasPortals = false; ///< pipelines of portal views are wanted
    GrowingBuffer m_vertexStream, m_indexStream, m_storageStream;
    BufferSlice m_vertexSlice, m_indexSlice, m_stageSlice, m_entitySlice, m_lightSlice, m_fogSlice;
    VkDescriptorSet m_frameSet = VK_NULL_HANDLE;
    uint32_t m_tableStageCount = 0;
    struct ViewRun {
        uint32_t firstView = 0, viewCount = 0;
        uint32_t target = 0; ///< the graph's number of it
    };
    std::vector<ViewRun> m_runs; ///< a pass each
    size_t m_graphPasses = 0;    ///< when the last of them had been added
    /// Stages that a buffer holds already, because they last.
    struct SentStages {
        VkBuffer buffer = VK_NULL_HANDLE;
        size_t count = 0;
    };
    std::vector<SentStages> m_sentStages; ///< by slot of the ring
    OcclusionQueries m_flareQueries;
    std::vector<std::vector<FlareKey>> m_askedFlares;  ///< by slot of the ring
    std::vector<std::vector<StagePass>> m_stagePasses; ///< by material, as far as they were asked for
    bool m_mergeStages = true;
    bool m_occludersListed = false; ///< of batches whose depth is drawn first
    bool m_depthFirst = false, m_showEdges = false;
    uint32_t m_edgeStage = 0;     ///< of FrameDrawData::ownStages
    uint32_t m_firstOccluder = 0; ///< where FrameDrawData::occluders begin among the indices on the GPU
    float m_debugSort = 0;
    float m_guardBand = 1;       ///< the viewport is so many times as wide and as high as the view
    bool m_cullPictures = false; ///< leave out those that no pixel shows
    float m_offsetFactor = -1, m_offsetUnits = -2;
    /// What the command buffer has now, so that equal state is not set again.
    struct BoundState {
        void setScissor(VkCommandBuffer commands, const VkRect2D& wanted);
        const GraphicsPipeline* pipeline = nullptr;
        int source = -1, range = -1, cull = -1, offset = -1;
        VkRect2D scissor{};
    };
    BoundState m_bound;
};

} // namespace q3rt
