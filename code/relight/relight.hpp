#pragma once
// The light that a map lost, from its own lightmap: strengths of what its scripts name, bounces, and point lights at
// free places that explain the rest. How and why: docs/lost_light.md.
// The work goes in stages. What a stage starts from is the text of the one before, so that work that was broken off
// goes on to the same end.

#include <functional>

#include "relight/relight_model.hpp"

namespace q3rt {

struct RelightStage {
    size_t points = 0;
    double cost = 0; ///< of the fit
    LightScore score;
};

struct RelightResult {
    LostLights lights;
    LightScore before, after; ///< held-out luxels: as scripted, without and with bounces; as recovered
    std::vector<RelightStage> stages;
    size_t patchCount = 0, luxelCount = 0;
    double shownShare = 0; ///< of the luxels' area that can be seen
};

/// Told of the work as it goes on. What a call throws ends the work.
struct RelightProgress {
    std::function<void(size_t done, size_t all)> step;   ///< in steps of about the same time
    std::function<void(const LostLights& lights)> stage; ///< the lights after each stage
};

/// `begun`: lights of an earlier run with the same settings that was broken off; null: from the start.
/// A map without luxels gives no result but luxelCount 0.
RelightResult relight(const World& world, const MaterialLibrary& materials, const RelightSettings& settings,
                      const LostLights* begun, const RelightProgress& progress);

} // namespace q3rt
