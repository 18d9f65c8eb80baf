// What r_shownormals and r_speeds show of a view.

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "renderer_vk/view_work.hpp"

namespace q3rt {

namespace {

constexpr float kNormalLengthQu = 2.0f;

} // namespace

/// A line from each vertex that the batch uses along its normal.
void DrawListBuilder::appendNormals(ViewWork& work, const DrawBatch& of) {
    const auto first = work.out.indices.begin() + of.firstIndex;
    std::vector<uint32_t> used(first, first + of.indexCount);
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    DrawBatch batch = of;
    batch.own = OwnDraw::Normals;
    batch.source = VertexSource::Dynamic;
    batch.depthRange = DepthRange::Near;
    batch.depthFirst = false;
    batch.stages = {kOwnStageBit | static_cast<uint32_t>(work.out.ownStages.size()), 1};
    work.out.ownStages.push_back(colorStage(vec4(1.0f)));
    batch.firstIndex = static_cast<uint32_t>(work.out.indices.size());
    for (const uint32_t index : used) {
        const Vertex foot = of.source == VertexSource::World ? m_world->vertices[index] : work.out.vertices[index];
        Vertex tip = foot;
        tip.position += foot.normal * kNormalLengthQu;
        for (const Vertex& end : {foot, tip}) {
            work.out.indices.push_back(static_cast<uint32_t>(work.out.vertices.size()));
            work.out.vertices.push_back(end);
        }
    }
    batch.indexCount = static_cast<uint32_t>(work.out.indices.size()) - batch.firstIndex;
    work.out.batches.push_back(batch);
}

void DrawListBuilder::countView(const ViewWork& work) {
    ViewCounts& counts = m_counts;
    counts.cluster = m_visibility ? m_visibility->cluster() : -1;
    counts.farQu = work.view.farQu;
    counts.leafs += work.hasWorld() ? work.visible.leafCount : 0;
    counts.surfaces += work.items.size();
    for (const Item& item : work.items) {
        const uint32_t vertices = item.fromWorld ? m_world->surfaces[item.surface].vertexCount
                                                 : work.geometry.surfaces[item.surface].vertexCount;
        counts.vertices += vertices;
        if (item.lit) ++counts.litSurfaces;
    }
    for (size_t i = 1; i < work.entityCull.size(); ++i)
        ++counts.models[static_cast<size_t>(work.entityCull[i])];
    counts.flares += work.flares.size();
    counts.flaresFading = m_fades.size();
}

std::string DrawListBuilder::describeCounts(int kind, const FrameDrawData& data) const {
    const ViewCounts& c = m_counts;
    size_t triangles = 0, allTriangles = 0, lightTriangles = 0, texels = 0;
    std::set<uint32_t> textures;
    for (const DrawBatch& batch : data.batches) {
        triangles += batch.indexCount / 3;
        allTriangles += batch.indexCount / 3 * (batch.stages.count + (batch.fog >= 0 ? 1 : 0));
        for (uint32_t i = 0; i < batch.lightCount; ++i)
            lightTriangles += data.lightDraws[batch.firstLight + i].indexCount / 3;
        if (batch.own != OwnDraw::None) continue;
        for (uint32_t i = 0; i < batch.stages.count; ++i)
            for (const TextureUnitState& unit : m_stages.states()[batch.stages.first + i].unit)
                textures.insert(unit.texture);
    }
    allTriangles += lightTriangles;
    for (const uint32_t id : textures) {
        const MipLevel& level = m_stages.textures().get(id).levels.front();
        texels += static_cast<size_t>(level.width) * static_cast<size_t>(level.height);
    }
    switch (kind) {
    case 1:
        return formatText("%zu batches of %zu surfaces, %zu leafs, %zu vertices, %zu triangles (%zu over all passes), "
                          "%.2f million texels",
                          data.batches.size(), c.surfaces, c.leafs, c.vertices, triangles, allTriangles,
                          static_cast<double>(texels) * 1e-6);
    case 2:
        return formatText("models: %zu in the view, %zu across its edges, %zu outside", c.models[0], c.models[1],
                          c.models[2]);
    case 3:
        return formatText("cluster %d", c.cluster);
    case 4:
        return formatText("dynamic lights: %zu surfaces, %zu triangles", c.litSurfaces, lightTriangles);
    case 5:
        return formatText("far plane at %.0f qu", static_cast<double>(c.farQu));
    case 6:
        return formatText("flares: %zu in the view, %zu asked about, %zu known", c.flares, data.flareTests.size(),
                          c.flaresFading);
    default:
        return {};
    }
}

} // namespace q3rt
