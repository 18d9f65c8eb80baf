// Questions that the game asks a renderer, asked of the packaged opengl1 module and of our scene: marks, light, tags
// and bounds of real maps and models must agree.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "host/headless/headless_engine.hpp"
#include "scene/model.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

constexpr const char* kModule = "/usr/lib/ioquake3/renderer_opengl1_x86_64.so";
constexpr const char* kModel = "models/players/sarge/upper.md3";
constexpr unsigned kSeed = 3;

vec3 toVec3(const float* v) { return {v[0], v[1], v[2]}; }

/// Both renderers with one map and one model loaded.
class QueriesTest : public testing::TestWithParam<const char*> {
  protected:
    std::unique_ptr<Pk3FileSource> m_files = openGameData();
    std::unique_ptr<HeadlessEngine> m_engine;
    std::unique_ptr<TextureLibrary> m_textures;
    std::unique_ptr<MaterialLibrary> m_materials;
    std::unique_ptr<ModelLibrary> m_models;
    std::unique_ptr<World> m_world;
    qhandle_t m_theirModel = 0;
    int m_ourModel = 0;
    std::mt19937 m_random{kSeed};

    void SetUp() override {
        if (!m_files) GTEST_SKIP() << kNoGameData;
        if (!std::filesystem::exists(kModule)) GTEST_SKIP() << "needs the packaged renderer: install ioquake3";
        if (!std::getenv("DISPLAY")) GTEST_SKIP() << "needs an X display: run it under xvfb-run";
        m_name = std::string("maps/") + GetParam() + ".bsp";
        m_engine = std::make_unique<HeadlessEngine>(*m_files);
        m_engine->showsMessages = false;
        m_engine->cvars.preset("r_fullscreen", "0");
        m_engine->loadModule(kModule);
        m_engine->beginRegistration();
        const char* map = m_name.c_str();
        qhandle_t* model = &m_theirModel;
        auto load = [map, model](const refexport_t& module) {
            module.LoadWorld(map);
            *model = module.RegisterModel(kModel);
        };
        m_engine->enter(load);
        m_textures = std::make_unique<TextureLibrary>(*m_files, TextureSettings{});
        m_materials = std::make_unique<MaterialLibrary>(*m_files, *m_textures, MaterialSettings{});
        m_models = std::make_unique<ModelLibrary>(*m_files, *m_materials);
        m_world = loadWorld(*m_files, m_name, *m_materials, WorldSettings{});
        m_ourModel = m_models->registerModel(kModel);
    }

    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(m_random); }

    /// Half of them in the map, half near a vertex of it.
    vec3 randomPoint() {
        const BspModel& box = m_world->bsp.models[0];
        if (m_random() % 2) {
            return m_world->vertices[m_random() % m_world->vertices.size()].position +
                   vec3(between(-8, 8), between(-8, 8), between(-8, 8));
        }
        return {between(box.mins.x, box.maxs.x), between(box.mins.y, box.maxs.y), between(box.mins.z, box.maxs.z)};
    }

  private:
    std::string m_name;
};

TEST_P(QueriesTest, LightForPoint) {
    constexpr int kPoints = 1000;
    float worst = 0;
    for (int i = 0; i < kPoints; ++i) {
        const vec3 point = randomPoint();
        struct Answer {
            float point[3], ambient[3], directed[3], direction[3];
            int found;
        } answer{{point.x, point.y, point.z}, {}, {}, {}, 0};
        Answer* a = &answer;
        auto ask = [a](const refexport_t& module) {
            a->found = module.LightForPoint(a->point, a->ambient, a->directed, a->direction);
        };
        m_engine->enter(ask);
        ASSERT_EQ(answer.found, 1);
        const GridLight light = m_world->grid.sample(point);
        worst = std::max({worst, glm::distance(light.ambient * 0.6f, toVec3(answer.ambient)),
                          glm::distance(light.directed, toVec3(answer.directed)),
                          glm::distance(light.direction, toVec3(answer.direction))});
    }
    std::printf("%s: %d points, largest difference of a light %g of 255\n", GetParam(), kPoints,
                static_cast<double>(worst));
    EXPECT_LT(worst, 0.01f);
}

struct MarkQuery {
    float polygon[4][3], projection[3];
    float points[384][3];
    markFragment_t fragments[128];
    int count;
};

/// A square of half width `size` that looks along `direction`, clockwise as seen along it.
void makeSquare(MarkQuery& query, const vec3& centre, const vec3& direction, float size) {
    const vec3 other = std::abs(direction.z) < 0.9f ? vec3(0, 0, 1) : vec3(1, 0, 0);
    const vec3 right = glm::normalize(glm::cross(direction, other)) * size;
    const vec3 up = glm::cross(right, direction);
    const vec3 corners[4] = {centre + right + up, centre + right - up, centre - right - up, centre - right + up};
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) {
            query.polygon[i][k] = corners[i][k];
            query.projection[k] = direction[k] * 20;
        }
    }
}

TEST_P(QueriesTest, MarkFragments) {
    constexpr int kMarks = 1500;
    int fragments = 0, differentCounts = 0, differentPoints = 0;
    for (int i = 0; i < kMarks; ++i) {
        const WorldSurface& surface = m_world->surfaces[m_random() % m_world->surfaces.size()];
        if (surface.indexCount == 0) continue;
        const size_t corner = surface.firstIndex + m_random() % (surface.indexCount / 3) * 3;
        const Vertex& vertex = m_world->vertices[m_world->indices[corner]];
        const vec3 centre = (vertex.position + m_world->vertices[m_world->indices[corner + 1]].position +
                             m_world->vertices[m_world->indices[corner + 2]].position) /
                            3.0f;
        const vec3 tilt(between(-0.3f, 0.3f), between(-0.3f, 0.3f), between(-0.3f, 0.3f));
        const vec3 direction = glm::normalize(-vertex.normal + tilt);
        static MarkQuery query;
        makeSquare(query, centre, direction, between(4, 64));
        auto ask = [](const refexport_t& module) {
            query.count =
                module.MarkFragments(4, query.polygon, query.projection, 384, query.points[0], 128, query.fragments);
        };
        m_engine->enter(ask);
        std::vector<vec3> polygon, points;
        for (const auto& point : query.polygon) {
            polygon.push_back(toVec3(point));
        }
        std::vector<MarkFragment> ours;
        const int count = MarkClipper().clip(*m_world, *m_materials, polygon, toVec3(query.projection), 384, points,
                                             128, ours, false);
        fragments += query.count;
        if (count != query.count) {
            ++differentCounts;
            continue;
        }
        float worst = 0;
        for (int f = 0; f < count; ++f) {
            const auto at = static_cast<size_t>(f);
            ASSERT_EQ(ours[at].firstPoint, query.fragments[f].firstPoint);
            if (ours[at].pointCount != query.fragments[f].numPoints) worst = 1e9f;
            for (int p = 0; p < std::min(ours[at].pointCount, query.fragments[f].numPoints); ++p) {
                const int n = ours[at].firstPoint + p;
                worst = std::max(worst, glm::distance(points[static_cast<size_t>(n)], toVec3(query.points[n])));
            }
        }
        differentPoints += worst > 0.02f;
    }
    std::printf("%s: %d marks, %d fragments; %d differ in number, %d in points\n", GetParam(), kMarks, fragments,
                differentCounts, differentPoints);
    EXPECT_GT(fragments, 100);
    EXPECT_EQ(differentCounts + differentPoints, 0);
}

TEST_P(QueriesTest, TagsAndBounds) {
    ASSERT_GT(m_theirModel, 0);
    ASSERT_GT(m_ourModel, 0);
    float worst = 0;
    constexpr int kTags = 300;
    for (int i = 0; i < kTags; ++i) {
        struct Query {
            qhandle_t model;
            int start, end, found;
            float fraction;
            const char* tag;
            orientation_t result;
        } query{m_theirModel,
                static_cast<int>(m_random() % 200),
                static_cast<int>(m_random() % 200),
                0,
                between(0, 1),
                i % 10 == 0 ? "TAG_HEAD"
                : i % 2     ? "tag_head"
                            : "tag_weapon",
                orientation_t{}};
        Query* q = &query;
        auto ask = [q](const refexport_t& module) {
            q->found = module.LerpTag(&q->result, q->model, q->start, q->end, q->fraction, q->tag);
        };
        m_engine->enter(ask);
        Orientation ours;
        const bool found = m_models->lerpTag(m_ourModel, query.start, query.end, query.fraction, query.tag, ours);
        ASSERT_EQ(found, query.found != 0);
        worst = std::max(worst, glm::distance(ours.origin, toVec3(query.result.origin)));
        for (int k = 0; k < 3; ++k) {
            worst = std::max(worst, glm::distance(ours.axis[k], toVec3(query.result.axis[k])));
        }
    }
    EXPECT_LT(worst, 1e-4f);
    struct Box {
        qhandle_t model;
        float mins[3], maxs[3];
    } box{m_theirModel, {}, {}};
    Box* b = &box;
    auto ask = [b](const refexport_t& module) { module.ModelBounds(b->model, b->mins, b->maxs); };
    m_engine->enter(ask);
    const Bounds ours = m_models->modelBounds(m_ourModel, m_world.get());
    EXPECT_EQ(ours.mins, toVec3(box.mins));
    EXPECT_EQ(ours.maxs, toVec3(box.maxs));
    std::printf("%s: %d tags, largest difference %g\n", GetParam(), kTags, static_cast<double>(worst));
}

INSTANTIATE_TEST_SUITE_P(Maps, QueriesTest, testing::Values("oa_shouse", "oa_dm5", "suspended", "oacmpdm1"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace q3rt::test
