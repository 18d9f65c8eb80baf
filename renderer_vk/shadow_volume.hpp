#pragma once
// The sides of the space that a model's surface hides from its light (spec of models 5.1). Pure CPU.

#include <span>
#include <vector>

#include "shaders/shared/vertex.h"

namespace q3rt {

/// Volumes end here, open: a shadow reaches no farther.
inline constexpr float kShadowLengthQu = 512.0f;

class ShadowVolumeBuilder {
  public:
    /// Appends two triangles for each edge between a triangle that faces the light and none that does. Vertices are
    /// told apart by number: a seam of the texture is an edge too, as in the original. `lightDirection` points to the
    /// light, in the vertices' space.
    void append(std::span<const Vertex> vertices, std::span<const uint32_t> indices, uint32_t firstVertex,
                const vec3& lightDirection, std::vector<Vertex>& outVertices, std::vector<uint32_t>& outIndices);

  private:
    struct Edge {
        uint32_t from, to;
        auto operator<=>(const Edge&) const = default;
    };
    std::vector<Edge> m_edges; ///< of triangles that face the light, sorted; kept for its memory
};

} // namespace q3rt
