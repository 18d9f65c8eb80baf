#pragma once
// What is compared: views of maps at rest, and frames of demos.

#include <string>
#include <vector>

#include "host/common/session.hpp"

namespace q3rt::parity {

/// Pictures that one run of a module draws, in this order.
struct PictureSource {
    std::string name;                ///< of the map or demo
    std::string map;                 ///< empty: a recording
    std::vector<std::string> places; ///< of the map: "x y z pitch yaw" or spawn:N
    std::filesystem::path recording;
    std::vector<int> frames; ///< of the recording, rising
    std::vector<std::string> pictureNames() const;
};

/// Every map of the game, by name.
std::vector<std::string> listMaps(FileSource& files);
/// `count` cameras: the first player starts; where a map has fewer, they turn by quarters.
PictureSource mapSource(FileSource& files, const std::string& map, int count);
/// `count` frames spread evenly over the recording.
PictureSource demoSource(const std::string& demo, const std::filesystem::path& recording, int count);

struct DrawSettings {
    PictureSize size{640, 480};
    CvarList cvars;
    GameChoice game;
};
/// Draws the source's pictures with a module into `folder`, as PNG files of their names.
void drawPictures(const PictureSource& source, const std::filesystem::path& module, const DrawSettings& settings,
                  const std::filesystem::path& folder);

} // namespace q3rt::parity
