#pragma once
// The cross-references of a parsed map. After this check no index of a Bsp leads outside its array.

#include <string_view>

#include "formats/bsp.hpp"

namespace q3rt {

/// Throws ContentError naming the map, the lump and the first bad record.
void checkBspReferences(const Bsp& bsp, std::string_view name);

} // namespace q3rt
