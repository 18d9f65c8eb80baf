// Rays a second on one core: our traversal (the shader's text as C++) and Embree's robust single rays, on the same
// rays of whole maps; and how the time of a closest hit grows with the triangles, as an exponent.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include "accel/cpu_tracer.hpp"
#include "accel/reference/embree_tracer.hpp"
#include "accel/reference/world_triangles.hpp"
#include "support/game_data.hpp"

namespace {

using namespace q3rt;
using namespace q3rt::test;

constexpr size_t kRays = 100000;
constexpr int kRounds = 5;
constexpr size_t kManyTriangles = 1000000;

double processSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Rays {
    std::vector<vec3> origins, directions, lights;
    float farQu = 0;
};

/// Best of a few rounds: other programs only ever add time.
template <typename Trace>
double raysPerSecond(Trace trace, size_t& hits) {
    double best = 1e30;
    for (int round = 0; round < kRounds; ++round) {
        hits = 0;
        const double start = processSeconds();
        for (size_t i = 0; i < kRays; ++i)
            hits += trace(i) ? 1 : 0;
        best = std::min(best, processSeconds() - start);
    }
    return static_cast<double>(kRays) / best;
}

/// Prints a row; returns seconds a closest hit of our own.
double measure(const char* name, const std::vector<vec3>& positions, const Rays& rays) {
    const CpuTracer ours(positions);
    const EmbreeTracer embree(positions);
    CpuHit hit;
    size_t hits[4];
    const double rates[4] = {
        raysPerSecond([&](size_t i) { return ours.closest(rays.origins[i], rays.directions[i], 0, rays.farQu, hit); },
                      hits[0]),
        raysPerSecond([&](size_t i) { return embree.closest(rays.origins[i], rays.directions[i], rays.farQu).hit; },
                      hits[1]),
        raysPerSecond([&](size_t i) { return ours.occluded(rays.origins[i], rays.lights[i] - rays.origins[i], 1); },
                      hits[2]),
        raysPerSecond([&](size_t i) { return embree.occluded(rays.origins[i], rays.lights[i] - rays.origins[i], 1); },
                      hits[3])};
    std::printf("%-12s %9zu %8.2f %8.2f %6.2f %10.2f %8.2f %6.2f   hits %zu %zu, shadowed %zu %zu\n", name,
                positions.size() / 3, rates[0] * 1e-6, rates[1] * 1e-6, rates[0] / rates[1], rates[2] * 1e-6,
                rates[3] * 1e-6, rates[2] / rates[3], hits[0], hits[1], hits[2], hits[3]);
    std::fflush(stdout);
    return 1 / rates[0];
}

/// One map side by side until there are `count` triangles; the rays stay in the first copy.
std::vector<vec3> repeatMap(const WorldTriangles& world, size_t count) {
    std::vector<vec3> positions;
    for (int copy = 0; positions.size() < 3 * count; ++copy)
        for (const vec3& p : world.positions())
            positions.push_back(p + vec3(static_cast<float>(copy) * world.farQu(), 0, 0));
    return positions;
}

} // namespace

int main() {
    const auto files = openGameData();
    if (!files) {
        std::fprintf(stderr, "%s\n", kNoGameData);
        return 1;
    }
    std::printf("Mrays/s, one core      closest: ours  Embree  ratio  any hit: ours  Embree  ratio\n");
    double repeatedExponent = 0;
    double sumX = 0, sumY = 0, sumXX = 0, sumXY = 0, count = 0;
    for (const char* map : {"fan", "oa_dm1", "oa_minia", "oa_thor", "oacmpctf3", "czest2ctf"}) {
        const WorldTriangles world(*files, map);
        const Rays rays{world.pointsInside(kRays, 1), unitDirections(kRays, 3), world.pointsInside(kRays, 2),
                        world.farQu()};
        const double x = std::log(static_cast<double>(world.count()));
        const double y = std::log(measure(map, world.positions(), rays));
        sumX += x;
        sumY += y;
        sumXX += x * x;
        sumXY += x * y;
        ++count;
        if (std::string_view(map) != "oacmpctf3") continue;
        const std::vector<vec3> many = repeatMap(world, kManyTriangles);
        const double repeatedY = std::log(measure("  repeated", many, rays));
        repeatedExponent = (repeatedY - y) / (std::log(static_cast<double>(many.size()) / 3) - x);
    }
    std::printf("time of a closest hit ~ triangles^%.3f from fan to czest2ctf (least squares)\n",
                (count * sumXY - sumX * sumY) / (count * sumXX - sumX * sumX));
    std::printf("time of a closest hit ~ triangles^%.3f from oacmpctf3 to its repetition, the same rays\n",
                repeatedExponent);
    return 0;
}
