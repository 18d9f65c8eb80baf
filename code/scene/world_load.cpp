// loadWorld: a map file to a World, in the order in which the original makes materials (their order of creation decides
// the draw order of equal sorts): lightmaps, fogs, surfaces, entities, light grid.

#include <algorithm>
#include <cstdio>

#include "base/error.hpp"
#include "base/log.hpp"
#include "scene/world_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

const vec3 kDefaultSunDirection{0.45f, 0.3f, 0.9f}; // until a sky with a sun is parsed; not yet normalised

bool startsWith(std::string_view text, std::string_view prefix) { return text.substr(0, prefix.size()) == prefix; }

bool equalsNoCase(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

void loadLightmaps(const WorldBuild& build) {
    std::vector<TextureId> pages;
    if (!build.settings.vertexLight) {
        constexpr size_t kPageBytes = 3 * kLightmapSize * kLightmapSize;
        for (size_t page = 0; page < build.world.bsp.lightmapPageCount(); ++page) {
            const uint8_t* rgb = &build.world.bsp.lightmaps[page * kPageBytes];
            pages.push_back(build.materials.textures().addLightmap(static_cast<int>(page), rgb));
        }
    }
    build.materials.setLightmaps(std::move(pages));
}

void groupByMaterial(World& world) {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < world.surfaces.size(); ++i) {
        if (world.surfaces[i].drawn) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return world.surfaces[a].material < world.surfaces[b].material; });
    for (const uint32_t i : order) {
        const MaterialId material = world.surfaces[i].material;
        if (world.materialGroups.empty() || world.materialGroups.back().material != material) {
            world.materialGroups.push_back({material, {}});
        }
        world.materialGroups.back().surfaces.push_back(i);
    }
}

void computeWorldBounds(World& world) {
    for (const WorldSurface& surface : world.surfaces) {
        if (surface.drawn && surface.bspModel == 0) world.bounds.add(surface.bounds);
    }
}

} // namespace

WorldspawnKeys readWorldspawn(const std::vector<MapEntity>& entities, bool vertexLight) {
    WorldspawnKeys keys;
    if (entities.empty()) return keys;
    for (const auto& [key, value] : entities.front().pairs) {
        const bool forVertexLight = startsWith(key, "vertexremapshader");
        if (forVertexLight || startsWith(key, "remapshader")) {
            if (forVertexLight && !vertexLight) continue;
            const size_t separator = value.find(';');
            if (separator == std::string::npos) {
                // The rest of the block is ignored, gridsize included: light grids of such maps were baked to match.
                logLine(LogLevel::Warning, "worldspawn: no semicolon in %s \"%s\"; keys after it are ignored",
                        key.c_str(), value.c_str());
                return keys;
            }
            keys.remaps.emplace_back(value.substr(0, separator), value.substr(separator + 1));
        } else if (equalsNoCase(key, "gridsize")) {
            vec3& size = keys.gridCellSize;
            std::sscanf(value.c_str(), "%f %f %f", &size.x, &size.y, &size.z);
        }
    }
    for (int i = 0; i < 3; ++i) {
        if (!(keys.gridCellSize[i] >= 1.0f)) {
            logLine(LogLevel::Warning, "worldspawn: gridsize %g is not usable; the default is taken",
                    static_cast<double>(keys.gridCellSize[i]));
            keys.gridCellSize[i] = WorldspawnKeys{}.gridCellSize[i];
        }
    }
    return keys;
}

void buildFogs(const WorldBuild& build) {
    World& world = build.world;
    const Bsp& bsp = world.bsp;
    const float identityLight = 1.0f / static_cast<float>(1 << build.materials.textures().settings().overbrightBits);
    world.fogs.resize(1);
    for (const BspFog& source : bsp.fogs) {
        FogVolume fog;
        const auto planeOf = [&](int side) -> const Plane& {
            const BspBrush& brush = bsp.brushes[static_cast<size_t>(source.brush)];
            return bsp.planes[static_cast<size_t>(bsp.brushSides[static_cast<size_t>(brush.firstSide + side)].plane)];
        };
        const bool hasBrush = source.brush >= 0 && bsp.brushes[static_cast<size_t>(source.brush)].sideCount >= 6;
        if (!hasBrush) {
            logLine(LogLevel::Warning, "%s: fog %s has no brush with six sides; it covers nothing", world.name.c_str(),
                    source.shader.c_str());
        }
        for (int axis = 0; hasBrush && axis < 3; ++axis) { // the first six sides are -X +X -Y +Y -Z +Z
            fog.bounds.mins[axis] = -planeOf(2 * axis).distance;
            fog.bounds.maxs[axis] = planeOf(2 * axis + 1).distance;
        }
        fog.material = build.materials.find(source.shader, lightmapContext::kNone);
        const FogParameters& parameters = build.materials.get(fog.material).fog;
        for (int i = 0; i < 3; ++i) {
            const float byte = std::clamp(parameters.color[i] * identityLight * 255.0f, 0.0f, 255.0f);
            fog.color[i] = std::floor(byte) / 255.0f;
        }
        fog.depthForOpaque = std::max(1.0f, parameters.depthForOpaque);
        fog.hasSurface = hasBrush && source.visibleSide >= 0 && source.visibleSide < 6;
        if (fog.hasSurface) fog.surface = planeOf(source.visibleSide);
        world.fogs.push_back(fog);
    }
}

std::unique_ptr<World> loadWorld(FileSource& files, std::string_view name, MaterialLibrary& materials,
                                 const WorldSettings& settings) {
    const std::string path(name);
    const auto file = files.read(path);
    if (!file) throw ContentError(path + ": no such map; check the name and that its pk3 is in the game folder");
    auto world = std::make_unique<World>();
    world->name = path;
    world->bsp = parseBsp(*file, path);
    const TextureSettings& display = materials.textures().settings();
    const WorldBuild build{*world, materials, settings,
                           std::max(0, display.mapOverbrightBits - display.overbrightBits)};
    materials.sunDirection = glm::normalize(kDefaultSunDirection);
    materials.sunLight = vec3(0.0f);
    loadLightmaps(build);
    buildFogs(build);
    buildSurfaces(build);
    groupByMaterial(*world);
    computeWorldBounds(*world);
    world->entities = parseEntities(world->bsp.entities);
    const WorldspawnKeys keys = readWorldspawn(world->entities, settings.vertexLight);
    for (const auto& [from, to] : keys.remaps) {
        materials.remap(from, to, "0");
    }
    world->grid = LightGrid::build(world->bsp, keys.gridCellSize, build.colorShift);
    return world;
}

} // namespace q3rt
