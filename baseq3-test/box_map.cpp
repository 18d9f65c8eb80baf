// From the description to the file's structs: surfaces with lightmaps, tree, visibility, light grid, world model.

#include "baseq3-test/box_map.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "baseq3-test/box_tree.hpp"

namespace q3rt {

namespace {

constexpr int kLuxelQu = 16;         ///< distance of lightmap samples
constexpr int kTextureRepeatQu = 64; ///< walls repeat their texture at this distance
constexpr uint32_t kContentsSolid = 1;
constexpr int kLightmapByVertex = -3;
constexpr ivec3 kGridCellQu{64, 64, 128};
constexpr double kGridAmbient = 16; ///< luxel units, so that no model is black

/// Bytes of a colour in luxel units; above 255 scaled down by the largest component, so that hue is kept.
std::array<uint8_t, 3> quantizeLight(const dvec3& light) {
    const double largest = std::max({light.r, light.g, light.b});
    const double scale = largest > 255.0 ? 255.0 / largest : 1.0;
    std::array<uint8_t, 3> bytes{};
    for (int i = 0; i < 3; ++i)
        bytes[static_cast<size_t>(i)] = static_cast<uint8_t>(std::lround(light[i] * scale));
    return bytes;
}

/// Places rectangles of luxels in pages, row by row.
class LightmapPacker {
  public:
    struct Place {
        int page = 0, x = 0, y = 0;
    };
    Place place(int width, int height) {
        if (width > kLightmapSize || height > kLightmapSize)
            throw UsageError(formatText("a wall of %d x %d luxels is larger than a lightmap page", width, height));
        if (m_x + width > kLightmapSize) m_x = 0, m_y += m_rowHeight, m_rowHeight = 0;
        if (m_y + height > kLightmapSize) ++m_page, m_x = m_y = m_rowHeight = 0;
        const Place result{m_page, m_x, m_y};
        m_x += width;
        m_rowHeight = std::max(m_rowHeight, height);
        return result;
    }

  private:
    int m_page = 0, m_x = 0, m_y = 0, m_rowHeight = 0;
};

class MapBuilder {
  public:
    explicit MapBuilder(const BoxMap& map)
        : m_map(map)
        , m_portals(findPortals(map))
        , m_faces(buildFaces(map, m_portals)) {}

    Bsp build() {
        m_bsp.entities = m_map.entities;
        for (const BoxFace& face : m_faces)
            addSurface(face);
        buildBoxTree(m_map, m_faces, findShader(m_map.air.front().wallShader), m_bsp);
        const BoxVisibility visibility = computeVisibility(m_map, m_portals);
        m_bsp.clusterCount = visibility.clusterCount;
        m_bsp.clusterRowBytes = visibility.rowBytes;
        m_bsp.visibility = visibility.rows;
        addWorldModel();
        addLightGrid();
        return std::move(m_bsp);
    }

  private:
    int findShader(const std::string& name) {
        for (size_t i = 0; i < m_bsp.shaders.size(); ++i)
            if (m_bsp.shaders[i].name == name) return static_cast<int>(i);
        m_bsp.shaders.push_back({name, 0, kContentsSolid});
        return static_cast<int>(m_bsp.shaders.size()) - 1;
    }

    void addSurface(const BoxFace& face) {
        const WallPanel* panel = face.panel >= 0 ? &m_map.panels[static_cast<size_t>(face.panel)] : nullptr;
        BspSurface surface;
        surface.shader = findShader(panel != nullptr ? panel->shader : m_map.air[face.airBox].wallShader);
        surface.firstVertex = static_cast<int>(m_bsp.vertices.size());
        surface.vertexCount = 4;
        surface.firstIndex = static_cast<int>(m_bsp.indices.size());
        surface.indexCount = 6;
        m_bsp.indices.insert(m_bsp.indices.end(), {0, 1, 2, 0, 2, 3});
        const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
        surface.lightmapOrigin = vec3(face.rectangle.mins);
        surface.lightmapVectors[0][u] = surface.lightmapVectors[1][v] = 1.0f;
        surface.lightmapVectors[2][face.axis] = static_cast<float>(face.towards);
        for (const dvec3& corner : computeCorners(face.rectangle, face.axis, face.towards)) {
            BspDrawVertex vertex;
            vertex.position = vec3(corner);
            vertex.st = vec2(vertex.position[u], vertex.position[v]) / static_cast<float>(kTextureRepeatQu);
            vertex.normal = surface.lightmapVectors[2];
            vertex.color = U8vec4(255);
            m_bsp.vertices.push_back(vertex);
        }
        // What shines is drawn at full brightness and holds no baked light.
        surface.lightmap =
            panel != nullptr && panel->surfaceLight > 0.0f ? kLightmapByVertex : addLightmap(face, surface);
        m_bsp.surfaces.push_back(surface);
    }

    /// Bakes a face; samples lie on its border and at equal steps between, so that neighbours agree at shared edges.
    int addLightmap(const BoxFace& face, const BspSurface& surface) {
        const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
        const ivec3 size = face.rectangle.maxs - face.rectangle.mins;
        const auto luxels = [](int length) { return (length + kLuxelQu - 1) / kLuxelQu + 1; };
        const int width = luxels(size[u]), height = luxels(size[v]);
        const LightmapPacker::Place place = m_packer.place(width, height);
        constexpr size_t kPageBytes = 3 * kLightmapSize * kLightmapSize;
        m_bsp.lightmaps.resize(std::max(m_bsp.lightmaps.size(), (static_cast<size_t>(place.page) + 1) * kPageBytes));
        dvec3 normal(0.0);
        normal[face.axis] = face.towards;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                dvec3 point(face.rectangle.mins);
                point[u] += size[u] * (double(x) / (width - 1));
                point[v] += size[v] * (double(y) / (height - 1));
                const auto bytes =
                    quantizeLight(computeIrradiance(m_map, m_portals, m_faces, face.airBox, point, normal));
                const size_t texel = static_cast<size_t>((place.y + y) * kLightmapSize + place.x + x);
                std::copy(bytes.begin(), bytes.end(),
                          m_bsp.lightmaps.begin() +
                              static_cast<std::ptrdiff_t>(static_cast<size_t>(place.page) * kPageBytes + 3 * texel));
            }
        for (int i = 0; i < surface.vertexCount; ++i) {
            BspDrawVertex& vertex = m_bsp.vertices[static_cast<size_t>(surface.firstVertex + i)];
            const vec3 offset = vertex.position - vec3(face.rectangle.mins);
            vertex.lightmapSt = vec2(place.x + 0.5f + (width - 1) * offset[u] / static_cast<float>(size[u]),
                                     place.y + 0.5f + (height - 1) * offset[v] / static_cast<float>(size[v])) /
                                static_cast<float>(kLightmapSize);
        }
        return place.page;
    }

    void addWorldModel() {
        BspModel world;
        Bounds bounds;
        for (const BspDrawVertex& vertex : m_bsp.vertices)
            bounds.add(vertex.position);
        world.mins = bounds.mins, world.maxs = bounds.maxs;
        world.surfaceCount = static_cast<int>(m_bsp.surfaces.size());
        world.brushCount = static_cast<int>(m_bsp.brushes.size());
        m_bsp.models.push_back(world);
    }

    /// Cells on multiples of the cell size inside the world's bounds, x fastest; 8 bytes each.
    void addLightGrid() {
        const vec3 cell(kGridCellQu);
        const vec3 first = glm::ceil(m_bsp.models[0].mins / cell) * cell,
                   last = glm::floor(m_bsp.models[0].maxs / cell) * cell;
        const ivec3 counts = ivec3((last - first) / cell) + 1;
        for (int z = 0; z < counts.z; ++z)
            for (int y = 0; y < counts.y; ++y)
                for (int x = 0; x < counts.x; ++x)
                    addGridCell(dvec3(first) + dvec3(kGridCellQu) * dvec3(x, y, z));
    }

    void addGridCell(const dvec3& point) {
        std::array<uint8_t, 8> cell{};
        const auto air = std::find_if(m_map.air.begin(), m_map.air.end(), [&](const AirBox& candidate) {
            return glm::all(glm::lessThanEqual(dvec3(candidate.box.mins), point)) &&
                   glm::all(glm::lessThanEqual(point, dvec3(candidate.box.maxs)));
        });
        if (air != m_map.air.end()) {
            // The flux vector: light through the three axis planes, each way.
            dvec3 flux(0.0), color(0.0);
            for (int axis = 0; axis < 3; ++axis)
                for (const double sign : {1.0, -1.0}) {
                    dvec3 normal(0.0);
                    normal[axis] = sign;
                    const dvec3 light = computeIrradiance(m_map, m_portals, m_faces,
                                                          static_cast<size_t>(air - m_map.air.begin()), point, normal);
                    flux[axis] += sign * (light.r + light.g + light.b);
                    color = glm::max(color, light);
                }
            const auto ambient = quantizeLight(dvec3(kGridAmbient)), directed = quantizeLight(color);
            std::copy(ambient.begin(), ambient.end(), cell.begin());
            std::copy(directed.begin(), directed.end(), cell.begin() + 3);
            if (glm::length(flux) > 0.0) {
                // Angles in 256ths of a turn: from the zenith, and around it from the X axis.
                const dvec3 direction = glm::normalize(flux);
                const double turn = 256.0 / (2.0 * M_PI);
                cell[6] = static_cast<uint8_t>(std::lround(std::acos(direction.z) * turn) & 255);
                cell[7] = static_cast<uint8_t>(std::lround(std::atan2(direction.y, direction.x) * turn) & 255);
            }
        }
        m_bsp.lightGrid.insert(m_bsp.lightGrid.end(), cell.begin(), cell.end());
    }

    const BoxMap& m_map;
    std::vector<BoxPortal> m_portals;
    std::vector<BoxFace> m_faces;
    LightmapPacker m_packer;
    Bsp m_bsp;
};

} // namespace

Bsp buildBoxMap(const BoxMap& map) {
    if (map.air.empty()) throw UsageError("a box map wants a box of air");
    return MapBuilder(map).build();
}

} // namespace q3rt
