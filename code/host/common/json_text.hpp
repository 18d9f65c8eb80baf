#pragma once
// JSON as the commands print it, of texts that may be anything.

#include <string>

#include <nlohmann/json.hpp>

namespace q3rt {

/// One line. The bytes of a path need be no UTF-8: what isn't becomes U+FFFD, so that the line is JSON all the same.
inline std::string toJsonText(const nlohmann::ordered_json& json) {
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// A path as text for any file that must be UTF-8.
inline std::string toUtf8(const std::string& text) { return nlohmann::ordered_json::parse(toJsonText(text)); }

} // namespace q3rt
