// MarkFragments on a world of one floor (spec of world 8.2).

#include <gtest/gtest.h>

#include "scene_fixture.hpp"

namespace q3rt::test {
namespace {

/// A square floor at z = 0, 512 qu wide, in one leaf; `type` decides how it is stored.
World makeFloor(BspSurfaceType type, MaterialId material = 0) {
    World world;
    world.bsp.planes = {{vec3(0, 0, 1), 0}, {vec3(0, 0, -1), 0}};
    world.bsp.nodes = {BspNode{0, {-1, -2}, ivec3(-256), ivec3(256)}};
    world.bsp.leafs.resize(2);
    world.bsp.leafs[0].cluster = 0;
    world.bsp.leafs[0].leafSurfaceCount = 1;
    world.bsp.leafSurfaces = {0};
    WorldSurface surface;
    surface.type = type;
    surface.material = material;
    surface.plane = {vec3(0, 0, 1), 0};
    for (const vec3& corner : {vec3(-256, -256, 0), vec3(-256, 256, 0), vec3(256, 256, 0), vec3(256, -256, 0)}) {
        world.vertices.push_back(Vertex{corner, vec3(0, 0, 1)});
        surface.bounds.add(corner);
    }
    world.indices = {0, 1, 2, 0, 2, 3}; // clockwise from above
    surface.vertexCount = 4;
    surface.indexCount = 6;
    world.surfaces = {surface};
    return world;
}

struct Marks {
    std::vector<vec3> points;
    std::vector<MarkFragment> fragments;
    int count = 0;
};

/// A 32 qu square mark at height z, projected 20 qu down; clockwise as seen along the projection.
std::vector<vec3> makePolygon(float z) { return {{-16, -16, z}, {-16, 16, z}, {16, 16, z}, {16, -16, z}}; }

class MarksTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    SceneLibraries m_libraries{m_files};

    Marks mark(const World& world, const std::vector<vec3>& polygon, bool onSoups = false, size_t maxPoints = 384,
               size_t maxFragments = 128) {
        Marks marks;
        marks.count = MarkClipper().clip(world, m_libraries.materials, polygon, vec3(0, 0, -20), maxPoints,
                                         marks.points, maxFragments, marks.fragments, onSoups);
        return marks;
    }
};

TEST_F(MarksTest, FloorIsMarkedExactlyWhereThePolygonLies) {
    const Marks marks = mark(makeFloor(BspSurfaceType::Planar), makePolygon(8));
    ASSERT_EQ(marks.count, 2);
    float area = 0;
    for (const MarkFragment& fragment : marks.fragments) {
        const vec3* p = &marks.points[static_cast<size_t>(fragment.firstPoint)];
        for (int i = 2; i < fragment.pointCount; ++i) {
            area += 0.5f * glm::length(glm::cross(p[i - 1] - p[0], p[i] - p[0]));
        }
    }
    EXPECT_NEAR(area, 32 * 32, 1.0f);
    for (const vec3& point : marks.points) {
        EXPECT_EQ(point.z, 0.0f);
        EXPECT_LE(std::abs(point.x), 16.1f);
    }
}

TEST_F(MarksTest, DistanceLimitHasHalfAUnitOfSlack) {
    const World world = makeFloor(BspSurfaceType::Planar);
    EXPECT_EQ(mark(world, makePolygon(19.0f)).count, 2);
    EXPECT_EQ(mark(world, makePolygon(19.7f)).count, 0);
}

TEST_F(MarksTest, PolygonMustRunClockwiseAlongTheProjection) {
    std::vector<vec3> polygon = makePolygon(8);
    std::reverse(polygon.begin(), polygon.end());
    EXPECT_EQ(mark(makeFloor(BspSurfaceType::Planar), polygon).count, 0);
}

TEST_F(MarksTest, SoupsAreMarkedOnlyWhenAskedFor) {
    const World world = makeFloor(BspSurfaceType::TriangleSoup);
    EXPECT_EQ(mark(world, makePolygon(8), false).count, 0);
    EXPECT_EQ(mark(world, makePolygon(8), true).count, 2);
}

TEST_F(MarksTest, LimitsLeaveOutWholeFragments) {
    const World world = makeFloor(BspSurfaceType::Planar);
    EXPECT_EQ(mark(world, makePolygon(8), false, 384, 1).count, 1);
    const Marks all = mark(world, makePolygon(8));
    const Marks few = mark(world, makePolygon(8), false, all.points.size() - 1);
    EXPECT_EQ(few.count, 1);
    EXPECT_EQ(mark(world, {}).count, 0);
}

TEST_F(MarksTest, MaterialsCanRefuseMarks) {
    m_files.addText("scripts/a.shader", "textures/no { surfaceparm nomarks\n { map $whiteimage } }\n");
    SceneLibraries libraries(m_files);
    const MaterialId material = libraries.materials.find("textures/no", lightmapContext::kByVertex);
    const World world = makeFloor(BspSurfaceType::Planar, material);
    std::vector<vec3> points;
    std::vector<MarkFragment> fragments;
    EXPECT_EQ(MarkClipper().clip(world, libraries.materials, makePolygon(8), vec3(0, 0, -20), 384, points, 128,
                                 fragments, false),
              0);
}

} // namespace
} // namespace q3rt::test
