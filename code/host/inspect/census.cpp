#include "host/inspect/census.hpp"

#include <algorithm>
#include <set>

#include "host/still/still_scene.hpp"

namespace q3rt {

namespace {

using Requirements = std::map<std::string, size_t>;

bool usesUnit(const Material& material, const auto& predicate) {
    return std::any_of(material.stages.begin(), material.stages.end(), [&](const Stage& stage) {
        return predicate(stage.unit[0]) || (stage.combine != Combine::Single && predicate(stage.unit[1]));
    });
}

bool usesStage(const Material& material, const auto& predicate) {
    return std::any_of(material.stages.begin(), material.stages.end(), predicate);
}

/// Adds one face's needs, by the compiled material: never by its name.
void addMaterialRequirements(const Material& material, Requirements& requirements) {
    const auto need = [&](const char* what, bool needed) {
        if (needed) ++requirements[what];
    };
    need("sky", material.isSky);
    need("portal or mirror", material.isPortal);
    need("water", (material.contentFlags & surfaceParm::kContentsWater) != 0);
    need("slime", (material.contentFlags & surfaceParm::kContentsSlime) != 0);
    need("lava", (material.contentFlags & surfaceParm::kContentsLava) != 0);
    need("deformed geometry", !material.deforms.empty());
    need("polygon offset", material.polygonOffset);
    need("two-sided", material.cull == CullMode::None);
    need("alpha test", usesStage(material, [](const Stage& s) { return s.alphaTest != AlphaTest::None; }));
    need("blending", !material.stages.empty() && material.stages.front().blended && !material.isSky);
    need("environment mapping",
         usesUnit(material, [](const TextureUnit& u) { return u.texCoordGen == TexCoordGen::Environment; }));
    need("moving texture coordinates", usesUnit(material, [](const TextureUnit& u) {
             return std::any_of(u.mods.begin(), u.mods.end(), [](const TexMod& mod) {
                 return mod.kind != TexModKind::Scale && mod.kind != TexModKind::None &&
                        mod.kind != TexModKind::Transform;
             });
         }));
    need("animated textures", usesUnit(material, [](const TextureUnit& u) { return u.frames.size() > 1; }));
    need("video", usesUnit(material, [](const TextureUnit& u) { return !u.videoName.empty(); }));
    need("colour waves",
         usesStage(material, [](const Stage& s) { return s.rgbGen == RgbGen::Wave || s.alphaGen == AlphaGen::Wave; }));
    need("specular highlights",
         usesStage(material, [](const Stage& s) { return s.alphaGen == AlphaGen::LightingSpecular; }));
}

size_t countZeroAreaTriangles(const World& world, const WorldSurface& surface) {
    size_t count = 0;
    for (uint32_t i = surface.firstIndex; i + 2 < surface.firstIndex + surface.indexCount; i += 3) {
        const auto corner = [&](uint32_t k) { return dvec3(vec3(world.vertices[world.indices[i + k]].position)); };
        const dvec3 a = corner(0);
        count += glm::cross(corner(1) - a, corner(2) - a) == dvec3(0.0);
    }
    return count;
}

void addSurface(const World& world, const WorldSurface& surface, const MaterialLibrary& materials,
                std::set<MaterialId>& used, MapCensus& census) {
    switch (surface.type) {
    case BspSurfaceType::Planar:
        ++census.planarFaces;
        break;
    case BspSurfaceType::Patch:
        ++census.patches;
        break;
    case BspSurfaceType::TriangleSoup:
        ++census.triangleSoups;
        break;
    case BspSurfaceType::Flare:
        ++census.flares;
        break;
    }
    if (!surface.drawn) {
        census.hiddenPatches += surface.type == BspSurfaceType::Patch;
        return;
    }
    ++census.drawnFaces;
    census.drawnTriangles += surface.indexCount / 3;
    census.zeroAreaTriangles += countZeroAreaTriangles(world, surface);
    used.insert(surface.material);
    if (surface.fog > 0) ++census.requirements["fog"];
    addMaterialRequirements(materials.drawn(surface.material), census.requirements);
}

void addLights(const World& world, const MaterialLibrary& materials, MapCensus& census) {
    const LightSet lights = extractLights(world, materials);
    census.emissiveFaces = lights.emissiveSurfaces;
    census.triangleLights = lights.triangles.size();
    census.suns = lights.suns.size();
    census.skyLights = lights.skies.size();
    census.pointLights = lights.points.size();
    const LightRows table = buildLightRows(world, materials, describeRowLights(lights.triangles, lights.points));
    const auto clusters = static_cast<size_t>(world.bsp.clusterCount);
    for (size_t cluster = 0; cluster < clusters; ++cluster)
        census.meanVisibleLights += static_cast<double>(table.ofCluster(cluster).count) / static_cast<double>(clusters);
}

} // namespace

MapCensus takeCensus(const World& world, const MaterialLibrary& materials) {
    MapCensus census;
    census.map = world.name;
    std::set<MaterialId> used;
    for (const WorldSurface& surface : world.surfaces)
        addSurface(world, surface, materials, used, census);
    census.materials = used.size();
    census.missingMaterials = static_cast<size_t>(
        std::count_if(used.begin(), used.end(), [&](MaterialId id) { return id == 0 || materials.get(id).isDefault; }));
    census.vertices = world.vertices.size();
    census.brushModels = world.bsp.models.empty() ? 0 : world.bsp.models.size() - 1;
    census.clusters = static_cast<size_t>(world.bsp.clusterCount);
    census.lightmapPages = world.bsp.lightmapPageCount();
    census.fogVolumes = world.fogs.empty() ? 0 : world.fogs.size() - 1;
    census.entities = world.entities.size();
    census.spawnPoints = findSpawnPoints(world.entities).size();
    census.lightGrid = !world.grid.empty();
    if (!world.bounds.empty()) census.sizeQu = world.bounds.maxs - world.bounds.mins;
    for (const MapEntity& entity : world.entities) {
        if (entity.className() == "misc_portal_surface") ++census.requirements["portal entities"];
        if (entity.className().starts_with("func_") && entity.className() != "func_group")
            ++census.requirements["moving models"];
    }
    addLights(world, materials, census);
    return census;
}

} // namespace q3rt
