// What light costs, and how it grows. The renderer draws views of maps in the headless engine; times are those of the
// processors, of all threads, per frame: on a software device they are the work, whatever else the machine does.
//
//   bench_growth culling [MAP...]  rt_cullLights 0, 1, 2 beside the lights that pixels try; without names all maps with
//                                  at least 100 triangle lights whose clusters see at most 0.4 of their map
//   bench_growth exponents         how time grows with pixels, lights per pixel, moving entities, world triangles

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/inspect/census.hpp"
#include "host/trade/session.hpp"

namespace {

using namespace q3rt;

constexpr PictureSize kSize{80, 60};
constexpr int kSettle = 3, kFrames = 3;
constexpr size_t kLeastLights = 100;
constexpr double kLargestShare = 0.4;

TradePoint makePoint(const PictureSize& size, std::map<std::string, std::string> settings) {
    settings.insert({{"rt_backend", "compute"}, {"rt_denoiser", "0"}, {"rt_taa", "0"}, {"rt_lostLights", "0"}});
    return {size, std::move(settings)};
}

double processorMs() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// Processor time of a frame, mean over views; the least of kFrames frames a view.
double measureMs(TradeSession& session, size_t viewCount, const TradePoint& point) {
    session.apply(point);
    double sum = 0;
    for (size_t view = 0; view < viewCount; ++view) {
        session.approach(view, kSettle);
        session.draw(view, true); // a captured picture is finished
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kFrames; ++i) {
            const double start = processorMs();
            session.draw(view, true);
            least = std::min(least, processorMs() - start);
        }
        sum += least;
    }
    return sum / double(viewCount);
}

struct LightWork {
    double tried = 0; ///< lights
    double rays = 0;
};

/// What a frame does, mean over views.
LightWork countWork(TradeSession& session, size_t viewCount, std::map<std::string, std::string> settings) {
    settings["rt_countWork"] = "1";
    session.apply(makePoint(kSize, settings));
    LightWork mean;
    for (size_t view = 0; view < viewCount; ++view) {
        session.approach(view, kSettle);
        session.draw(view, true);
        const auto stats = nlohmann::json::parse(session.stats());
        mean.tried += stats.at("work").at("lights_tried").get<double>() / double(viewCount);
        mean.rays += stats.at("rays").get<double>() / double(viewCount);
    }
    return mean;
}

struct MapFacts {
    size_t triangleLights = 0, spawnPoints = 0, triangles = 0;
    double visibleShare = 0; ///< of all clusters, mean over clusters
};

MapFacts findFacts(Pk3FileSource& files, const std::string& map) {
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + map + ".bsp", materials, WorldSettings{});
    const MapCensus census = takeCensus(*world, materials);
    const int count = world->bsp.clusterCount;
    double visible = 0;
    for (int from = 0; from < count; ++from)
        for (int to = 0; to < count; ++to)
            visible += world->bsp.clusterVisible(from, to) ? 1 : 0;
    return {census.triangleLights, census.spawnPoints, census.drawnTriangles,
            count > 0 ? visible / count / count : 1.0};
}

std::vector<std::string> spawnPlaces(const MapFacts& facts, size_t most) {
    std::vector<std::string> places;
    for (size_t i = 0; i < std::min(most, facts.spawnPoints); ++i)
        places.push_back("spawn:" + std::to_string(i));
    return places;
}

// --- culling

/// `| time ratio of a count's ratio: quotient |`, without culling over with it.
void printQuotient(double timeRatio, double countRatio) {
    std::printf(" %.2f of %.2f: %.2f |", timeRatio, countRatio, timeRatio / countRatio);
}

void benchCulling(const std::string& map, const MapFacts& facts) {
    const auto source = openMapSource({.map = map, .places = spawnPlaces(facts, 4)}, {});
    const size_t views = source->viewNames().size();
    TradeSession session(*source, findModule("rt"), false);
    const std::map<std::string, std::string> unlit = {{"rt_illumination", "0"}};
    const double unlitMs = measureMs(session, views, makePoint(kSize, unlit));
    const double looks = countWork(session, views, unlit).rays;
    double tried[3] = {}, rays[3] = {}, ms[3] = {};
    for (int cull = 0; cull < 3; ++cull) {
        const std::map<std::string, std::string> settings = {{"rt_numRandomDL", "0"},
                                                             {"rt_cullLights", std::to_string(cull)}};
        ms[cull] = measureMs(session, views, makePoint(kSize, settings)) - unlitMs;
        const LightWork work = countWork(session, views, settings);
        tried[cull] = work.tried / kSize.width / kSize.height;
        rays[cull] = (work.rays - looks) / kSize.width / kSize.height;
    }
    std::printf("| %s | %zu | %.2f | %.0f, %.0f, %.0f | %.1f, %.1f, %.1f | %.0f, %.0f, %.0f |", map.c_str(),
                facts.triangleLights, facts.visibleShare, tried[0], tried[1], tried[2], rays[0], rays[1], rays[2],
                ms[0], ms[1], ms[2]);
    printQuotient(ms[0] / ms[1], tried[0] / tried[1]);
    printQuotient(ms[0] / ms[1], rays[0] / rays[1]);
    printQuotient(ms[0] / ms[2], tried[0] / tried[2]);
    printQuotient(ms[0] / ms[2], rays[0] / rays[2]);
    std::printf("\n");
    std::fflush(stdout);
}

void runCulling(Pk3FileSource& files, std::vector<std::string> maps) {
    const bool chosen = !maps.empty();
    if (!chosen)
        for (const std::string& name : files.list("maps", ".bsp"))
            maps.push_back(name.substr(0, name.size() - 4));
    std::printf("| map | triangle lights | visible share | lights tried a pixel, rt_cullLights 0, 1, 2 | shadow rays "
                "| ms of light | time 0 / 1 of lights | of rays | 0 / 2 of lights | of rays |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& map : maps) {
        const MapFacts facts = findFacts(files, map);
        if (facts.spawnPoints == 0) continue;
        if (chosen || (facts.triangleLights >= kLeastLights && facts.visibleShare <= kLargestShare))
            benchCulling(map, facts);
    }
}

// --- exponents

struct Growth {
    double size = 0, ms = 0;
};

/// Slope of log time over log size, least squares.
double exponentOf(const std::vector<Growth>& points) {
    double x = 0, y = 0, xx = 0, xy = 0;
    const auto n = static_cast<double>(points.size());
    for (const Growth& p : points) {
        const double lx = std::log(p.size), ly = std::log(p.ms);
        x += lx, y += ly, xx += lx * lx, xy += lx * ly;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

void printGrowth(const char* what, const std::vector<Growth>& points) {
    std::printf("| %s | %.2f |", what, exponentOf(points));
    for (const Growth& p : points)
        std::printf(" %.0f: %.2f ms;", p.size, p.ms);
    std::printf(" |\n");
    std::fflush(stdout);
}

constexpr const char* kGrowthMap = "oa_shouse";

std::vector<Growth> growWithPixels(TradeSession& session) {
    std::vector<Growth> result;
    for (const PictureSize size : {PictureSize{80, 60}, {160, 120}, {320, 240}})
        result.push_back({double(size.width) * size.height, measureMs(session, 1, makePoint(size, {}))});
    return result;
}

std::vector<Growth> growWithLights(TradeSession& session) {
    const double unlit = measureMs(session, 1, makePoint(kSize, {{"rt_illumination", "0"}}));
    std::vector<Growth> result;
    for (const int lights : {1, 2, 4, 8, 16, 32})
        result.push_back(
            {double(lights),
             measureMs(session, 1, makePoint(kSize, {{"rt_numRandomDL", std::to_string(lights)}})) - unlit});
    return result;
}

/// Time that animated models add to a frame: none of them twice the same, all changing their shape in every frame.
class EntityCrowd {
  public:
    EntityCrowd(Pk3FileSource& files)
        : m_stage(files, kGrowthMap)
        , m_engine(files) {
        presetPicture(m_engine.cvars, kSize, {{"rt_backend", "compute"}, {"rt_denoiser", "0"}, {"rt_taa", "0"}});
        m_engine.showsMessages = false;
        m_engine.loadModule(findModule("rt"));
        m_stage.load(m_engine);
        m_engine.enter([this](const refexport_t& module) { m_model = module.RegisterModel(kModel); });
        m_eye = m_stage.findEye("spawn:1");
    }
    ~EntityCrowd() { m_engine.unloadModule(); }

    /// Processor time of a frame.
    double measure(int count) {
        const glconfig_t& config = m_engine.config();
        refdef_t view = makeView(m_eye, 90, config.vidWidth, config.vidHeight, 0);
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kSettle + 2 * kFrames; ++i) {
            view.time += 16;
            const double start = processorMs();
            m_engine.enter([&](const refexport_t& module) {
                module.BeginFrame(0);
                module.ClearScene();
                for (int e = 0; e < count; ++e) {
                    const refEntity_t entity = makeEntity(e, i);
                    module.AddRefEntityToScene(&entity);
                }
                module.RenderScene(&view);
            });
            m_engine.endFrame(true);
            if (i >= kSettle) least = std::min(least, processorMs() - start);
        }
        return least;
    }

  private:
    static constexpr const char* kModel = "models/players/sarge/lower.md3";

    refEntity_t makeEntity(int number, int frame) const {
        refEntity_t entity{};
        entity.reType = RT_MODEL;
        entity.hModel = m_model;
        for (int k = 0; k < 3; ++k)
            entity.axis[k][k] = 1;
        const float ring = 60.0f + 8.0f * static_cast<float>(number / 8), angle = 0.785f * static_cast<float>(number);
        entity.origin[0] = entity.lightingOrigin[0] = m_eye.origin.x + ring * std::cos(angle);
        entity.origin[1] = entity.lightingOrigin[1] = m_eye.origin.y + ring * std::sin(angle);
        entity.origin[2] = entity.lightingOrigin[2] = m_eye.origin.z;
        entity.frame = (number + frame) % 50;
        entity.oldframe = (number + frame + 49) % 50;
        entity.backlerp = 0.5f;
        return entity;
    }

    MapStage m_stage;
    HeadlessEngine m_engine;
    EyePoint m_eye;
    qhandle_t m_model = 0;
};

std::vector<Growth> growWithEntities(Pk3FileSource& files) {
    EntityCrowd crowd(files);
    const double none = crowd.measure(0);
    std::vector<Growth> result;
    for (const int count : {16, 32, 64, 128, 256})
        result.push_back({double(count), std::max(1e-3, crowd.measure(count) - none)});
    return result;
}

std::vector<Growth> growWithTriangles(Pk3FileSource& files) {
    std::vector<Growth> result;
    for (const char* map : {"fan", "q3dm6ish", "aggressor", "oa_dm1", "oa_shouse", "oacmpdm9", "oacmpctf3"}) {
        const MapFacts facts = findFacts(files, map);
        const auto source = openMapSource({.map = map, .places = spawnPlaces(facts, 4)}, {});
        const size_t views = source->viewNames().size();
        TradeSession session(*source, findModule("rt"), false);
        result.push_back({double(facts.triangles), measureMs(session, views, makePoint(kSize, {}))});
    }
    return result;
}

void runExponents(Pk3FileSource& files) {
    std::printf("| time grows with | exponent | |\n|---|---|---|\n");
    {
        const auto source = openMapSource({.map = kGrowthMap, .places = {"spawn:1"}}, {});
        TradeSession session(*source, findModule("rt"), false);
        printGrowth("pixels", growWithPixels(session));
        printGrowth("lights a pixel (what they add to an unlit frame)", growWithLights(session));
    }
    printGrowth("animated models (what they add to a frame)", growWithEntities(files));
    printGrowth("world triangles (seven maps, 4 views each)", growWithTriangles(files));
}

} // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "";
    try {
        const auto files = openGame({});
        if (mode == "culling")
            runCulling(*files, {argv + 2, argv + argc});
        else if (mode == "exponents")
            runExponents(*files);
        else
            return std::fprintf(stderr, "bench_growth culling [MAP...] | exponents\n"), 2;
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_growth: %s\n", error.what());
        return 1;
    }
}
