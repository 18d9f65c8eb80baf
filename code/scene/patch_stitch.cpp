// Stitching of neighbouring patches (spec of world 2.9): cracks appear where one edge has a point that the touching
// edge lacks, so that point is inserted there. Matching is by position within small boxes, as the content was built
// with.

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

#include "scene/patch.hpp"

namespace q3rt {
namespace {

constexpr float kSamePointQu = 0.1f;       // a per-axis distance: two edges share this point
constexpr float kCoincidentPairQu = 0.01f; // nearer pairs have no room for a point between them

bool within(const vec3& a, const vec3& b, float limit) {
    const vec3 d = glm::abs(a - b);
    return d.x <= limit && d.y <= limit && d.z <= limit;
}

/// One of the four edges: rows first (their points run along the width), then columns.
struct Edge {
    bool isRow = true;
    bool last = false;
};
constexpr Edge kEdges[4] = {{true, false}, {true, true}, {false, false}, {false, true}};

/// Read access to the points of an edge by their number along it.
class EdgePoints {
  public:
    EdgePoints(const TessellatedPatch& patch, Edge edge)
        : m_patch(patch)
        , m_edge(edge) {
        const auto width = static_cast<size_t>(patch.width), height = static_cast<size_t>(patch.height);
        m_stride = edge.isRow ? 1 : width;
        m_offset = !edge.last ? 0 : edge.isRow ? (height - 1) * width : width - 1;
    }
    int count() const { return m_edge.isRow ? m_patch.width : m_patch.height; }
    const vec3& operator[](int i) const {
        return m_patch.vertices[m_offset + static_cast<size_t>(i) * m_stride].position;
    }
    /// Do interior points coincide? Such an edge is folded and takes no part.
    bool hasMergedPoints() const {
        for (int i = 1; i < count() - 1; ++i) {
            for (int j = i + 1; j < count() - 1; ++j) {
                if (within((*this)[i], (*this)[j], kSamePointQu)) return true;
            }
        }
        return false;
    }

  private:
    const TessellatedPatch& m_patch;
    Edge m_edge;
    size_t m_stride = 1, m_offset = 0;
};

std::vector<float>& errorsAlong(TessellatedPatch& patch, Edge edge) {
    return edge.isRow ? patch.columnError : patch.rowError;
}

/// New column before column `at`; on row `touchRow` its point is `position`.
void insertColumn(TessellatedPatch& patch, int at, int touchRow, const vec3& position, float error) {
    std::vector<Vertex> grown;
    grown.reserve(patch.vertices.size() + static_cast<size_t>(patch.height));
    for (int r = 0; r < patch.height; ++r) {
        const Vertex* row = patch.vertices.data() + static_cast<size_t>(r) * static_cast<size_t>(patch.width);
        grown.insert(grown.end(), row, row + at);
        grown.push_back(averagePatchVertex(row[at - 1], row[at]));
        if (r == touchRow) grown.back().position = position;
        grown.insert(grown.end(), row + at, row + patch.width);
    }
    patch.vertices = std::move(grown);
    patch.columnError.insert(patch.columnError.begin() + at, error);
    ++patch.width;
}

void insertRow(TessellatedPatch& patch, int at, int touchColumn, const vec3& position, float error) {
    const auto width = static_cast<size_t>(patch.width);
    const auto begin = static_cast<size_t>(at) * width;
    std::vector<Vertex> row(width);
    for (size_t c = 0; c < width; ++c) {
        row[c] = averagePatchVertex(patch.vertices[begin - width + c], patch.vertices[begin + c]);
    }
    row[static_cast<size_t>(touchColumn)].position = position;
    patch.vertices.insert(patch.vertices.begin() + static_cast<std::ptrdiff_t>(begin), row.begin(), row.end());
    patch.rowError.insert(patch.rowError.begin() + at, error);
    ++patch.height;
}

struct NewPoint {
    vec3 from{0}, position{0},
        to{0}; ///< two points of an edge of A that B must have as neighbours, and the one between
    float error = 0;
};

/// Finds the first edge of `b` with from and to as adjacent points and inserts the point there.
bool insertBetween(TessellatedPatch& b, const NewPoint& point) {
    for (const Edge edge : kEdges) {
        const EdgePoints points(b, edge);
        if (points.count() >= kMaxPatchSide) continue;
        for (int l = 0; l + 1 < points.count(); ++l) {
            if (!within(point.from, points[l], kSamePointQu) || !within(point.to, points[l + 1], kSamePointQu))
                continue;
            if (within(points[l], points[l + 1], kCoincidentPairQu)) continue;
            const int across = !edge.last ? 0 : (edge.isRow ? b.height : b.width) - 1;
            if (edge.isRow) {
                insertColumn(b, l + 1, across, point.position, point.error);
            } else {
                insertRow(b, l + 1, across, point.position, point.error);
            }
            computePatchNormals(b);
            return true;
        }
    }
    return false;
}

/// One pass over an edge of `a`; `descending` walks it from the far end, so that edges of opposite direction match.
bool stitchEdge(TessellatedPatch& a, TessellatedPatch& b, Edge edge, bool descending) {
    const EdgePoints points(a, edge);
    if (points.hasMergedPoints()) return false;
    const std::vector<float>& errors = errorsAlong(a, edge);
    const int count = points.count();
    for (int k = descending ? count - 1 : 0; descending ? k > 1 : k < count - 2; k += descending ? -2 : 2) {
        const int middle = descending ? k - 1 : k + 1, end = descending ? k - 2 : k + 2;
        // The error of index k + 1 also when descending, as the original has it; past the table's end it counts as 0.
        const auto errorIndex = static_cast<size_t>(k) + 1;
        const float error = errorIndex < errors.size() ? errors[errorIndex] : 0.0f;
        if (insertBetween(b, {points[k], points[middle], points[end], error})) return true;
    }
    return false;
}

bool stitchOnce(TessellatedPatch& a, TessellatedPatch& b) {
    for (const bool descending : {false, true}) {
        for (const Edge edge : kEdges) {
            if (stitchEdge(a, b, edge, descending)) return true;
        }
    }
    return false;
}

/// Numbers of the patches of one level-of-detail sphere, ascending.
using Group = std::vector<size_t>;

std::vector<Group> findGroups(const std::vector<PatchMesh>& meshes) {
    std::map<std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>, Group> groups;
    for (size_t i = 0; i < meshes.size(); ++i) {
        const auto bits = [](float f) { return std::bit_cast<uint32_t>(f == 0.0f ? 0.0f : f); };
        const vec3& o = meshes[i].lodOrigin;
        groups[{bits(o.x), bits(o.y), bits(o.z), bits(meshes[i].lodRadius)}].push_back(i);
    }
    std::vector<Group> list;
    for (auto& [key, members] : groups) {
        list.push_back(std::move(members));
    }
    return list;
}

Bounds boundsOf(const TessellatedPatch& patch) {
    Bounds bounds;
    for (const Vertex& vertex : patch.vertices) {
        bounds.add(vertex.position);
    }
    return bounds;
}

/// Patches farther apart than this can't share a point: most pairs of a big group are done with here.
bool mayTouch(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.mins - b.maxs, vec3(kSamePointQu))) &&
           glm::all(glm::lessThanEqual(b.mins - a.maxs, vec3(kSamePointQu)));
}

std::vector<Bounds> boundsOfGroup(const std::vector<PatchMesh>& meshes, const Group& group) {
    std::vector<Bounds> bounds;
    for (const size_t i : group) {
        bounds.push_back(boundsOf(meshes[i].grid));
    }
    return bounds;
}

void stitchGroup(std::vector<PatchMesh>& meshes, const Group& group) {
    std::vector<char> done(group.size(), 0);
    std::vector<Bounds> bounds = boundsOfGroup(meshes, group);
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t a = 0; a < group.size(); ++a) {
            if (done[a]) continue;
            done[a] = 1;
            changed = true;
            for (size_t b = 0; b < group.size(); ++b) {
                while (mayTouch(bounds[a], bounds[b]) && stitchOnce(meshes[group[a]].grid, meshes[group[b]].grid)) {
                    done[b] = 0;
                    bounds[b] = boundsOf(meshes[group[b]].grid);
                }
            }
        }
    }
}

/// Copies the errors of shared interior edge points from `from` to `to`; true if there was one.
bool shareErrors(TessellatedPatch& from, TessellatedPatch& to) {
    bool touched = false;
    for (const Edge fromEdge : kEdges) {
        const EdgePoints source(from, fromEdge);
        if (source.hasMergedPoints()) continue;
        for (const Edge toEdge : kEdges) {
            const EdgePoints target(to, toEdge);
            if (target.hasMergedPoints()) continue;
            for (int k = 1; k < source.count() - 1; ++k) {
                for (int l = 1; l < target.count() - 1; ++l) {
                    if (!within(source[k], target[l], kSamePointQu)) continue;
                    errorsAlong(to, toEdge)[static_cast<size_t>(l)] =
                        errorsAlong(from, fromEdge)[static_cast<size_t>(k)];
                    touched = true;
                }
            }
        }
    }
    return touched;
}

void equalizeGroup(std::vector<PatchMesh>& meshes, const Group& group) {
    std::vector<char> fixed(group.size(), 0);
    const std::vector<Bounds> bounds = boundsOfGroup(meshes, group);
    const auto handsOn = [&](size_t from, size_t to) {
        return mayTouch(bounds[from], bounds[to]) && shareErrors(meshes[group[from]].grid, meshes[group[to]].grid);
    };
    std::vector<size_t> open; // patches whose errors have to be handed on, most recent first
    for (size_t start = 0; start < group.size(); ++start) {
        if (fixed[start]) continue;
        fixed[start] = 1;
        open.assign(1, start);
        while (!open.empty()) {
            const size_t from = open.back();
            size_t to = start + 1;
            while (to < group.size() && (fixed[to] || !handsOn(from, to))) {
                ++to;
            }
            if (to == group.size()) {
                open.pop_back();
            } else {
                fixed[to] = 1;
                open.push_back(to);
            }
        }
    }
}

} // namespace

void stitchPatches(std::vector<PatchMesh>& meshes) {
    for (const Group& group : findGroups(meshes)) {
        stitchGroup(meshes, group);
        equalizeGroup(meshes, group);
    }
}

} // namespace q3rt
