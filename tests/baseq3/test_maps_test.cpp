#include "baseq3-test/test_maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "baseq3-test/bsp_writer.hpp"
#include "formats/entities.hpp"

namespace q3rt::test {

namespace {

Bsp roundTrip(const BoxMap& map) { return parseBsp(writeBsp(buildBoxMap(map)), "maps/test.bsp"); }

int findLeaf(const Bsp& bsp, const vec3& point) {
    int node = 0;
    while (node >= 0) {
        const BspNode& at = bsp.nodes[static_cast<size_t>(node)];
        const Plane& plane = bsp.planes[static_cast<size_t>(at.plane)];
        node = at.children[glm::dot(plane.normal, point) >= plane.distance ? 0 : 1];
    }
    return -1 - node;
}

/// Is the point in a brush of its leaf?
bool isSolid(const Bsp& bsp, const vec3& point) {
    const BspLeaf& leaf = bsp.leafs[static_cast<size_t>(findLeaf(bsp, point))];
    for (int i = 0; i < leaf.leafBrushCount; ++i) {
        const BspBrush& brush =
            bsp.brushes[static_cast<size_t>(bsp.leafBrushes[static_cast<size_t>(leaf.firstLeafBrush + i)])];
        bool inside = true;
        for (int side = 0; side < brush.sideCount; ++side) {
            const Plane& plane =
                bsp.planes[static_cast<size_t>(bsp.brushSides[static_cast<size_t>(brush.firstSide + side)].plane)];
            inside = inside && glm::dot(plane.normal, point) <= plane.distance;
        }
        if (inside) return true;
    }
    return false;
}

} // namespace

TEST(BoxMaps, ParserReadsBackWhatWasWritten) {
    for (const BoxMap& map : {describeSquareLightRoom(), describeThreeClusterCorridor()}) {
        const Bsp built = buildBoxMap(map), read = parseBsp(writeBsp(built), "maps/test.bsp");
        EXPECT_EQ(read.entities.c_str(), built.entities);
        EXPECT_EQ(read.surfaces.size(), built.surfaces.size());
        EXPECT_EQ(read.vertices.size(), built.vertices.size());
        EXPECT_EQ(read.indices, built.indices);
        EXPECT_EQ(read.lightmaps, built.lightmaps);
        EXPECT_EQ(read.lightGrid, built.lightGrid);
        EXPECT_EQ(read.visibility, built.visibility);
        EXPECT_EQ(read.nodes.size(), built.nodes.size());
        EXPECT_EQ(read.leafSurfaces, built.leafSurfaces);
        for (size_t i = 0; i < read.vertices.size(); ++i) {
            EXPECT_EQ(read.vertices[i].position, built.vertices[i].position);
            EXPECT_EQ(read.vertices[i].lightmapSt, built.vertices[i].lightmapSt);
            EXPECT_EQ(read.vertices[i].color, built.vertices[i].color);
        }
        EXPECT_EQ(read.shaders[0].name, "textures/baseq3test/wall");
    }
}

TEST(BoxMaps, RoomHasItsWallsAndOneLight) {
    const Bsp bsp = roundTrip(describeSquareLightRoom());
    // Five plain sides, and the ceiling as 3 x 3 parts around the light.
    ASSERT_EQ(bsp.surfaces.size(), 14u);
    double area = 0, lightArea = 0;
    for (const BspSurface& surface : bsp.surfaces) {
        const BspDrawVertex* v = &bsp.vertices[static_cast<size_t>(surface.firstVertex)];
        const vec3 cross = glm::cross(v[1].position - v[0].position, v[3].position - v[0].position);
        // Clockwise from the front: the right-handed normal looks away from the air.
        EXPECT_LT(glm::dot(cross, surface.lightmapVectors[2]), 0.0f);
        area += glm::length(cross);
        if (bsp.shaders[static_cast<size_t>(surface.shader)].name == "textures/baseq3test/light_square")
            lightArea += glm::length(cross);
    }
    EXPECT_EQ(area, 2.0 * 512 * 512 + 4.0 * 512 * 256);
    EXPECT_EQ(lightArea, 128.0 * 128);
    EXPECT_EQ(bsp.clusterCount, 1);
    EXPECT_EQ(parseEntities(bsp.entities).size(), 3u);
}

TEST(BoxMaps, RoomLightmapHoldsTheClosedForm) {
    const Bsp bsp = roundTrip(describeSquareLightRoom());
    int checked = 0;
    for (const BspSurface& surface : bsp.surfaces) {
        if (surface.lightmap < 0) continue;
        for (int i = 0; i < surface.vertexCount; ++i) {
            const BspDrawVertex& vertex = bsp.vertices[static_cast<size_t>(surface.firstVertex + i)];
            const int x = static_cast<int>(std::floor(vertex.lightmapSt.x * kLightmapSize));
            const int y = static_cast<int>(std::floor(vertex.lightmapSt.y * kLightmapSize));
            const size_t page = static_cast<size_t>(surface.lightmap) * kLightmapSize * kLightmapSize;
            const uint8_t luxel = bsp.lightmaps[3 * (page + static_cast<size_t>(y * kLightmapSize + x))];
            const double expected =
                squareLightRoom::computeIrradiance(dvec3(vertex.position), dvec3(surface.lightmapVectors[2]));
            EXPECT_NEAR(luxel, expected, 0.5 + 1e-9);
            ++checked;
        }
    }
    EXPECT_EQ(checked, 52);
    EXPECT_NEAR(squareLightRoom::computeIrradiance({0, 0, 0}, {0, 0, 1}), 55.1, 0.1);
}

TEST(BoxMaps, CorridorHidesTheFarRooms) {
    const Bsp bsp = roundTrip(describeThreeClusterCorridor());
    ASSERT_EQ(bsp.clusterCount, threeClusterCorridor::kClusterCount);
    const bool expected[3][3] = {{true, true, false}, {true, true, true}, {false, true, true}};
    for (int from = 0; from < 3; ++from)
        for (int to = 0; to < 3; ++to)
            EXPECT_EQ(bsp.clusterVisible(from, to), expected[from][to]) << from << " " << to;
}

TEST(BoxMaps, StraightCorridorShowsTheFarRoom) {
    BoxMap map;
    map.air = {{{{0, 0, 0}, {64, 64, 64}}, 0, "w"},
               {{{64, 16, 0}, {256, 48, 64}}, 1, "w"},
               {{{256, 0, 0}, {320, 64, 64}}, 2, "w"}};
    EXPECT_TRUE(roundTrip(map).clusterVisible(0, 2));
    EXPECT_TRUE(roundTrip(map).clusterVisible(2, 0));
}

TEST(BoxMaps, TreeFindsEveryPointInItsBox) {
    int points = 0;
    for (const BoxMap& map : {describeSquareLightRoom(), describeThreeClusterCorridor()}) {
        const Bsp bsp = roundTrip(map);
        for (int x = -260; x < 1040; x += 23)
            for (int y = -260; y < 530; y += 23)
                for (int z = -10; z < 268; z += 23) {
                    const vec3 point(x + 0.5f, y + 0.5f, z + 0.5f);
                    const auto air = std::find_if(map.air.begin(), map.air.end(), [&](const AirBox& box) {
                        return glm::all(glm::lessThan(vec3(box.box.mins), point)) &&
                               glm::all(glm::lessThan(point, vec3(box.box.maxs)));
                    });
                    const int cluster = bsp.leafs[static_cast<size_t>(findLeaf(bsp, point))].cluster;
                    EXPECT_EQ(cluster, air == map.air.end() ? -1 : air->cluster);
                    if (air != map.air.end()) {
                        EXPECT_FALSE(isSolid(bsp, point));
                        ++points;
                    }
                }
    }
    EXPECT_GT(points, 3000);
}

TEST(BoxMaps, AirIsWrappedInSolid) {
    int points = 0;
    for (const BoxMap& map : {describeSquareLightRoom(), describeThreeClusterCorridor()}) {
        const Bsp bsp = roundTrip(map);
        const std::vector<BoxFace> faces = buildFaces(map, findPortals(map));
        for (const BoxFace& face : faces) {
            vec3 behind = 0.5f * vec3(face.rectangle.mins + face.rectangle.maxs);
            behind[face.axis] -= 8.0f * static_cast<float>(face.towards);
            EXPECT_TRUE(isSolid(bsp, behind));
            ++points;
        }
    }
    EXPECT_GT(points, 40);
}

TEST(BoxMaps, LightStaysBehindTheBend) {
    const BoxMap map = describeThreeClusterCorridor();
    const auto portals = findPortals(map);
    const auto faces = buildFaces(map, portals);
    const dvec3 red = computeIrradiance(map, portals, faces, 0, {128, 128, 0}, {0, 0, 1});
    EXPECT_GT(red.r, 20.0);
    EXPECT_NEAR(red.g / red.r, 0.25, 1e-12);
    EXPECT_NEAR(red.b / red.r, 0.25, 1e-12);
    const dvec3 blue = computeIrradiance(map, portals, faces, 4, {896, 384, 0}, {0, 0, 1});
    EXPECT_GT(blue.b, 20.0);
    EXPECT_NEAR(blue.r / blue.b, 0.25, 1e-12);
}

TEST(BoxMaps, BadDescriptionsAreRefused) {
    BoxMap overlapping;
    overlapping.air = {{{{0, 0, 0}, {64, 64, 64}}, 0, "w"}, {{{32, 0, 0}, {96, 64, 64}}, 0, "w"}};
    EXPECT_THROW(buildBoxMap(overlapping), UsageError);
    BoxMap strayPanel;
    strayPanel.air = {{{{0, 0, 0}, {64, 64, 64}}, 0, "w"}};
    strayPanel.panels = {{{{10, 10, 32}, {20, 20, 32}}, "p", 0.0f, vec3(1.0f)}};
    EXPECT_THROW(buildBoxMap(strayPanel), UsageError);
    EXPECT_THROW(buildBoxMap(BoxMap{}), UsageError);
}

} // namespace q3rt::test
