#include "renderer_rt/traced_view.hpp"

#include <algorithm>
#include <tuple>

#include "renderer_rt/triangle_sort.hpp"

namespace q3rt {

namespace {

RtEntity makeEntity(const EntityRecord& record) {
    RtEntity out{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            out.worldFromModel[row][column] = record.worldFromModel[column][row];
    out.eyeInModel = record.eyeInModel;
    out.ambient = record.light.ambient;
    out.directed = record.light.directed;
    out.lightDirection = record.light.direction;
    return out;
}

void count(ViewTables& out, StructureClass structureClass, uint32_t triangleCount) {
    ClassCount& of = out.counts[static_cast<size_t>(structureClass)];
    ++of.surfaces;
    of.triangles += triangleCount;
}

StructureClass dynamicClass(const EntitySurface& surface) {
    return surface.worldSurface >= 0 ? StructureClass::DynamicWorld : StructureClass::DynamicEntity;
}

} // namespace

void ViewTables::clear() {
    instances.clear();
    surfaces.clear();
    entities.clear();
    indices.clear();
    surfaceOfTriangle.clear();
    surfacesOfParts.clear();
    parts.clear();
    sources.clear();
    skies.clear();
    portals.clear();
    hasLayers = hasNear = hasStagedCover = false;
    layerOrderCount = 0;
    counts = {};
}

Visibility visibilityOf(uint32_t flags) {
    Visibility v;
    v.near = (flags & entityFlag::kDepthHack) != 0;
    v.shadow = (flags & entityFlag::kNoShadow) == 0;
    if (flags & entityFlag::kThirdPerson) v.eye = false;
    if (flags & entityFlag::kFirstPerson) v.mirrors = v.shadow = false;
    return v;
}

uint64_t sourceKey(const EntitySurface& surface) {
    if (surface.source) return reinterpret_cast<uintptr_t>(surface.source);
    return surface.worldSurface >= 0 ? static_cast<uint64_t>(surface.worldSurface) + 1 : 0;
}

const std::vector<uint32_t>& TriangleOrderCache::find(uint64_t source, std::span<const Vertex> vertices,
                                                      std::span<const uint32_t> indices) {
    std::vector<uint32_t>& order = source ? m_orders[source] : m_scratch;
    // A text deform may change the count of triangles from frame to frame.
    if (!source || order.size() != indices.size() / 3) order = sortTriangles(vertices, indices);
    return order;
}

uint32_t ViewTableBuilder::skyIndex(const Material& material, MaterialId id, const StageInputs& inputs,
                                    ViewTables& out) {
    for (const auto& [known, index] : m_skies)
        if (known == id) return index;
    const StageRange clouds = m_stages.evaluate(m_materials.drawnId(id), inputs);
    RtSky sky{};
    for (size_t i = 0; i < material.sky.box.size(); ++i)
        sky.box[i] = material.sky.box[i];
    sky.hasBox = material.sky.hasBox ? 1 : 0;
    sky.firstStage = clouds.first;
    sky.stageCount = clouds.count;
    sky.cloudHeightQu = m_materials.lastCloudHeight;
    const auto index = static_cast<uint32_t>(out.skies.size());
    out.skies.push_back(sky);
    m_skies.emplace_back(id, index);
    return index;
}

RtSurface ViewTableBuilder::makeSurface(MaterialId id, SurfaceClass surfaceClass, int fog, const StageInputs& inputs,
                                        ViewTables& out) {
    const Material& material = m_materials.drawn(id);
    RtSurface surface{};
    surface.flags = surfaceFlags(material, surfaceClass);
    surface.fog = fog > 0 ? static_cast<uint32_t>(fog) : 0;
    if (surfaceClass == SurfaceClass::Sky) {
        surface.sky = skyIndex(material, id, inputs, out);
    } else {
        const StageRange stages = m_stages.evaluate(m_materials.drawnId(id), inputs);
        surface.firstStage = stages.first;
        surface.stageCount = stages.count;
        if (surfaceClass == SurfaceClass::Tested && (surface.flags & kSurfaceTested) != 0) {
            surface.cover = coverOf(std::span(m_stages.states()).subspan(stages.first, stages.count));
            out.hasStagedCover |= surface.cover == 0;
        }
    }
    if (surfaceClass == SurfaceClass::Layer)
        m_layers.emplace_back(m_materials.get(id).sortRank, static_cast<uint32_t>(out.surfaces.size()));
    return surface;
}

void ViewTableBuilder::addStaticParts(const World& world, const StaticGeometry& statics, const ViewGeometry& geometry,
                                      uint32_t entity, int model, ViewTables& out) {
    const EntityRecord& record = geometry.entities[entity];
    for (size_t p = 0; p < statics.parts().size(); ++p) {
        const StaticPart& part = statics.parts()[p];
        if (part.model != model) continue;
        RtInstance instance{};
        instance.vertices = statics.vertices();
        instance.indices = part.indices;
        instance.surfaceOfTriangle = part.surfaceOfTriangle;
        instance.firstSurface = static_cast<uint32_t>(out.surfaces.size());
        instance.entity = entity;
        for (const uint32_t number : part.surfaces) {
            const WorldSurface& surface = world.surfaces[number];
            out.surfaces.push_back(makeSurface(surface.material, part.surfaceClass, surface.fog, record.stage, out));
            const Material& material = m_materials.drawn(surface.material);
            out.surfaces.back().portal = m_portals.findStatic(world, surface, material, record);
            count(out,
                  entity != 0         ? StructureClass::StaticEntity
                  : material.usesTime ? StructureClass::ChangingWorld
                                      : StructureClass::StaticWorld,
                  surface.indexCount / 3);
        }
        out.instances.push_back(instance);
        out.sources.push_back({.staticPart = static_cast<int>(p),
                               .entity = entity,
                               .surfaceClass = part.surfaceClass,
                               .mask = instanceMask(part.surfaceClass, visibilityOf(record.flags))});
    }
}

void ViewTableBuilder::appendTriangles(const ViewGeometry& geometry, DynamicPart& part, ViewTables& out) {
    uint32_t low = ~0u, high = 0;
    const std::span<const uint32_t> surfaces = out.surfacesOf(part);
    for (const uint32_t s : surfaces) {
        const EntitySurface& surface = geometry.surfaces[s];
        low = std::min(low, surface.firstVertex);
        high = std::max(high, surface.firstVertex + surface.vertexCount);
    }
    part.firstVertex = low;
    part.vertexCount = high - low;
    part.firstIndex = static_cast<uint32_t>(out.indices.size());
    for (size_t i = 0; i < surfaces.size(); ++i) {
        const EntitySurface& surface = geometry.surfaces[surfaces[i]];
        const std::span<const uint32_t> indices(geometry.indices.data() + surface.firstIndex, surface.indexCount);
        for (const uint32_t triangle : m_orders.find(sourceKey(surface), geometry.vertices, indices)) {
            for (size_t corner = 0; corner < 3; ++corner)
                out.indices.push_back(indices[3 * triangle + corner] - low);
            out.surfaceOfTriangle.push_back(static_cast<uint32_t>(i));
        }
    }
    part.triangleCount = (static_cast<uint32_t>(out.indices.size()) - part.firstIndex) / 3;
}

void ViewTableBuilder::addModelPart(const ViewGeometry& geometry, const EntitySurface& surface,
                                    SurfaceClass surfaceClass, ModelGeometry& models, ViewTables& out) {
    const EntityRecord& record = geometry.entities[surface.entity];
    const uint8_t mask = instanceMask(surfaceClass, visibilityOf(record.flags));
    if (mask == 0) return;
    const ModelPart& part = models.find(surface.source, surfaceClass, geometry.vertices,
                                        std::span(geometry.indices).subspan(surface.firstIndex, surface.indexCount));
    RtInstance instance{};
    instance.vertices = part.geometry.vertices;
    instance.indices = part.geometry.indices;
    instance.surfaceOfTriangle = part.surfaceOfTriangle;
    instance.firstSurface = static_cast<uint32_t>(out.surfaces.size());
    instance.entity = surface.entity;
    out.surfaces.push_back(makeSurface(surface.material, surfaceClass, surface.fog, record.stage, out));
    out.instances.push_back(instance);
    out.sources.push_back({.modelPart = &part, .entity = surface.entity, .surfaceClass = surfaceClass, .mask = mask});
    count(out, StructureClass::StaticEntity, part.geometry.triangleCount);
}

void ViewTableBuilder::sortMovingSurfaces(const ViewGeometry& geometry, ModelGeometry& models, ViewTables& out) {
    m_moving.clear();
    for (uint32_t s = 0; s < geometry.surfaces.size(); ++s) {
        const EntitySurface& surface = geometry.surfaces[s];
        const Material& material = m_materials.drawn(surface.material);
        const auto surfaceClass = classifySurface(material);
        if (!surfaceClass || surface.indexCount < 3) continue;
        if (surface.source && surface.singleFrame && !surface.deformed)
            addModelPart(geometry, surface, *surfaceClass, models, out);
        else // A sprite turns with the eye: light must not depend on who looks.
            m_moving.push_back({{surface.entity, *surfaceClass, surface.isPoly, !deformsWithView(material)}, s});
    }
    std::ranges::sort(m_moving);
}

void ViewTableBuilder::addDynamicPart(const World* world, const ViewGeometry& geometry,
                                      std::span<const MovingSurface> moving, ViewTables& out) {
    DynamicPart part;
    std::tie(part.entity, part.surfaceClass, part.isPoly, part.castsShadow) = moving.front().group;
    const EntityRecord& record = geometry.entities[part.entity];
    Visibility visibility = visibilityOf(record.flags);
    visibility.shadow &= part.castsShadow;
    const uint8_t mask = instanceMask(part.surfaceClass, visibility);
    if (mask == 0) return;
    part.firstSurface = static_cast<uint32_t>(out.surfacesOfParts.size());
    part.surfaceCount = static_cast<uint32_t>(moving.size());
    RtInstance instance{};
    instance.firstSurface = static_cast<uint32_t>(out.surfaces.size());
    instance.entity = part.entity;
    for (const MovingSurface& one : moving) {
        const EntitySurface& surface = geometry.surfaces[one.surface];
        out.surfacesOfParts.push_back(one.surface);
        out.surfaces.push_back(makeSurface(surface.material, part.surfaceClass, surface.fog, record.stage, out));
        out.surfaces.back().portal =
            m_portals.findMoving(world, geometry, surface, m_materials.drawn(surface.material));
        count(out, dynamicClass(surface), surface.indexCount / 3);
    }
    appendTriangles(geometry, part, out);
    part.structureClass = dynamicClass(geometry.surfaces[moving.front().surface]);
    instance.vertices = part.firstVertex * sizeof(Vertex);
    instance.indices = part.firstIndex * sizeof(uint32_t);
    instance.surfaceOfTriangle = part.firstIndex / 3 * sizeof(uint32_t);
    out.instances.push_back(instance);
    out.sources.push_back({.dynamicPart = static_cast<int>(out.parts.size()),
                           .entity = part.entity,
                           .surfaceClass = part.surfaceClass,
                           .mask = mask});
    out.parts.push_back(part);
}

void ViewTableBuilder::addDynamicParts(const World* world, const ViewGeometry& geometry, ModelGeometry& models,
                                       ViewTables& out) {
    sortMovingSurfaces(geometry, models, out);
    for (auto first = m_moving.begin(); first != m_moving.end();) {
        const auto end = std::find_if(first, m_moving.end(),
                                      [&](const MovingSurface& other) { return other.group != first->group; });
        addDynamicPart(world, geometry, {first, end}, out);
        first = end;
    }
}

void ViewTableBuilder::orderLayers(ViewTables& out) {
    std::sort(m_layers.begin(), m_layers.end());
    uint32_t order = 0, lastRank = ~0u;
    for (const auto& [rank, surface] : m_layers) {
        if (rank != lastRank) ++order;
        lastRank = rank;
        out.surfaces[surface].drawOrder = order;
    }
    out.layerOrderCount = order;
    out.hasLayers = !m_layers.empty();
    for (const ViewTables::Source& source : out.sources)
        out.hasNear |= (source.mask & (kMaskNearSolid | kMaskNearLayer)) != 0;
}

void ViewTableBuilder::build(const World* world, const StaticGeometry* statics, const ViewGeometry& geometry,
                             const PortalScene& portals, ModelGeometry& models, ViewTables& out) {
    out.clear();
    m_portals.begin(portals);
    m_layers.clear();
    m_skies.clear();
    for (const EntityRecord& record : geometry.entities)
        out.entities.push_back(makeEntity(record));
    if (world && statics) {
        for (uint32_t e = 0; e < geometry.entities.size(); ++e) {
            const int model = e == 0 ? 0 : geometry.entities[e].inlineModel;
            if (model >= 0) addStaticParts(*world, *statics, geometry, e, model, out);
        }
    }
    addDynamicParts(world, geometry, models, out);
    out.portals = m_portals.table();
    orderLayers(out);
}

} // namespace q3rt
