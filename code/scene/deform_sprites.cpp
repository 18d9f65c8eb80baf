// autosprite, autosprite2 and text deforms (spec of models 6).

#include "scene/deform_sprites.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/deform_stamp.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kHalfEdgeOfRadius = 0.707f; // a corner's distance to the half edge, as the content was built with
constexpr float kTextWidth = 0.75f;         // of a character, relative to its height
constexpr float kTextCell = 1.0f / 16.0f;   // the font image has 16 x 16 characters

constexpr size_t kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

vec3 meanOf4(const Vertex* quad) {
    return (quad[0].position + quad[1].position + quad[2].position + quad[3].position) * 0.25f;
}

/// One short end of a quad.
struct QuadEnd {
    size_t pair = 0;
    float lengthSquared = std::numeric_limits<float>::max();
};

void findEnds(const Vertex* quad, QuadEnd ends[2]) {
    for (size_t pair = 0; pair < 6; ++pair) {
        const vec3 edge = quad[kPairs[pair][0]].position - quad[kPairs[pair][1]].position;
        const float lengthSquared = glm::dot(edge, edge);
        if (lengthSquared < ends[0].lengthSquared) {
            ends[1] = ends[0];
            ends[0] = {pair, lengthSquared};
        } else if (lengthSquared < ends[1].lengthSquared) {
            ends[1] = {pair, lengthSquared};
        }
    }
}

/// Do the two vertices follow each other, in this order, in the quad's six indices?
bool areConsecutive(const std::vector<uint32_t>& indices, size_t firstIndex, uint32_t a, uint32_t b) {
    for (size_t k = firstIndex; k + 1 < std::min(firstIndex + 6, indices.size()); ++k) {
        if (indices[k] == a && indices[k + 1] == b) return true;
    }
    return false;
}

} // namespace

void deformAutoSprite(const DeformContext& context, std::vector<Vertex>& vertices, std::vector<uint32_t>& indices) {
    const float scale = context.axisScale != 0.0f ? 1.0f / context.axisScale : 0.0f;
    const vec3 left = context.viewLeft * (context.mirrored ? -scale : scale), up = context.viewUp * scale;
    indices.clear();
    const size_t count = vertices.size();
    for (size_t first = 0; first + 4 <= count; first += 4) {
        Stamp stamp;
        stamp.centre = meanOf4(&vertices[first]);
        const float radius = kHalfEdgeOfRadius * glm::length(vertices[first].position - stamp.centre);
        stamp.left = left * radius;
        stamp.up = up * radius;
        stamp.normal = -context.worldForward;
        stamp.color = vertices[first].color;
        appendStamp(stamp, vertices, indices);
    }
    vertices.erase(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(count));
    for (uint32_t& index : indices) {
        index -= static_cast<uint32_t>(count);
    }
}

void deformAutoSprite2(const DeformContext& context, std::vector<Vertex>& vertices,
                       const std::vector<uint32_t>& indices) {
    for (size_t first = 0; first + 4 <= vertices.size(); first += 4) {
        Vertex* quad = &vertices[first];
        QuadEnd ends[2];
        findEnds(quad, ends);
        vec3 middle[2];
        for (int i = 0; i < 2; ++i) {
            middle[i] = (quad[kPairs[ends[i].pair][0]].position + quad[kPairs[ends[i].pair][1]].position) * 0.5f;
        }
        const vec3 minor = normalizeOrZero(glm::cross(middle[1] - middle[0], context.viewForward));
        for (int i = 0; i < 2; ++i) {
            const size_t a = kPairs[ends[i].pair][0], b = kPairs[ends[i].pair][1];
            const bool inOrder = areConsecutive(indices, first / 4 * 6, static_cast<uint32_t>(first + a),
                                                static_cast<uint32_t>(first + b));
            const vec3 half = minor * (0.5f * std::sqrt(ends[i].lengthSquared) * (inOrder ? 1.0f : -1.0f));
            quad[a].position = middle[i] - half;
            quad[b].position = middle[i] + half;
        }
    }
}

void deformText(const DeformContext& context, int textNumber, std::vector<Vertex>& vertices,
                std::vector<uint32_t>& indices) {
    std::vector<Vertex> quad(vertices.begin(), vertices.begin() + std::min<std::ptrdiff_t>(4, std::ssize(vertices)));
    vertices.clear();
    indices.clear();
    if (!context.text || quad.size() < 4) return;
    const std::string& text = (*context.text)[static_cast<size_t>(textNumber)];
    float bottom = quad[0].position.z, top = bottom;
    for (const Vertex& vertex : quad) {
        bottom = std::min(bottom, vertex.position.z);
        top = std::max(top, vertex.position.z);
    }
    const float halfHeight = (top - bottom) * 0.5f;
    Stamp stamp;
    stamp.left = glm::cross(quad[0].normal, vec3(0, 0, -1)) * (-kTextWidth * halfHeight);
    stamp.up = vec3(0, 0, halfHeight);
    stamp.normal = -context.worldForward;
    stamp.centre = meanOf4(quad.data()) + stamp.left * (static_cast<float>(text.size()) - 1.0f);
    for (const char character : text) {
        const auto code = static_cast<uint8_t>(character);
        stamp.stFirst = vec2(static_cast<float>(code & 15), static_cast<float>(code >> 4)) * kTextCell;
        stamp.stLast = stamp.stFirst + kTextCell;
        if (code != ' ') appendStamp(stamp, vertices, indices);
        stamp.centre -= stamp.left * 2.0f;
    }
}

} // namespace q3rt
