#pragma once
// .skin files: which shader each model surface wears.

#include <string>
#include <string_view>
#include <vector>

namespace q3rt {

struct SkinSurface {
    std::string surface; ///< lower case
    std::string shader;
};

/// Lines that name a tag are skipped. Never fails: an empty result means that the file says nothing.
std::vector<SkinSurface> parseSkin(std::string_view text);

} // namespace q3rt
