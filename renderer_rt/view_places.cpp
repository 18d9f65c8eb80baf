#include "renderer_rt/view_places.hpp"

namespace q3rt {

namespace {

/// FNV-1a (Fowler, Noll, Vo) over 64-bit words.
class KeyHash {
  public:
    KeyHash& add(uint64_t word) {
        m_value = (m_value ^ word) * 1099511628211u;
        return *this;
    }
    uint64_t value() const { return m_value; }

  private:
    uint64_t m_value = 14695981039346656037u;
};

/// Equal keys: corner i of one shape is corner i of the other.
uint64_t keyOfShape(const ViewTables& tables, const DynamicPart& part, const ViewGeometry& geometry) {
    KeyHash hash;
    hash.add(static_cast<uint64_t>(part.surfaceClass));
    for (const uint32_t s : tables.surfacesOf(part)) {
        const EntitySurface& surface = geometry.surfaces[s];
        hash.add(sourceKey(surface)).add(surface.firstVertex - part.firstVertex);
        hash.add(surface.vertexCount).add(surface.indexCount);
    }
    return hash.value();
}

} // namespace

std::vector<EntityPlace> findEntities(const FrameCommands& frame, const SceneView& scene,
                                      const ViewGeometry& geometry) {
    std::vector<EntityPlace> places;
    for (const EntityRecord& record : geometry.entities) {
        EntityPlace& place = places.emplace_back();
        place.worldFromModel = record.worldFromModel;
        place.inlineModel = record.inlineModel;
        place.flags = record.flags;
        place.moves = record.sceneIndex >= 0;
        if (!place.moves) continue;
        const SceneEntity& entity = frame.entities[scene.firstEntity + static_cast<uint32_t>(record.sceneIndex)];
        place.kind = entity.kind;
        place.model = entity.model;
        place.skin = entity.customSkin;
        place.skinNumber = entity.skinNumber;
        place.shader = entity.customShader;
        place.startSeconds = entity.kind != EntityKind::Model ? entity.shaderTimeSeconds : 0.0f;
        place.anchor = entity.orientation.origin;
    }
    return places;
}

std::vector<InstancePlace> findInstances(const ViewTables& tables, const ViewGeometry& geometry,
                                         std::vector<vec3>& corners) {
    std::vector<InstancePlace> places;
    corners.clear();
    for (const ViewTables::Source& source : tables.sources) {
        InstancePlace& place = places.emplace_back();
        place.entity = source.entity;
        KeyHash hash;
        if (source.modelPart) {
            place.key = hash.add(reinterpret_cast<uintptr_t>(source.modelPart)).value();
            continue;
        }
        if (source.staticPart >= 0) {
            place.key = hash.add(static_cast<uint64_t>(source.staticPart)).add(1).value();
            continue;
        }
        const DynamicPart& part = tables.parts[static_cast<size_t>(source.dynamicPart)];
        if (part.isPoly) {
            // Marks come and go; those that are there stay where they are.
            place.key = hash.add(static_cast<uint64_t>(part.surfaceClass)).add(2).value();
            continue;
        }
        place.key = keyOfShape(tables, part, geometry);
        place.changesShape = true;
        place.firstCorner = static_cast<uint32_t>(corners.size());
        for (uint32_t i = 0; i < part.vertexCount; ++i)
            corners.push_back(geometry.vertices[part.firstVertex + i].position);
        for (const uint32_t s : tables.surfacesOf(part))
            place.keepsOrder &= sourceKey(geometry.surfaces[s]) != 0;
    }
    return places;
}

} // namespace q3rt
