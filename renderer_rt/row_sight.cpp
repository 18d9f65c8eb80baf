#include "renderer_rt/row_sight.hpp"

#include <cmath>

#include "base/parallel.hpp"
#include "scene/luxels.hpp"

namespace q3rt {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/random.glsl"

/// Rays from each of a row's points to each of its lights.
constexpr uint32_t kRaysPerPoint = 2;

/// Share of a light that arrives at points. As if two rays more had been traced of which one arrived (Laplace's rule of
/// succession): no light that some pixel may see becomes too seldom, whatever the few rays met.
float shareSeen(const LightProbe& probe, const std::vector<RowPoint>& points, uint32_t light) {
    float given = 0, arrives = 0, count = 0;
    for (size_t p = 0; p < points.size(); ++p)
        for (uint32_t ray = 0; ray < kRaysPerPoint; ++ray) {
            const uvec4 bits = hashPcg4d(uvec4(static_cast<uint>(p), ray, light, 0));
            const vec3 point = points[p].position + kLuxelOffsetQu * points[p].normal;
            const LightProbe::Arrival sample =
                probe.sample(point, points[p].normal, light, unitFloat(bits.x), unitFloat(bits.y));
            given += sample.given;
            arrives += sample.arrives;
            count += sample.given > 0 ? 1.0f : 0.0f;
        }
    const float one = count > 0 ? given / count : 1.0f;
    return (arrives + one) / (given + 2 * one);
}

} // namespace

void lookFromRows(const LightProbe& probe, LightRows& rows) {
    const size_t clusterRows = (rows.points.size() - 1) * kNormalClassCount;
    parallelFor(clusterRows, [&](size_t r) {
        const RtLightRow& row = rows.rows[r];
        const std::vector<RowPoint>& points = rows.points[r / kNormalClassCount][r % kNormalClassCount].points;
        std::vector<float> seen(row.facing);
        for (uint32_t i = 0; i < row.facing; ++i)
            seen[i] = std::sqrt(shareSeen(probe, points, rows.entries[row.first + i].light));
        followSight(rows, row, seen);
    });
}

} // namespace q3rt
