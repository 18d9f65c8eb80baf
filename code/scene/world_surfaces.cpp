// Map surfaces to triangles with materials (spec of world 1.4 and 2). Traps T1, T2, T5, T6 of the content survey are
// handled here.

#include <algorithm>
#include <cmath>

#include "base/log.hpp"
#include "scene/world_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr int kLowestLightmapCode = lightmapContext::k2D;

/// The lightmap context a surface's material is looked up with.
int lightmapContextOf(const WorldBuild& build, const BspSurface& surface) {
    if (build.settings.fullbright) return lightmapContext::kWhite;
    if (build.settings.vertexLight || surface.type == BspSurfaceType::TriangleSoup ||
        surface.type == BspSurfaceType::Flare) {
        return lightmapContext::kByVertex;
    }
    const size_t pages = build.world.bsp.lightmapPageCount();
    const int usable = static_cast<int>(pages == 1 ? 2 : pages); // a lone page also answers to index 1
    if (surface.lightmap >= usable) return lightmapContext::kByVertex;
    if (surface.lightmap < kLowestLightmapCode) {
        logLineOnce(LogLevel::Warning, "%s: lightmap number %d is no known code; lit by vertex",
                    build.world.name.c_str(), surface.lightmap);
        return lightmapContext::kByVertex;
    }
    return surface.lightmap;
}

MaterialId findMaterial(const WorldBuild& build, const BspSurface& surface) {
    const std::string& name = build.world.bsp.shaders[static_cast<size_t>(surface.shader)].name;
    const MaterialId id = build.materials.find(name, lightmapContextOf(build, surface));
    const Material& material = build.materials.get(id);
    if (build.settings.singleShader && !material.isSky) return 0;
    if (!material.isDefault) return id;
    // The library has warned of the shader itself; this line says who wears it.
    logLineOnce(LogLevel::Developer, "%s: no usable script or image for %s; the default look is drawn",
                build.world.name.c_str(), name.c_str());
    return 0;
}

/// Compilers leave garbage in coordinates that nothing uses; beyond this, sums of them would overflow. NaN fails too.
constexpr float kLargestCoordinate = 1e30f;

vec2 usableOrZero(const vec2& st) {
    return std::abs(st.x) < kLargestCoordinate && std::abs(st.y) < kLargestCoordinate ? st : vec2(0.0f);
}

Vertex convertVertex(const BspDrawVertex& source, int colorShift) {
    Vertex vertex{};
    vertex.position = source.position;
    vertex.normal = source.normal;
    vertex.st = usableOrZero(source.st);
    vertex.lightmapSt = usableOrZero(source.lightmapSt);
    vertex.color = packColor(shiftBakedLight(source.color, colorShift));
    return vertex;
}

std::vector<Vertex> convertVertices(const WorldBuild& build, const BspSurface& source) {
    std::vector<Vertex> vertices;
    vertices.reserve(static_cast<size_t>(source.vertexCount));
    for (int i = 0; i < source.vertexCount; ++i) {
        const auto at = static_cast<size_t>(source.firstVertex + i);
        vertices.push_back(convertVertex(build.world.bsp.vertices[at], build.colorShift));
    }
    return vertices;
}

/// Appends to the world's arrays and notes ranges and bounds. `indices` are relative to `vertices`.
void appendGeometry(World& world, WorldSurface& surface, const std::vector<Vertex>& vertices,
                    const std::vector<uint32_t>& indices) {
    surface.firstVertex = static_cast<uint32_t>(world.vertices.size());
    surface.vertexCount = static_cast<uint32_t>(vertices.size());
    surface.firstIndex = static_cast<uint32_t>(world.indices.size());
    surface.indexCount = static_cast<uint32_t>(indices.size());
    for (const Vertex& vertex : vertices) {
        surface.bounds.add(vertex.position);
    }
    world.vertices.insert(world.vertices.end(), vertices.begin(), vertices.end());
    for (const uint32_t index : indices) {
        world.indices.push_back(surface.firstVertex + index);
    }
}

/// Planar faces and triangle soups, as the file has them. Zero-area triangles stay: builders must accept them.
void buildMesh(const WorldBuild& build, const BspSurface& source, WorldSurface& surface) {
    World& world = build.world;
    std::vector<Vertex> vertices = convertVertices(build, source);
    const auto first = world.bsp.indices.begin() + source.firstIndex;
    const std::vector<uint32_t> indices(first, first + source.indexCount - source.indexCount % 3);
    if (source.type == BspSurfaceType::Planar) {
        surface.plane.normal = source.lightmapVectors[2];
        if (!vertices.empty()) surface.plane.distance = glm::dot(surface.plane.normal, vertices[0].position);
        for (Vertex& vertex : vertices) { // the file's own are not used on flat faces
            vertex.normal = surface.plane.normal;
        }
    }
    appendGeometry(world, surface, vertices, indices);
}

void buildFlare(const BspSurface& source, WorldSurface& surface) {
    surface.flareOrigin = source.lightmapOrigin;
    surface.flareColor = source.lightmapVectors[0];
    surface.flareNormal = source.lightmapVectors[2];
    surface.bounds.add(surface.flareOrigin);
    surface.drawn = false;
}

PatchMesh buildPatch(const WorldBuild& build, const BspSurface& source) {
    PatchMesh mesh;
    mesh.grid = tessellatePatch(source.patchWidth, source.patchHeight, convertVertices(build, source),
                                build.settings.subdivisions);
    mesh.lodOrigin = (source.lightmapVectors[0] + source.lightmapVectors[1]) * 0.5f;
    mesh.lodRadius = glm::length(source.lightmapVectors[0] - mesh.lodOrigin);
    return mesh;
}

std::vector<uint32_t> gridIndices(int width, int height) {
    std::vector<uint32_t> indices;
    for (uint32_t r = 0; r + 1 < static_cast<uint32_t>(height); ++r) {
        for (uint32_t c = 0; c + 1 < static_cast<uint32_t>(width); ++c) {
            const uint32_t corner = r * static_cast<uint32_t>(width) + c, below = corner + static_cast<uint32_t>(width);
            indices.insert(indices.end(), {corner, below, corner + 1, corner + 1, below, below + 1});
        }
    }
    return indices;
}

/// Patches get their geometry last, when stitching has settled their points.
void appendPatches(World& world, std::vector<PatchMesh>& meshes, const std::vector<size_t>& owners) {
    for (size_t i = 0; i < meshes.size(); ++i) {
        TessellatedPatch& grid = meshes[i].grid;
        WorldSurface& surface = world.surfaces[owners[i]];
        surface.patch = static_cast<int>(world.patches.size());
        appendGeometry(world, surface, grid.vertices, gridIndices(grid.width, grid.height));
        world.patches.push_back({grid.width, grid.height, std::move(grid.columnError), std::move(grid.rowError),
                                 meshes[i].lodOrigin, meshes[i].lodRadius});
    }
}

void assignModels(World& world) {
    for (size_t model = 1; model < world.bsp.models.size(); ++model) {
        const BspModel& range = world.bsp.models[model];
        for (int i = 0; i < range.surfaceCount; ++i) {
            world.surfaces[static_cast<size_t>(range.firstSurface + i)].bspModel = static_cast<int>(model);
        }
    }
}

} // namespace

void buildSurfaces(const WorldBuild& build) {
    World& world = build.world;
    std::vector<PatchMesh> meshes;
    std::vector<size_t> owners; // surface of each mesh
    world.surfaces.resize(world.bsp.surfaces.size());
    for (size_t i = 0; i < world.surfaces.size(); ++i) {
        const BspSurface& source = world.bsp.surfaces[i];
        WorldSurface& surface = world.surfaces[i];
        surface.type = source.type;
        surface.bspShader = source.shader;
        surface.fog = source.fog >= 0 && source.fog < static_cast<int>(world.bsp.fogs.size()) ? source.fog + 1 : 0;
        surface.material = findMaterial(build, source);
        if (source.type == BspSurfaceType::Flare) {
            buildFlare(source, surface);
        } else if (source.type != BspSurfaceType::Patch) {
            buildMesh(build, source, surface);
        } else if (world.bsp.shaders[static_cast<size_t>(source.shader)].surfaceFlags & kBspSurfaceNodraw) {
            surface.drawn = false; // collision only: the map's triangles already hold this shape
        } else {
            meshes.push_back(buildPatch(build, source));
            owners.push_back(i);
        }
    }
    stitchPatches(meshes);
    appendPatches(world, meshes, owners);
    assignModels(world);
}

} // namespace q3rt
