// The second half of DrawListBuilder: from sorted surfaces to batches, entities, lights and fogs of the frame.

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer_vk/patch_lod.hpp"
#include "renderer_vk/stage_passes.hpp"
#include "renderer_vk/view_work.hpp"

namespace q3rt {

namespace {

constexpr float kBlackGrey = 0.0f;
constexpr float kOpaqueSort = 3.0f;

float wholeByte(float value) { return std::floor(std::clamp(value, 0.0f, 1.0f) * 255.0f) / 255.0f; }

/// All four of its corners are there.
bool isSquare(const EntitySurface& surface) { return surface.vertexCount == 4 && !surface.partly; }

/// Every pixel of such a surface gets a colour and a depth of its own, whatever lies behind.
bool coversWhatIsBehind(const Material& material) {
    if (material.sort != kOpaqueSort || material.polygonOffset || material.stages.empty()) return false;
    const Stage& first = material.stages.front();
    return !first.blended && first.depthWrite && first.depthFunc == DepthFunc::LessEqual &&
           first.alphaTest == AlphaTest::None;
}

/// Those of a surface of the view, whose vertices begin at `base` less the surface's own first.
void appendSurfaceIndices(const ViewGeometry& geometry, const EntitySurface& surface, uint32_t base,
                          std::vector<uint32_t>& out) {
    const size_t first = out.size();
    out.resize(first + surface.indexCount);
    for (uint32_t i = 0; i < surface.indexCount; ++i)
        out[first + i] = base + geometry.indices[surface.firstIndex + i];
}

StageState boxStage(TextureId texture, float brightness) {
    StageState state{};
    for (TextureUnitState& unit : state.unit)
        unit.texture = texture;
    state.unit[0].coord = kCoordLightmap; // where a sky's box has its own
    state.unit[0].clamped = 1;
    state.color = vec4(vec3(brightness), 1.0f);
    state.rgbGen = kColorConstant;
    state.alphaGen = kAlphaConstant;
    return state;
}

} // namespace

uint32_t DrawListBuilder::entityIndex(ViewWork& work, uint32_t entity) {
    int& index = work.entityIndices[entity];
    if (index >= 0) return static_cast<uint32_t>(index);
    index = static_cast<int>(work.out.entities.size());
    const EntityRecord& record = work.geometry.entities[entity];
    RasterEntity target{};
    const mat4& clip = entityFlag::isHeld(record.flags) ? work.view.clipFromWorldNear : work.view.clipFromWorld;
    target.clipFromModel = mat4(glm::dmat4(clip) * glm::dmat4(record.worldFromModel));
    const mat4 rows = glm::transpose(record.worldFromModel);
    target.worldRow0 = rows[0];
    target.worldRow1 = rows[1];
    target.worldRow2 = rows[2];
    target.clipPlane = work.view.portal ? vec4(work.view.clip.normal, work.view.clip.distance) : vec4(0.0f);
    target.eyeInModel = entity == 0 ? work.view.eye.origin : record.eyeInModel;
    target.eyeInWorld = work.view.eye.origin;
    target.ambient = record.light.ambient;
    target.directed = record.light.directed;
    target.lightDirection = record.light.direction;
    work.out.entities.push_back(target);
    return static_cast<uint32_t>(index);
}

int DrawListBuilder::fogIndex(ViewWork& work, int fog) {
    if (fog <= 0 || !m_world || static_cast<size_t>(fog) >= m_world->fogs.size()) return -1;
    int& index = work.fogIndices[static_cast<size_t>(fog)];
    if (index >= 0) return index;
    const FogVolume& volume = m_world->fogs[static_cast<size_t>(fog)];
    RasterFog target{};
    target.color = vec3(wholeByte(volume.color.r), wholeByte(volume.color.g), wholeByte(volume.color.b));
    target.scale = 1.0f / (8.0f * std::max(volume.depthForOpaque, 1.0f));
    target.forward = work.view.eye.axis[0];
    target.eye = work.view.eye.origin;
    target.hasSurface = volume.hasSurface ? 1 : 0;
    target.planeNormal = volume.surface.normal;
    target.planeDistance = volume.surface.distance;
    // A fog without a surface: the eye counts as inside, every depth as 0.
    target.eyeDepth =
        volume.hasSurface ? volume.surface.distance - glm::dot(volume.surface.normal, work.view.eye.origin) : 1.0f;
    index = static_cast<int>(work.out.fogs.size());
    work.out.fogs.push_back(target);
    return index;
}

void DrawListBuilder::appendLights(ViewWork& work, DrawBatch& batch, size_t firstItem, size_t lastItem) {
    const auto lights = work.settings.dynamicLights ? work.lights() : std::span<const SceneLight>();
    m_batchLights.clear();
    for (size_t i = firstItem; i < lastItem; ++i) {
        const Item& item = work.items[i];
        const int surface =
            item.fromWorld ? static_cast<int>(item.surface) : work.geometry.surfaces[item.surface].worldSurface;
        if (surface < 0) continue;
        for (const uint32_t light : m_lights->touching(static_cast<uint32_t>(surface)))
            if (light < lights.size()) m_batchLights.push_back(light);
    }
    if (m_batchLights.empty()) return;
    std::ranges::sort(m_batchLights);
    m_batchLights.erase(std::unique(m_batchLights.begin(), m_batchLights.end()), m_batchLights.end());
    const mat4 modelFromWorld = glm::inverse(work.geometry.entities[work.items[firstItem].entity].worldFromModel);
    batch.firstLight = static_cast<uint32_t>(work.out.lights.size());
    batch.lightCount = static_cast<uint32_t>(m_batchLights.size());
    for (const uint32_t index : m_batchLights) {
        const SceneLight& light = lights[index];
        RasterLight target{};
        target.origin = vec3(modelFromWorld * vec4(light.origin, 1.0f));
        target.radius = light.radius;
        target.color = light.color;
        work.out.lights.push_back(target);
        work.out.lightDraws.push_back(findLitPart(work, batch, target));
        work.out.lightDraws.back().additive = light.additive;
    }
}

LightDraw DrawListBuilder::findLitPart(ViewWork& work, const DrawBatch& batch, const RasterLight& light) {
    LightDraw lit;
    lit.firstIndex = batch.firstIndex;
    lit.indexCount = batch.indexCount;
    lit.box.to = glm::ivec2(work.view.scene->width, work.view.scene->height);
    if (!work.settings.cullTriangles) return lit;
    std::vector<uint32_t>& indices = work.out.indices;
    lit.firstIndex = static_cast<uint32_t>(indices.size());
    lit.box = appendLitTriangles(triangleView(work, batch), light, verticesOf(work, batch), indices, batch.firstIndex,
                                 batch.indexCount);
    lit.indexCount = static_cast<uint32_t>(indices.size()) - lit.firstIndex;
    return lit;
}

void DrawListBuilder::appendItemIndices(ViewWork& work, const Item& item) {
    std::vector<uint32_t>& out = work.out.indices;
    if (!item.fromWorld)
        return appendSurfaceIndices(work.geometry, work.geometry.surfaces[item.surface], work.vertexBase, out);
    const WorldSurface& surface = m_world->surfaces[item.surface];
    if (surface.patch >= 0) {
        appendPatchIndices(surface, m_world->patches[static_cast<size_t>(surface.patch)], work.view,
                           work.geometry.entities[item.entity].worldFromModel, work.settings.raster.r_lodCurveError,
                           out);
        return;
    }
    const auto first = m_world->indices.begin() + surface.firstIndex;
    out.insert(out.end(), first, first + surface.indexCount);
}

void DrawListBuilder::makeBatches(ViewWork& work) {
    const SceneView& scene = *work.view.scene;
    ViewDraw draw;
    draw.x = scene.x;
    draw.y = scene.y;
    draw.width = scene.width;
    draw.height = scene.height;
    draw.mirrored = work.view.mirrored;
    draw.clipped = work.view.portal;
    draw.clearColor = work.settings.fastSky && work.hasWorld();
    draw.clearGrey = kBlackGrey;
    if (scene.flags & viewFlag::kHyperspace) {
        draw.clearColor = true;
        draw.clearGrey = static_cast<float>(scene.timeMs & 255) / 255.0f;
    }
    if (!work.out.views.empty()) appendDepthClear(work, draw);
    draw.firstBatch = static_cast<uint32_t>(work.out.batches.size());
    const bool volumes = work.settings.geometry.shadows == Shadows::Volume;
    bool volumesDrawn = !volumes;
    for (size_t first = 0; first < work.items.size();) {
        const Item& head = work.items[first];
        if (!volumesDrawn && m_materials.get(head.material).sort > kShadowVolumeSort) {
            appendShadowVolumes(work);
            volumesDrawn = true;
        }
        const bool merge = m_materials.get(head.material).entityMergable;
        size_t last = first + 1;
        for (; last < work.items.size(); ++last) {
            const Item& next = work.items[last];
            const bool same = next.material == head.material && next.fog == head.fog && next.lit == head.lit &&
                              next.fromWorld == head.fromWorld && (merge || next.entity == head.entity);
            if (!same) break;
        }
        appendBatch(work, first, last);
        first = last;
    }
    if (!volumesDrawn) appendShadowVolumes(work);
    if (work.settings.raster.r_drawSun != 0 && work.skyDrawn) appendSun(work);
    if (volumes) appendShadowShade(work);
    appendFlares(work, draw);
    if (work.settings.raster.r_speeds != 0) countView(work);
    draw.batchCount = static_cast<uint32_t>(work.out.batches.size()) - draw.firstBatch;
    work.out.views.push_back(draw);
}

/// Between what is drawn a square at the far end clears as well. For a command that clears a software driver waits
/// until all before it is drawn.
void DrawListBuilder::appendDepthClear(ViewWork& work, ViewDraw& draw) {
    constexpr float kFar = 1.0f;
    draw.clearEntity = screenEntity(work);
    draw.depthClear = {static_cast<uint32_t>(work.out.indices.size()), 6};
    appendScreenSquare(work, vec2(0.0f), vec2(draw.width, draw.height), kFar, 0);
}

void DrawListBuilder::appendBatch(ViewWork& work, size_t firstItem, size_t lastItem) {
    const Item& last = work.items[lastItem - 1];
    const MaterialId id = drawnId(last.material);
    const Material& material = m_materials.get(id);
    const float debugSort = work.settings.raster.r_debugSort;
    if (debugSort > 0 && material.sort > debugSort) return;
    if (material.isSky) {
        if (!work.settings.fastSky) appendSky(work, material, id, firstItem, lastItem);
        return;
    }
    const EntityRecord& record = work.geometry.entities[last.entity];
    DrawBatch batch;
    batch.material = id;
    batch.source = last.fromWorld ? VertexSource::World : VertexSource::Dynamic;
    batch.firstIndex = static_cast<uint32_t>(work.out.indices.size());
    batch.entity = entityIndex(work, last.entity);
    const bool heldInHand = (record.flags & entityFlag::kDepthHack) != 0;
    batch.firstOccluder = static_cast<uint32_t>(work.out.occluders.size());
    const bool covers = !work.view.portal && coversWhatIsBehind(material);
    batch.depthFirst = covers && last.fromWorld;
    batch.nearest = covers && heldInHand;
    for (size_t i = firstItem; i < lastItem; ++i) {
        const size_t firstIndex = work.out.indices.size();
        appendItemIndices(work, work.items[i]);
        if (work.settings.cullTriangles) cullTriangles(work, batch, material.cull, firstIndex);
    }
    batch.occluderCount = static_cast<uint32_t>(work.out.occluders.size()) - batch.firstOccluder;
    batch.indexCount = static_cast<uint32_t>(work.out.indices.size()) - batch.firstIndex;
    if (batch.indexCount == 0) return;
    batch.stages = m_stages.evaluate(id, record.stage);
    batch.fog = fogIndex(work, last.fog);
    batch.erasesShadows = work.settings.geometry.shadows == Shadows::Volume && material.sort > kShadowVolumeSort;
    const bool trims = work.settings.cullTriangles && batch.fog < 0 && !batch.erasesShadows;
    if (trims) trimEffects(work, batch, firstItem, lastItem);
    if (heldInHand) batch.depthRange = DepthRange::Weapon;
    constexpr uint32_t kUnlit = surfaceParm::kNoDlight | surfaceParm::kSky;
    if (material.sort <= 3 && (material.surfaceFlags & kUnlit) == 0) appendLights(work, batch, firstItem, lastItem);
    work.out.batches.push_back(batch);
    if (work.settings.raster.r_shownormals != 0) appendNormals(work, batch);
}

/// The vertices of effects are the view's own: they move where the picture begins and ends, for each stage by itself.
void DrawListBuilder::trimEffects(ViewWork& work, DrawBatch& batch, size_t firstItem, size_t lastItem) {
    if (batch.source != VertexSource::Dynamic || batch.stages.count == 0) return;
    const auto items = std::span(work.items).subspan(firstItem, lastItem - firstItem);
    if (std::ranges::none_of(items, [&](const Item& item) { return isSquare(work.geometry.surfaces[item.surface]); }))
        return;
    const size_t firstIndex = work.out.indices.size(), firstVertex = work.out.vertices.size();
    const auto firstRange = static_cast<uint32_t>(work.out.stageRanges.size());
    bool trimmed = false;
    for (uint32_t stage = 0; stage < batch.stages.count; ++stage) {
        const size_t first = work.out.indices.size();
        for (const Item& item : items)
            trimmed |= appendTrimmed(work, batch, stage, item);
        cullTriangles(work, batch, m_materials.get(batch.material).cull, first);
        work.out.stageRanges.push_back(
            {static_cast<uint32_t>(first), static_cast<uint32_t>(work.out.indices.size() - first)});
    }
    if (trimmed) {
        batch.firstStageRange = static_cast<int>(firstRange);
        return;
    }
    work.out.indices.resize(firstIndex);
    work.out.vertices.resize(firstVertex);
    work.out.stageRanges.resize(firstRange);
}

/// Indices of an item as a stage shows it; false if it shows all.
bool DrawListBuilder::appendTrimmed(ViewWork& work, const DrawBatch& batch, uint32_t stage, const Item& item) {
    const EntitySurface& surface = work.geometry.surfaces[item.surface];
    const uint32_t firstVertex = work.vertexBase + surface.firstVertex;
    const auto trim = [&]() -> std::optional<TexturePart> {
        const StageState& state = m_stages.states()[batch.stages.first + stage];
        const size_t texture = state.unit[0].texture;
        if (!isSquare(surface) || texture >= work.settings.textureParts.size()) return std::nullopt;
        const TriangleView view = triangleView(work, batch);
        const EffectSquare square(std::span(work.out.vertices).subspan(firstVertex).first<4>(), view.clipFromModel,
                                  view.sizePx);
        if (!square.usable()) return std::nullopt;
        const TextureParts& parts = work.settings.textureParts[texture];
        const TexturePart part = findPartShown(state, parts, square.texelsPerPixel(parts.sizeTexels));
        if (part.whole()) return std::nullopt;
        if (part.empty()) return part;
        const size_t first = work.out.vertices.size();
        work.out.vertices.resize(first + 4);
        square.write(part, std::span(work.out.vertices).subspan(first).first<4>());
        return part;
    };
    const std::optional<TexturePart> part = trim();
    if (!part) {
        appendItemIndices(work, item);
        return false;
    }
    if (part->empty()) return true;
    const auto base = static_cast<uint32_t>(work.out.vertices.size()) - 4 - surface.firstVertex;
    appendSurfaceIndices(work.geometry, surface, base, work.out.indices);
    return true;
}

void DrawListBuilder::cullTriangles(ViewWork& work, const DrawBatch& batch, CullMode cull, size_t firstIndex) {
    TriangleView view = triangleView(work, batch);
    view.cull = cull;
    m_culler.cull(view, verticesOf(work, batch), work.out.indices, firstIndex,
                  batch.depthFirst ? &work.out.occluders : nullptr);
}

TriangleView DrawListBuilder::triangleView(const ViewWork& work, const DrawBatch& batch) const {
    TriangleView view;
    view.clipFromModel = work.out.entities[batch.entity].clipFromModel;
    view.sizePx = vec2(work.view.scene->width, work.view.scene->height);
    view.mirrored = work.view.mirrored;
    view.manySamples = work.settings.raster.r_ext_multisample > 0;
    return view;
}

const std::vector<Vertex>& DrawListBuilder::verticesOf(const ViewWork& work, const DrawBatch& batch) const {
    return batch.source == VertexSource::World ? m_world->vertices : work.out.vertices;
}

void DrawListBuilder::findSkyCoverage(ViewWork& work, size_t firstItem, size_t lastItem) {
    m_skyCoverage.clear();
    const vec3& eye = work.view.eye.origin;
    const std::vector<Vertex>& vertices = work.items[firstItem].fromWorld ? m_world->vertices : work.out.vertices;
    const size_t firstIndex = work.out.indices.size();
    for (size_t i = firstItem; i < lastItem; ++i)
        appendItemIndices(work, work.items[i]);
    for (size_t i = firstIndex; i + 2 < work.out.indices.size(); i += 3) {
        const auto at = [&](size_t k) { return vertices[work.out.indices[i + k]].position - eye; };
        m_skyCoverage.addTriangle(at(0), at(1), at(2));
    }
    work.out.indices.resize(firstIndex);
}

void DrawListBuilder::appendSky(ViewWork& work, const Material& material, MaterialId id, size_t firstItem,
                                size_t lastItem) {
    work.skyDrawn = true;
    findSkyCoverage(work, firstItem, lastItem);
    DrawBatch batch;
    batch.material = id;
    batch.source = VertexSource::Dynamic;
    batch.depthRange = work.settings.raster.r_showsky != 0 ? DepthRange::Near : DepthRange::Far;
    batch.entity = entityIndex(work, 0);
    const float halfSize = work.view.farQu / kSkyPart;
    std::array<SkyFaceRange, kSkyFaces> faces;
    for (int face = 0; face < (material.sky.hasBox ? kSkyFaces : kSkyCloudFaces); ++face) {
        SkyFaceRange& range = faces[static_cast<size_t>(face)];
        range = appendSkyFace(m_skyCoverage, face, work.view.eye.origin, halfSize, m_materials.lastCloudHeight,
                              work.out.vertices, work.out.indices);
        if (!work.settings.cullTriangles) continue;
        cullTriangles(work, batch, CullMode::None, range.firstIndex);
        range.indexCount = static_cast<uint32_t>(work.out.indices.size()) - range.firstIndex;
    }
    const int fog = fogIndex(work, work.items[firstItem].fog);
    StageRange clouds;
    if (!material.stages.empty()) clouds = m_stages.evaluate(id, work.geometry.entities[0].stage);
    const bool inOnePass = material.sky.hasBox && fog < 0 && work.settings.raster.r_mergeStages != 0 &&
                           findCloudLayers(material.stages).has_value();
    for (size_t face = 0; material.sky.hasBox && face < kSkyFaces; ++face) {
        if (faces[face].indexCount == 0) continue;
        // Images are in the order rt lf bk ft up dn, as the faces are.
        batch.own = OwnDraw::SkyBox;
        batch.stages = {kOwnStageBit | static_cast<uint32_t>(work.out.ownStages.size()), 1};
        if (inOnePass && face < kSkyCloudFaces) batch.clouds = clouds;
        work.out.ownStages.push_back(boxStage(material.sky.box[face], m_stages.identityLight()));
        batch.firstIndex = faces[face].firstIndex;
        batch.indexCount = faces[face].indexCount;
        work.out.batches.push_back(batch);
        batch.clouds = {};
    }
    if (clouds.count == 0 || inOnePass) return;
    batch.own = OwnDraw::None;
    batch.firstIndex = faces[0].firstIndex;
    batch.indexCount = 0;
    for (size_t face = 0; face < kSkyCloudFaces; ++face)
        batch.indexCount += faces[face].indexCount;
    if (batch.indexCount == 0) return;
    batch.stages = clouds;
    batch.fog = fog;
    work.out.batches.push_back(batch);
}

} // namespace q3rt
