// Rays a second of the back end `compute` on the device and of Embree's robust single rays, on the same rays in one
// run: camera rays of a map's player start, and a shadow ray from each hit to one of many points.
//   bench_rays [MAP [WIDTHxHEIGHT]]

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <numeric>
#include <vector>

#include "accel/bvh.hpp"
#include "accel/reference/embree_tracer.hpp"
#include "accel/reference/world_triangles.hpp"
#include "accel/shader_traversal.hpp"
#include "gpu/compute_pipeline.hpp"
#include "gpu/device.hpp"
#include "gpu/readback.hpp"
#include "rays_push.h"
#include "spirv/rays_any.hpp"
#include "spirv/rays_closest.hpp"
#include "spirv/roped_any.hpp"
#include "spirv/roped_closest.hpp"
#include "support/game_data.hpp"

namespace {

using namespace q3rt;
using namespace q3rt::test;

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
constexpr size_t kLightCount = 64;
/// What is hit is left behind by this much, relative to the distance, so that few shadow rays meet it again.
constexpr float kAway = 1e-3f;
constexpr double kShortestRoundSeconds = 0.5;
constexpr int kRounds = 5;

double now(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds of one call of `work`: the least of some rounds; other programs only ever add time.
template <typename Work>
double measure(clockid_t clock, Work work) {
    work();
    double best = 1e30;
    for (int round = 0; round < kRounds; ++round) {
        const double start = now(clock);
        int calls = 0;
        for (; calls == 0 || now(clock) - start < kShortestRoundSeconds; ++calls)
            work();
        best = std::min(best, (now(clock) - start) / calls);
    }
    return best;
}

template <typename T>
Buffer upload(Device& device, const std::vector<T>& items) {
    Buffer buffer(device, {.size = items.size() * sizeof(T), .usage = kUsage, .domain = MemoryDomain::Upload});
    Buffer local(device, {.size = buffer.size(), .usage = kUsage});
    std::memcpy(buffer.mapped(), items.data(), items.size() * sizeof(T));
    device.submitAndWait([&](VkCommandBuffer commands) {
        const VkBufferCopy all{0, 0, buffer.size()};
        vkCmdCopyBuffer(commands, buffer.handle(), local.handle(), 1, &all);
    });
    return local;
}

/// Boxes below a node, each before those that it holds.
void appendRoped(const Bvh& bvh, uint32_t index, std::vector<RopedBox>& out) {
    const BvhNode& node = bvh.nodes[index];
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        const Bounds box = childBounds(node, slot);
        if (box.empty()) continue;
        const size_t at = out.size();
        const uint32_t child = node.child[slot];
        const bool leaf = (child & kBvhLeafBit) != 0;
        out.push_back({box.mins, 0, box.maxs, leaf ? child : 0});
        if (!leaf) appendRoped(bvh, child, out);
        out[at].skip = static_cast<uint32_t>(out.size());
    }
}

/// Our own tree, its addresses those of the device.
struct DeviceTree {
    Buffer nodes, triangles, sceneNodes, instances, ropedBoxes;
    uint32_t boxCount = 0;
    float reach = 0;

    DeviceTree(Device& device, const Bvh& bvh, const std::vector<vec3>& positions) {
        nodes = upload(device, bvh.nodes);
        triangles = upload(device, leafTriangles(bvh, positions, {}));
        sceneNodes = upload(device, buildSah({&bvh.bounds, 1}, {.maxLeafItems = 1}).nodes);
        std::vector<RopedBox> boxes;
        appendRoped(bvh, 0, boxes);
        ropedBoxes = upload(device, boxes);
        boxCount = static_cast<uint32_t>(boxes.size());
        reach = bvh.nodes[0].reach;
        instances = upload(device, std::vector{instanceInPlace(nodes.address(), triangles.address(), 0xff)});
    }
};

/// Camera rays, 90 degrees wide, level, from the map's first player start.
std::vector<BenchRay> cameraRays(const WorldTriangles& world, glm::uvec2 size) {
    std::vector<BenchRay> rays;
    const float unit = 2.0f / static_cast<float>(size.x);
    for (uint32_t y = 0; y < size.y; ++y)
        for (uint32_t x = 0; x < size.x; ++x)
            rays.push_back(
                {world.playerStart(),
                 glm::normalize(vec3(1, 1 - (static_cast<float>(x) + 0.5f) * unit,
                                     (0.5f * static_cast<float>(size.y) - static_cast<float>(y) - 0.5f) * unit))});
    return rays;
}

/// From what the rays hit to points of the map, t = 1 there. A ray that hit nothing becomes one of no length.
std::vector<BenchRay> shadowRays(const WorldTriangles& world, const std::vector<BenchRay>& rays,
                                 const EmbreeTracer& embree) {
    const std::vector<vec3> lights = world.pointsInside(kLightCount, 1);
    std::vector<BenchRay> shadows;
    uint32_t random = 1;
    for (const BenchRay& ray : rays) {
        const EmbreeHit hit = embree.closest(ray.origin, ray.direction, world.farQu());
        const vec3 origin = ray.origin + ray.direction * (hit.t * (1 - kAway));
        random = random * 1664525u + 1013904223u; // Numerical Recipes, 7.1
        shadows.push_back({origin, hit.hit ? lights[(random >> 16) % kLightCount] - origin : vec3(0, 0, 1e-3f)});
    }
    return shadows;
}

enum class Traversal { Stack, Roped };

/// Traces by the device; `hits`: how many of the rays hit.
double deviceSeconds(Device& device, const ShaderStage& shader, const DeviceTree& tree, Traversal traversal,
                     const std::vector<BenchRay>& rays, glm::uvec2 size, float tMax, size_t& hits) {
    const Buffer input = upload(device, rays);
    const Buffer results(device, {.size = rays.size() * sizeof(float), .usage = kUsage});
    const RaysPush push{.rays = input.address(),
                        .results = results.address(),
                        .treeNodes = (traversal == Traversal::Roped ? tree.ropedBoxes : tree.sceneNodes).address(),
                        .treeInstances = tree.instances.address(),
                        .width = size.x,
                        .height = size.y,
                        .tMax = tMax,
                        .boxCount = tree.boxCount,
                        .reach = tree.reach};
    const ComputePipeline pipeline(device, {.name = "rays", .shader = shader, .interface = {{}, sizeof(RaysPush)}});
    constexpr int kDispatches = 8; // in a row, so that their submission does not count on a GPU
    const auto trace = [&] {
        device.submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.push(commands, push);
            const VkMemoryBarrier order{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                        .dstAccessMask = VK_ACCESS_SHADER_WRITE_BIT};
            for (int i = 0; i < kDispatches; ++i) {
                pipeline.dispatchOver(commands, {size.x, size.y});
                vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &order, 0, nullptr, 0, nullptr);
            }
        });
    };
    // A software device computes on this process's time, however busy the machine is.
    const bool software = device.capabilities().software;
    const double seconds = measure(software ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, trace) / kDispatches;
    const std::vector<std::byte> read = readBuffer(device, results);
    hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        float t = 0;
        std::memcpy(&t, &read[i * sizeof(float)], sizeof(float));
        hits += t > 0 ? 1 : 0;
    }
    return seconds;
}

/// Prints the mean and the 95th percentile of what a ray costs: the same text of the traversal, run on the CPU.
void printWork(const char* what, const TestScene& scene, const std::vector<BenchRay>& rays, float tMax, bool anyHit) {
    std::vector<uint64_t> visits, tests;
    for (const BenchRay& ray : rays) {
        const TestHit hit = traceShader(scene, ray.origin, ray.direction, 0, tMax, 0xff, anyHit);
        visits.push_back(hit.visitCount);
        tests.push_back(hit.testCount);
    }
    std::printf("%-8s", what);
    for (std::vector<uint64_t>* counts : {&visits, &tests}) {
        std::sort(counts->begin(), counts->end());
        std::printf(" %8.2f (%3llu)",
                    static_cast<double>(std::accumulate(counts->begin(), counts->end(), uint64_t{0})) /
                        static_cast<double>(counts->size()),
                    static_cast<unsigned long long>((*counts)[counts->size() * 95 / 100]));
    }
    std::printf("\n");
}

template <typename Trace>
double embreeSeconds(const std::vector<BenchRay>& rays, size_t& hits, Trace trace) {
    return measure(CLOCK_THREAD_CPUTIME_ID, [&] {
        hits = 0;
        for (const BenchRay& ray : rays)
            hits += trace(ray) ? 1 : 0;
    });
}

void printRow(const char* what, size_t count, double ours, double embree, const size_t hits[2]) {
    const double rate = static_cast<double>(count) * 1e-6;
    std::printf("%-8s %10.2f %10.2f %8.2f   %zu and %zu of %zu hit\n", what, rate / ours, rate / embree, embree / ours,
                hits[0], hits[1], count);
}

void compare(Device& device, FileSource& files, const char* map, glm::uvec2 size) {
    const WorldTriangles world(files, map);
    const EmbreeTracer embree(world.positions());
    const Bvh bvh = buildSah(triangleBounds(world.positions()), {.reinsert = true});
    const DeviceTree tree(device, bvh, world.positions());
    std::printf("%s, %zu triangles, %ux%u rays, %s\n", map, world.count(), size.x, size.y,
                device.capabilities().deviceName.c_str());
    const std::vector<BenchRay> rays = cameraRays(world, size);
    const std::vector<BenchRay> shadows = shadowRays(world, rays, embree);
    TestScene scene;
    scene.instances.push_back(scene.addModel(bvh, world.positions()));
    scene.buildScene({bvh.bounds});
    std::printf("a ray: node visits (95 %% need no more), triangle tests\n");
    printWork("camera", scene, rays, world.farQu(), false);
    printWork("shadow", scene, shadows, 1, true);
    std::printf("Mrays/s     device     Embree    ratio   (a software device: of one core)\n");
    // As renderer_rt/backend.cpp has it.
    const std::vector<uint32_t> traversal{device.capabilities().software ? 0u : 1u};
    size_t hits[2];
    double ours = deviceSeconds(device, {shaders::rays_closest, traversal}, tree, Traversal::Stack, rays, size,
                                world.farQu(), hits[0]);
    double reference = embreeSeconds(rays, hits[1], [&](const BenchRay& ray) {
        return embree.closest(ray.origin, ray.direction, world.farQu()).hit;
    });
    printRow("camera", rays.size(), ours, reference, hits);
    double sum[2] = {ours, reference};
    ours = deviceSeconds(device, {shaders::rays_any, traversal}, tree, Traversal::Stack, shadows, size, 1, hits[0]);
    reference = embreeSeconds(shadows, hits[1],
                              [&](const BenchRay& ray) { return embree.occluded(ray.origin, ray.direction, 1); });
    printRow("shadow", rays.size(), ours, reference, hits);
    std::printf("both     %10.2f %10.2f %8.2f   %.3f ms on the device\n",
                2e-6 * static_cast<double>(rays.size()) / (sum[0] + ours),
                2e-6 * static_cast<double>(rays.size()) / (sum[1] + reference), (sum[1] + reference) / (sum[0] + ours),
                1e3 * (sum[0] + ours));
    const double roped[2] = {
        deviceSeconds(device, {shaders::roped_closest, {}}, tree, Traversal::Roped, rays, size, world.farQu(), hits[0]),
        deviceSeconds(device, {shaders::roped_any, {}}, tree, Traversal::Roped, shadows, size, 1, hits[1])};
    const double rate = static_cast<double>(rays.size()) * 1e-6;
    std::printf("by skip links instead of a stack: camera %.2f, shadow %.2f; %zu and %zu hit\n", rate / roped[0],
                rate / roped[1], hits[0], hits[1]);
}

} // namespace

int main(int argc, char** argv) {
    const auto files = openGameData();
    if (!files) {
        std::fprintf(stderr, "%s\n", kNoGameData);
        return 1;
    }
    glm::uvec2 size(320, 240);
    if (argc > 2 && std::sscanf(argv[2], "%ux%u", &size.x, &size.y) != 2) {
        std::fprintf(stderr, "bench_rays [MAP [WIDTHxHEIGHT]]: %s is no size\n", argv[2]);
        return 2;
    }
    try {
        Device device;
        compare(device, *files, argc > 1 ? argv[1] : "oa_minia", size);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
