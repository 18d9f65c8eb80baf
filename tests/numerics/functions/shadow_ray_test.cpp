// Shadow rays of a map moved far from the origin, and of the map as a rotated instance: how many pixels of a view are
// wrongly shadowed or wrongly lit. The arithmetic is the shaders' own, compiled as C++.

#include "numerics/measured.hpp"
#include "numerics/shadow_cases.hpp"
#include "support/game_data.hpp"
#include "tracer/shader_text.hpp"

namespace q3rt::test {
namespace {

struct Counts {
    size_t lit = 0, wronglyShadowed = 0, wronglyLit = 0;
    double largestOffset = 0; ///< qu
};

Counts traceCases(const PlacedMap& map) {
    Counts counts;
    for (const ShadowCase& c : map.cases) {
        const vec3* corner = &map.corners[size_t{3} * c.triangle];
        shader::HitPoint point = shader::makeHitPoint(corner[0], corner[1], corner[2], c.barycentric);
        const vec4* rows = map.placement.worldFromModel;
        if (map.placement.rotation) point = shader::transformHitPoint(rows[0], rows[1], rows[2], point, 0.0f);
        const vec3 origin = shader::offsetOrigin(point.position, point.error, c.normal);
        counts.largestOffset = std::max(counts.largestOffset, double(glm::length(origin - point.position)));
        const bool blocked = traceShader(map.scene, origin, c.light - origin, 0, 1, 0xff, true).hit;
        counts.lit += c.hidden ? 0 : 1;
        counts.wronglyShadowed += blocked && !c.hidden;
        counts.wronglyLit += !blocked && c.hidden;
    }
    return counts;
}

TEST(ShadowRays, NeitherShadowThemselvesNorLeak) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const WorldTriangles world(*files, "oa_minia");
    for (const bool rotated : {false, true})
        for (const float distance : {0.0f, 8000.0f, -8000.0f, 65536.0f, -65536.0f, 1e6f}) {
            const PlacedMap map = makeShadowCases(world, makePlacement(distance, rotated));
            const Counts counts = traceCases(map);
            const size_t considered = map.cases.size();
            const std::string name = std::string("oa_minia") + (rotated ? ", rotated instance" : "") + " at " +
                                     std::to_string(static_cast<int>(distance));
            std::printf("numerics | shadow rays, %s | %zu pixels, %zu lit, %zu undecided, offset up to %.2g qu\n",
                        name.c_str(), considered, counts.lit, map.undecided, counts.largestOffset);
            EXPECT_GT(considered, 50000u);
            EXPECT_GT(counts.lit, considered / 10);
            EXPECT_LT(counts.lit, considered * 9 / 10);
            const bool claimed = std::abs(distance) <= 65536;
            expectCount("wrongly shadowed, " + name, counts.wronglyShadowed, considered, claimed ? 1 : considered);
            expectCount("wrongly lit, " + name, counts.wronglyLit, considered, claimed ? 0 : considered);
        }
}

} // namespace
} // namespace q3rt::test
