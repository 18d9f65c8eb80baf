// Writes the blue-noise masks of the ray tracer's samples as a C++ header: four masks side by side, one for each
// component of a random vector.

#include <cstdio>

#include "renderer_rt/blue_noise/void_and_cluster.hpp"
#include "shaders/shared/rt_noise.h"

int main(int argc, char** argv) {
    using namespace q3rt;
    FILE* file = argc == 2 ? std::fopen(argv[1], "w") : nullptr;
    if (!file) {
        std::fprintf(stderr, "make_blue_noise: give the name of a header that can be written\n");
        return 1;
    }
    std::vector<uint16_t> masks[4];
    for (uint32_t k = 0; k < 4; ++k)
        masks[k] = makeBlueNoise(kBlueNoiseSide, k + 1);
    std::fprintf(file,
                 "#pragma once\n#include <cstdint>\nnamespace q3rt {\ninline constexpr uint16_t "
                 "kBlueNoise[%u][4] = {\n",
                 kBlueNoiseSide * kBlueNoiseSide);
    for (size_t i = 0; i < masks[0].size(); ++i)
        std::fprintf(file, "{%u,%u,%u,%u},\n", masks[0][i], masks[1][i], masks[2][i], masks[3][i]);
    std::fprintf(file, "};\n}\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
