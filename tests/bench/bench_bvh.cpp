// Builders of our own trees: time a triangle on one core, by builder and by size. Synthetic surface: a height field
// with a tenth of long thin triangles, near what maps are made of; the map's own triangles are timed by `q3rt info`.

#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "accel/bvh.hpp"

namespace {

using namespace q3rt;

std::vector<Bounds> heightField(size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> noise(0, 1);
    const auto side = static_cast<size_t>(std::sqrt(static_cast<double>(count) / 2)) + 1;
    std::vector<vec3> positions;
    while (positions.size() < 3 * count) {
        const float x = static_cast<float>(positions.size() / 6 % side) * 64,
                    y = static_cast<float>(positions.size() / 6 / side) * 64;
        const float length = noise(random) < 0.1f ? 1024.0f : 64.0f;
        for (const vec3& p : {vec3(x, y, 0), vec3(x + length, y, 0), vec3(x, y + 64, 0)})
            positions.push_back(p + vec3(0, 0, 256 * std::sin(p.x / 700) + 16 * noise(random)));
    }
    positions.resize(3 * count);
    return triangleBounds(positions);
}

template <Bvh (*build)(std::span<const Bounds>, const BvhBuildSettings&)>
void buildTree(benchmark::State& state) {
    const std::vector<Bounds> boxes = heightField(static_cast<size_t>(state.range(0)));
    float cost = 0;
    for (auto _ : state)
        cost = surfaceAreaCost(build(boxes, {}));
    state.counters["us_per_triangle"] =
        benchmark::Counter(static_cast<double>(state.range(0)) / 1e6,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["sah_cost"] = cost;
}

void buildBaseline(benchmark::State& state) {
    const std::vector<Bounds> boxes = heightField(static_cast<size_t>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(buildPairing(boxes).nodes.data());
    state.counters["us_per_triangle"] =
        benchmark::Counter(static_cast<double>(state.range(0)) / 1e6,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void refitTree(benchmark::State& state) {
    const std::vector<Bounds> boxes = heightField(static_cast<size_t>(state.range(0)));
    Bvh bvh = buildSah(boxes);
    for (auto _ : state)
        benchmark::DoNotOptimize(refit(bvh, boxes));
}

} // namespace

BENCHMARK(buildTree<buildSah>)
    ->Name("sah")
    ->Arg(500)
    ->Arg(1000)
    ->Arg(29577)
    ->Arg(37152)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(buildTree<buildMorton>)
    ->Name("morton")
    ->Arg(500)
    ->Arg(1000)
    ->Arg(29577)
    ->Arg(37152)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(buildBaseline)->Name("pairing")->Arg(500)->Arg(1000)->Arg(3000)->Unit(benchmark::kMillisecond);
BENCHMARK(refitTree)->Name("refit")->Arg(1000)->Arg(37152)->Unit(benchmark::kMillisecond);
