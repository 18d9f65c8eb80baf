#include <cmath>

#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const Bsp bsp = parseBsp(fuzz::asBytes(data, size), "input.bsp");
        for (const BspSurface& surface : bsp.surfaces) {
            const BspShader& shader = bsp.shaders.at(static_cast<size_t>(surface.shader));
            fuzz::require(shader.name.size() <= 64);
            if (surface.type == BspSurfaceType::Patch) continue;
            if (surface.type == BspSurfaceType::Flare) continue;
            for (int i = 0; i < surface.indexCount; ++i) {
                const int index = bsp.indices.at(static_cast<size_t>(surface.firstIndex + i));
                fuzz::require(
                    std::isfinite(bsp.vertices.at(static_cast<size_t>(surface.firstVertex + index)).position.x));
            }
        }
        for (const BspLeaf& leaf : bsp.leafs)
            bsp.clusterVisible(leaf.cluster, 0);
        parseEntities(bsp.entities);
    });
}
