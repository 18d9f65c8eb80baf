// Tessellation, normals and stitching of patches.

#include <cmath>

#include <gtest/gtest.h>

#include "scene/patch.hpp"
#include "scene/world_math.hpp"

namespace q3rt::test {
namespace {

Vertex point(float x, float y, float z) {
    Vertex vertex{};
    vertex.position = {x, y, z};
    vertex.st = {x, y};
    vertex.color = 0xffffffffu;
    return vertex;
}

/// 3x3: a parabolic arch along x (control height `bulge` in the middle), straight along y.
std::vector<Vertex> makeArch(float length, float bulge, float y0 = 0, float y1 = 32) {
    std::vector<Vertex> control;
    for (int row = 0; row < 3; ++row) {
        const float y = y0 + (y1 - y0) * 0.5f * static_cast<float>(row);
        control.insert(control.end(), {point(0, y, 0), point(length / 2, y, bulge), point(length, y, 0)});
    }
    return control;
}

TEST(Patch, FlatGridLosesAllInnerPoints) {
    const TessellatedPatch patch = tessellatePatch(3, 3, makeArch(128, 0), 4);
    EXPECT_EQ(patch.width, 2);
    EXPECT_EQ(patch.height, 2);
    ASSERT_EQ(patch.vertices.size(), 4u);
    for (const Vertex& vertex : patch.vertices) {
        EXPECT_NEAR(std::abs(vertex.normal.z), 1.0f, 1e-6f);
    }
}

TEST(Patch, ArcStaysWithinTheSubdivisionTolerance) {
    int cases = 0;
    for (const float tolerance : {1.0f, 4.0f, 20.0f}) {
        for (const float bulge : {1.0f, 16.0f, 64.0f, 256.0f}) {
            const float length = 256;
            const TessellatedPatch patch = tessellatePatch(3, 3, makeArch(length, bulge), tolerance);
            ASSERT_GE(patch.width, 2);
            EXPECT_EQ(patch.height, 2);
            // The curve is z = 4 h (x / L)(1 - x / L) with h half the control height.
            const auto curve = [&](float x) { return 2 * bulge * (x / length) * (1 - x / length); };
            for (int c = 0; c + 1 < patch.width; ++c) {
                const vec3 a = patch.vertices[static_cast<size_t>(c)].position;
                const vec3 b = patch.vertices[static_cast<size_t>(c) + 1].position;
                EXPECT_NEAR(a.z, curve(a.x), 1e-3f) << "grid points lie on the curve";
                const vec3 middle = (a + b) * 0.5f;
                EXPECT_LE(std::abs(curve(middle.x) - middle.z), tolerance);
                ++cases;
            }
        }
    }
    EXPECT_GE(cases, 40);
}

TEST(Patch, NoGridExceedsTheLargestSide) {
    const TessellatedPatch patch = tessellatePatch(3, 3, makeArch(10000, 100000), 0.25f);
    EXPECT_LE(patch.width, kMaxPatchSide);
    EXPECT_GT(patch.width, kMaxPatchSide - 4);
    EXPECT_EQ(patch.columnError.size(), static_cast<size_t>(patch.width));
    EXPECT_EQ(patch.rowError.size(), static_cast<size_t>(patch.height));
}

TEST(Patch, TallGridIsTurnedAndKeepsItsSide) {
    std::vector<Vertex> control; // the arch runs along the height
    for (int row = 0; row < 3; ++row) {
        const float z = row == 1 ? 64.0f : 0.0f;
        for (int column = 0; column < 3; ++column) {
            control.push_back(point(32.0f * static_cast<float>(column), 64.0f * static_cast<float>(row), z));
        }
    }
    const TessellatedPatch patch = tessellatePatch(3, 3, control, 4);
    EXPECT_GT(patch.width, patch.height);
    EXPECT_EQ(patch.vertices[0].position, vec3(0, 128, 0)) << "new[0][0] = old[H-1][0]";
    // A quarter turn does not change which side is clockwise.
    const vec3 before = clockwiseCross(control[0].position, control[3].position, control[1].position);
    const auto width = static_cast<size_t>(patch.width);
    const vec3 after =
        clockwiseCross(patch.vertices[0].position, patch.vertices[width].position, patch.vertices[1].position);
    EXPECT_GT(before.z * after.z, 0.0f);
}

TEST(Patch, ColoursTruncateAtEachHalving) {
    Vertex a = point(0, 0, 0), b = point(1, 0, 0);
    a.color = packColor({255, 1, 10, 255});
    b.color = packColor({254, 2, 10, 0});
    EXPECT_EQ(unpackColor(averagePatchVertex(a, b).color), U8vec4(254, 1, 10, 127));
}

TEST(Patch, ClosedCylinderHasTheSameNormalAtItsSeam) {
    std::vector<Vertex> control; // 9x3: a closed tube of square control points
    const float ring[9][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (int row = 0; row < 3; ++row) {
        for (const auto& xy : ring) {
            control.push_back(point(xy[0] * 64, xy[1] * 64, 64.0f * static_cast<float>(row)));
        }
    }
    const TessellatedPatch patch = tessellatePatch(9, 3, control, 4);
    const vec3 first = patch.vertices[0].normal;
    const vec3 last = patch.vertices[static_cast<size_t>(patch.width) - 1].normal;
    EXPECT_NEAR(glm::distance(first, last), 0.0f, 1e-4f);
    EXPECT_NEAR(std::abs(first.x), 1.0f, 0.01f);
}

PatchMesh makeMesh(const TessellatedPatch& grid) { return {grid, vec3(1, 2, 3), 100}; }

TEST(PatchStitching, FinerEdgeGivesItsPointsToTheNeighbour) {
    // Both touch along y = 32; the second is flat along x, so it has two points where the first has more.
    const TessellatedPatch arch = tessellatePatch(3, 3, makeArch(64, 8), 1);
    ASSERT_EQ(arch.width, 5);
    TessellatedPatch coarse = tessellatePatch(3, 3, makeArch(64, 8, 32, 64), 4);
    ASSERT_EQ(coarse.width, 3);
    std::vector<PatchMesh> meshes{makeMesh(arch), makeMesh(coarse)};
    stitchPatches(meshes);
    EXPECT_EQ(meshes[0].grid.width, 5);
    ASSERT_EQ(meshes[1].grid.width, 5);
    for (size_t c = 0; c < 5; ++c) { // row 1 of the arch is the edge, row 0 of the other
        const vec3 shared = meshes[0].grid.vertices[5 + c].position, stitched = meshes[1].grid.vertices[c].position;
        EXPECT_EQ(shared, stitched);
    }
    EXPECT_EQ(meshes[0].grid.columnError, meshes[1].grid.columnError);
}

TEST(PatchStitching, OtherGroupsAreLeftAlone) {
    std::vector<PatchMesh> meshes{makeMesh(tessellatePatch(3, 3, makeArch(64, 8), 1)),
                                  makeMesh(tessellatePatch(3, 3, makeArch(64, 8, 32, 64), 4))};
    meshes[1].lodRadius += 1;
    stitchPatches(meshes);
    EXPECT_EQ(meshes[1].grid.width, 3);
}

} // namespace
} // namespace q3rt::test
