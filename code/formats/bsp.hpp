#pragma once
// IBSP version 46: the map file. One struct a lump, in file order; every index is checked here, so that no later code
// has to. Throws ContentError naming the file and the lump.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

struct BspShader {
    std::string name;
    uint32_t surfaceFlags = 0; ///< compile-time flags; the renderer uses kBspSurfaceNodraw on patches only
    uint32_t contentFlags = 0;
};
inline constexpr uint32_t kBspSurfaceNodraw = 0x80;

struct BspNode {
    int plane = 0;
    int children[2] = {0, 0}; ///< front, back; >= 0 a node, c < 0 the leaf -1 - c
    ivec3 mins{0}, maxs{0};
};

struct BspLeaf {
    int cluster = -1; ///< -1: solid or outside
    int area = 0;
    ivec3 mins{0}, maxs{0};
    int firstLeafSurface = 0, leafSurfaceCount = 0;
    int firstLeafBrush = 0, leafBrushCount = 0;
};

struct BspModel {
    vec3 mins{0}, maxs{0};
    int firstSurface = 0, surfaceCount = 0;
    int firstBrush = 0, brushCount = 0;
};

struct BspBrush {
    int firstSide = 0, sideCount = 0, shader = 0;
};
struct BspBrushSide {
    int plane = 0, shader = 0;
};

struct BspDrawVertex {
    vec3 position{0};
    vec2 st{0};
    vec2 lightmapSt{
        0}; ///< may be NaN or garbage on vertex-lit surfaces (trap T2); made 0 by the parser where not finite
    vec3 normal{0};
    U8vec4 color{0};
};

struct BspFog {
    std::string shader;
    int brush = -1;
    int visibleSide = -1; ///< brush side that is the fog's surface, -1 none
};

enum class BspSurfaceType { Planar = 1, Patch = 2, TriangleSoup = 3, Flare = 4 };

struct BspSurface {
    int shader = 0;
    int fog = -1;
    BspSurfaceType type = BspSurfaceType::Planar;
    int firstVertex = 0, vertexCount = 0;
    int firstIndex = 0, indexCount = 0;
    int lightmap = -1; ///< page; negative: see behaviour of lightmap contexts in scene/material.hpp
    vec3 lightmapOrigin{0};
    vec3 lightmapVectors[3] = {};
    int patchWidth = 0, patchHeight = 0;
};

inline constexpr int kLightmapSize = 128; ///< texels a side of one RGB page

struct Bsp {
    std::string entities;
    std::vector<BspShader> shaders;
    std::vector<Plane> planes;
    std::vector<BspNode>
        nodes; ///< [0] is the root of a tree (checked); it may be as deep as it has nodes: don't recurse
    std::vector<BspLeaf> leafs;
    std::vector<int> leafSurfaces;
    std::vector<int> leafBrushes;
    std::vector<BspModel> models; ///< [0] is the world
    std::vector<BspBrush> brushes;
    std::vector<BspBrushSide> brushSides;
    std::vector<BspDrawVertex> vertices;
    std::vector<int> indices; ///< relative to the surface's firstVertex
    std::vector<BspFog> fogs;
    std::vector<BspSurface> surfaces;
    std::vector<uint8_t> lightmaps; ///< pages of 128x128 RGB, raw (no overbright shift)
    std::vector<uint8_t> lightGrid; ///< records of 8 bytes, raw
    int clusterCount = 0;           ///< 0: no visibility lump, everything sees everything
    int clusterRowBytes = 0;
    std::vector<uint8_t> visibility; ///< clusterCount rows; bit c of row r: c potentially visible from r

    size_t lightmapPageCount() const { return lightmaps.size() / (3 * kLightmapSize * kLightmapSize); }
    /// Is cluster `to` potentially visible from `from`? True where either is outside or there is no visibility lump.
    bool clusterVisible(int from, int to) const;
};

/// Parses a whole map. `name` is used in messages.
Bsp parseBsp(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
