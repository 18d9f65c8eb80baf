// Smooth normals of a patch grid: the mean of the corner normals between existing neighbours (spec of world 2.7).

#include <optional>

#include "scene/patch.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr int kNeighbours = 8;
constexpr int kSteps[kNeighbours][2] = {{0, 1}, {1, 1}, {1, 0}, {1, -1}, {0, -1}, {-1, -1}, {-1, 0}, {-1, 1}};
constexpr int kLongestReach = 3;            // grid steps over coincident points
constexpr float kDegenerateLength = 0.001f; // qu; shorter edges have no direction
constexpr float kClosedSquared = 1.0f;      // qu^2; ends nearer than this make the grid closed

struct Closed {
    bool width = true, height = true;
};

const vec3& at(const TessellatedPatch& patch, int column, int row) {
    return patch.vertices[static_cast<size_t>(row) * static_cast<size_t>(patch.width) + static_cast<size_t>(column)]
        .position;
}

bool near(const vec3& a, const vec3& b) { return glm::dot(a - b, a - b) <= kClosedSquared; }

Closed findClosed(const TessellatedPatch& patch) {
    Closed closed;
    for (int r = 0; r < patch.height; ++r) {
        closed.width = closed.width && near(at(patch, 0, r), at(patch, patch.width - 1, r));
    }
    for (int c = 0; c < patch.width; ++c) {
        closed.height = closed.height && near(at(patch, c, 0), at(patch, c, patch.height - 1));
    }
    return closed;
}

/// Brings an index that left a closed grid back in, past the doubled seam; false where the grid is open.
bool wrapIndex(int& index, int size, bool closed) {
    if (index >= 0 && index < size) return true;
    if (!closed) return false;
    index = index < 0 ? size - 1 + index : 1 + index - size;
    return index >= 0 && index < size;
}

std::optional<vec3> findNeighbour(const TessellatedPatch& patch, Closed closed, int column, int row, const int* step) {
    const vec3& centre = at(patch, column, row);
    for (int reach = 1; reach <= kLongestReach; ++reach) {
        int c = column + step[0] * reach, r = row + step[1] * reach;
        if (!wrapIndex(c, patch.width, closed.width) || !wrapIndex(r, patch.height, closed.height)) return {};
        const vec3 offset = at(patch, c, r) - centre;
        const float length = glm::length(offset);
        if (length >= kDegenerateLength) return offset / length;
    }
    return {};
}

vec3 computeNormal(const TessellatedPatch& patch, Closed closed, int column, int row) {
    std::optional<vec3> around[kNeighbours];
    for (int k = 0; k < kNeighbours; ++k) {
        around[k] = findNeighbour(patch, closed, column, row, kSteps[k]);
    }
    vec3 sum(0.0f);
    for (int k = 0; k < kNeighbours; ++k) {
        const auto& next = around[(k + 1) % kNeighbours];
        if (!around[k] || !next) continue;
        const vec3 normal = glm::cross(*next, *around[k]);
        const float length = glm::length(normal);
        if (length >= kDegenerateLength) sum += normal / length;
    }
    return normalizeOrZero(sum);
}

} // namespace

void computePatchNormals(TessellatedPatch& patch) {
    const Closed closed = findClosed(patch);
    for (int r = 0; r < patch.height; ++r) {
        for (int c = 0; c < patch.width; ++c) {
            const size_t i = static_cast<size_t>(r) * static_cast<size_t>(patch.width) + static_cast<size_t>(c);
            patch.vertices[i].normal = computeNormal(patch, closed, c, r);
        }
    }
}

} // namespace q3rt
