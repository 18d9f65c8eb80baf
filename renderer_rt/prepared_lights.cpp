#include "renderer_rt/prepared_lights.hpp"

#include <algorithm>

#include "base/log.hpp"
#include "renderer_rt/baked_strengths.hpp"
#include "renderer_rt/grid_fit.hpp"
#include "renderer_rt/row_sight.hpp"
#include "scene/lost_light_file.hpp"

namespace q3rt {
namespace {

void adjustStrengths(const World& world, const MaterialLibrary& materials, const TextureLibrary& textures,
                     const ProbeGeometry& geometry, LightSet& lights) {
    const std::vector<BakedStrength> strengths = estimateStrengths(world, materials, textures, geometry, lights);
    const auto changed = std::ranges::count_if(strengths, [](const BakedStrength& of) { return of.factor != 1; });
    if (changed > 0)
        logLine(LogLevel::Info, "%zd of %zu kinds of light are not in the lightmap as the scripts have them: adjusted",
                changed, strengths.size());
    applyStrengths(strengths, world, materials, lights);
}

} // namespace

PreparedLights prepareLights(FileSource& files, const World& world, const MaterialLibrary& materials,
                             const TextureLibrary& textures, LightSource source, const ModelLightScale& scale) {
    const ProbeGeometry geometry(world, materials);
    PreparedLights out{extractLights(world, materials), LightAnimation(materials, textures), {}};
    if (source == LightSource::RecoveredOrEstimated) {
        if (const auto lost = readLostLights(files, world))
            applyLostLights(*lost, world, materials, out.lights);
        else
            adjustStrengths(world, materials, textures, geometry, out.lights);
    }
    out.tables = buildLightTables(world, materials, out.lights, scale, out.animation);
    const LightProbe probe(world, geometry, out.tables);
    lookFromRows(probe, out.tables.rows);
    explainGrid(world, materials, probe, out.lights, out.tables);
    return out;
}

} // namespace q3rt
