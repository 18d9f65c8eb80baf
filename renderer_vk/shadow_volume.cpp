#include "renderer_vk/shadow_volume.hpp"

#include <algorithm>

namespace q3rt {

void ShadowVolumeBuilder::append(std::span<const Vertex> vertices, std::span<const uint32_t> indices,
                                 uint32_t firstVertex, const vec3& lightDirection, std::vector<Vertex>& outVertices,
                                 std::vector<uint32_t>& outIndices) {
    const auto at = [&](uint32_t index) -> const vec3& { return vertices[index - firstVertex].position; };
    m_edges.clear();
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (glm::dot(glm::cross(at(b) - at(a), at(c) - at(a)), lightDirection) <= 0) continue;
        m_edges.insert(m_edges.end(), {{a, b}, {b, c}, {c, a}});
    }
    std::ranges::sort(m_edges);
    for (const Edge& edge : m_edges) {
        if (std::ranges::binary_search(m_edges, Edge{edge.to, edge.from})) continue;
        const auto first = static_cast<uint32_t>(outVertices.size());
        for (const uint32_t end : {edge.from, edge.to}) {
            for (const float length : {0.0f, kShadowLengthQu}) {
                Vertex vertex{};
                vertex.position = at(end) - lightDirection * length;
                outVertices.push_back(vertex);
            }
        }
        const uint32_t strip[6] = {first, first + 1, first + 2, first + 2, first + 1, first + 3};
        outIndices.insert(outIndices.end(), strip, strip + 6);
    }
}

} // namespace q3rt
