#pragma once
// Small models with bones, made in memory: a square bar of length 32 along x whose outer half bends upward, 45 degrees
// more with each frame. The middle ring follows both bones by half.

#include <cstddef>
#include <string>
#include <vector>

namespace q3rt::test {

struct BarOptions {
    std::string surface = "Bar", shader = "models/bar";
    int frames = 3;
    float thickness = 8;     ///< qu
    bool compressed = false; ///< MDR: bones in 16-bit steps
    int lods = 1;            ///< MDR: the bar is half as thick in each
    bool colors = false;     ///< IQM: red at the root, blue at the tip
    bool floatWeights = false;
    bool bounds = true;
    bool skeleton = true; ///< IQM: false leaves joints and frames out
};
std::vector<std::byte> makeBarMdr(const BarOptions& options = {});
std::vector<std::byte> makeBarIqm(const BarOptions& options = {});

/// Names of the bones, root first.
inline constexpr const char* kBarBones[2] = {"root", "tip"};
inline constexpr float kBarBendDegrees = 45, kBarLengthQu = 32;

} // namespace q3rt::test
