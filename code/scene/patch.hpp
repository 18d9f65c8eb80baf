#pragma once
// What loadWorld does with curved patches after each one is tessellated: normals, stitching of neighbours, shared
// level-of-detail errors (spec of world 2.7 to 2.9).

#include <vector>

#include "scene/world.hpp"

namespace q3rt {

/// Most points on a side of a tessellated grid; part of the content's look, since it bounds the subdivision.
inline constexpr int kMaxPatchSide = 65;

struct PatchMesh {
    TessellatedPatch grid;
    vec3 lodOrigin{0};
    float lodRadius = 0; ///< patches of bit-identical sphere form a group: only those are stitched to each other
};

/// Smooth normals of the whole grid, closed grids (first = last column or row) included.
void computePatchNormals(TessellatedPatch& patch);

/// Componentwise half sum of positions and coordinates; colours are bytes and truncate. Normal of the first.
Vertex averagePatchVertex(const Vertex& a, const Vertex& b);

/// Inserts points where an edge of one patch is finer than the touching edge of a neighbour, then equalises the errors
/// of shared edge points so that both sides drop them at the same distance. `meshes` are in surface order.
void stitchPatches(std::vector<PatchMesh>& meshes);

} // namespace q3rt
