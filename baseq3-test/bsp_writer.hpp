#pragma once
// IBSP-46 bytes from the structs of the parser: what parseBsp reads back.

#include <cstddef>
#include <vector>

#include "formats/bsp.hpp"

namespace q3rt {

std::vector<std::byte> writeBsp(const Bsp& bsp);

} // namespace q3rt
