#pragma once
// deformVertexes on the CPU, in double where time enters: one result for the rasteriser and the acceleration
// structures.

#include <array>
#include <string>
#include <vector>

#include "scene/material.hpp"
#include "scene/scene_types.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

struct DeformContext {
    double shaderTimeSeconds = 0;                                  ///< entity-relative
    int sceneTimeMs = 0;                                           ///< bulge uses it
    vec3 viewForward{1, 0, 0}, viewLeft{0, 1, 0}, viewUp{0, 0, 1}; ///< in the space of the vertices
    vec3 worldForward{1, 0, 0}; ///< view forward in world axes: sprites get its negative as normal, unrotated
    float axisScale = 1;        ///< |axis[0]| if nonNormalizedAxes, else 1; sprites are divided by it
    bool mirrored = false;
    vec3 lightDirection{0}; ///< model space (projection shadow)
    vec3 worldUpInModel{0, 0, 1};
    float heightAboveShadowPlane = 0;
    const std::array<std::string, 8>* text = nullptr;
};

/// Applies the material's deforms in order to a batch; `indices` are relative to `vertices`. Text may change both.
void deformVertices(const Material& material, const DeformContext& context, std::vector<Vertex>& vertices,
                    std::vector<uint32_t>& indices);

/// How far the material's deforms move a vertex of unit normal at most, at any time and from any view, qu. Infinite
/// where the size of the surface decides (sprites) or nothing does (text, shadows).
float deformReachQu(const Material& material);

/// Holds what the material's deforms make of unit-normal vertices that lie in `box`, at any time and from any view
/// whose axes are unit vectors; empty where that is not known.
Bounds deformedBounds(const Material& material, const Bounds& box);

/// Do any of the material's deforms turn with the view?
bool deformsWithView(const Material& material);

} // namespace q3rt
