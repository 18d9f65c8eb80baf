#include "host/still/map_stage.hpp"

#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "host/common/number_text.hpp"

namespace q3rt {

Place parsePlace(const std::string& at) {
    Place place;
    constexpr std::string_view kSpawn = "spawn:";
    if (at.starts_with(kSpawn))
        if ((place.spawnPoint = parseNumber<unsigned>(at.substr(kSpawn.size())))) return place;
    EyePoint& eye = place.eye;
    char rest = 0;
    const int numbers = std::sscanf(at.c_str(), "%f %f %f %f %f %c", &eye.origin.x, &eye.origin.y, &eye.origin.z,
                                    &eye.pitchDegrees, &eye.yawDegrees, &rest);
    const float sum = eye.origin.x + eye.origin.y + eye.origin.z + eye.pitchDegrees + eye.yawDegrees;
    if (numbers != 5 || !std::isfinite(sum))
        throw UsageError("'" + at + "' is no place: write \"x y z pitch yaw\" or spawn:N");
    return place;
}

MapStage::MapStage(Pk3FileSource& files, const std::string& map)
    : m_file("maps/" + map + ".bsp") {
    const Bsp bsp = parseBsp(readMap(files, map), m_file);
    const std::vector<MapEntity> entities = parseEntities(bsp.entities);
    m_spawnPoints = findSpawnPoints(entities);
    m_scene = buildStillScene(bsp, entities);
}

EyePoint MapStage::findEye(const std::string& at) const {
    const Place place = parsePlace(at);
    if (!place.spawnPoint) return place.eye;
    if (m_spawnPoints.empty())
        throw UsageError(m_file + " has no spawn points: name a place with --at \"x y z pitch yaw\"");
    if (*place.spawnPoint >= m_spawnPoints.size())
        throw UsageError(formatText("%s has %zu spawn points, numbered from 0: choose another --at", m_file.c_str(),
                                    m_spawnPoints.size()));
    return m_spawnPoints[*place.spawnPoint];
}

void MapStage::load(HeadlessEngine& engine) {
    engine.beginRegistration();
    engine.enter([this](const refexport_t& module) { module.LoadWorld(m_file.c_str()); });
    for (StillEntity& still : m_scene) {
        if (still.model.empty()) continue;
        engine.enter(
            [&](const refexport_t& module) { still.entity.hModel = module.RegisterModel(still.model.c_str()); });
    }
    std::erase_if(m_scene, [](const StillEntity& still) { return !still.model.empty() && still.entity.hModel == 0; });
    engine.enter([](const refexport_t& module) { module.EndRegistration(); });
}

void MapStage::drawScene(HeadlessEngine& engine, const refdef_t& view) const {
    // As the engine does it: with coloured glasses one eye after the other.
    const bool stereo = engine.cvars.value("r_anaglyphMode") != "" && engine.cvars.value("r_anaglyphMode") != "0";
    for (int eye = stereo ? 1 : 0; eye <= (stereo ? 2 : 0); ++eye)
        engine.enter([&](const refexport_t& module) {
            module.BeginFrame(eye);
            module.ClearScene();
            for (const StillEntity& still : m_scene)
                module.AddRefEntityToScene(&still.entity);
            module.RenderScene(&view);
        });
}

void presetPicture(CvarTable& cvars, const PictureSize& size, const CvarList& settings) {
    for (const auto& [name, value] : CvarList{{"r_mode", "-1"},
                                              {"r_customwidth", std::to_string(size.width)},
                                              {"r_customheight", std::to_string(size.height)},
                                              {"r_fullscreen", "0"},
                                              {"r_swapInterval", "0"},
                                              {"q3rt_wantStats", "1"}})
        cvars.preset(name, value);
    for (const auto& [name, value] : settings)
        cvars.preset(name, value);
}
} // namespace q3rt
