#include "renderer_vk/raster_scene.hpp"

#include <algorithm>

#include "base/log.hpp"
#include "gpu/device.hpp"
#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

constexpr VkDeviceSize kStorageAlignment = 256; // the largest that Vulkan lets a device ask for
// Weapons keep to the nearest part of the depth range, so that they never reach into walls.
constexpr float kWeaponDepth = 0.3f;

DescriptorLayout makeFrameLayout(Device& device) {
    return DescriptorLayout(device,
                            {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                             {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                             {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                             {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
                            "raster frame");
}

BufferInfo streamInfo(VkDeviceSize size, VkBufferUsageFlags usage, const char* name) {
    return {.size = size, .usage = usage, .domain = MemoryDomain::Upload, .name = name};
}

VkViewport viewportOf(const ViewDraw& view, DepthRange range) {
    VkViewport viewport{static_cast<float>(view.x),
                        static_cast<float>(view.y),
                        static_cast<float>(view.width),
                        static_cast<float>(view.height),
                        0.0f,
                        1.0f};
    if (range == DepthRange::Weapon) viewport.maxDepth = kWeaponDepth;
    if (range == DepthRange::Far) viewport.minDepth = 1.0f;
    if (range == DepthRange::Near) viewport.maxDepth = 0.0f;
    return viewport;
}

/// The view's rectangle inside the target; empty (0 wide) if none of it is.
VkRect2D scissorOf(const ViewDraw& view, VkExtent2D extent) {
    const int left = std::clamp(view.x, 0, static_cast<int>(extent.width));
    const int top = std::clamp(view.y, 0, static_cast<int>(extent.height));
    const int right = std::clamp(view.x + view.width, left, static_cast<int>(extent.width));
    const int bottom = std::clamp(view.y + view.height, top, static_cast<int>(extent.height));
    return {{left, top}, {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
}

void writeTargets(PassBuilder& pass, FrameTargets& targets) {
    targets.color = pass.write(targets.color, access::kColorAttachment);
    targets.depth = pass.write(targets.depth, access::kDepthAttachment);
    if (targets.samples) targets.samples = pass.write(targets.samples, access::kColorAttachment);
}

} // namespace

FrameTargets importTargets(FrameGraph& graph, TargetImages& images) {
    const auto import = [&](GpuImage& image) { return graph.importImage(image.info().name.c_str(), image); };
    return {import(images.color), import(images.depth), images.samples ? import(images.samples) : ImageId{}};
}

Attachment colorAttachment(PassContext& pass, const FrameTargets& targets) {
    if (!targets.samples) return {.view = pass.view(targets.color)};
    return {.view = pass.view(targets.samples), .resolve = pass.view(targets.color)};
}

/// What the command buffer has now, so that equal state is not set again.
struct RasterScene::BoundState {
    const GraphicsPipeline* pipeline = nullptr;
    int source = -1, range = -1, cull = -1, offset = -1;
};

RasterScene::RasterScene(GpuContext& context)
    : m_context(context)
    , m_frameLayout(makeFrameLayout(context.device()))
    , m_pipelines(context.device(), m_frameLayout.handle(), context.textures().layout(), context.main().depth.format(),
                  context.samples())
    , m_vertexStream(
          context.device(),
          streamInfo(busyFrame::kVertices * sizeof(Vertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "vertex stream"),
          context.ring().framesInFlight())
    , m_indexStream(
          context.device(),
          streamInfo(busyFrame::kIndices * sizeof(uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "index stream"),
          context.ring().framesInFlight())
    , m_storageStream(
          context.device(),
          streamInfo(busyFrame::kStages * sizeof(StageState), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "storage stream"),
          context.ring().framesInFlight())
    , m_flareQueries(context.device(), context.ring().framesInFlight())
    , m_askedFlares(context.ring().framesInFlight())
    , m_bound(std::make_unique<BoundState>()) {
    if (TargetImages* scaled = context.scaledWorld())
        m_upscaler = std::make_unique<Upscaler>(context.device(), *scaled, context.main());
}

RasterScene::~RasterScene() = default;

void RasterScene::setContent(const MaterialLibrary& materials, const ModelLibrary& models, StageTable& stages,
                             float greyscale) {
    m_materials = &materials;
    m_models = &models;
    m_stages = &stages;
    m_pipelines.setGreyscale(greyscale);
    m_stagePasses.clear();
    m_data.reserve();
    setWorld(nullptr);
}

void RasterScene::setWorld(const World* world) {
    m_builder = std::make_unique<DrawListBuilder>(*m_materials, *m_models, *m_stages, world);
    m_worldVertices = Buffer();
    m_worldHasPortals = false;
    if (!world) return;
    m_worldHasPortals = std::ranges::any_of(
        world->surfaces, [&](const WorldSurface& surface) { return m_materials->get(surface.material).sort <= 1; });
    const std::span<const Vertex> vertices(world->vertices);
    m_worldVertices =
        Buffer(m_context.device(), {.size = vertices.size_bytes(),
                                    .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                    .name = "world vertices"});
    m_context.uploader().upload(m_worldVertices, vertices);
    m_context.uploader().flush();
}

void RasterScene::dropContent() {
    m_builder.reset();
    m_worldVertices = Buffer();
    m_materials = nullptr;
    m_models = nullptr;
    m_stages = nullptr;
    m_data.clear();
}

void RasterScene::beginFrame(const DrawListSettings& listSettings) {
    const RasterSettings& settings = listSettings.raster;
    m_cullPictures = listSettings.cullTriangles && settings.r_ext_multisample <= 1;
    m_debugSort = settings.r_debugSort;
    m_showEdges = settings.r_showtris != 0;
    if (m_showEdges && !m_context.device().capabilities().fillModeNonSolid) {
        m_showEdges = false;
        logLineOnce(LogLevel::Warning, "r_showtris: %s can't draw edges",
                    m_context.device().capabilities().deviceName.c_str());
    }
    const bool mergeStages = settings.r_mergeStages != 0;
    if (mergeStages != m_mergeStages) m_stagePasses.clear();
    m_mergeStages = mergeStages;
    m_data.clear();
    m_runs.clear();
    const uint32_t slot = m_context.ring().slot();
    m_vertexStream.beginFrame(slot);
    m_indexStream.beginFrame(slot);
    m_storageStream.beginFrame(slot);
    m_frameSet = VK_NULL_HANDLE;
    if (m_builder) m_builder->beginFrame(m_context.ring().frameNumber());
    readFlareTests(slot);
}

void RasterScene::readFlareTests(uint32_t slot) {
    m_flareQueries.beginFrame(slot, m_context.ring().frameNumber());
    std::vector<FlareKey>& asked = m_askedFlares[slot];
    const std::vector<uint8_t>& answers = m_flareQueries.answers();
    for (size_t i = 0; m_builder && i < std::min(asked.size(), answers.size()); ++i)
        m_builder->fades().answer(asked[i], m_flareQueries.answeredFrame(), answers[i] != 0);
    asked.clear();
}

void RasterScene::abandonFrame() { m_flareQueries.abandonFrame(); }

void RasterScene::addView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame, const SceneView& scene,
                          const DrawListSettings& settings, const char* pass) {
    if (!m_builder) return;
    m_offsetFactor = settings.raster.r_offsetFactor;
    m_offsetUnits = settings.raster.r_offsetUnits;
    m_depthFirst = settings.raster.r_depthFirst != 0;
    if (m_upscaler && (scene.flags & viewFlag::kNoWorldModel) == 0) {
        addScaledView(graph, targets, frame, scene, settings, pass);
        return;
    }
    const auto first = static_cast<uint32_t>(m_data.views.size());
    m_builder->addScene(frame, scene, settings, m_data);
    recordPass(graph, targets, pass, first, static_cast<uint32_t>(m_data.views.size()) - first);
}

void RasterScene::addScaledView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                                const SceneView& scene, const DrawListSettings& settings, const char* pass) {
    TargetImages& images = *m_context.scaledWorld();
    FrameTargets world = importTargets(graph, images);
    const VkRect2D shown = {{scene.x, scene.y},
                            {static_cast<uint32_t>(scene.width), static_cast<uint32_t>(scene.height)}};
    const VkRect2D drawn = Upscaler::scaledArea(shown, m_context.extent(), images.color.extent());
    SceneView scaled = scene;
    scaled.x = drawn.offset.x;
    scaled.y = drawn.offset.y;
    scaled.width = static_cast<int>(drawn.extent.width);
    scaled.height = static_cast<int>(drawn.extent.height);
    const auto first = static_cast<uint32_t>(m_data.views.size());
    m_builder->addScene(frame, scaled, settings, m_data);
    recordPass(graph, world, pass, first, static_cast<uint32_t>(m_data.views.size()) - first);
    m_upscaler->addPass(graph, world.color, drawn, targets, shown);
}

void RasterScene::addClear(FrameGraph& graph, FrameTargets& targets) {
    graph.addPass(
        "clear", [&](PassBuilder& pass) { writeTargets(pass, targets); },
        [current = targets](PassContext& pass) {
            // A colour that no map has: what no surface covers shows it.
            Attachment color = colorAttachment(pass, current);
            color.load = VK_ATTACHMENT_LOAD_OP_CLEAR;
            color.clear = {.color = {.float32 = {1.0f, 0.0f, 0.5f, 1.0f}}};
            const Attachment depth{.view = pass.view(current.depth),
                                   .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                   .clear = {.depthStencil = {1.0f, 0}},
                                   .stencil = true};
            beginRendering(pass.commands(), pass.extent(current.color), color, depth);
            vkCmdEndRenderingKHR(pass.commands());
        });
}

void RasterScene::recordPass(FrameGraph& graph, FrameTargets& targets, const char* name, uint32_t firstView,
                             uint32_t viewCount) {
    if (!m_runs.empty() && graph.passes().size() == m_graphPasses && m_runs.back().target == targets.color.index) {
        m_runs.back().viewCount += viewCount;
        return;
    }
    m_runs.push_back({firstView, viewCount, targets.color.index});
    graph.addPass(
        name, [&](PassBuilder& pass) { writeTargets(pass, targets); },
        [this, current = targets, run = m_runs.size() - 1](PassContext& pass) {
            recordViews(pass, current, m_runs[run].firstView, m_runs[run].viewCount);
        });
    m_graphPasses = graph.passes().size();
}

void RasterScene::uploadFrame() {
    if (!m_stages) return;
    for (const FlareTest& test : m_data.flareTests)
        m_askedFlares[m_context.ring().slot()].push_back(test.key);
    m_flareQueries.reserve(m_context.ring().commands(), static_cast<uint32_t>(m_data.flareTests.size()));
    m_vertexSlice = m_vertexStream.append(std::span<const Vertex>(m_data.vertices));
    m_indexSlice = m_indexStream.append(std::span<const uint32_t>(m_data.indices));
    if (m_showEdges) {
        m_edgeStage = static_cast<uint32_t>(m_data.ownStages.size());
        m_data.ownStages.push_back(colorStage(vec4(1.0f)));
    }
    // One buffer of stages: the materials' first, then those of sky boxes and cinematics.
    const auto& table = m_stages->states();
    m_tableStageCount = static_cast<uint32_t>(table.size());
    const size_t count = table.size() + m_data.ownStages.size();
    m_stageSlice = m_storageStream.reserve(std::max<size_t>(count, 1) * sizeof(StageState), kStorageAlignment);
    auto* stages = reinterpret_cast<StageState*>(m_stageSlice.mapped);
    std::copy(table.begin(), table.end(), stages);
    std::copy(m_data.ownStages.begin(), m_data.ownStages.end(), stages + table.size());
    // A set must name a buffer even when nothing is in it.
    if (m_data.entities.empty()) m_data.entities.emplace_back();
    if (m_data.lights.empty()) m_data.lights.emplace_back();
    if (m_data.fogs.empty()) m_data.fogs.emplace_back();
    m_entitySlice = m_storageStream.append(std::span<const RasterEntity>(m_data.entities), kStorageAlignment);
    m_lightSlice = m_storageStream.append(std::span<const RasterLight>(m_data.lights), kStorageAlignment);
    m_fogSlice = m_storageStream.append(std::span<const RasterFog>(m_data.fogs), kStorageAlignment);
}

void RasterScene::bindFrame(PassContext& pass) {
    if (m_frameSet == VK_NULL_HANDLE) {
        const auto bind = [](uint32_t slot, const BufferSlice& slice) {
            return bindStorageBuffer(slot, slice.buffer, slice.offset, slice.size);
        };
        m_frameSet = pass.makeSet(
            m_frameLayout, {bind(0, m_stageSlice), bind(1, m_entitySlice), bind(2, m_lightSlice), bind(3, m_fogSlice)});
    }
    *m_bound = BoundState{};
    vkCmdBindIndexBuffer(pass.commands(), m_indexSlice.buffer, m_indexSlice.offset, VK_INDEX_TYPE_UINT32);
}

void RasterScene::recordViews(PassContext& pass, FrameTargets targets, uint32_t firstView, uint32_t viewCount) {
    const Attachment color = colorAttachment(pass, targets);
    const Attachment depth{.view = pass.view(targets.depth), .stencil = true};
    beginRendering(pass.commands(), pass.extent(targets.color), color, depth);
    bindFrame(pass);
    for (uint32_t i = 0; i < viewCount; ++i)
        recordView(pass, m_data.views[firstView + i], pass.extent(targets.color));
    vkCmdEndRenderingKHR(pass.commands());
}

void RasterScene::recordView(PassContext& pass, const ViewDraw& view, VkExtent2D extent) {
    const VkRect2D scissor = scissorOf(view, extent);
    if (scissor.extent.width == 0 || scissor.extent.height == 0) return;
    vkCmdSetScissor(pass.commands(), 0, 1, &scissor);
    m_bound->range = -1;
    constexpr VkImageAspectFlags kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    VkClearAttachment clears[2] = {};
    uint32_t clearCount = 0;
    if (view.clearDepth) clears[clearCount++] = {kDepthStencil, 0, {.depthStencil = {1.0f, 0}}};
    if (view.clearColor) {
        const float grey = view.clearGrey;
        clears[clearCount++] = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {grey, grey, grey, 1.0f}}}};
    }
    const VkClearRect area{scissor, 0, 1};
    if (clearCount > 0) vkCmdClearAttachments(pass.commands(), clearCount, clears, 1, &area);
    if (m_depthFirst && depthFirstPays(view)) recordDepth(pass.commands(), view);
    for (uint32_t i = 0; i < view.batchCount; ++i) {
        const DrawBatch& batch = m_data.batches[view.firstBatch + i];
        recordBatch(pass.commands(), view, batch);
        if (m_showEdges && batch.own == OwnDraw::None) recordEdges(pass.commands(), view, batch);
    }
    recordFlareTests(pass.commands(), view);
}

/// A vertex costs about what a pixel does: a small picture is shaded sooner than its depth is drawn.
bool RasterScene::depthFirstPays(const ViewDraw& view) const {
    size_t vertices = 0;
    for (const DrawBatch& batch : std::span(m_data.batches).subspan(view.firstBatch, view.batchCount))
        if (batch.depthFirst) vertices += batch.indexCount;
    return vertices < static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
}

void RasterScene::recordDepth(VkCommandBuffer commands, const ViewDraw& view) {
    const std::span<const DrawBatch> batches = std::span(m_data.batches).subspan(view.firstBatch, view.batchCount);
    for (size_t i = 0; i < batches.size();) {
        DrawBatch run = batches[i++];
        if (!run.depthFirst) continue;
        const CullMode cull = m_materials->get(run.material).cull;
        for (; i < batches.size() && batches[i].depthFirst && batches[i].entity == run.entity &&
               batches[i].depthRange == run.depthRange && m_materials->get(batches[i].material).cull == cull;
             ++i)
            run.indexCount += batches[i].indexCount;
        RasterDraw constants{};
        constants.entity = run.entity;
        constants.pass = kPassDepth;
        draw(commands, depthKey(), constants, run, false, cull, view);
    }
}

void RasterScene::recordEdges(VkCommandBuffer commands, const ViewDraw& view, DrawBatch batch) {
    batch.depthRange = DepthRange::Near;
    batch.erasesShadows = false;
    RasterDraw constants{};
    constants.entity = batch.entity;
    constants.stage = m_tableStageCount + m_edgeStage;
    draw(commands, edgesKey(view.clipped), constants, batch, false, m_materials->get(batch.material).cull, view);
}

const std::vector<StagePass>& RasterScene::stagePasses(MaterialId id) {
    while (m_stagePasses.size() <= id) {
        const auto next = static_cast<MaterialId>(m_stagePasses.size());
        m_stagePasses.push_back(findStagePasses(m_materials->get(next), m_mergeStages));
    }
    return m_stagePasses[id];
}

void RasterScene::recordBatch(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch) {
    const Material& material = m_materials->get(batch.material);
    RasterDraw constants{};
    constants.entity = batch.entity;
    if (batch.own != OwnDraw::None) {
        recordOwn(commands, view, batch, constants);
        return;
    }
    if (batch.fog >= 0) constants.fog = static_cast<uint32_t>(batch.fog);
    for (const StagePass& pass : stagePasses(batch.material)) {
        const Stage& first = material.stages[pass.firstStage];
        constants.stage = batch.stages.first + pass.firstStage;
        constants.layerStage = constants.stage + 1;
        const bool mayBeLeftOut = pass.stageCount == 1 && !batch.erasesShadows;
        if (mayBeLeftOut && changesNothing(first, m_stages->states()[constants.stage])) continue;
        constants.useFog = batch.fog >= 0 && first.fogFade != FogFade::None ? 1 : 0;
        draw(commands, passKey(material.stages, pass, view.clipped), constants, batch, material.polygonOffset,
             material.cull, view);
    }
    constants.useFog = 0;
    for (uint32_t i = 0; i < batch.lightCount; ++i) {
        constants.pass = kPassLight;
        constants.light = batch.firstLight + i;
        const bool additive = m_data.lightAdditive[constants.light] != 0;
        draw(commands, lightKey(additive, view.clipped), constants, batch, material.polygonOffset, material.cull, view);
    }
    const bool opaque = material.sort <= 3;
    if (batch.fog >= 0 && (opaque || (material.contentFlags & surfaceParm::kContentsFog) != 0)) {
        constants.pass = kPassFog;
        draw(commands, fogKey(opaque, view.clipped), constants, batch, material.polygonOffset, material.cull, view);
    }
}

void RasterScene::recordFlares(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch) {
    const Material& material = m_materials->get(batch.material);
    RasterDraw constants{};
    constants.entity = batch.entity;
    for (size_t i = 0; i < std::min<size_t>(material.stages.size(), batch.stages.count); ++i) {
        constants.stage = batch.stages.first + static_cast<uint32_t>(i);
        draw(commands, flareKey(material.stages[i]), constants, batch, false, CullMode::None, view);
    }
}

void RasterScene::recordFlareTests(VkCommandBuffer commands, const ViewDraw& view) {
    DrawBatch pixel;
    pixel.source = VertexSource::Dynamic;
    pixel.indexCount = 6;
    RasterDraw constants{};
    constants.entity = view.flareEntity;
    constants.pass = kPassDepth;
    for (uint32_t i = view.firstFlareTest; i < view.firstFlareTest + view.flareTestCount; ++i) {
        pixel.firstIndex = m_data.flareTests[i].firstIndex;
        m_flareQueries.begin(commands, i);
        draw(commands, flareTestKey(), constants, pixel, false, CullMode::None, view);
        m_flareQueries.end(commands, i);
    }
}

void RasterScene::recordOwn(VkCommandBuffer commands, const ViewDraw& view, const DrawBatch& batch,
                            RasterDraw constants) {
    constants.stage = m_tableStageCount + (batch.stages.first & ~kOwnStageBit);
    switch (batch.own) {
    case OwnDraw::SkyBox:
        constants.layerStage = batch.clouds.first;
        draw(commands,
             batch.clouds.count > 0 ? skyBoxKey(view.clipped, m_materials->get(batch.material).stages)
                                    : skyBoxKey(view.clipped),
             constants, batch, false, CullMode::Front, view);
        break;
    case OwnDraw::ShadowVolume:
        draw(commands, shadowVolumeKey(true, view.clipped), constants, batch, false, CullMode::Back, view);
        draw(commands, shadowVolumeKey(false, view.clipped), constants, batch, false, CullMode::Front, view);
        break;
    case OwnDraw::ShadowShade:
        draw(commands, shadowShadeKey(), constants, batch, false, CullMode::None, view);
        break;
    case OwnDraw::Normals:
        draw(commands, normalsKey(view.clipped), constants, batch, false, CullMode::None, view);
        break;
    case OwnDraw::Flares:
        recordFlares(commands, view, batch);
        break;
    case OwnDraw::Overlay:
    case OwnDraw::None:
        draw(commands, overlayKey(), constants, batch, false, CullMode::None, view);
        break;
    }
}

void RasterScene::draw(VkCommandBuffer commands, const StateKey& key, const RasterDraw& constants,
                       const DrawBatch& batch, bool polygonOffset, CullMode cull, const ViewDraw& view) {
    const GraphicsPipeline& pipeline = m_pipelines.find(batch.erasesShadows ? erasingShadows(key) : key);
    if (m_bound->pipeline != &pipeline) {
        pipeline.bind(commands);
        if (!m_bound->pipeline) pipeline.bindSets(commands, {m_frameSet, m_context.textures().set()});
        m_bound->pipeline = &pipeline;
    }
    if (m_bound->source != static_cast<int>(batch.source)) {
        m_bound->source = static_cast<int>(batch.source);
        const bool world = batch.source == VertexSource::World;
        const VkBuffer buffer = world ? m_worldVertices.handle() : m_vertexSlice.buffer;
        const VkDeviceSize offset = world ? 0 : m_vertexSlice.offset;
        vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
    }
    if (m_bound->range != static_cast<int>(batch.depthRange)) {
        m_bound->range = static_cast<int>(batch.depthRange);
        const VkViewport viewport = viewportOf(view, batch.depthRange);
        vkCmdSetViewport(commands, 0, 1, &viewport);
    }
    const int cullState = static_cast<int>(cull) * 2 + (view.mirrored ? 1 : 0);
    if (m_bound->cull != cullState) {
        m_bound->cull = cullState;
        // Clockwise on the screen is the front; a mirror turns it round.
        vkCmdSetFrontFaceEXT(commands, view.mirrored ? VK_FRONT_FACE_COUNTER_CLOCKWISE : VK_FRONT_FACE_CLOCKWISE);
        vkCmdSetCullModeEXT(commands, cull == CullMode::None    ? VK_CULL_MODE_NONE
                                      : cull == CullMode::Front ? VK_CULL_MODE_BACK_BIT
                                                                : VK_CULL_MODE_FRONT_BIT);
    }
    if (m_bound->offset != (polygonOffset ? 1 : 0)) {
        m_bound->offset = polygonOffset ? 1 : 0;
        vkCmdSetDepthBias(commands, polygonOffset ? m_offsetUnits : 0.0f, 0.0f, polygonOffset ? m_offsetFactor : 0.0f);
    }
    pipeline.push(commands, constants);
    vkCmdDrawIndexed(commands, batch.indexCount, 1, batch.firstIndex, 0, 0);
}

} // namespace q3rt
