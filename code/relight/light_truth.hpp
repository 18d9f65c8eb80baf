#pragma once
// How well recovered lights agree with those of a map's source (.map text), where that is at hand.

#include <string_view>

#include "scene/lights.hpp"

namespace q3rt {

struct TruthReport {
    size_t sourceLights = 0;
    double sourceEnergy = 0, foundEnergy = 0; ///< sums of the lights' values (intensity / 7500)
    /// Of the source's energy: lights around which the sums over a ball of kTruthBallQu agree within a factor 1.5.
    double matchedShare = 0;
    double nearShare = 0; ///< of the found energy: lights with one of the source's within kTruthBallQu
};

inline constexpr float kTruthBallQu = 64;
inline constexpr double kTruthFactor = 1.5;

/// Point and spot lights of a .map file; its brushes are passed over.
std::vector<PointLight> parseMapSourceLights(std::string_view text);
TruthReport compareWithTruth(const std::vector<PointLight>& truth, const std::vector<PointLight>& found);

} // namespace q3rt
