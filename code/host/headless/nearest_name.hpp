#pragma once
// What a mistyped name was probably meant to be.

#include <span>
#include <string>

namespace q3rt {

/// " (did you mean X?)" for the nearest of `names`, whatever the case; empty if none is near enough to be a slip.
std::string hintAtNearest(const std::string& name, std::span<const std::string> names);

} // namespace q3rt
