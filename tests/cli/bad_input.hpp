#pragma once
// Game folders, recordings and pictures of which each is spoiled in one way. Made in memory: no game data is needed.

#include <filesystem>
#include <string>

namespace q3rt::test {

/// The map that the spoiled game folders are about.
inline constexpr const char* kBadMap = "room_square_light";

/// Fills `folder`:
///   good, none, cut_archive, spoiled_entry, cut_map, hostile_map, empty_map, spoiled_content: base folders of a game
///     baseoa (the last one has a good map and a bad image, script and model)
///   good.q3t, cut.q3t, spoiled.q3t, empty.q3t, text.q3t: recordings
///   good.png, cut.png, cut.jpg, cut.tga, cut.pfm, text.exr, small.png: pictures
void makeBadInput(const std::filesystem::path& folder);

} // namespace q3rt::test
