// What a map's walls are lit by in the picture, beside what its lightmap holds: the lights of lights/MAP.ent, without
// bounces, and the light grid's share on top of them, at luxels that the grid was not fitted to.
//
//   bench_grid [MAP...]   without names all maps of the game

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "host/common/session.hpp"
#include "relight/light_score.hpp"
#include "renderer_rt/grid_fit.hpp"
#include "renderer_rt/grid_light.hpp"
#include "renderer_rt/surface_class.hpp"
#include "scene/lost_light_file.hpp"
#include "scene/luxels.hpp"

namespace {

using namespace q3rt;

constexpr size_t kLuxels = 20'000;
constexpr uint32_t kSeed = 2, kRays = 64; ///< the fit's seed is another one
constexpr float kOffsetQu = 1;
/// A place: as much as a view shows of it, and enough luxels to tell.
constexpr float kPlaceQu = 256;
constexpr size_t kLuxelsOfPlace = 10;

float largestOf(const vec3& v) { return std::max({v.x, v.y, v.z}); }

struct Compared {
    std::array<int, 3> place{};
    float baked = 0, lights = 0, all = 0; ///< largest channel, luxel units; 0 in all: covered
};

/// Of all places, how far off their mean is at the median, and at nine of ten.
std::pair<double, double> placeErrors(const std::vector<Compared>& luxels) {
    std::map<std::array<int, 3>, std::vector<const Compared*>> places;
    for (const Compared& luxel : luxels)
        places[luxel.place].push_back(&luxel);
    std::vector<double> errors;
    for (const auto& [place, members] : places) {
        double all = 0, baked = 0;
        for (const Compared* luxel : members) {
            all += double(luxel->all);
            baked += double(luxel->baked);
        }
        if (members.size() >= kLuxelsOfPlace && baked > double(members.size()))
            errors.push_back(std::abs(all / baked - 1));
    }
    std::sort(errors.begin(), errors.end());
    if (errors.empty()) return {};
    return {errors[errors.size() / 2], errors[errors.size() * 9 / 10]};
}

void printMap(Pk3FileSource& files, const std::string& name) {
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + name + ".bsp", materials, WorldSettings{});
    LightSet lights = extractLights(*world, materials);
    if (const auto lost = readLostLights(files, *world)) applyLostLights(*lost, *world, materials, lights);
    LightAnimation animation(materials, textures);
    LightTables tables = buildLightTables(*world, materials, lights, {}, animation);
    if (tables.grid.empty()) return;
    const LightProbe probe(*world, materials, tables);
    explainGrid(*world, materials, probe, lights, tables.grid);

    const std::vector<Luxel> luxels = sampleLuxels(*world, materials, LuxelFaces::AllBaked, kLuxels, kSeed);
    std::vector<Compared> compared(luxels.size());
    parallelFor(luxels.size(), [&](size_t i) {
        const Luxel& luxel = luxels[i];
        const vec3 point = luxel.position + kOffsetQu * luxel.normal;
        const bool thin = isThin(materials.get(world->surfaces[static_cast<size_t>(luxel.surface)].material));
        if (thin || world->clusterOf(point) < 0) return;
        std::mt19937 random(static_cast<unsigned>(i));
        const vec3 given = probe.look(point, luxel.normal, kRays, random).irradiance[0];
        const vec3 grid = lightOfGrid(world->grid, tables.grid, {.position = luxel.position, .normal = luxel.normal});
        const auto place = ivec3(glm::floor(luxel.position / kPlaceQu));
        const auto clamped = [](const vec3& v) { return std::min(255.0f, largestOf(v)); };
        compared[i] = {{place.x, place.y, place.z}, largestOf(luxel.baked), clamped(given), clamped(given + grid)};
    });
    std::erase_if(compared, [](const Compared& c) { return c.baked == 0 && c.lights == 0 && c.all == 0; });
    ScoreSum lightsAlone, all;
    for (const Compared& c : compared) {
        lightsAlone.add(double(c.lights), double(c.baked), 1);
        all.add(double(c.all), double(c.baked), 1);
    }
    const LightScore a = lightsAlone.result(), b = all.result();
    const auto [median, nine] = placeErrors(compared);
    std::printf("%-16s %6.1f %6.1f %6.1f   %5.3f %5.3f   %3.0f %% %3.0f %%   %3.0f %% %3.0f %%\n", name.c_str(),
                b.meanBaked, a.meanTraced, b.meanTraced, a.correlation, b.correlation, 100 * a.medianRelativeError,
                100 * b.medianRelativeError, 100 * median, 100 * nine);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    try {
        const auto files = openGame({});
        std::vector<std::string> maps(argv + 1, argv + argc);
        if (maps.empty())
            for (const std::string& file : files->list("maps", ".bsp"))
                maps.push_back(file.substr(0, file.size() - 4));
        std::printf("map              baked lights with grid  correlation  median error  places off by\n");
        for (const std::string& map : maps)
            printMap(*files, map);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_grid: %s\n", error.what());
        return 1;
    }
    return 0;
}
