#include "host/inspect/luxel_table.hpp"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "host/common/interrupt.hpp"
#include "host/common/json_text.hpp"
#include "scene/luxels.hpp"

namespace q3rt {
namespace {

/// The points are the same in every run, so that tables can be compared.
constexpr uint32_t kSeed = 1;

} // namespace

void printLuxelHeader() {
    std::printf("luxel units, largest channel\n%-18s %6s %8s %8s %7s %7s %7s %7s %6s %6s %9s %6s\n", "map", "lights",
                "baked", "traced", "surface", "sun", "sky", "points", "corr", "slope", "explained", "ratio");
}

void printLuxels(const std::string& map, const World& world, const MaterialLibrary& materials, const LightSet& lights,
                 size_t count, bool json) {
    const LuxelReport r = checkLuxels(world, materials, lights, count, kSeed, throwIfInterrupted);
    if (json) {
        const nlohmann::ordered_json line = {{"map", map},
                                             {"triangle_lights", lights.triangles.size()},
                                             {"points", r.pointCount},
                                             {"mean_baked", r.meanBaked},
                                             {"mean_traced", r.meanTraced},
                                             {"mean_surfaces", r.meanSurfaces},
                                             {"mean_sun", r.meanSun},
                                             {"mean_sky", r.meanSky},
                                             {"mean_points", r.meanPoints},
                                             {"correlation", r.correlation},
                                             {"slope", r.slope},
                                             {"explained_share", r.explainedShare},
                                             {"median_ratio", r.medianRatio}};
        std::printf("%s\n", toJsonText(line).c_str());
    } else {
        std::printf("%-18s %6zu %8.1f %8.1f %7.1f %7.1f %7.1f %7.1f %6.2f %6.2f %8.0f%% %6.2f\n", map.c_str(),
                    lights.triangles.size(), r.meanBaked, r.meanTraced, r.meanSurfaces, r.meanSun, r.meanSky,
                    r.meanPoints, r.correlation, r.slope, 100 * r.explainedShare, r.medianRatio);
    }
    std::fflush(stdout);
}

} // namespace q3rt
