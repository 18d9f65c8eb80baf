#pragma once
// The entity lump: { "key" "value" ... } blocks.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

struct MapEntity {
    std::vector<std::pair<std::string, std::string>> pairs; ///< in file order, keys as written
    /// First value of `key` (case-insensitive), or nullopt.
    std::optional<std::string_view> value(std::string_view key) const;
    std::string_view className() const;
    std::optional<vec3> vector(std::string_view key) const;
    float number(std::string_view key, float fallback) const;
};

/// Tolerant: stops at the first malformed block and returns what came before.
std::vector<MapEntity> parseEntities(std::string_view text);

} // namespace q3rt
