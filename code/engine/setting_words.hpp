#pragma once
// A text setting that takes certain words only: they stand in its list as "one|two|three", the default among them.

#include <string>
#include <string_view>

namespace q3rt {

/// The word that a text is in any letter case, as the list spells it; empty if it is none of them.
std::string_view findWord(std::string_view words, std::string_view text);
/// "NAME takes one, two or three, not 'TEXT'"; empty if it takes the text, as it does any without words.
std::string complainOfWord(std::string_view name, std::string_view words, std::string_view text);

} // namespace q3rt
