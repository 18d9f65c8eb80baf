#include "accel/reference/world_triangles.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace q3rt::test {

namespace {

/// std::uniform_real_distribution differs between libraries: 24 bits of the generator, in [0, 1).
float unitRandom(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

} // namespace

WorldTriangles::WorldTriangles(FileSource& files, const std::string& map)
    : m_textures(files, {})
    , m_materials(files, m_textures, {})
    , m_world(loadWorld(files, "maps/" + map + ".bsp", m_materials, {})) {
    const BspModel& model = m_world->bsp.models[0];
    for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
        const WorldSurface& surface = m_world->surfaces[static_cast<size_t>(s)];
        if (!surface.drawn || m_materials.drawn(surface.material).isSky) continue;
        for (uint32_t i = 0; i < surface.indexCount; ++i)
            m_positions.push_back(m_world->vertices[m_world->indices[surface.firstIndex + i]].position);
    }
}

std::vector<vec3> WorldTriangles::pointsInside(size_t count, uint32_t seed) const {
    std::mt19937 random(seed);
    const Bounds& box = m_world->bounds;
    std::vector<vec3> points;
    while (points.size() < count) {
        const float x = unitRandom(random), y = unitRandom(random);
        const vec3 point = box.mins + (box.maxs - box.mins) * vec3(x, y, unitRandom(random));
        if (m_world->clusterOf(point) >= 0) points.push_back(point);
    }
    return points;
}

vec3 WorldTriangles::playerStart() const {
    const vec3 eyeAboveStart(0, 0, 26);
    for (const MapEntity& entity : m_world->entities)
        if (entity.className() == "info_player_deathmatch")
            if (const auto origin = entity.vector("origin")) return *origin + eyeAboveStart;
    return (m_world->bounds.mins + m_world->bounds.maxs) * 0.5f;
}

float WorldTriangles::farQu() const { return 2 * glm::length(m_world->bounds.maxs - m_world->bounds.mins); }

std::vector<vec3> unitDirections(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<vec3> directions;
    while (directions.size() < count) {
        const float z = 2 * unitRandom(random) - 1;
        const float angle = 2 * std::numbers::pi_v<float> * unitRandom(random);
        const float radius = std::sqrt(std::max(0.0f, 1 - z * z));
        directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return directions;
}

} // namespace q3rt::test
