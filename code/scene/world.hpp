#pragma once
// A loaded map: geometry with materials, fogs, light grid, visibility. Everything that T1 to T9 of the content survey
// warns of is handled at load: SURF_NODRAW patches give no geometry, bounds come from vertices, NaN lightmap
// coordinates are 0, zero-area triangles stay (and must be accepted by every builder).

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "scene/material.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

struct WorldSettings {
    float subdivisions = 4; ///< r_subdivisions
    bool vertexLight = false, fullbright = false;
    bool singleShader = false; ///< the default material everywhere but for skies
};

/// Level-of-detail data of a tessellated patch (row-major grid of width x height vertices from firstVertex).
struct PatchGrid {
    int width = 0, height = 0;
    std::vector<float> columnError, rowError; ///< 1 / deviation; a column is kept while error <= allowed
    vec3 lodOrigin{0};
    float lodRadius = 0;
};

struct WorldSurface {
    BspSurfaceType type = BspSurfaceType::Planar;
    MaterialId material = 0;
    int fog = 0;       ///< 0 none, else index in World::fogs
    bool drawn = true; ///< false: flare, or SURF_NODRAW patch
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t firstIndex = 0, indexCount = 0; ///< in World::indices, absolute vertex numbers; patches at full resolution
    Plane plane;                             ///< planar faces
    Bounds bounds;
    int patch = -1; ///< index in World::patches
    vec3 flareOrigin{0}, flareColor{0}, flareNormal{0};
    int bspShader = 0;
    int bspModel = 0; ///< the submodel that owns it; 0 the world
};

struct FogVolume {
    Bounds bounds;
    MaterialId material = 0;
    vec3 color{0};            ///< [0, 1]
    float depthForOpaque = 1; ///< qu, at least 1
    bool hasSurface = false;
    Plane surface; ///< depth below it at p: distance - dot(normal, p)
};

/// Result of the light grid at a point. Colours 0..255.
struct GridLight {
    vec3 ambient{0}, directed{0};
    vec3 direction{0}; ///< toward the light, unit or zero
};

class LightGrid {
  public:
    /// Empty if the lump's size does not fit the map (warned).
    static LightGrid build(const Bsp& bsp, const vec3& cellSize, int shift);
    bool empty() const { return m_cells.empty(); }
    /// Trilinear sample (spec of world 7.1), before r_ambientScale and r_directedScale.
    GridLight sample(const vec3& point) const;
    vec3 origin{0}, cellSize{64, 64, 128};
    ivec3 counts{0};

  private:
    struct Cell {
        U8vec4 ambient, directed;
        vec3 direction;
    };
    std::vector<Cell> m_cells;
};

struct World {
    std::string name; ///< "maps/x.bsp" as asked for
    Bsp bsp;
    std::vector<MapEntity> entities;
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<WorldSurface> surfaces; ///< same numbering as bsp.surfaces
    std::vector<PatchGrid> patches;
    std::vector<FogVolume> fogs; ///< [0] unused: fog numbers start at 1
    LightGrid grid;
    Bounds bounds; ///< of all drawn vertices (the models lump is too small on oa_dm3)
    int entityTokenOffset = 0;
    /// Drawn surfaces that share a material, surface numbers ascending: a look at each material finds all its surfaces.
    struct MaterialGroup {
        MaterialId material = 0;
        std::vector<uint32_t> surfaces;
    };
    std::vector<MaterialGroup> materialGroups; ///< by ascending material

    int leafOf(const vec3& point) const;
    int clusterOf(const vec3& point) const { return bsp.leafs[static_cast<size_t>(leafOf(point))].cluster; }
    /// The engine's R_inPVS, with its answers for points in solid. Not symmetric; ignores areas.
    bool inPvs(const vec3& from, const vec3& to) const;
    /// First fog whose box overlaps the box strictly; 0 none.
    int fogOf(const Bounds& box) const;
};

/// Loads "maps/x.bsp". Throws ContentError (missing, damaged). Registers materials, lightmaps and the sun.
std::unique_ptr<World> loadWorld(FileSource& files, std::string_view name, MaterialLibrary& materials,
                                 const WorldSettings& settings);

/// Tessellates one control grid (spec of world 2.6, 2.7); pure.
struct TessellatedPatch {
    int width = 0, height = 0;
    std::vector<Vertex> vertices;
    std::vector<float> columnError, rowError;
};
TessellatedPatch tessellatePatch(int width, int height, const std::vector<Vertex>& control, float subdivisions);

// --- marks (spec of world 8.2) ---
struct MarkFragment {
    int firstPoint = 0, pointCount = 0;
};
class MarkClipper {
  public:
    MarkClipper();
    /// Clips a convex polygon, swept along `projection`, against the world. Appends points and fragments up to the
    /// limits; their number.
    int clip(const World& world, const MaterialLibrary& materials, const std::vector<vec3>& polygon,
             const vec3& projection, size_t maxPoints, std::vector<vec3>& points, size_t maxFragments,
             std::vector<MarkFragment>& fragments, bool onTriangleSoups);

  private:
    struct Volume;
    struct Output;
    Volume makeVolume(const std::vector<vec3>& polygon, const vec3& projection);
    void findSurfaces(const World& world, const MaterialLibrary& materials, const Volume& volume);
    void clipTriangle(const Volume& volume, const vec3* corners, Output& out);
    void clipSurface(const World& world, const Volume& volume, const WorldSurface& surface, Output& out);

    // Work space, kept from mark to mark.
    std::vector<Plane> m_planes;
    std::vector<int> m_surfaces, m_openNodes;
    std::vector<vec3> m_polygon, m_scratch;
};

} // namespace q3rt
