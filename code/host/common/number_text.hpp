#pragma once
// Numbers as the user writes them.

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace q3rt {

/// The whole text as a number; nullopt: it is none, or none that fits. No blanks, no plus sign, and not of the user's
/// locale: a comma is no decimal point.
template <class Number>
std::optional<Number> parseNumber(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Two numbers with `mark` between them, such as 640x480.
template <class Number>
std::optional<std::pair<Number, Number>> parsePair(std::string_view text, std::string_view mark) {
    const size_t at = text.find(mark);
    if (at == std::string_view::npos) return std::nullopt;
    const auto first = parseNumber<Number>(text.substr(0, at)),
               second = parseNumber<Number>(text.substr(at + mark.size()));
    if (!first || !second) return std::nullopt;
    return std::pair{*first, *second};
}

} // namespace q3rt
