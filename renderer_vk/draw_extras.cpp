// What a view draws beside its surfaces: shadow volumes and their shade, the sun (spec of world 5.5, of models 5.1).

#include "renderer_vk/portal.hpp"
#include "renderer_vk/view_work.hpp"

namespace q3rt {

namespace {

constexpr float kSunPart = 0.1f;          // half size of the sun's disc over its distance
constexpr float kShadeDistanceQu = 10.0f; // of the picture-filling square that darkens shadows: nearer things stay lit
constexpr float kShadeHalfSizeQu = 100.0f;
constexpr float kShade = 0.6f;

/// Four vertices and two triangles around `center`.
void appendSquare(FrameDrawData& out, const vec3& center, const vec3& right, const vec3& up, DrawBatch& batch) {
    const auto first = static_cast<uint32_t>(out.vertices.size());
    constexpr vec2 kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const vec2& st : kCorners) {
        Vertex vertex{};
        vertex.position = center + right * (2 * st.x - 1) + up * (1 - 2 * st.y);
        vertex.st = vertex.lightmapSt = st;
        vertex.color = 0xFFFFFFFFu;
        out.vertices.push_back(vertex);
    }
    batch.source = VertexSource::Dynamic;
    batch.firstIndex = static_cast<uint32_t>(out.indices.size());
    batch.indexCount = 6;
    for (const uint32_t corner : {0u, 1u, 2u, 2u, 3u, 0u})
        out.indices.push_back(first + corner);
}

} // namespace

void DrawListBuilder::appendShadowVolumes(ViewWork& work) {
    for (size_t i = 0; i < work.geometry.surfaces.size(); ++i) {
        const EntitySurface& surface = work.geometry.surfaces[i];
        if (!surface.castsVolume || work.entityCull[surface.entity] == CullResult::Outside) continue;
        DrawBatch batch;
        batch.own = OwnDraw::ShadowVolume;
        batch.source = VertexSource::Dynamic;
        batch.firstIndex = static_cast<uint32_t>(work.out.indices.size());
        m_shadowVolumes.append(std::span(work.geometry.vertices).subspan(surface.firstVertex, surface.vertexCount),
                               std::span(work.geometry.indices).subspan(surface.firstIndex, surface.indexCount),
                               surface.firstVertex, work.geometry.entities[surface.entity].light.direction,
                               work.out.vertices, work.out.indices);
        batch.indexCount = static_cast<uint32_t>(work.out.indices.size()) - batch.firstIndex;
        if (batch.indexCount == 0) continue;
        batch.entity = entityIndex(work, surface.entity);
        work.out.batches.push_back(batch);
    }
}

void DrawListBuilder::appendShadowShade(ViewWork& work) {
    DrawBatch batch;
    batch.own = OwnDraw::ShadowShade;
    batch.entity = entityIndex(work, 0);
    batch.stages = {kOwnStageBit | static_cast<uint32_t>(work.out.ownStages.size()), 1};
    work.out.ownStages.push_back(colorStage(vec4(vec3(kShade), 1.0f)));
    const Orientation& eye = work.view.eye;
    appendSquare(work.out, eye.origin + eye.axis[0] * kShadeDistanceQu, eye.axis[1] * -kShadeHalfSizeQu,
                 eye.axis[2] * kShadeHalfSizeQu, batch);
    work.out.batches.push_back(batch);
}

void DrawListBuilder::appendSun(ViewWork& work) {
    const vec3& direction = m_materials.sunDirection;
    const float distance = work.view.farQu / kSkyPart, half = distance * kSunPart;
    const vec3 right = perpendicularTo(direction), up = glm::cross(right, direction);
    DrawBatch batch;
    batch.material = drawnId(work.settings.sun);
    batch.depthRange = DepthRange::Far;
    batch.erasesShadows = work.settings.geometry.shadows == Shadows::Volume;
    batch.entity = entityIndex(work, 0);
    batch.stages = m_stages.evaluate(batch.material, work.geometry.entities[0].stage);
    appendSquare(work.out, work.view.eye.origin + direction * distance, right * half, up * half, batch);
    work.out.batches.push_back(batch);
}

} // namespace q3rt
