#pragma once
// A map as a module draws it without a game: loaded, movers at rest, seen from any point. Shared by the commands that
// draw still views.

#include <optional>
#include <string>
#include <vector>

#include "host/common/session.hpp"
#include "host/still/still_scene.hpp"

namespace q3rt {

/// Where to look from.
struct Place {
    std::optional<unsigned> spawnPoint;
    EyePoint eye; ///< if it is no spawn point
};
/// From "x y z pitch yaw" (units, degrees) or spawn:N. Throws UsageError.
Place parsePlace(const std::string& at);

class MapStage {
  public:
    /// Reads the map. Throws ContentError if it isn't there or is damaged.
    MapStage(Pk3FileSource& files, const std::string& map);

    const std::string& file() const { return m_file; } ///< such as maps/oa_dm1.bsp
    /// Throws UsageError if parsePlace does or the map has no such spawn point.
    EyePoint findEye(const std::string& at) const;
    size_t spawnPointCount() const { return m_spawnPoints.size(); }

    /// Starts the loaded module with this map: registration from begin to end. Models that are missing are left out.
    void load(HeadlessEngine& engine);
    /// One frame's calls up to RenderScene; the caller ends the frame.
    void drawScene(HeadlessEngine& engine, const refdef_t& view) const;

  private:
    std::string m_file;
    std::vector<EyePoint> m_spawnPoints;
    std::vector<StillEntity> m_scene;
};

/// What makes a headless module draw pictures of this size, with these settings on top, and tell its times.
void presetPicture(CvarTable& cvars, const PictureSize& size, const CvarList& settings);

} // namespace q3rt
