#pragma once
// --set and --size are for one run, but the engine writes every archived cvar into the player's configuration. What
// such a run sets is put back when it is over; what the player changes in the game meanwhile (keys, volume ...) stays.

#include <filesystem>

#include "host/common/session.hpp"

namespace q3rt {

class KeptConfiguration {
  public:
    /// `folder` holds the engine's configuration. Notes in a file beside it how `settings` stand there, and first puts
    /// back what a run that was killed had noted.
    KeptConfiguration(std::filesystem::path folder, const CvarList& settings);
    /// After the engine's end: puts them back.
    ~KeptConfiguration();
    KeptConfiguration(const KeptConfiguration&) = delete;
    KeptConfiguration& operator=(const KeptConfiguration&) = delete;

  private:
    std::filesystem::path m_folder, m_note;
};

} // namespace q3rt
