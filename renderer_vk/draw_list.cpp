#include "renderer_vk/draw_list.hpp"

#include <algorithm>

#include "renderer_vk/view_work.hpp"
#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

// A planar face is culled only when the eye is farther than this behind it.
constexpr float kPlaneSlackQu = 8.0f;
constexpr float kPortalSort = 1.0f;

Plane planeOfTriangle(const vec3& a, const vec3& b, const vec3& c) {
    const vec3 cross = glm::cross(c - a, b - a);
    const float length = glm::length(cross);
    if (length <= 0) return {vec3(1, 0, 0), 0};
    const vec3 normal = cross / length;
    return {normal, glm::dot(normal, a)};
}

} // namespace

uint64_t makeSortKey(uint32_t rank, int sceneIndex, int fog, bool lit) {
    constexpr uint64_t kWorld = (1u << 22) - 1; // after every entity of the scene
    const uint64_t entity = sceneIndex < 0 ? kWorld : std::min<uint64_t>(static_cast<uint64_t>(sceneIndex), kWorld - 1);
    return uint64_t{rank} << 40 | entity << 18 | static_cast<uint64_t>(fog & 0x1FFFF) << 1 | (lit ? 1u : 0u);
}

DrawListBuilder::DrawListBuilder(const MaterialLibrary& materials, const ModelLibrary& models, StageTable& stages,
                                 const World* world)
    : m_materials(materials)
    , m_models(models)
    , m_stages(stages)
    , m_world(world) {
    m_surfaceLights.reserve(busyFrame::kLights);
    m_batchLights.reserve(busyFrame::kSurfaces);
    for (int depth = 0; depth < 2; ++depth) // the view, and a portal's in it
        memoryOf(depth);
    if (!world) return;
    m_visibility = std::make_unique<WorldVisibility>(*world);
    m_lights = std::make_unique<SurfaceLights>(world->surfaces.size(), world->bsp.leafs.size());
    m_handled.resize(world->surfaces.size());
}

DrawListBuilder::~DrawListBuilder() = default;

void DrawListBuilder::beginFrame(uint64_t frame) {
    m_sceneNumber = 0;
    m_counts = {};
    m_fades.beginFrame(frame);
}

DrawListBuilder::ViewMemory& DrawListBuilder::memoryOf(int portalDepth) {
    const auto index = static_cast<size_t>(portalDepth);
    while (m_memory.size() <= index) {
        m_memory.push_back(std::make_unique<ViewMemory>());
        m_memory.back()->reserve(m_world ? m_world->surfaces.size() : 0);
    }
    return *m_memory[index];
}

MaterialId DrawListBuilder::drawnId(MaterialId id) const {
    const MaterialId other = m_materials.get(id).remappedTo;
    return other ? other : id;
}

void DrawListBuilder::addScene(const FrameCommands& frame, const SceneView& scene, const DrawListSettings& settings,
                               FrameDrawData& out) {
    ++m_sceneNumber;
    RasterView view = makeMainView(scene, settings.raster.r_znear);
    separateEye(view, settings.raster.r_zproj, settings.raster.r_stereoSeparation);
    ViewWork work(frame, settings, view, memoryOf(0), out);
    buildView(work);
}

void DrawListBuilder::buildView(ViewWork& work) {
    const bool world = m_world && work.hasWorld();
    if (world) {
        const RasterSettings& r = work.settings.raster;
        m_visibility->findVisible(work.view, {r.r_novis != 0, r.r_lockpvs != 0, r.r_nocull != 0}, work.visible);
    }
    const bool bounded = world && !work.visible.bounds.empty();
    work.view.farQu = bounded ? farthestCornerQu(work.view.eye.origin, work.visible.bounds) : kNoWorldFarQu;
    updateProjection(work.view);

    ViewGeometrySettings geometry = work.settings.geometry;
    geometry.isPortalView = work.view.portal;
    geometry.mirrored = work.view.mirrored;
    geometry.deformWorld = world && work.settings.drawWorld;
    if (work.settings.raster.r_nocull == 0) geometry.cullPlanes = work.view.frustum;
    if (work.settings.cullTriangles && work.settings.raster.r_ext_multisample <= 0)
        geometry.picture = {work.view.clipFromWorld, work.view.clipFromWorldNear,
                            vec2(work.view.scene->width, work.view.scene->height)};
    if (world) geometry.visibleSurfaces = m_visibility->visibleSurfaces();
    buildViewGeometry(work.frame, *work.view.scene, work.view.eye, m_world, m_models, m_materials, geometry,
                      work.geometry);
    work.vertexBase = static_cast<uint32_t>(work.out.vertices.size());
    // Shadow volumes are made of the view's vertices while theirs are added.
    if (work.out.vertices.empty() && geometry.shadows != Shadows::Volume)
        work.out.vertices.swap(work.geometry.vertices); // both keep the memory of a busy frame
    else
        work.out.vertices.insert(work.out.vertices.end(), work.geometry.vertices.begin(), work.geometry.vertices.end());
    work.entityIndices.assign(work.geometry.entities.size(), -1);
    work.fogIndices.assign(m_world ? m_world->fogs.size() : 1, -1);

    findDeformed(work);

    ++m_stamp;
    if (world && work.settings.drawWorld) addWorld(work);
    addEntities(work);
    std::ranges::sort(work.items, {}, [](const Item& item) { return std::pair(item.key, item.order); });

    const bool portalShown = work.view.portalDepth < work.settings.raster.r_portalDepth && addPortalView(work);
    if (portalShown && !work.view.portal && work.settings.raster.r_portalOnly != 0) return;
    makeBatches(work);
}

bool DrawListBuilder::surfaceCulled(const ViewWork& work, const WorldSurface& surface, const EntityRecord& entity,
                                    bool isWorld) const {
    const RasterSettings& r = work.settings.raster;
    if (!surface.drawn) return true;
    const CullMode cull = m_materials.get(surface.material).cull;
    switch (surface.type) {
    case BspSurfaceType::Planar: {
        if (cull == CullMode::None || r.r_facePlaneCull == 0 || r.r_nocull != 0) return false;
        const vec3& eye = isWorld ? work.view.eye.origin : entity.eyeInModel;
        const float distance = glm::dot(surface.plane.normal, eye) - surface.plane.distance;
        return cull == CullMode::Front ? distance < -kPlaneSlackQu : distance > kPlaneSlackQu;
    }
    case BspSurfaceType::Patch:
        if (r.r_nocurves != 0) return true;
        [[fallthrough]];
    case BspSurfaceType::TriangleSoup:
        return r.r_nocull == 0 && cullBox(work.view, surface.bounds, entity.worldFromModel) == CullResult::Outside;
    case BspSurfaceType::Flare:
        break;
    }
    return true;
}

void DrawListBuilder::findDeformed(ViewWork& work) {
    work.deformedSurface.assign(m_world ? m_world->surfaces.size() : 0, -1);
    for (size_t i = 0; i < work.geometry.surfaces.size(); ++i) {
        const int surface = work.geometry.surfaces[i].worldSurface;
        if (surface >= 0) work.deformedSurface[static_cast<size_t>(surface)] = static_cast<int>(i);
    }
}

bool DrawListBuilder::touchWorldLights(const ViewWork& work, size_t place) {
    const auto reaching = m_lights->reaching(place);
    if (reaching.empty()) return false;
    const uint32_t surface = work.visible.surfaces[place];
    m_surfaceLights.clear();
    for (const auto& [unused, light] : reaching)
        if (lightTouchesSurface(m_world->surfaces[surface], work.lights()[light])) m_surfaceLights.push_back(light);
    m_lights->setTouching(surface, m_surfaceLights);
    return !m_surfaceLights.empty();
}

void DrawListBuilder::addWorld(ViewWork& work) {
    const auto lights = work.settings.dynamicLights ? work.lights() : std::span<const SceneLight>();
    m_lights->findReached(*m_world, work.visible, lights);
    for (size_t i = 0; i < work.visible.surfaces.size(); ++i)
        addWorldSurface(work, work.visible.surfaces[i], 0, [&] { return touchWorldLights(work, i); });
}

template <typename Touch>
void DrawListBuilder::addWorldSurface(ViewWork& work, uint32_t index, uint32_t entity, const Touch& touch) {
    // Once a view, whoever asks first: a second entity with the same brush model shows nothing.
    if (m_handled[index] == m_stamp) return;
    m_handled[index] = m_stamp;
    const WorldSurface& surface = m_world->surfaces[index];
    const EntityRecord& record = work.geometry.entities[entity];
    if (surfaceCulled(work, surface, record, entity == 0)) return;
    const bool lit = touch();
    const uint64_t key = makeSortKey(m_materials.get(surface.material).sortRank, record.sceneIndex, surface.fog, lit);
    const int deformed = work.deformedSurface[index];
    work.items.push_back({key, deformed >= 0 ? static_cast<uint32_t>(deformed) : index, entity, surface.material,
                          surface.fog, deformed < 0, lit, static_cast<uint32_t>(work.items.size())});
}

void DrawListBuilder::addBrushModel(ViewWork& work, uint32_t index) {
    const EntityRecord& entity = work.geometry.entities[index];
    const auto number = static_cast<size_t>(entity.inlineModel);
    if (!m_world || number >= m_world->bsp.models.size()) return;
    const BspModel& model = m_world->bsp.models[number];
    if (work.settings.raster.r_nocull == 0 &&
        cullBox(work.view, Bounds{model.mins, model.maxs}, entity.worldFromModel) == CullResult::Outside)
        return;
    const auto lights = work.lights();
    const bool lit = work.settings.dynamicLights && brushModelLit(model, entity, lights);
    for (int i = 0; i < model.surfaceCount; ++i) {
        const auto surface = static_cast<uint32_t>(model.firstSurface + i);
        addWorldSurface(work, surface, index, [&] {
            m_surfaceLights.clear();
            if (lit && lightTouchesSurface(m_world->surfaces[surface], lights.front())) m_surfaceLights.push_back(0);
            m_lights->setTouching(surface, m_surfaceLights);
            return !m_surfaceLights.empty();
        });
    }
}

void DrawListBuilder::addEntities(ViewWork& work) {
    const auto& entities = work.geometry.entities;
    work.entityCull.assign(entities.size(), CullResult::Inside);
    for (size_t i = 1; i < entities.size(); ++i) {
        if (work.settings.raster.r_nocull == 0 && !entities[i].worldBounds.empty())
            work.entityCull[i] = cullBox(work.view, entities[i].worldBounds);
    }
    const auto add = [&](size_t i) {
        const EntitySurface& surface = work.geometry.surfaces[i];
        const int sceneIndex = surface.isPoly ? -1 : entities[surface.entity].sceneIndex;
        const Material& material = m_materials.get(surface.material);
        work.items.push_back({makeSortKey(material.sortRank, sceneIndex, surface.fog, false), static_cast<uint32_t>(i),
                              surface.entity, surface.material, surface.fog, false, false,
                              static_cast<uint32_t>(work.items.size())});
    };
    for (size_t i = 0; i < work.geometry.surfaces.size(); ++i)
        if (work.geometry.surfaces[i].isPoly) add(i);
    for (uint32_t i = 1; i < entities.size(); ++i)
        if (entities[i].inlineModel >= 0) addBrushModel(work, i);
    for (size_t i = 0; i < work.geometry.surfaces.size(); ++i) {
        const EntitySurface& surface = work.geometry.surfaces[i];
        if (!surface.isPoly && surface.worldSurface < 0 && work.entityCull[surface.entity] != CullResult::Outside)
            add(i);
    }
}

bool DrawListBuilder::addPortalView(ViewWork& work) {
    if (work.settings.raster.r_noportals != 0 || work.settings.fastSky || !work.hasWorld()) return false;
    for (const Item& item : work.items) {
        if (m_materials.get(item.material).sort > kPortalSort) break;
        // A deformed face keeps the plane that it has in the map.
        const int worldSurface =
            item.fromWorld ? static_cast<int>(item.surface) : work.geometry.surfaces[item.surface].worldSurface;
        const WorldSurface* face = worldSurface >= 0 ? &m_world->surfaces[static_cast<size_t>(worldSurface)] : nullptr;
        const bool planar = face && face->type == BspSurfaceType::Planar;
        const std::span<const Vertex> vertices =
            item.fromWorld ? std::span(m_world->vertices) : std::span(work.out.vertices).subspan(work.vertexBase);
        const std::vector<uint32_t>& all = item.fromWorld ? m_world->indices : work.geometry.indices;
        const uint32_t first = item.fromWorld ? m_world->surfaces[item.surface].firstIndex
                                              : work.geometry.surfaces[item.surface].firstIndex;
        const uint32_t count = item.fromWorld ? m_world->surfaces[item.surface].indexCount
                                              : work.geometry.surfaces[item.surface].indexCount;
        if (count < 3) continue;
        auto& [positions, normals, indices] = m_portalCorners;
        positions.clear();
        normals.clear();
        indices.clear();
        Plane plane = planar ? face->plane
                             : planeOfTriangle(vertices[all[first]].position, vertices[all[first + 1]].position,
                                               vertices[all[first + 2]].position);
        for (uint32_t i = 0; i < count; ++i) {
            const Vertex& vertex = vertices[all[first + i]];
            indices.push_back(i);
            positions.push_back(vertex.position);
            normals.push_back(planar ? plane.normal : vertex.normal);
        }
        Plane match = plane;
        if (item.entity != 0) {
            const mat4& transform = work.geometry.entities[item.entity].worldFromModel;
            const vec3 origin(transform[3]);
            match.distance += glm::dot(plane.normal, origin);
            const vec3 rotated = mat3(transform) * plane.normal;
            plane = {rotated, plane.distance + glm::dot(rotated, origin)};
        }
        const auto mirror = portalIsMirror(match, work.entities());
        const float range = m_materials.get(drawnId(item.material)).portalRange;
        if (!mirror || !portalVisible(work.view, {positions, normals, indices, plane}, range, *mirror)) continue;
        const auto view = makePortalView(work.view, plane, match, work.entities());
        ViewWork portal(work.frame, work.settings, *view, memoryOf(view->portalDepth), work.out);
        buildView(portal);
        return true;
    }
    return false;
}

} // namespace q3rt
