// The 2D part of RasterScene: pictures and cinematics in window pixels, and the warming of pipelines.

#include <algorithm>

#include "base/log.hpp"
#include "gpu/device.hpp"
#include "renderer_vk/raster_scene.hpp"

namespace q3rt {

namespace {

uint32_t packColor(const U8vec4& c) {
    return uint32_t{c.r} | uint32_t{c.g} << 8 | uint32_t{c.b} << 16 | uint32_t{c.a} << 24;
}

} // namespace

uint32_t RasterScene::addUiEntity() {
    // Pixels, top-left origin, to clip space; depth 0 is the nearest.
    RasterEntity entity{};
    const VkExtent2D extent = m_context.extent();
    entity.clipFromModel = mat4(0.0f);
    entity.clipFromModel[0][0] = 2.0f / static_cast<float>(extent.width);
    entity.clipFromModel[1][1] = 2.0f / static_cast<float>(extent.height);
    entity.clipFromModel[3] = vec4(-1, -1, 0, 1);
    m_data.entities.push_back(entity);
    return static_cast<uint32_t>(m_data.entities.size() - 1);
}

void RasterScene::appendQuad(const Picture& quad) {
    const auto first = static_cast<uint32_t>(m_data.vertices.size());
    const float x[2] = {quad.x, quad.x + quad.width}, y[2] = {quad.y, quad.y + quad.height};
    const float s[2] = {quad.s1, quad.s2}, t[2] = {quad.t1, quad.t2};
    for (int corner = 0; corner < 4; ++corner) {
        const int right = corner == 1 || corner == 2, bottom = corner >= 2;
        Vertex vertex{};
        vertex.position = vec3(x[right], y[bottom], 0);
        vertex.st = vertex.lightmapSt = vec2(s[right], t[bottom]);
        vertex.color = packColor(quad.color);
        m_data.vertices.push_back(vertex);
    }
    const uint32_t indices[6] = {first + 3, first, first + 2, first + 2, first, first + 1};
    m_data.indices.insert(m_data.indices.end(), indices, indices + 6);
}

void RasterScene::addUiPicture(const Picture& picture, uint32_t entity, int clockMs, uint32_t firstBatch) {
    const auto handle = static_cast<size_t>(std::max(picture.shader, 0));
    const MaterialId asked = handle < m_materials->count() ? static_cast<MaterialId>(handle) : 0;
    const MaterialId remapped = m_materials->get(asked).remappedTo;
    const MaterialId id = remapped ? remapped : asked;
    if (m_debugSort > 0 && m_materials->get(id).sort > m_debugSort) return;
    const vec2 corner(picture.x, picture.y), size(picture.width, picture.height);
    const VkExtent2D extent = m_context.extent();
    if (m_cullPictures && !rectangleShows(corner, corner + size, vec2(extent.width, extent.height))) return;
    auto& batches = m_data.batches;
    if (batches.size() > firstBatch && batches.back().own == OwnDraw::None && batches.back().material == id) {
        appendQuad(picture);
        batches.back().indexCount += 6;
        return;
    }
    StageInputs inputs;
    inputs.shaderTimeSeconds = clockMs * 0.001;
    DrawBatch batch;
    batch.material = id;
    batch.source = VertexSource::Dynamic;
    batch.entity = entity;
    batch.firstIndex = static_cast<uint32_t>(m_data.indices.size());
    batch.indexCount = 6;
    batch.stages = m_stages->evaluate(id, inputs);
    appendQuad(picture);
    batches.push_back(batch);
}

void RasterScene::addUiCinematic(const CinematicPicture& picture, uint32_t entity) {
    DrawBatch batch;
    batch.source = VertexSource::Dynamic;
    batch.entity = entity;
    batch.own = OwnDraw::Overlay;
    batch.stages = {kOwnStageBit | static_cast<uint32_t>(m_data.ownStages.size()), 1};
    batch.firstIndex = static_cast<uint32_t>(m_data.indices.size());
    batch.indexCount = 6;
    StageState state{};
    state.unit[0].texture = state.unit[1].texture = builtinTexture::kScratch0 + static_cast<uint32_t>(picture.slot);
    state.color = vec4(vec3(m_stages->identityLight()), 1.0f);
    m_data.ownStages.push_back(state);
    // Half a texel inside, so that the filter doesn't reach over the border.
    const float insetS = 0.5f / static_cast<float>(picture.columns), insetT = 0.5f / static_cast<float>(picture.rows);
    appendQuad({static_cast<float>(picture.x), static_cast<float>(picture.y), static_cast<float>(picture.width),
                static_cast<float>(picture.height), insetS, insetT, 1 - insetS, 1 - insetT, 0, U8vec4(255)});
    m_data.batches.push_back(batch);
}

void RasterScene::addUi(FrameGraph& graph, FrameTargets& targets, std::span<const FrameCommand> run, int clockMs) {
    if (!m_materials) return;
    ViewDraw view;
    view.width = static_cast<int>(m_context.extent().width);
    view.height = static_cast<int>(m_context.extent().height);
    view.clearDepth = false;
    view.firstBatch = static_cast<uint32_t>(m_data.batches.size());
    const uint32_t entity = addUiEntity();
    for (const FrameCommand& command : run) {
        if (const auto* picture = std::get_if<Picture>(&command))
            addUiPicture(*picture, entity, clockMs, view.firstBatch);
        else if (const auto* cinematic = std::get_if<CinematicPicture>(&command))
            addUiCinematic(*cinematic, entity);
    }
    view.batchCount = static_cast<uint32_t>(m_data.batches.size()) - view.firstBatch;
    m_data.views.push_back(view);
    recordPass(graph, targets, "ui", static_cast<uint32_t>(m_data.views.size()) - 1, 1);
}

void RasterScene::warmPipelines(MaterialId flare, MaterialId sun) {
    if (!m_materials) return;
    if (m_materials->count() > 0) stagePasses(static_cast<MaterialId>(m_materials->count() - 1));
    std::vector<StateKey> fresh;
    for (const StateKey& key : m_pipelines.statesOf(*m_materials, m_worldHasPortals, flare, sun, m_mergeStages))
        if (!m_pipelines.known(key)) fresh.push_back(key);
    if (fresh.empty()) return;
    logLine(LogLevel::Developer, "%zu raster pipelines to compile", fresh.size());
    // Software drivers compile at the first draw: one triangle of no size in each state makes them do it now.
    Device& device = m_context.device();
    const std::vector<std::byte> zeros(4096);
    Buffer buffer(device, {.size = zeros.size(),
                           .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           .name = "warm-up"});
    m_context.uploader().upload(buffer, std::span<const std::byte>(zeros));
    m_context.uploader().flush();
    DescriptorArena arena(device);
    const VkDescriptorSet set =
        arena.make(m_frameLayout, {bindStorageBuffer(0, buffer.handle()), bindStorageBuffer(1, buffer.handle()),
                                   bindStorageBuffer(2, buffer.handle()), bindStorageBuffer(3, buffer.handle())});
    TargetImages& main = m_context.main();
    GpuImage &target = main.samples ? main.samples : main.color, &depth = main.depth;
    device.submitAndWait([&](VkCommandBuffer commands) {
        target.transition(commands, {access::kColorAttachment.stages, access::kColorAttachment.access,
                                     access::kColorAttachment.layout});
        depth.transition(commands, {access::kDepthAttachment.stages, access::kDepthAttachment.access,
                                    access::kDepthAttachment.layout});
        const Attachment color{.view = target.view()}, depthAttachment{.view = depth.view(), .stencil = true};
        beginRendering(commands, target.extent(), color, depthAttachment);
        const VkDeviceSize offset = 0;
        const VkBuffer vertices = buffer.handle();
        vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
        vkCmdBindIndexBuffer(commands, buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
        vkCmdSetFrontFaceEXT(commands, VK_FRONT_FACE_CLOCKWISE);
        vkCmdSetCullModeEXT(commands, VK_CULL_MODE_NONE);
        vkCmdSetDepthBias(commands, 0, 0, 0);
        for (const StateKey& key : fresh) {
            const GraphicsPipeline& pipeline = m_pipelines.find(key);
            pipeline.bind(commands);
            pipeline.bindSets(commands, {set, m_context.textures().set()});
            pipeline.push(commands, RasterDraw{});
            vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
        }
        vkCmdEndRenderingKHR(commands);
    });
}

} // namespace q3rt
