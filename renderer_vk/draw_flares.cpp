// Flares of a view: squares on the screen, and for each a pixel that asks whether it is seen.

#include <algorithm>
#include <cmath>

#include "renderer_vk/view_work.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {

namespace {

// What stands less than this before a flare does not hide it: the lamp that it belongs to.
constexpr float kLampQu = 24.0f;

uint32_t wrappedByte(float value) { return static_cast<uint32_t>(static_cast<int>(value * 255.0f)) & 0xFFu; }

/// Depth in the window of what is `depthQu` along the view; what is before the near plane counts as at it.
float windowDepth(const RasterView& view, float depthQu) {
    const float n = view.nearQu, f = std::max(view.farQu, 2 * n);
    return depthQu <= n ? 0.0f : std::min(f / (f - n) * (1 - n / depthQu), 1.0f);
}

float fogDensityAt(const FogVolume& volume, const Orientation& eye, const vec3& point) {
    const float scale = 1.0f / (8.0f * std::max(volume.depthForOpaque, 1.0f));
    const auto depthOf = [&](const vec3& p) { return volume.surface.distance - glm::dot(volume.surface.normal, p); };
    constexpr float kOut = 1.0f / 32, kIn = 31.0f / 32;
    float t = kIn;
    if (volume.hasSurface) {
        const float depth = depthOf(point), eyeDepth = depthOf(eye.origin);
        if (eyeDepth >= 0)
            t = depth < 0 ? kOut : kIn;
        else
            t = depth < 1 ? kOut : kOut + (kIn - kOut) * depth / (depth - eyeDepth);
    }
    return fogDensity(glm::dot(eye.axis[0], point - eye.origin) * scale + 1.0f / 512, t);
}

} // namespace

/// Viewport pixels from the top left to clip space; depth stays.
uint32_t DrawListBuilder::screenEntity(ViewWork& work) {
    RasterEntity entity{};
    entity.clipFromModel = mat4(1.0f);
    entity.clipFromModel[0][0] = 2.0f / static_cast<float>(work.view.scene->width);
    entity.clipFromModel[1][1] = 2.0f / static_cast<float>(work.view.scene->height);
    entity.clipFromModel[3] = vec4(-1, -1, 0, 1);
    work.out.entities.push_back(entity);
    return static_cast<uint32_t>(work.out.entities.size() - 1);
}

/// A square of pixels; texture rows run upward.
void DrawListBuilder::appendScreenSquare(ViewWork& work, const vec2& from, const vec2& to, float depth,
                                         uint32_t color) {
    const auto first = static_cast<uint32_t>(work.out.vertices.size());
    constexpr vec2 kCorners[4] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    for (const vec2& st : kCorners) {
        Vertex vertex{};
        vertex.position = vec3(glm::mix(from, to, vec2(st.x, 1 - st.y)), depth);
        vertex.st = vertex.lightmapSt = st;
        vertex.color = color;
        work.out.vertices.push_back(vertex);
    }
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u})
        work.out.indices.push_back(first + corner);
}

void DrawListBuilder::findFlares(ViewWork& work) {
    work.flares.clear();
    const auto add = [&](uint32_t number, const mat4& worldFromModel) {
        const WorldSurface& surface = m_world->surfaces[number];
        if (surface.type != BspSurfaceType::Flare) return;
        ViewFlare flare{{number, m_sceneNumber, work.view.portal}, {}, surface.flareColor};
        const auto origin = vec3(worldFromModel * vec4(surface.flareOrigin, 1.0f));
        if (surface.flareNormal != vec3(0.0f)) {
            const vec3 normal = mat3(worldFromModel) * surface.flareNormal;
            const float facing = glm::dot(glm::normalize(work.view.eye.origin - origin), normal);
            if (!(facing >= 0)) return;
            flare.color *= facing;
        }
        const auto place = placeFlare(work.view, origin);
        if (!place) return;
        flare.place = *place;
        if (surface.fog > 0)
            flare.fogKeep = 1.0f - fogDensityAt(m_world->fogs[static_cast<size_t>(surface.fog)], work.view.eye, origin);
        work.flares.push_back(flare);
    };
    if (work.settings.drawWorld)
        for (const uint32_t number : work.visible.surfaces)
            add(number, mat4(1.0f));
    for (size_t i = 1; i < work.geometry.entities.size(); ++i) {
        const EntityRecord& entity = work.geometry.entities[i];
        if (entity.inlineModel < 0 || static_cast<size_t>(entity.inlineModel) >= m_world->bsp.models.size()) continue;
        const BspModel& model = m_world->bsp.models[static_cast<size_t>(entity.inlineModel)];
        for (int k = 0; k < model.surfaceCount; ++k)
            add(static_cast<uint32_t>(model.firstSurface + k), entity.worldFromModel);
    }
}

void DrawListBuilder::appendFlares(ViewWork& work, ViewDraw& draw) {
    const RasterSettings& r = work.settings.raster;
    if (r.r_flares == 0 || !m_world || !work.hasWorld()) return;
    findFlares(work);
    if (work.flares.empty()) return;
    const SceneView& scene = *work.view.scene;
    DrawBatch batch;
    batch.own = OwnDraw::Flares;
    batch.material = drawnId(work.settings.flare);
    batch.source = VertexSource::Dynamic;
    batch.entity = draw.flareEntity = screenEntity(work);
    batch.stages = m_stages.evaluate(batch.material, work.geometry.entities[0].stage);
    batch.firstIndex = static_cast<uint32_t>(work.out.indices.size());
    for (const ViewFlare& flare : work.flares) {
        const float strength = m_fades.strength(flare.key, scene.timeMs, r.r_flareFade);
        if (strength <= 0 || flare.fogKeep <= 0) continue;
        const FlareLook look = flareLook(flare.place.depthQu, scene.width, r.r_flareSize, r.r_flareCoeff);
        const vec3 color = flare.color * (strength * look.intensity * flare.fogKeep);
        const vec2 center(flare.place.x, scene.height - flare.place.y);
        appendScreenSquare(work, center - look.halfSizePixels, center + look.halfSizePixels, 0,
                           wrappedByte(color.r) | wrappedByte(color.g) << 8 | wrappedByte(color.b) << 16 | 0xFF000000u);
    }
    batch.indexCount = static_cast<uint32_t>(work.out.indices.size()) - batch.firstIndex;
    if (batch.indexCount > 0) work.out.batches.push_back(batch);
    draw.firstFlareTest = static_cast<uint32_t>(work.out.flareTests.size());
    for (const ViewFlare& flare : work.flares) {
        work.out.flareTests.push_back({flare.key, static_cast<uint32_t>(work.out.indices.size())});
        const vec2 corner(flare.place.x, scene.height - 1 - flare.place.y);
        appendScreenSquare(work, corner, corner + 1.0f, windowDepth(work.view, flare.place.depthQu - kLampQu), 0);
    }
    draw.flareTestCount = static_cast<uint32_t>(work.flares.size());
}

} // namespace q3rt
