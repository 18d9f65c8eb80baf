#include "renderer_rt/world_lights.hpp"

#include <algorithm>
#include <cmath>

#include "gpu/device.hpp"
#include "renderer_rt/node_starts.hpp"
#include "renderer_rt/packed_grid.hpp"
#include "shaders/shared/constants.h"

namespace q3rt {

namespace {

constexpr VkBufferUsageFlags kTableUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

template <typename T>
Buffer makeTable(Device& device, Uploader& uploader, const std::vector<T>& items, const char* name) {
    Buffer buffer(device, {.size = items.size() * sizeof(T), .usage = kTableUsage, .name = name});
    if (!items.empty()) uploader.upload(buffer, std::span<const T>(items));
    return buffer;
}

float largestComponent(const vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

RtTriangleLight makeTriangleLight(const TriangleLight& light) {
    RtTriangleLight out{};
    out.corner = light.corner[0];
    out.edge1 = light.corner[1] - light.corner[0];
    out.edge2 = light.corner[2] - light.corner[0];
    out.normal = light.normal;
    out.areaQu2 = light.areaQu2;
    out.radiance = light.radiance;
    out.faintest = light.faintest;
    out.flags = (light.twoSided ? kLightTwoSided : 0) | (light.upward ? kLightUpward : 0);
    // |n| . error <= sqrt(3) x the largest component's error; the whole triangle has one bound. Samples are placed
    // relative to the shaded point: only the triangle's own size counts.
    out.error = 1.7320508f * kOwnTriangleError * (largestComponent(out.edge1) + largestComponent(out.edge2));
    return out;
}

/// The same light somewhere else.
void replaceLight(RtTriangleLight& of, const TriangleLight& moved) {
    const uint animation = of.animation;
    of = makeTriangleLight(moved);
    of.animation = animation;
}

/// A child of the map's tree as RtNode has it.
int shaderChild(const World& world, int child) {
    return child >= 0 ? child : -2 - world.bsp.leafs[static_cast<size_t>(-1 - child)].cluster;
}

std::vector<RtNode> makeNodes(const World& world) {
    std::vector<RtNode> nodes;
    nodes.reserve(world.bsp.nodes.size());
    for (const BspNode& node : world.bsp.nodes) {
        const Plane& plane = world.bsp.planes[static_cast<size_t>(node.plane)];
        nodes.push_back({{plane.normal, plane.distance},
                         shaderChild(world, node.children[0]),
                         shaderChild(world, node.children[1])});
    }
    return nodes;
}

std::vector<GridCell> makeGrid(const World& world, const ModelLightScale& scale) {
    std::vector<GridCell> cells;
    if (world.grid.empty()) {
        const ivec3 counts = gridShapeOf(world).counts;
        const GridCell dark{.direction = vec3(0, 0, 1)};
        cells.assign(static_cast<size_t>(counts.x) * static_cast<size_t>(counts.y) * static_cast<size_t>(counts.z),
                     dark);
        return cells;
    }
    // As it was baked: a brightened one has lost what did not fit its bytes.
    const LightGrid grid = LightGrid::build(world.bsp, world.grid.cellSize, 0);
    for (int z = 0; z < grid.counts.z; ++z)
        for (int y = 0; y < grid.counts.y; ++y)
            for (int x = 0; x < grid.counts.x; ++x) {
                const vec3 point = grid.origin + grid.cellSize * vec3(x, y, z);
                const GridLight light = grid.sample(point);
                GridCell cell{};
                const bool valid = light.ambient != vec3(0.0f);
                cell.surfaces = {light.ambient, light.directed, valid};
                cell.models = {scale.ambient * light.ambient, scale.directed * light.directed, valid};
                cell.direction = light.direction == vec3(0.0f) ? vec3(0, 0, 1) : light.direction;
                cells.push_back(cell);
            }
    return cells;
}

RtLight makePointLight(const PointLight& light) {
    const float cosine = light.cosOuter;
    return {.position = light.origin,
            .kind = kLightSphere,
            .power = light.intensity,
            .size = 0,
            .axis = light.direction,
            .spot = light.spot ? std::sqrt(1.0f - cosine * cosine) / cosine : 0.0f,
            .faintest = light.faintest};
}

RtLight makeSun(const SunLight& sun) {
    return {.position = sun.direction,
            .kind = kLightSun,
            .power = sun.irradiance,
            .size = 1.0f - std::cos(sun.halfAngleRadians),
            .axis = vec3(0.0f),
            .spot = 0,
            .faintest = 0};
}

} // namespace

LightGrid gridShapeOf(const World& world) {
    constexpr double kMostCells = 1 << 20; // as the luxels that tell what they give (grid_fit.cpp)
    LightGrid shape;
    shape.cellSize = world.grid.cellSize;
    if (!world.grid.empty()) {
        shape.origin = world.grid.origin;
        shape.counts = world.grid.counts;
        return shape;
    }
    const float extent = world.bounds.empty() ? 0 : glm::length(world.bounds.maxs - world.bounds.mins);
    const bool isUsable = extent > 0 && std::isfinite(extent);
    const vec3 size = isUsable ? world.bounds.maxs - world.bounds.mins : vec3(0);
    const auto cellCount = [&] {
        const dvec3 counts = glm::ceil(dvec3(size) / dvec3(shape.cellSize)) + 1.0;
        return counts.x * counts.y * counts.z;
    };
    while (cellCount() > kMostCells)
        shape.cellSize *= 2.0f;
    shape.origin = isUsable ? world.bounds.mins : vec3(0);
    shape.counts = ivec3(glm::ceil(size / shape.cellSize)) + 1;
    return shape;
}

RtLight makeDynamicLight(const vec3& origin, float radiusQu, const vec3& color) {
    return {.position = origin,
            .kind = kLightSphere,
            .power = color * (kDynamicLightIntensity * radiusQu * radiusQu),
            .size = kLightMinDistanceQu,
            .axis = vec3(0.0f),
            .spot = 0,
            .faintest = 0};
}

std::vector<bool> findSkyClusters(const World& world, const MaterialLibrary& materials) {
    const Bsp& bsp = world.bsp;
    const auto count = static_cast<size_t>(bsp.clusterCount);
    std::vector<bool> holds(count, false);
    bool outside = false;
    for (const BspLeaf& leaf : bsp.leafs)
        for (int i = 0; i < leaf.leafSurfaceCount; ++i) {
            const int surface = bsp.leafSurfaces[static_cast<size_t>(leaf.firstLeafSurface + i)];
            if (!materials.get(world.surfaces[static_cast<size_t>(surface)].material).isSky) continue;
            if (leaf.cluster >= 0 && static_cast<size_t>(leaf.cluster) < count)
                holds[static_cast<size_t>(leaf.cluster)] = true;
            else
                outside = true;
        }
    if (outside) return std::vector<bool>(count, true);
    std::vector<bool> sees(count, false);
    for (size_t from = 0; from < count; ++from)
        for (size_t to = 0; to < count && !sees[from]; ++to)
            sees[from] = holds[to] && bsp.clusterVisible(static_cast<int>(from), static_cast<int>(to));
    return sees;
}

LightTables buildLightTables(const World& world, const MaterialLibrary& materials, const LightSet& lights,
                             const ModelLightScale& scale, LightAnimation& animation) {
    LightTables tables;
    std::vector<TriangleLight> triangles = lights.triangles;
    const std::vector<TriangleLight> skies = skyTriangles(world, materials, lights);
    triangles.insert(triangles.end(), skies.begin(), skies.end());
    for (const TriangleLight& light : triangles) {
        tables.triangles.push_back(makeTriangleLight(light));
        tables.triangles.back().animation = animation.find(world.surfaces[static_cast<size_t>(light.surface)].material);
    }
    for (const PointLight& light : lights.points)
        tables.points.push_back(makePointLight(light));
    for (const SunLight& sun : lights.suns)
        tables.others.push_back(makeSun(sun));
    tables.rows = buildLightRows(world, materials, describeRowLights(triangles, lights.points));
    const std::vector<bool> seesSky = findSkyClusters(world, materials);
    for (size_t r = 0; r < tables.rows.rows.size(); ++r) {
        const size_t cluster = r / kNormalClassCount;
        tables.rows.rows[r].seesSky = cluster >= seesSky.size() || seesSky[cluster] ? 1 : 0;
    }
    tables.nodes = makeNodes(world);
    tables.gridShape = gridShapeOf(world);
    tables.grid = makeGrid(world, scale);
    return tables;
}

TriangleLight moveLight(const TriangleLight& light, const mat4& worldFromModel) {
    TriangleLight moved = light;
    for (vec3& corner : moved.corner)
        corner = vec3(worldFromModel * vec4(corner, 1.0f));
    moved.normal = mat3(worldFromModel) * light.normal;
    return moved;
}

TriangleLight deformLight(const TriangleLight& light, const ViewGeometry& geometry, const EntitySurface& surface) {
    TriangleLight moved = light;
    const uint32_t first = surface.firstIndex + 3 * light.triangle;
    if (3 * light.triangle + 2 >= surface.indexCount) return moved;
    const mat4& worldFromModel = geometry.entities[surface.entity].worldFromModel;
    for (uint32_t k = 0; k < 3; ++k)
        moved.corner[k] = vec3(worldFromModel * vec4(geometry.vertices[geometry.indices[first + k]].position, 1.0f));
    if (light.flipped) std::swap(moved.corner[1], moved.corner[2]);
    measureTriangle(moved);
    return moved;
}

WorldLights::WorldLights(Device& device, Uploader& uploader, const World& world, const PreparedLights& prepared)
    : m_animation(prepared.animation) {
    const LightSet& lights = prepared.lights;
    const LightTables& tables = prepared.tables;
    m_others = tables.others;
    for (size_t i = 0; i < lights.triangles.size(); ++i) {
        const TriangleLight& light = lights.triangles[i];
        if (light.reachQu > 0)
            m_deformed[light.surface].push_back({i, light});
        else if (light.bspModel != 0)
            m_ofMovers.push_back({i, light});
    }
    if (!m_ofMovers.empty() || !m_deformed.empty()) m_resting = tables.triangles;
    m_triangles = makeTable(device, uploader, tables.triangles, "triangle lights");
    m_points = makeTable(device, uploader, tables.points, "point lights");
    m_rows = makeTable(device, uploader, tables.rows.rows, "light rows");
    m_entries = makeTable(device, uploader, tables.rows.entries, "light entries");
    m_nodes = makeTable(device, uploader, tables.nodes, "map nodes");
    m_grid = makeTable(device, uploader, packGrid(tables.grid), "light grid");
    const NodeStarts starts = findNodeStarts(tables.nodes, world.bounds.mins, world.bounds.maxs);
    m_nodeStarts = makeTable(device, uploader, starts.starts, "starts in the map's tree");
    m_nodeStartOrigin = starts.origin;
    m_nodeStartCellQu = starts.cellQu;
    m_nodeStartCounts = starts.counts;
    m_triangleCount = tables.triangles.size();
    m_pointCount = tables.points.size();
    m_rowEntryCount = tables.rows.entries.size();
    m_clusterCount = static_cast<uint32_t>(world.bsp.clusterCount);
    m_gridOrigin = tables.gridShape.origin;
    m_gridCellSize = tables.gridShape.cellSize;
    m_gridCounts = tables.gridShape.counts;
    uploader.flush();
}

std::vector<RtTriangleLight> WorldLights::moveTriangles(const ViewGeometry& geometry) const {
    std::vector<RtTriangleLight> moved;
    for (const auto& [index, light] : m_ofMovers) {
        const auto model = static_cast<size_t>(light.bspModel);
        const uint32_t record = model < geometry.recordOfInlineModel.size() ? geometry.recordOfInlineModel[model] : 0;
        // A mover that the view doesn't hold is taken to be where the map has it.
        if (record == 0 || geometry.entities[record].worldFromModel == mat4(1.0f)) continue;
        if (moved.empty()) moved = m_resting;
        replaceLight(moved[index], moveLight(light, geometry.entities[record].worldFromModel));
        // The instance that shows the light is not made of these corners.
        moved[index].error += 1.7320508f * kMatrixInverseError * largestComponent(moved[index].corner);
    }
    if (!m_deformed.empty()) moveDeformed(geometry, moved);
    return moved;
}

void WorldLights::moveDeformed(const ViewGeometry& geometry, std::vector<RtTriangleLight>& moved) const {
    for (const EntitySurface& surface : geometry.surfaces) {
        const auto found = m_deformed.find(surface.worldSurface);
        if (found == m_deformed.end()) continue;
        if (moved.empty()) moved = m_resting;
        for (const auto& [index, light] : found->second)
            replaceLight(moved[index], deformLight(light, geometry, surface));
    }
}

void WorldLights::describe(RtFrame& frame) const {
    frame.triangleLights = m_triangles.address();
    frame.lightRows = m_rows.address();
    frame.lightEntries = m_entries.address();
    frame.pointLights = m_points.address();
    frame.nodes = m_nodes.address();
    frame.nodeStarts = m_nodeStarts.address();
    frame.nodeStartOrigin = m_nodeStartOrigin;
    frame.nodeStartCellQu = m_nodeStartCellQu;
    frame.nodeStartCounts = m_nodeStartCounts;
    frame.grid = m_grid.address();
    frame.triangleLightCount = static_cast<uint32_t>(m_triangleCount);
    frame.pointLightCount = static_cast<uint32_t>(m_pointCount);
    frame.clusterCount = m_clusterCount;
    frame.gridOrigin = m_gridOrigin;
    frame.gridCellSize = m_gridCellSize;
    frame.gridCounts = m_gridCounts;
    frame.flags |= kFrameGrid;
}

} // namespace q3rt
