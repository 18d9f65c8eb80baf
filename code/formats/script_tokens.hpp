#pragma once
// The two steps that turn a script's text into tokens: comments go first (even inside a word), words are cut
// afterwards.

#include <string>
#include <string_view>
#include <vector>

namespace q3rt {

/// One word of a script, with what a parser needs to keep arguments on their keyword's line.
struct ScriptToken {
    std::string text;
    int line = 0;             ///< 1-based, in the file as written
    bool firstOnLine = false; ///< a line break (outside comments) stands between this token and the one before
};

/// Tokens of a whole script as the merged script text holds them: comments are removed wherever they stand outside
/// quotes, also inside a word ("a//b" is "a"), and a lone carriage return breaks a line.
std::vector<ScriptToken> tokenizeScript(std::string_view text);

} // namespace q3rt
