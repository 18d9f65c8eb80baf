#include "picture_source.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "formats/pk3_file_source.hpp"
#include "host/headless/replayer.hpp"
#include "host/still/map_stage.hpp"

namespace q3rt::parity {

namespace {

/// Of all map views: waves and scrolls are under way.
constexpr int kClockMs = 4321;
constexpr float kFovDegrees = 90;
constexpr float kEyeHeightQu = 26; // of a standing player, as spawn:N has it
/// Of a recording's frames between those that are kept.
constexpr size_t kDrawnEvery = 100;

/// Anything a player might stand on: duel and team maps name their starts otherwise.
std::vector<EyePoint> standingPlaces(const std::vector<MapEntity>& entities) {
    std::vector<EyePoint> points = findSpawnPoints(entities);
    if (!points.empty()) return points;
    for (const MapEntity& entity : entities) {
        const std::string_view kind = entity.className();
        if (!kind.starts_with("info_player") && !kind.starts_with("team_CTF")) continue;
        if (const auto origin = entity.vector("origin"))
            points.push_back({*origin + vec3(0, 0, kEyeHeightQu), 0, entity.number("angle", 0)});
    }
    return points;
}

void drawMap(const PictureSource& source, HeadlessEngine& engine, Pk3FileSource& files, const DrawSettings& settings,
             const std::filesystem::path& folder) {
    MapStage stage(files, source.map);
    engine.clockMs = kClockMs;
    presetPicture(engine.cvars, settings.size, settings.cvars);
    stage.load(engine);
    const std::vector<std::string> names = source.pictureNames();
    for (size_t i = 0; i < names.size(); ++i) {
        const refdef_t view = makeView(stage.findEye(source.places[i]), kFovDegrees, engine.config().vidWidth,
                                       engine.config().vidHeight, kClockMs);
        // Twice: what no surface covers keeps the picture before, which is then the same view's.
        for (const bool keep : {false, true}) {
            stage.drawScene(engine, view);
            const auto picture = engine.endFrame(keep);
            if (picture) writePng(folder / (names[i] + ".png"), *picture);
        }
    }
}

void drawDemo(const PictureSource& source, HeadlessEngine& engine, Recording& recording, const DrawSettings& settings,
              const std::filesystem::path& folder) {
    Replayer replayer(recording, engine, {settings.size.width, settings.size.height, settings.cvars});
    const std::vector<std::string> names = source.pictureNames();
    size_t next = 0;
    for (size_t i = 0; i < recording.frameCount() && next < names.size(); ++i) {
        const Recording::Frame frame = recording.readFrame(i);
        const bool wanted = frame.number == source.frames[next];
        // The original queues colours until a frame ends, and takes no command more when its queue is full.
        const bool drawn = i % kDrawnEvery == 0;
        const auto result = replayer.play(frame, wanted  ? Replayer::Draw::Capture
                                                 : drawn ? Replayer::Draw::Frame
                                                         : Replayer::Draw::Nothing);
        if (wanted && result.picture) writePng(folder / (names[next] + ".png"), *result.picture);
        if (wanted) ++next;
    }
}

} // namespace

std::vector<std::string> PictureSource::pictureNames() const {
    std::vector<std::string> names;
    for (size_t i = 0; i < places.size(); ++i)
        names.push_back(formatText("camera%zu", i));
    for (const int frame : frames)
        names.push_back(formatText("%08d", frame));
    return names;
}

std::vector<std::string> listMaps(FileSource& files) {
    std::vector<std::string> maps = files.list("maps", ".bsp");
    for (std::string& map : maps)
        map.erase(map.rfind('.'));
    std::ranges::sort(maps);
    maps.erase(std::unique(maps.begin(), maps.end()), maps.end());
    return maps;
}

PictureSource mapSource(FileSource& files, const std::string& map, int count) {
    const auto bytes = files.read("maps/" + map + ".bsp");
    if (!bytes) throw ContentError("maps/" + map + ".bsp is not in the game's archives; choose other maps");
    const std::vector<EyePoint> points = standingPlaces(parseEntities(parseBsp(*bytes, map).entities));
    if (points.empty()) throw ContentError("maps/" + map + ".bsp has no place to stand");
    PictureSource source;
    source.name = source.map = map;
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
        const EyePoint& eye = points[i % points.size()];
        const auto quarters = static_cast<float>(i / points.size());
        source.places.push_back(formatText("%.9g %.9g %.9g %.9g %.9g", static_cast<double>(eye.origin.x),
                                           static_cast<double>(eye.origin.y), static_cast<double>(eye.origin.z),
                                           static_cast<double>(eye.pitchDegrees),
                                           static_cast<double>(eye.yawDegrees + 90.0f * quarters)));
    }
    return source;
}

PictureSource demoSource(const std::string& demo, const std::filesystem::path& recording, int count) {
    PictureSource source;
    source.name = demo;
    source.recording = recording;
    const TraceInfo info = Recording(recording).info();
    const auto available = static_cast<int>(info.frameCount);
    for (int i = 0; i < std::min(count, available); ++i)
        source.frames.push_back(static_cast<int>(info.firstFrame) + (2 * i + 1) * available / (2 * count));
    return source;
}

void drawPictures(const PictureSource& source, const std::filesystem::path& module, const DrawSettings& settings,
                  const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    if (!source.map.empty()) {
        const auto files = openGame(settings.game);
        HeadlessEngine engine(*files);
        engine.showsMessages = false;
        engine.loadModule(module);
        drawMap(source, engine, *files, settings, folder);
        engine.unloadModule();
        return;
    }
    Recording recording(source.recording);
    RecordedFiles files(recording, settings.game);
    HeadlessEngine engine(files);
    engine.showsMessages = false;
    engine.loadModule(module);
    drawDemo(source, engine, recording, settings, folder);
    engine.unloadModule();
}

} // namespace q3rt::parity
