// q3rt-testmaps FOLDER: writes the game folder with the test maps.

#include <cstdio>
#include <exception>
#include <filesystem>

#include "baseq3-test/test_maps.hpp"
#include "formats/pk3.hpp"

int main(int argumentCount, char** arguments) {
    if (argumentCount != 2) {
        std::fprintf(stderr, "usage: q3rt-testmaps FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = arguments[1];
        std::filesystem::create_directories(folder);
        q3rt::writePk3(folder / "pak0.pk3", q3rt::buildTestGameFiles());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "q3rt-testmaps: %s\n", error.what());
        return 1;
    }
    return 0;
}
