// Acceleration structures and a ray-tracing pipeline on one triangle.

#include <array>
#include <cstring>

#include "gpu/acceleration_structure.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/ray_tracing_pipeline.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "gpu_test.hpp"
#include "spirv/shaders_one_ray_rchit.hpp"
#include "spirv/shaders_one_ray_rgen.hpp"
#include "spirv/shaders_one_ray_rmiss.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kSide = 16; // rays a row
constexpr float kIdentity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

class RayTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped()) return;
        if (!device().capabilities().rayTracingPipeline)
            GTEST_SKIP() << device().capabilities().deviceName << " has no ray-tracing pipelines";
    }

    /// t of each ray of the grid, -1 for a miss.
    std::vector<float> traceGrid(const RayTracingPipeline& pipeline, const DescriptorLayout& layout,
                                 const AccelerationStructure& top) {
        const Buffer distances(device(), {.size = kSide * kSide * sizeof(float)});
        DescriptorArena arena(device());
        const VkDescriptorSet set =
            arena.make(layout, {bindAccelerationStructure(0, top.handle()), bindStorageBuffer(1, distances.handle())});
        device().submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.bindSets(commands, {set});
            pipeline.warmUp(commands);
            pipeline.trace(commands, kSide, kSide);
        });
        const std::vector<std::byte> bytes = readBuffer(device(), distances);
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }
};

/// Rays that hit at distance `t`.
size_t countHits(const std::vector<float>& values, float t) {
    size_t hits = 0;
    for (const float value : values)
        hits += value == t;
    return hits;
}

constexpr VkBufferUsageFlags kInput =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

/// The triangle (-1, -1), (1, -1), (-1, 1): the half of the grid with x + y < 0.
struct Triangle {
    explicit Triangle(Device& device)
        : vertices(device, {.size = 9 * sizeof(float), .usage = kInput})
        , indices(device, {.size = 3 * sizeof(uint32_t), .usage = kInput})
        , geometry{.vertices = vertices.address(), .vertexCount = 3, .indices = indices.address(), .triangleCount = 1} {
        const uint32_t order[3] = {0, 1, 2};
        Uploader uploader(device);
        uploader.upload(indices, std::span<const uint32_t>(order));
        uploader.flush();
        moveTo(device, -1);
    }
    void moveTo(Device& device, float z) {
        const float positions[9] = {-1, -1, z, 1, -1, z, -1, 1, z};
        Uploader uploader(device);
        uploader.upload(vertices, std::span<const float>(positions));
        uploader.flush();
    }
    Buffer vertices;
    Buffer indices;
    TriangleGeometry geometry;
};

TEST_F(RayTest, RaysHitATriangleAlsoAfterUpdateAndCompaction) {
    Triangle triangle(device()); // at z = -1: 2 from the rays' origin
    const TriangleGeometry& geometry = triangle.geometry;
    AccelerationStructure bottom = AccelerationStructure::makeBottom(
        device(), geometry, {.allowUpdate = true, .allowCompaction = true, .name = "triangle"});
    AccelerationStructure top = AccelerationStructure::makeTop(device(), 4, {.name = "scene"});
    AccelerationScratch scratch(device());
    const Buffer instances(
        device(),
        {.size = sizeof(VkAccelerationStructureInstanceKHR) * 4, .usage = kInput, .domain = MemoryDomain::Upload});
    const auto buildTop = [&](VkCommandBuffer commands) {
        const auto instance = makeInstance(bottom, kIdentity, 7, 0xff, 0, 0);
        std::memcpy(instances.mapped(), &instance, sizeof(instance));
        top.recordBuildTop(commands, scratch, instances.address(), 1);
        recordBuildBarrier(device(), commands);
    };
    device().submitAndWait([&](VkCommandBuffer commands) {
        recordBuilds(commands, scratch, std::array{BottomBuild{&bottom, geometry}});
        recordBuildBarrier(device(), commands);
        buildTop(commands);
    });

    const DescriptorLayout layout(device(), {{0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}, {1}});
    const RayTracingPipeline pipeline(device(), {.name = "one ray",
                                                 .rayGeneration = {shaders::shaders_one_ray_rgen},
                                                 .misses = {{shaders::shaders_one_ray_rmiss}},
                                                 .hitGroups = {{.closestHit = {shaders::shaders_one_ray_rchit}}},
                                                 .interface = {{layout.handle()}},
                                                 .stackBytes = 256});
    std::vector<float> values = traceGrid(pipeline, layout, top);
    // Pixels (i, j) with i + j + 1 < 16 lie inside; those on the diagonal may fall either way.
    constexpr size_t kInside = kSide * (kSide - 1) / 2;
    EXPECT_GE(countHits(values, 2.0f), kInside);
    EXPECT_LE(countHits(values, 2.0f), kInside + kSide);
    EXPECT_EQ(countHits(values, 2.0f) + countHits(values, -1.0f), values.size());

    // Moved one unit away from the rays, refitted.
    triangle.moveTo(device(), -2);
    device().submitAndWait([&](VkCommandBuffer commands) {
        recordBuildInputBarrier(commands);
        bottom.recordUpdate(commands, scratch, geometry);
        recordBuildBarrier(device(), commands);
        buildTop(commands);
    });
    EXPECT_GE(countHits(traceGrid(pipeline, layout, top), 3.0f), kInside);

    AccelerationStructure* structures[] = {&bottom};
    compactStructures(device(), structures);
    device().submitAndWait([&](VkCommandBuffer commands) {
        recordBuildInputBarrier(commands);
        buildTop(commands);
    });
    EXPECT_GE(countHits(traceGrid(pipeline, layout, top), 3.0f), kInside);
    EXPECT_THROW(top.recordBuildTop(VK_NULL_HANDLE, scratch, instances.address(), 5), UsageError);
}

} // namespace
} // namespace q3rt
