#include "renderer_vk/raster_scene.hpp"

#include <algorithm>

#include "base/log.hpp"
#include "gpu/device.hpp"
#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

constexpr VkDeviceSize kStorageAlignment = 256; // the largest that Vulkan lets a device ask for

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

/// A software driver clips at the viewport's sides, and takes a slow way with all triangles of a draw if one of them is
/// clipped. In a viewport some times as large as the view few are; the scissor holds pixels inside. A power of two
/// changes no digit of where a vertex lies.
float guardBandOf(GpuContext& context, VkExtent2D extent) {
    constexpr float kMost = 4; // more hardly leaves fewer
    const Capabilities& can = context.device().capabilities();
    const auto fits = [&](float guardBand, uint32_t sizePx, uint32_t largest) {
        const float viewport = guardBand * static_cast<float>(sizePx); // reaches as far beyond one side as the other
        return viewport <= static_cast<float>(largest) && -viewport >= can.limits.viewportBoundsRange[0] &&
               viewport <= can.limits.viewportBoundsRange[1];
    };
    float guardBand = can.software ? kMost : 1.0f;
    while (guardBand > 1 && !(fits(guardBand, extent.width, can.limits.maxViewportDimensions[0]) &&
                              fits(guardBand, extent.height, can.limits.maxViewportDimensions[1])))
        guardBand /= 2;
    return guardBand;
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

RasterScene::RasterScene(GpuContext& context)
    : m_context(context)
    , m_frameLayout(makeFrameLayout(context.device()))
    , m_pipelines(context.device(), m_frameLayout.handle(), context.textures().layout(), context.main().depth.format(),
                  context.samples(), context.blueFirst())
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
    , m_sentStages(context.ring().framesInFlight())
    , m_flareQueries(context.device(), context.ring().framesInFlight())
    , m_askedFlares(context.ring().framesInFlight()) {
    m_guardBand = guardBandOf(context, context.extent());
    if (TargetImages* scaled = context.scaledWorld()) {
        m_guardBand = std::min(m_guardBand, guardBandOf(context, scaled->color.extent()));
        m_upscaler = std::make_unique<Upscaler>(context.device(), *scaled, context.main());
    }
}

RasterScene::~RasterScene() = default;

void RasterScene::setContent(const MaterialLibrary& materials, const ModelLibrary& models, StageTable& stages,
                             float greyscale) {
    m_materials = &materials;
    m_models = &models;
    m_stages = &stages;
    std::ranges::fill(m_sentStages, SentStages{});
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
    m_occludersListed = listSettings.cullTriangles;
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
    const std::span<const uint32_t> answers = m_flareQueries.answers();
    for (size_t i = 0; m_builder && i < std::min(asked.size(), answers.size()); ++i)
        if (answers[i] != OcclusionQueries::kUnanswered)
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
        [current = targets, blueFirst = m_context.blueFirst()](PassContext& pass) {
            // A colour that no map has: what no surface covers shows it.
            constexpr float kRed = 1.0f, kBlue = 0.5f;
            Attachment color = colorAttachment(pass, current);
            color.load = VK_ATTACHMENT_LOAD_OP_CLEAR;
            color.clear = {.color = {.float32 = {blueFirst ? kBlue : kRed, 0.0f, blueFirst ? kRed : kBlue, 1.0f}}};
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
    m_firstOccluder = static_cast<uint32_t>(m_data.indices.size());
    m_data.indices.insert(m_data.indices.end(), m_data.occluders.begin(), m_data.occluders.end());
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
    // Those that last lie there since the slot's last frame, if it had them and the buffer is the same.
    SentStages& sent = m_sentStages[m_context.ring().slot()];
    if (sent.buffer != m_stageSlice.buffer || m_stageSlice.offset != 0) sent.count = 0;
    std::copy(table.begin() + static_cast<ptrdiff_t>(sent.count), table.end(), stages + sent.count);
    sent = {m_stageSlice.buffer, m_stageSlice.offset == 0 ? m_stages->lastingCount() : 0};
    std::copy(m_data.ownStages.begin(), m_data.ownStages.end(), stages + table.size());
    // A set must name a buffer even when nothing is in it.
    if (m_data.entities.empty()) m_data.entities.emplace_back();
    if (m_data.lights.empty()) m_data.lights.emplace_back();
    if (m_data.fogs.empty()) m_data.fogs.emplace_back();
    // What the viewport has more the view takes less of it.
    const vec4 part(vec2(1.0f / m_guardBand), 1.0f, 1.0f);
    for (RasterEntity& entity : m_data.entities)
        for (int column = 0; column < 4; ++column)
            entity.clipFromModel[column] *= part;
    m_entitySlice = m_storageStream.append(std::span<const RasterEntity>(m_data.entities), kStorageAlignment);
    m_lightSlice = m_storageStream.append(std::span<const RasterLight>(m_data.lights), kStorageAlignment);
    m_fogSlice = m_storageStream.append(std::span<const RasterFog>(m_data.fogs), kStorageAlignment);
}

} // namespace q3rt
