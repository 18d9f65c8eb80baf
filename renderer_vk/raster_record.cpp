// The recording half of RasterScene: views and their batches as commands.

#include <algorithm>
#include <cstring>

#include "gpu/device.hpp"
#include "renderer_vk/raster_scene.hpp"

namespace q3rt {

namespace {

// Weapons keep to the nearest part of the depth range, so that they never reach into walls.
constexpr float kWeaponDepth = 0.3f;

VkViewport viewportOf(const ViewDraw& view, DepthRange range, float guardBand) {
    const vec2 size(view.width, view.height), corner = vec2(view.x, view.y) - 0.5f * (guardBand - 1.0f) * size;
    VkViewport viewport{corner.x, corner.y, guardBand * size.x, guardBand * size.y, 0.0f, 1.0f};
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

bool isEmpty(const VkRect2D& area) { return area.extent.width == 0 || area.extent.height == 0; }

/// What of `scissor` lies in a box of the view's pixels.
VkRect2D partOf(const VkRect2D& scissor, const ViewDraw& view, const PixelBox& box) {
    const glm::ivec2 least(scissor.offset.x, scissor.offset.y);
    const glm::ivec2 greatest = least + glm::ivec2(scissor.extent.width, scissor.extent.height);
    const glm::ivec2 corner(view.x, view.y);
    const glm::ivec2 from = glm::clamp(corner + box.from, least, greatest),
                     to = glm::clamp(corner + box.to, from, greatest);
    return {{from.x, from.y}, {static_cast<uint32_t>(to.x - from.x), static_cast<uint32_t>(to.y - from.y)}};
}

} // namespace

void RasterScene::BoundState::setScissor(VkCommandBuffer commands, const VkRect2D& wanted) {
    if (std::memcmp(&scissor, &wanted, sizeof(wanted)) == 0) return;
    scissor = wanted;
    vkCmdSetScissor(commands, 0, 1, &wanted);
}

void RasterScene::bindFrame(PassContext& pass) {
    if (m_frameSet == VK_NULL_HANDLE) {
        const auto bind = [](uint32_t slot, const BufferSlice& slice) {
            return bindStorageBuffer(slot, slice.buffer, slice.offset, slice.size);
        };
        m_frameSet = pass.makeSet(
            m_frameLayout, {bind(0, m_stageSlice), bind(1, m_entitySlice), bind(2, m_lightSlice), bind(3, m_fogSlice)});
    }
    m_bound = BoundState{};
    vkCmdBindIndexBuffer(pass.commands(), m_indexSlice.buffer, m_indexSlice.offset, VK_INDEX_TYPE_UINT32);
}

void RasterScene::recordViews(PassContext& pass, FrameTargets targets, uint32_t firstView, uint32_t viewCount) {
    const Attachment color = colorAttachment(pass, targets);
    const Attachment depth{.view = pass.view(targets.depth), .stencil = true};
    beginRendering(pass.commands(), pass.extent(targets.color), color, depth);
    bindFrame(pass);
    const auto views = std::span(m_data.views).subspan(firstView, viewCount);
    for (const ViewDraw& view : views)
        recordView(pass, view, pass.extent(targets.color));
    vkCmdEndRenderingKHR(pass.commands());
    for (const ViewDraw& view : views)
        if (!isEmpty(scissorOf(view, pass.extent(targets.color))))
            m_flareQueries.answer(pass.commands(), view.firstFlareTest, view.flareTestCount);
}

void RasterScene::recordView(PassContext& pass, const ViewDraw& view, VkExtent2D extent) {
    const VkRect2D scissor = scissorOf(view, extent);
    if (isEmpty(scissor)) return;
    m_bound.setScissor(pass.commands(), scissor);
    m_bound.range = -1;
    constexpr VkImageAspectFlags kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    VkClearAttachment clears[2] = {};
    uint32_t clearCount = 0;
    if (view.clearDepth && view.depthClear.count == 0)
        clears[clearCount++] = {kDepthStencil, 0, {.depthStencil = {1.0f, 0}}};
    if (view.clearColor) {
        const float grey = view.clearGrey;
        clears[clearCount++] = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {grey, grey, grey, 1.0f}}}};
    }
    const VkClearRect area{scissor, 0, 1};
    if (clearCount > 0) vkCmdClearAttachments(pass.commands(), clearCount, clears, 1, &area);
    recordDepthClear(pass.commands(), view);
    const std::span<const DrawBatch> batches = batchesOf(view);
    const bool nearestFirst = m_depthFirst && !m_showEdges;
    for (const DrawBatch& batch : batches)
        if (nearestFirst && batch.nearest) recordBatch(pass.commands(), view, batch);
    if (m_depthFirst && depthFirstPays(view)) recordDepth(pass.commands(), view);
    for (const DrawBatch& batch : batches) {
        if (nearestFirst && batch.nearest) continue;
        recordBatch(pass.commands(), view, batch);
        if (m_showEdges && batch.own == OwnDraw::None) recordEdges(pass.commands(), view, batch);
    }
    recordFlareTests(pass.commands(), view);
}

void RasterScene::recordDepthClear(VkCommandBuffer commands, const ViewDraw& view) {
    if (view.depthClear.count == 0) return;
    DrawBatch square;
    square.source = VertexSource::Dynamic;
    square.firstIndex = view.depthClear.first;
    square.indexCount = view.depthClear.count;
    RasterDraw constants{};
    constants.entity = view.clearEntity;
    constants.pass = kPassDepth;
    draw(commands, depthClearKey(), constants, square, false, CullMode::None, view);
}

std::span<const DrawBatch> RasterScene::batchesOf(const ViewDraw& view) const {
    return std::span(m_data.batches).subspan(view.firstBatch, view.batchCount);
}

/// What is drawn of a batch if its depth is drawn first.
DrawBatch RasterScene::depthOf(DrawBatch batch) const {
    if (!m_occludersListed) return batch;
    batch.firstIndex = m_firstOccluder + batch.firstOccluder;
    batch.indexCount = batch.occluderCount;
    return batch;
}

/// A vertex costs about what a pixel does: a small picture is shaded sooner than its depth is drawn.
bool RasterScene::depthFirstPays(const ViewDraw& view) const {
    size_t vertices = 0;
    for (const DrawBatch& batch : batchesOf(view))
        if (batch.depthFirst) vertices += depthOf(batch).indexCount;
    return vertices < static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
}

void RasterScene::recordDepth(VkCommandBuffer commands, const ViewDraw& view) {
    const std::span<const DrawBatch> batches = batchesOf(view);
    for (size_t i = 0; i < batches.size();) {
        DrawBatch run = depthOf(batches[i++]);
        if (!run.depthFirst) continue;
        const CullMode cull = m_materials->get(run.material).cull;
        for (; i < batches.size() && batches[i].depthFirst && batches[i].entity == run.entity &&
               batches[i].depthRange == run.depthRange && m_materials->get(batches[i].material).cull == cull;
             ++i)
            run.indexCount += depthOf(batches[i]).indexCount;
        if (run.indexCount == 0) continue;
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
        DrawBatch shown = batch;
        if (batch.firstStageRange >= 0) {
            const IndexRange& range = m_data.stageRanges[static_cast<size_t>(batch.firstStageRange) + pass.firstStage];
            shown.firstIndex = range.first;
            shown.indexCount = range.count;
            if (range.count == 0) continue;
        }
        draw(commands, passKey(material.stages, pass, view.clipped), constants, shown, material.polygonOffset,
             material.cull, view);
    }
    constants.useFog = 0;
    recordLights(commands, view, batch, constants);
    const bool opaque = material.sort <= 3;
    if (batch.fog >= 0 && (opaque || (material.contentFlags & surfaceParm::kContentsFog) != 0)) {
        constants.pass = kPassFog;
        draw(commands, fogKey(opaque, view.clipped), constants, batch, material.polygonOffset, material.cull, view);
    }
}

void RasterScene::recordLights(VkCommandBuffer commands, const ViewDraw& view, DrawBatch batch, RasterDraw constants) {
    const Material& material = m_materials->get(batch.material);
    const VkRect2D all = m_bound.scissor;
    constants.pass = kPassLight;
    for (uint32_t i = 0; i < batch.lightCount; ++i) {
        constants.light = batch.firstLight + i;
        const LightDraw& light = m_data.lightDraws[constants.light];
        batch.firstIndex = light.firstIndex;
        batch.indexCount = light.indexCount;
        const VkRect2D lit = partOf(all, view, light.box);
        if (batch.indexCount == 0 || isEmpty(lit)) continue;
        m_bound.setScissor(commands, lit);
        draw(commands, lightKey(light.additive, view.clipped), constants, batch, material.polygonOffset, material.cull,
             view);
    }
    m_bound.setScissor(commands, all);
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
    if (m_bound.pipeline != &pipeline) {
        pipeline.bind(commands);
        if (!m_bound.pipeline) pipeline.bindSets(commands, {m_frameSet, m_context.textures().set()});
        m_bound.pipeline = &pipeline;
    }
    if (m_bound.source != static_cast<int>(batch.source)) {
        m_bound.source = static_cast<int>(batch.source);
        const bool world = batch.source == VertexSource::World;
        const VkBuffer buffer = world ? m_worldVertices.handle() : m_vertexSlice.buffer;
        const VkDeviceSize offset = world ? 0 : m_vertexSlice.offset;
        vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
    }
    if (m_bound.range != static_cast<int>(batch.depthRange)) {
        m_bound.range = static_cast<int>(batch.depthRange);
        const VkViewport viewport = viewportOf(view, batch.depthRange, m_guardBand);
        vkCmdSetViewport(commands, 0, 1, &viewport);
    }
    const int cullState = static_cast<int>(cull) * 2 + (view.mirrored ? 1 : 0);
    if (m_bound.cull != cullState) {
        m_bound.cull = cullState;
        // Clockwise on the screen is the front; a mirror turns it round.
        vkCmdSetFrontFaceEXT(commands, view.mirrored ? VK_FRONT_FACE_COUNTER_CLOCKWISE : VK_FRONT_FACE_CLOCKWISE);
        vkCmdSetCullModeEXT(commands, cull == CullMode::None    ? VK_CULL_MODE_NONE
                                      : cull == CullMode::Front ? VK_CULL_MODE_BACK_BIT
                                                                : VK_CULL_MODE_FRONT_BIT);
    }
    if (m_bound.offset != (polygonOffset ? 1 : 0)) {
        m_bound.offset = polygonOffset ? 1 : 0;
        vkCmdSetDepthBias(commands, polygonOffset ? m_offsetUnits : 0.0f, 0.0f, polygonOffset ? m_offsetFactor : 0.0f);
    }
    pipeline.push(commands, constants);
    vkCmdDrawIndexed(commands, batch.indexCount, 1, batch.firstIndex, 0, 0);
}

} // namespace q3rt
