#include <cmath>

#include "formats/entities.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        for (const MapEntity& entity : parseEntities(fuzz::asText(data, size))) {
            fuzz::require(std::isfinite(entity.number("light", 0)));
            if (const auto origin = entity.vector("origin")) fuzz::require(std::isfinite(origin->x));
            entity.className();
        }
    });
}
