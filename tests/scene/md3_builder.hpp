#pragma once
// Writes small MD3 files for tests.

#include <cstddef>
#include <string>
#include <vector>

#include "math/vector.hpp"

namespace q3rt::test {

struct Md3TestFrame {
    vec3 mins{-8}, maxs{8};
    float radius = 8;
    std::vector<std::pair<std::string, Orientation>> tags;
    float height = 0; ///< z of the one triangle
};

/// One surface "body" with one triangle (0,0) (0,8) (8,0) at each frame's height, worn shader `shader`.
std::vector<std::byte> buildMd3(const std::vector<Md3TestFrame>& frames, const std::string& shader);

} // namespace q3rt::test
