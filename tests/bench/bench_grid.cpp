// What a map's walls are lit by in the picture, beside what its lightmap holds: the lights of lights/MAP.ent, without
// bounces, and the light grid's share on top of them, at luxels that the grid was not fitted to.
//
//   bench_grid [--without] [MAP...]   without names all maps of the game; --without: as if there were no files

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
#include "renderer_rt/light_probe.hpp"
#include "renderer_rt/prepared_lights.hpp"
#include "renderer_rt/surface_class.hpp"
#include "scene/luxels.hpp"
#include "shaders/shared/constants.h"

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
    float baked = 0, lights = 0, all = 0; ///< largest channel, luxel units, no more than 255; 0 in all: covered
};

/// Of all places, how far off their mean is at the median, and at nine of ten.
std::pair<double, double> placeErrors(const std::vector<Compared>& luxels, float most) {
    std::map<std::array<int, 3>, std::vector<const Compared*>> places;
    for (const Compared& luxel : luxels)
        places[luxel.place].push_back(&luxel);
    std::vector<double> errors;
    for (const auto& [place, members] : places) {
        double all = 0, baked = 0;
        for (const Compared* luxel : members) {
            all += double(std::min(most, luxel->all));
            baked += double(std::min(most, luxel->baked));
        }
        if (members.size() >= kLuxelsOfPlace && baked > double(members.size()))
            errors.push_back(std::abs(all / baked - 1));
    }
    std::sort(errors.begin(), errors.end());
    if (errors.empty()) return {};
    return {errors[errors.size() / 2], errors[errors.size() * 9 / 10]};
}

/// The game as it is for a map that nobody made a file for.
class WithoutLights : public FileSource {
  public:
    explicit WithoutLights(FileSource& files)
        : m_files(files) {}
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        return name.starts_with("lights/") ? std::nullopt : m_files.read(name);
    }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return directory == "lights" ? std::vector<std::string>() : m_files.list(directory, extension);
    }

  private:
    FileSource& m_files;
};

void printMap(FileSource& files, const std::string& name) {
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + name + ".bsp", materials, WorldSettings{});
    const PreparedLights lights =
        prepareLights(files, *world, materials, textures, LightSource::RecoveredOrEstimated, {});
    const LightTables& tables = lights.tables;
    const ProbeGeometry geometry(*world, materials);
    const LightProbe probe(*world, geometry, tables);

    const std::vector<Luxel> luxels = sampleLuxels(*world, materials, LuxelFaces::AllBaked, kLuxels, kSeed);
    std::vector<Compared> compared(luxels.size());
    parallelFor(luxels.size(), [&](size_t i) {
        const Luxel& luxel = luxels[i];
        const vec3 point = luxel.position + kOffsetQu * luxel.normal;
        const bool thin = isThin(materials.get(world->surfaces[static_cast<size_t>(luxel.surface)].material));
        if (thin || world->clusterOf(point) < 0) return;
        std::mt19937 random(static_cast<unsigned>(i));
        const vec3 given = probe.look(point, luxel.normal, kRays, random).irradiance[0];
        const vec3 grid =
            lightOfGrid(tables.gridShape, tables.grid, {.position = luxel.position, .normal = luxel.normal});
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
    const auto [median, nine] = placeErrors(compared, 255);
    const auto [medianShown, nineShown] = placeErrors(compared, kWhiteIrradiance);
    double shown = 0, shownBaked = 0;
    for (const Compared& c : compared) {
        shown += double(std::min(kWhiteIrradiance, c.all));
        shownBaked += double(std::min(kWhiteIrradiance, c.baked));
    }
    std::printf(
        "%-16s %6.1f %6.1f %6.1f   %5.3f %5.3f   %3.0f %% %3.0f %%   %3.0f %% %3.0f %%   %5.3f %3.0f %% %3.0f %%\n",
        name.c_str(), b.meanBaked, a.meanTraced, b.meanTraced, a.correlation, b.correlation,
        100 * a.medianRelativeError, 100 * b.medianRelativeError, 100 * median, 100 * nine, shown / shownBaked,
        100 * medianShown, 100 * nineShown);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    try {
        const auto files = openGame({});
        std::vector<std::string> maps(argv + 1, argv + argc);
        const bool withFiles = std::erase(maps, "--without") == 0;
        if (maps.empty())
            for (const std::string& file : files->list("maps", ".bsp"))
                maps.push_back(file.substr(0, file.size() - 4));
        std::printf("map              baked lights with grid  correlation  median error  places off by  as shown: "
                    "mean, places off by\n");
        WithoutLights without(*files);
        FileSource& source = withFiles ? static_cast<FileSource&>(*files) : without;
        for (const std::string& map : maps)
            printMap(source, map);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_grid: %s\n", error.what());
        return 1;
    }
    return 0;
}
