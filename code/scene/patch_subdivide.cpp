// Subdivision of quadratic Bezier patches into a grid of points (spec of world 2.6). The steps and their order decide
// which points exist and which way quads are split, so they are those that content was built against.

#include <algorithm>
#include <cmath>

#include "scene/patch.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kFlatDeviationQu = 0.1f; // below this the middle column adds nothing and is dropped
constexpr float kFlatMark = -1.0f;       // in the error table; real errors are positive

using Row = std::vector<Vertex>;

struct ControlGrid {
    std::vector<Row> rows;

    int width() const { return rows.empty() ? 0 : static_cast<int>(rows[0].size()); }
    int height() const { return static_cast<int>(rows.size()); }

    void transpose() {
        std::vector<Row> turned(static_cast<size_t>(width()), Row(rows.size()));
        for (size_t r = 0; r < rows.size(); ++r) {
            for (size_t c = 0; c < rows[r].size(); ++c) {
                turned[c][r] = rows[r][c];
            }
        }
        rows = std::move(turned);
    }
};

/// Largest distance over all rows of the curve's middle from the chord of the segment that starts at column j.
float measureDeviation(const ControlGrid& grid, size_t j) {
    float largestSquared = 0.0f;
    for (const Row& row : grid.rows) {
        const vec3 a = row[j].position;
        const vec3 chord = normalizeOrZero(row[j + 2].position - a);
        const vec3 middle = (a + row[j + 1].position * 2.0f + row[j + 2].position) * 0.25f - a;
        const vec3 away = middle - chord * glm::dot(middle, chord);
        largestSquared = std::max(largestSquared, glm::dot(away, away));
    }
    return std::sqrt(largestSquared);
}

void splitSegment(ControlGrid& grid, size_t j) {
    for (Row& row : grid.rows) {
        const Vertex before = averagePatchVertex(row[j], row[j + 1]);
        const Vertex after = averagePatchVertex(row[j + 1], row[j + 2]);
        const Vertex middle = averagePatchVertex(before, after);
        row[j + 1] = before;
        const Vertex added[2] = {middle, after};
        row.insert(row.begin() + static_cast<std::ptrdiff_t>(j) + 2, added, added + 2);
    }
}

/// Subdivides along the width; returns the error of each column (0: always kept).
std::vector<float> subdivideColumns(ControlGrid& grid, float toleranceQu) {
    std::vector<float> errors(static_cast<size_t>(std::max(kMaxPatchSide, grid.width())) + 2, 0.0f);
    for (size_t j = 0; static_cast<int>(j) + 2 < grid.width();) {
        const float deviation = measureDeviation(grid, j);
        if (deviation < kFlatDeviationQu) {
            errors[j + 1] = kFlatMark;
            j += 2;
        } else if (grid.width() + 2 > kMaxPatchSide || deviation <= toleranceQu) {
            errors[j + 1] = 1.0f / deviation;
            j += 2;
        } else {
            errors[j + 2] = 1.0f / deviation;
            splitSegment(grid, j);
        }
    }
    errors.resize(static_cast<size_t>(grid.width()));
    return errors;
}

Vertex pointOnCurve(const Vertex& previous, const Vertex& point, const Vertex& next) {
    return averagePatchVertex(averagePatchVertex(point, next), averagePatchVertex(point, previous));
}

/// Odd points still are control points that the curve only approaches; move them onto it.
void putOnCurve(ControlGrid& grid) {
    for (size_t r = 1; r + 1 < grid.rows.size(); r += 2) {
        for (size_t c = 0; c < grid.rows[r].size(); ++c) {
            grid.rows[r][c] = pointOnCurve(grid.rows[r - 1][c], grid.rows[r][c], grid.rows[r + 1][c]);
        }
    }
    for (Row& row : grid.rows) {
        for (size_t c = 1; c + 1 < row.size(); c += 2) {
            row[c] = pointOnCurve(row[c - 1], row[c], row[c + 1]);
        }
    }
}

void dropFlatColumns(ControlGrid& grid, std::vector<float>& errors) {
    for (size_t c = 1; c + 1 < errors.size();) {
        if (errors[c] != kFlatMark) {
            ++c;
            continue;
        }
        errors.erase(errors.begin() + static_cast<std::ptrdiff_t>(c));
        for (Row& row : grid.rows) {
            row.erase(row.begin() + static_cast<std::ptrdiff_t>(c));
        }
    }
}

/// Quarter turn of tall grids; it chooses the diagonal of every quad.
void turnTallGrid(ControlGrid& grid, std::vector<float>& columnError, std::vector<float>& rowError) {
    if (grid.height() <= grid.width()) return;
    grid.transpose();
    for (Row& row : grid.rows) {
        std::reverse(row.begin(), row.end());
    }
    std::swap(columnError, rowError);
    std::reverse(columnError.begin(), columnError.end());
}

} // namespace

Vertex averagePatchVertex(const Vertex& a, const Vertex& b) {
    Vertex middle = a;
    middle.position = (a.position + b.position) * 0.5f;
    middle.st = (a.st + b.st) * 0.5f;
    middle.lightmapSt = (a.lightmapSt + b.lightmapSt) * 0.5f;
    const U8vec4 ca = unpackColor(a.color), cb = unpackColor(b.color);
    U8vec4 color;
    for (int i = 0; i < 4; ++i) {
        color[i] = static_cast<uint8_t>((ca[i] + cb[i]) >> 1);
    }
    middle.color = packColor(color);
    return middle;
}

TessellatedPatch tessellatePatch(int width, int height, const std::vector<Vertex>& control, float subdivisions) {
    ControlGrid grid;
    for (int r = 0; r < height; ++r) {
        const auto first = control.begin() + static_cast<std::ptrdiff_t>(r) * width;
        grid.rows.emplace_back(first, first + width);
    }
    TessellatedPatch out;
    out.columnError = subdivideColumns(grid, subdivisions);
    grid.transpose();
    out.rowError = subdivideColumns(grid, subdivisions);
    grid.transpose();
    putOnCurve(grid);
    dropFlatColumns(grid, out.columnError);
    grid.transpose();
    dropFlatColumns(grid, out.rowError);
    grid.transpose();
    turnTallGrid(grid, out.columnError, out.rowError);
    out.width = grid.width();
    out.height = grid.height();
    out.vertices.reserve(static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
    for (const Row& row : grid.rows) {
        out.vertices.insert(out.vertices.end(), row.begin(), row.end());
    }
    computePatchNormals(out);
    return out;
}

} // namespace q3rt
