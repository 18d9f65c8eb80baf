#include "double_tracer.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baseq3-test/form_factor.hpp"
#include "scene/deform.hpp"

namespace q3rt::test {

namespace {

constexpr double kPi = std::numbers::pi;

/// Nearer than this to either end of a shadow ray nothing counts, qu: the surface itself and the light's own. Double
/// precision knows a point of a map (16 binary digits before the point) to 1e-11.
constexpr double kOwnSurfaceQu = 1e-6;

/// Strata a side: at first, and where some samples are lit and some not.
constexpr int kFewStrata = 4, kManyStrata = 16;
constexpr int kSkyStrata = 16, kSunStrata = 8;
/// A light that can't give more than this share of all the light at a point gets one shadow ray.
constexpr double kFaintShare = 1e-3;

double uniform(std::mt19937& random) { return std::uniform_real_distribution<double>(0, 1)(random); }

/// Two unit vectors that complete a frame.
std::pair<dvec3, dvec3> frameAround(const dvec3& n) {
    const dvec3 other = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 tangent = glm::normalize(glm::cross(n, other));
    return {tangent, glm::cross(n, tangent)};
}

double formFactor(const DoubleHit& hit, const TriangleLight& light) {
    const dvec3 a(light.corner[0]), b(light.corner[1]), c(light.corner[2]);
    return rectangleFormFactor(hit.position, hit.normal, {a, b, c, c});
}

bool passesTest(AlphaTest test, double alpha) {
    switch (test) {
    case AlphaTest::Greater0:
        return alpha > 0;
    case AlphaTest::Less128:
        return alpha < 0.5;
    case AlphaTest::GreaterEqual128:
        return alpha >= 0.5;
    default:
        return true;
    }
}

/// Bilinear, repeating, of the finest level.
double sampleAlpha(const Texture& texture, const dvec2& st) {
    const MipLevel& level = texture.levels[0];
    const dvec2 at = st * dvec2(level.width, level.height) - 0.5;
    const dvec2 cell = glm::floor(at), f = at - cell;
    const auto alphaOf = [&](double x, double y) {
        const auto wrap = [](double v, int size) { return static_cast<int>(v - std::floor(v / size) * size); };
        const int i = wrap(y, level.height) * level.width + wrap(x, level.width);
        return level.rgba[4 * static_cast<size_t>(i) + 3] / 255.0;
    };
    return glm::mix(glm::mix(alphaOf(cell.x, cell.y), alphaOf(cell.x + 1, cell.y), f.x),
                    glm::mix(alphaOf(cell.x, cell.y + 1), alphaOf(cell.x + 1, cell.y + 1), f.x), f.y);
}

/// Does the line meet the box at t in [0, tMax]?
bool meetsBox(const Bounds& box, const dvec3& origin, const dvec3& direction, double tMax) {
    const dvec3 one = (dvec3(box.mins) - origin) / direction, other = (dvec3(box.maxs) - origin) / direction;
    const dvec3 enter = glm::min(one, other), leave = glm::max(one, other);
    return std::max({enter.x, enter.y, enter.z, 0.0}) <= std::min({leave.x, leave.y, leave.z, tMax});
}

} // namespace

struct DoubleTracer::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

namespace {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

struct CandidateQuery {
    QueryContext context; ///< first: Embree hands its address to the filter
    const std::function<bool(uint32_t)>* visit;
};

/// Refuses every candidate, so that all are named, until the visitor has enough.
void nameCandidate(const RTCFilterFunctionNArguments* arguments) {
    const auto* query = reinterpret_cast<const CandidateQuery*>(arguments->context);
    const uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
    if (!(*query->visit)(triangle)) arguments->valid[0] = 0;
}

} // namespace

DoubleTracer::DoubleTracer(const World& world, const MaterialLibrary& materials, const LightSet& lights)
    : m_world(world)
    , m_materials(materials)
    , m_lights(lights)
    , m_embree(std::make_unique<Embree>()) {
    const BspModel& model = world.bsp.models[0];
    for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
        const auto number = static_cast<uint32_t>(s);
        const WorldSurface& surface = world.surfaces[number];
        const auto surfaceClass = classifySurface(materials.drawn(surface.material));
        if (!surface.drawn || !surfaceClass) continue;
        const Material& material = materials.drawn(surface.material);
        const bool turns = deformsWithView(material);
        if (turns) m_sprites.push_back(boundSprite(surface));
        for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3)
            m_triangles.push_back({number, surface.firstIndex + i, *surfaceClass, turns});
    }
    RTCGeometry geometry = rtcNewGeometry(m_embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), 3 * m_triangles.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), m_triangles.size()));
    for (uint32_t i = 0; i < 3 * m_triangles.size(); ++i) {
        const vec3& p = world.vertices[world.indices[m_triangles[i / 3].firstIndex + i % 3]].position;
        for (int axis = 0; axis < 3; ++axis)
            points[3 * i + static_cast<uint32_t>(axis)] = p[axis];
        indices[i] = i;
    }
    rtcSetGeometryOccludedFilterFunction(geometry, nameCandidate);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_embree->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(m_embree->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(m_embree->scene);
    m_farQu = 2.0 * double(glm::length(world.bounds.maxs - world.bounds.mins));
}

DoubleTracer::~DoubleTracer() = default;

/// A sprite turns about its middle: no farther than its longest edge.
Bounds DoubleTracer::boundSprite(const WorldSurface& surface) const {
    float longestEdge = 0;
    for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t from = m_world.indices[surface.firstIndex + i + k];
            const uint32_t to = m_world.indices[surface.firstIndex + i + (k + 1) % 3];
            longestEdge =
                std::max(longestEdge, glm::distance(m_world.vertices[from].position, m_world.vertices[to].position));
        }
    return {surface.bounds.mins - vec3(longestEdge), surface.bounds.maxs + vec3(longestEdge)};
}

void DoubleTracer::visitCandidates(const dvec3& origin, const dvec3& direction, double tMax,
                                   const std::function<bool(uint32_t)>& visit) const {
    CandidateQuery query{};
    query.visit = &visit;
    RTCRay ray{};
    const vec3 o(origin), d(direction);
    ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
    ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
    // A little more than asked for: what lies beyond is refused by the double intersection.
    ray.tfar = static_cast<float>(tMax * 1.001);
    ray.mask = ~0u;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&query.context);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query.context;
    rtcOccluded1(m_embree->scene, &ray, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    rtcOccluded1(m_embree->scene, &query.context, &ray);
#endif
}

dvec3 DoubleTracer::corner(uint32_t triangle, uint32_t k) const {
    return dvec3(m_world.vertices[m_world.indices[m_triangles[triangle].firstIndex + k]].position);
}

/// Fills t, triangle, surface and barycentric (Cramer's rule on origin + t direction = a + u (b - a) + v (c - a)).
bool DoubleTracer::intersect(uint32_t triangle, const dvec3& origin, const dvec3& direction, DoubleHit& hit) const {
    const dvec3 a = corner(triangle, 0), edge1 = corner(triangle, 1) - a, edge2 = corner(triangle, 2) - a;
    const dvec3 across = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, across);
    if (determinant == 0) return false;
    const dvec3 from = origin - a, side = glm::cross(from, edge1);
    const double u = glm::dot(from, across) / determinant, v = glm::dot(direction, side) / determinant;
    if (u < 0 || v < 0 || u + v > 1) return false;
    hit.t = glm::dot(edge2, side) / determinant;
    hit.triangle = triangle;
    hit.surface = m_triangles[triangle].surface;
    hit.barycentric = {u, v};
    return true;
}

/// Of alpha-tested surfaces: is there something at this point? Their first stage that covers decides.
bool DoubleTracer::isCovered(const DoubleHit& hit) const {
    const Material& material = m_materials.drawn(m_world.surfaces[hit.surface].material);
    const uint32_t first = m_triangles[hit.triangle].firstIndex;
    dvec2 st[3];
    for (uint32_t k = 0; k < 3; ++k)
        st[k] = dvec2(m_world.vertices[m_world.indices[first + k]].st);
    const dvec2 at = st[0] + (st[1] - st[0]) * hit.barycentric.x + (st[2] - st[0]) * hit.barycentric.y;
    for (const Stage& stage : material.stages) {
        if (stage.blended || stage.depthFunc == DepthFunc::Equal) continue;
        if (stage.alphaTest == AlphaTest::None || stage.unit[0].frames.empty()) return true;
        if (passesTest(stage.alphaTest, sampleAlpha(m_materials.textures().get(stage.unit[0].frames[0]), at)))
            return true;
    }
    return false;
}

std::optional<DoubleHit> DoubleTracer::look(const dvec3& origin, const dvec3& direction) const {
    std::optional<DoubleHit> nearest;
    double nearestOther = std::numeric_limits<double>::infinity();
    visitCandidates(origin, direction, m_farQu, [&](uint32_t triangle) {
        DoubleHit hit;
        if (!intersect(triangle, origin, direction, hit) || hit.t <= 0) return false;
        if (m_triangles[triangle].turns) return false;
        const SurfaceClass surfaceClass = m_triangles[triangle].surfaceClass;
        const dvec3 facing =
            glm::cross(corner(triangle, 2) - corner(triangle, 0), corner(triangle, 1) - corner(triangle, 0));
        const bool front = glm::dot(facing, direction) < 0;
        if (surfaceClass == SurfaceClass::Tested || surfaceClass == SurfaceClass::Layer) {
            nearestOther = std::min(nearestOther, hit.t);
            return false;
        }
        if (surfaceClass == SurfaceClass::Sky || (surfaceClass == SurfaceClass::Solid && !front)) return false;
        if (nearest && nearest->t <= hit.t) return false;
        hit.geometricNormal = glm::normalize(front ? facing : -facing);
        nearest = hit;
        return false;
    });
    if (!nearest || nearestOther < nearest->t) return std::nullopt;
    for (const Bounds& box : m_sprites)
        if (meetsBox(box, origin, direction, nearest->t)) return std::nullopt;
    DoubleHit& hit = *nearest;
    hit.position = origin + direction * hit.t;
    const uint32_t first = m_triangles[hit.triangle].firstIndex;
    dvec3 normal[3];
    for (uint32_t k = 0; k < 3; ++k)
        normal[k] = dvec3(m_world.vertices[m_world.indices[first + k]].normal);
    const dvec3 blend =
        normal[0] + (normal[1] - normal[0]) * hit.barycentric.x + (normal[2] - normal[0]) * hit.barycentric.y;
    const dvec3 facing = glm::cross(corner(hit.triangle, 2) - corner(hit.triangle, 0),
                                    corner(hit.triangle, 1) - corner(hit.triangle, 0));
    const double side = glm::dot(facing, direction) < 0 ? 1 : -1;
    hit.normal = glm::length(blend) > 0 ? glm::normalize(blend) * side : hit.geometricNormal;
    return hit;
}

bool DoubleTracer::isOpen(const dvec3& from, const dvec3& way, double tMax) const {
    const double own = kOwnSurfaceQu / glm::length(way);
    bool open = true;
    visitCandidates(from, way, tMax, [&](uint32_t triangle) {
        const SurfaceClass surfaceClass = m_triangles[triangle].surfaceClass;
        if (surfaceClass == SurfaceClass::Layer || m_triangles[triangle].turns) return false;
        DoubleHit hit;
        if (!intersect(triangle, from, way, hit) || hit.t <= own || hit.t >= tMax - own) return false;
        if (surfaceClass == SurfaceClass::Tested && !isCovered(hit)) return false;
        open = false;
        return true;
    });
    return open;
}

int DoubleTracer::findSky(const dvec3& from, const dvec3& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    int sky = -1;
    visitCandidates(from, direction, m_farQu, [&](uint32_t triangle) {
        if (m_triangles[triangle].surfaceClass != SurfaceClass::Sky) return false;
        DoubleHit hit;
        if (!intersect(triangle, from, direction, hit) || hit.t <= 0 || hit.t >= nearest) return false;
        nearest = hit.t;
        sky = static_cast<int>(hit.surface);
        return false;
    });
    return sky >= 0 && isOpen(from, direction, nearest) ? sky : -1;
}

/// The exact form factor times the visible share of `side` x `side` equal parts, each weighted by what it would give.
dvec3 DoubleTracer::triangleLight(const DoubleHit& hit, const TriangleLight& light, int side,
                                  std::mt19937& random) const {
    const dvec3 a(light.corner[0]), edge1 = dvec3(light.corner[1]) - a, edge2 = dvec3(light.corner[2]) - a;
    const dvec3 lightNormal(light.normal);
    double lit = 0, all = 0;
    bool anyOpen = false, anyBlocked = false;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            // A cell of the unit square and its mirror image across the diagonal fold to two equal triangles.
            double u = (i + uniform(random)) / side, v = (j + uniform(random)) / side;
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const dvec3 way = a + edge1 * u + edge2 * v - hit.position;
            const double receiver = glm::dot(hit.normal, way), squared = glm::dot(way, way);
            if (receiver <= 0) continue;
            const double weight = receiver * std::abs(glm::dot(lightNormal, way)) / (squared * squared);
            all += weight;
            const bool open = glm::dot(hit.geometricNormal, way) > 0 && isOpen(hit.position, way, 1.0);
            (open ? anyOpen : anyBlocked) = true;
            if (open) lit += weight;
        }
    if (anyOpen && anyBlocked && side == kFewStrata) return triangleLight(hit, light, kManyStrata, random);
    const double share = all > 0 ? lit / all : 0;
    return dvec3(light.radiance) * (kPi * formFactor(hit, light) * share);
}

dvec3 DoubleTracer::surfaceLight(const DoubleHit& hit, std::mt19937& random) const {
    const auto sizeOf = [&](const TriangleLight& light) {
        const double height = glm::dot(hit.position - dvec3(light.corner[0]), dvec3(light.normal));
        // No light reaches its own plane, also where the shading normal leans to it.
        if (std::abs(height) < kOwnSurfaceQu || (height < 0 && !light.twoSided)) return 0.0;
        if (isTooFaint(light, vec3(hit.position), vec3(hit.normal))) return 0.0;
        const vec3& l = light.radiance;
        return formFactor(hit, light) * double(l.r + l.g + l.b);
    };
    double all = 0;
    for (const TriangleLight& light : m_lights.triangles)
        all += sizeOf(light);
    dvec3 sum(0);
    for (const TriangleLight& light : m_lights.triangles) {
        const double size = sizeOf(light);
        if (size > 0) sum += triangleLight(hit, light, size < kFaintShare * all ? 1 : kFewStrata, random);
    }
    return sum;
}

dvec3 DoubleTracer::sunLight(const DoubleHit& hit, std::mt19937& random) const {
    dvec3 sum(0);
    for (const SunLight& sun : m_lights.suns) {
        const auto [tangent, bitangent] = frameAround(dvec3(sun.direction));
        const int side = sun.halfAngleRadians > 0 ? kSunStrata : 1;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double z = 1 - (i + uniform(random)) / side * (1 - std::cos(double(sun.halfAngleRadians)));
                const double around = 2 * kPi * (j + uniform(random)) / side, sine = std::sqrt(1 - z * z);
                const dvec3 direction = dvec3(sun.direction) * z + tangent * (sine * std::cos(around)) +
                                        bitangent * (sine * std::sin(around));
                const double cosine = glm::dot(direction, hit.normal);
                if (cosine > 0 && glm::dot(direction, hit.geometricNormal) > 0 && findSky(hit.position, direction) >= 0)
                    sum += dvec3(sun.irradiance) * (cosine / (side * side));
            }
    }
    return sum;
}

dvec3 DoubleTracer::skyLight(const DoubleHit& hit, std::mt19937& random) const {
    if (m_lights.skies.empty()) return dvec3(0);
    const auto radiosityOf = [&](int surface, const dvec3& direction) {
        dvec3 radiosity(0);
        for (const SkyLight& sky : m_lights.skies)
            if (sky.surface == surface && (!sky.upperHemisphere || direction.z > 0))
                radiosity += double(sky.radiosity) * dvec3(sky.color);
        return radiosity;
    };
    const auto [tangent, bitangent] = frameAround(hit.normal);
    dvec3 sum(0);
    for (int i = 0; i < kSkyStrata; ++i)
        for (int j = 0; j < kSkyStrata; ++j) {
            const double square = (i + uniform(random)) / kSkyStrata, radius = std::sqrt(square);
            const double around = 2 * kPi * (j + uniform(random)) / kSkyStrata;
            const dvec3 direction = tangent * (radius * std::cos(around)) + bitangent * (radius * std::sin(around)) +
                                    hit.normal * std::sqrt(1 - square);
            if (glm::dot(direction, hit.geometricNormal) <= 0) continue;
            const int sky = findSky(hit.position, direction);
            if (sky >= 0) sum += radiosityOf(sky, direction);
        }
    return sum / double(kSkyStrata * kSkyStrata);
}

dvec3 DoubleTracer::pointLight(const DoubleHit& hit) const {
    constexpr double kNearestQu = 16; // how the maps were baked
    dvec3 sum(0);
    for (const PointLight& light : m_lights.points) {
        const dvec3 way = dvec3(light.origin) - hit.position;
        const double distance = glm::length(way), cosine = glm::dot(way, hit.normal) / distance;
        const double share = light.spot ? double(spotShare(light, vec3(-way))) : 1;
        if (cosine <= 0 || share <= 0 || glm::dot(way, hit.geometricNormal) <= 0 || !isOpen(hit.position, way, 1))
            continue;
        const double near = std::max(distance, kNearestQu);
        const dvec3 given = dvec3(light.intensity) * (cosine / (near * near));
        if (std::max({given.x, given.y, given.z}) > double(light.faintest)) sum += share * given;
    }
    return sum;
}

dvec3 DoubleTracer::irradiance(const DoubleHit& hit, std::mt19937& random) const {
    dvec3 sum = sideIrradiance(hit, random);
    if (!isThin(m_materials.drawn(m_world.surfaces[hit.surface].material))) return sum;
    DoubleHit behind = hit;
    behind.normal = -hit.normal;
    behind.geometricNormal = -hit.geometricNormal;
    return sum + sideIrradiance(behind, random);
}

dvec3 DoubleTracer::sideIrradiance(const DoubleHit& hit, std::mt19937& random) const {
    return surfaceLight(hit, random) + sunLight(hit, random) + skyLight(hit, random) + pointLight(hit);
}

void deformWorld(World& world, const MaterialLibrary& materials) {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    for (WorldSurface& surface : world.surfaces) {
        const Material& material = materials.drawn(surface.material);
        if (!surface.drawn || material.deforms.empty() || deformsWithView(material) || surface.bspModel != 0) continue;
        const auto first = world.vertices.begin() + surface.firstVertex;
        vertices.assign(first, first + surface.vertexCount);
        deformVertices(material, {}, vertices, indices);
        std::copy(vertices.begin(), vertices.end(), first);
    }
}

} // namespace q3rt::test
