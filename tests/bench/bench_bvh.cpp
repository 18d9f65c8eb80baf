// Builders of our own trees on one core: from the drawn triangles of whole maps to what the shaders read. And what a
// frame does: the scene tree over its instances, and a model's boxes moved.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include <benchmark/benchmark.h>

#include "accel/reference/world_triangles.hpp"
#include "renderer_rt/scene_trees.hpp"
#include "support/game_data.hpp"

namespace {

using namespace q3rt;
using namespace q3rt::test;

constexpr size_t kModelTriangles = 1000;
constexpr int kInstances = 500;

const WorldTriangles& worldOf(const std::string& map) {
    static std::map<std::string, WorldTriangles> worlds;
    static const auto files = openGameData();
    if (!files) {
        std::fprintf(stderr, "%s\n", kNoGameData);
        std::exit(1);
    }
    return worlds.try_emplace(map, *files, map).first->second;
}

using Build = Bvh (*)(std::span<const Bounds>, const BvhBuildSettings&);
/// What is loaded once.
Bvh buildLasting(std::span<const Bounds> items, const BvhBuildSettings&) { return buildSah(items, {.reinsert = true}); }
Bvh buildPaired(std::span<const Bounds> items, const BvhBuildSettings&) { return buildPairing(items); }

size_t buildWhole(Build build, const std::vector<vec3>& positions) {
    const Bvh bvh = build(triangleBounds(positions), {});
    return bvh.nodes.size() + leafTriangles(bvh, positions).size();
}

void count(benchmark::State& state, size_t triangles) {
    state.counters["triangles"] = static_cast<double>(triangles);
    state.counters["us_per_triangle"] =
        benchmark::Counter(static_cast<double>(triangles) / 1e6,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void buildMap(benchmark::State& state, const char* map, Build build) {
    const std::vector<vec3>& positions = worldOf(map).positions();
    for (auto _ : state)
        benchmark::DoNotOptimize(buildWhole(build, positions));
    count(state, positions.size() / 3);
    state.counters["sah_cost"] = surfaceAreaCost(build(triangleBounds(positions), {}));
}

/// The baseline, and how many times as long as the others it takes.
void buildBaseline(benchmark::State& state, const char* map) {
    const std::vector<vec3>& positions = worldOf(map).positions();
    const auto secondsOf = [&](Build build) {
        const auto start = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(buildWhole(build, positions));
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    double pairing = 1e30, sah = 1e30, morton = 1e30;
    for (auto _ : state) {
        pairing = std::min(pairing, secondsOf(buildPaired));
        state.PauseTiming();
        sah = std::min({sah, secondsOf(buildSah), secondsOf(buildSah)});
        morton = std::min({morton, secondsOf(buildMorton), secondsOf(buildMorton)});
        state.ResumeTiming();
    }
    count(state, positions.size() / 3);
    state.counters["times_sah"] = pairing / sah;
    state.counters["times_morton"] = pairing / morton;
}

/// Triangles that move a little from frame to frame, as those of an animated model.
void refitModel(benchmark::State& state) {
    std::vector<vec3> positions = worldOf("oacmpctf3").positions();
    positions.resize(3 * kModelTriangles);
    Bvh bvh = buildSah(triangleBounds(positions));
    const std::vector<BvhTriangle> still = leafTriangles(bvh, positions);
    for (vec3& p : positions)
        p.z += std::sin(p.x);
    const std::vector<BvhTriangle> moved = leafTriangles(bvh, positions);
    bool turn = false;
    for (auto _ : state)
        benchmark::DoNotOptimize(refit(bvh, (turn = !turn) ? moved : still));
}

void buildScene(benchmark::State& state) {
    const WorldTriangles& world = worldOf("oacmpctf3");
    std::mt19937 random(1);
    std::vector<TreeInstance> instances;
    for (const vec3& place : world.pointsInside(kInstances, 1)) {
        TreeInstance instance;
        instance.tree.bounds = {vec3(-24), vec3(24, 24, 40)};
        const float yaw = std::uniform_real_distribution<float>(0, 6.28f)(random);
        instance.worldFromModel[0] = {std::cos(yaw), std::sin(yaw), 0, 0};
        instance.worldFromModel[1] = {-std::sin(yaw), std::cos(yaw), 0, 0};
        instance.worldFromModel[3] = vec4(place, 1);
        instance.masks[0] = 0xff;
        instances.push_back(instance);
    }
    for (auto _ : state)
        benchmark::DoNotOptimize(buildSceneTree(instances).nodes.data());
}

} // namespace

BENCHMARK_CAPTURE(buildMap, sah / fan, "fan", buildSah)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, sah / oacmpctf3, "oacmpctf3", buildSah)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, sah / czest2ctf, "czest2ctf", buildSah)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, lasting / fan, "fan", buildLasting)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, lasting / oacmpctf3, "oacmpctf3", buildLasting)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, lasting / czest2ctf, "czest2ctf", buildLasting)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, morton / fan, "fan", buildMorton)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, morton / oacmpctf3, "oacmpctf3", buildMorton)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildMap, morton / czest2ctf, "czest2ctf", buildMorton)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildBaseline, fan, "fan")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(buildBaseline, oacmpctf3, "oacmpctf3")->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK_CAPTURE(buildBaseline, czest2ctf, "czest2ctf")->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(refitModel)->Unit(benchmark::kMicrosecond);
BENCHMARK(buildScene)->Unit(benchmark::kMicrosecond);
