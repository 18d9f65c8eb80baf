// Shadow rays of a map moved far from the origin, and of the map as a rotated instance, traced on the device by every
// back end that it has.

#include <array>
#include <cstring>

#include "gpu/acceleration_structure.hpp"
#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/gpu_test.hpp"
#include "gpu/ray_tracing_pipeline.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "numerics/measured.hpp"
#include "numerics/shadow_cases.hpp"
#include "renderer_rt/backend.hpp"
#include "shaders/shared/constants.h"
#include "shadow_push.h"
#include "spirv/shaders_shadow_rays_rgen.hpp"
#include "spirv/shadow_rays_compute.hpp"
#include "spirv/shadow_rays_query.hpp"
#include "spirv/trace_record_rchit.hpp"
#include "spirv/trace_record_rmiss.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                      VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

template <typename T>
Buffer upload(Device& device, const std::vector<T>& items) {
    Buffer buffer(device, {.size = items.size() * sizeof(T), .usage = kUsage, .name = "input"});
    Uploader uploader(device);
    uploader.upload(buffer, std::span<const T>(items));
    uploader.flush();
    return buffer;
}

/// The map as the driver has it.
struct DriverScene {
    Buffer corners, instances;
    AccelerationStructure bottom, top;
};

DriverScene buildDriverScene(Device& device, const PlacedMap& map) {
    DriverScene scene;
    scene.corners = upload(device, map.corners);
    const TriangleGeometry geometry{.vertices = scene.corners.address(),
                                    .vertexCount = static_cast<uint32_t>(map.corners.size()),
                                    .indexed = false,
                                    .triangleCount = static_cast<uint32_t>(map.corners.size() / 3)};
    scene.bottom = AccelerationStructure::makeBottom(device, geometry, {.name = "map"});
    scene.top = AccelerationStructure::makeTop(device, 1, {.name = "scene"});
    float rows[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    if (map.placement.rotation) std::memcpy(rows, map.placement.worldFromModel, sizeof(rows));
    scene.instances = upload(device, std::vector{makeInstance(scene.bottom, rows, 0, 0xff, 0, 0)});
    AccelerationScratch scratch(device);
    device.submitAndWait([&](VkCommandBuffer commands) {
        recordBuilds(commands, scratch, std::array{BottomBuild{&scene.bottom, geometry}});
        recordBuildBarrier(device, commands);
        scene.top.recordBuildTop(commands, scratch, scene.instances.address(), 1);
        recordBuildBarrier(device, commands);
    });
    return scene;
}

/// Our own tree, its addresses those of the device.
struct TreeScene {
    Buffer nodes, triangles, sceneNodes, instances;
};

TreeScene uploadTree(Device& device, const PlacedMap& map) {
    TreeScene tree;
    const TestScene::Model& model = map.scene.models.front();
    tree.nodes = upload(device, model.nodes);
    tree.triangles = upload(device, model.triangles);
    tree.sceneNodes = upload(device, map.scene.sceneNodes);
    BvhInstance instance = map.scene.instances.front();
    instance.nodes = tree.nodes.address();
    instance.triangles = tree.triangles.address();
    tree.instances = upload(device, std::vector{instance});
    return tree;
}

class DeviceShadowRays : public GpuTest {
  protected:
    /// Which lights are seen, by case.
    std::vector<uint32_t> trace(Backend backend, const PlacedMap& map) {
        std::vector<ShadowInput> inputs;
        for (const ShadowCase& c : map.cases) {
            const vec3* corner = &map.corners[size_t{3} * c.triangle];
            inputs.push_back({{corner[0], corner[1], corner[2]}, c.barycentric, c.normal, c.light});
        }
        const Buffer rays = upload(device(), inputs);
        const Buffer results(device(), {.size = inputs.size() * sizeof(uint32_t), .usage = kUsage});
        ShadowPush push{.rays = rays.address(),
                        .results = results.address(),
                        .count = static_cast<uint32_t>(inputs.size()),
                        .instanced = map.placement.rotation ? 1u : 0u};
        std::copy(std::begin(map.placement.worldFromModel), std::end(map.placement.worldFromModel),
                  push.worldFromModel);
        if (usesStructures(backend)) {
            push.inverseError = kMatrixInverseError;
            traceByDriver(backend, buildDriverScene(device(), map), push);
        } else {
            traceByTree(uploadTree(device(), map), push);
        }
        const std::vector<std::byte> read = readBuffer(device(), results);
        std::vector<uint32_t> seen(inputs.size());
        std::memcpy(seen.data(), read.data(), read.size());
        return seen;
    }

  private:
    void traceByTree(const TreeScene& tree, ShadowPush push) {
        push.treeNodes = tree.sceneNodes.address();
        push.treeInstances = tree.instances.address();
        const ComputePipeline pipeline(
            device(),
            {.name = "shadow rays", .shader = {shaders::shadow_rays_compute}, .interface = {{}, sizeof(ShadowPush)}});
        device().submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.push(commands, push);
            pipeline.dispatch(commands, (push.count + 63) / 64);
        });
    }

    void traceByDriver(Backend backend, const DriverScene& scene, const ShadowPush& push) {
        // The back ends keep their structure in set 1.
        const DescriptorLayout nothing(device(), {});
        const DescriptorLayout layout(device(), {{0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}});
        DescriptorArena arena(device());
        const VkDescriptorSet empty = arena.make(nothing, {});
        const VkDescriptorSet set = arena.make(layout, {bindAccelerationStructure(0, scene.top.handle())});
        const PipelineInterface interface { {nothing.handle(), layout.handle()}, sizeof(ShadowPush) };
        const auto record = [&](const Pipeline& pipeline, VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.bindSets(commands, {empty, set});
            pipeline.push(commands, push);
        };
        if (backend == Backend::Query) {
            const ComputePipeline pipeline(
                device(), {.name = "shadow rays", .shader = {shaders::shadow_rays_query}, .interface = interface});
            device().submitAndWait([&](VkCommandBuffer commands) {
                record(pipeline, commands);
                pipeline.dispatch(commands, (push.count + 63) / 64);
            });
            return;
        }
        const RayTracingPipeline pipeline(device(), {.name = "shadow rays",
                                                     .rayGeneration = {shaders::shaders_shadow_rays_rgen},
                                                     .misses = {{shaders::trace_record_rmiss}},
                                                     .hitGroups = {{.closestHit = {shaders::trace_record_rchit}}},
                                                     .interface = interface});
        device().submitAndWait([&](VkCommandBuffer commands) {
            record(pipeline, commands);
            pipeline.trace(commands, push.count);
        });
    }
};

TEST_F(DeviceShadowRays, NeitherShadowThemselvesNorLeak) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const WorldTriangles world(*files, "oa_minia");
    const Capabilities& can = device().capabilities();
    std::printf("device: %s\n", can.deviceName.c_str());
    for (const bool rotated : {false, true})
        for (const float distance : {0.0f, 8000.0f, -16384.0f, -65536.0f, 65536.0f, 1e6f}) {
            const PlacedMap map = makeShadowCases(world, makePlacement(distance, rotated));
            for (const Backend backend : {Backend::Compute, Backend::Query, Backend::Pipeline}) {
                if (!isAvailable(backend, can)) continue;
                const std::vector<uint32_t> seen = trace(backend, map);
                size_t wronglyShadowed = 0, wronglyLit = 0;
                for (size_t i = 0; i < seen.size(); ++i) {
                    wronglyShadowed += !seen[i] && !map.cases[i].hidden;
                    wronglyLit += seen[i] && map.cases[i].hidden;
                }
                const std::string name = std::string(nameOf(backend)) + (rotated ? ", rotated instance" : "") + " at " +
                                         std::to_string(static_cast<int>(distance));
                // A driver turns rays about the world's zero: far from it, they miss what they aim at.
                const bool turnedByDriver = rotated && usesStructures(backend);
                const bool claimed = std::abs(distance) <= (turnedByDriver ? 8000.0f : 65536.0f);
                expectCount("wrongly shadowed, " + name, wronglyShadowed, seen.size(), claimed ? 1 : seen.size());
                expectCount("wrongly lit, " + name, wronglyLit, seen.size(), claimed ? 0 : seen.size());
            }
        }
}

} // namespace
} // namespace q3rt::test
