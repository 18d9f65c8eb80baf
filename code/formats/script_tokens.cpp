#include "formats/script_tokens.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "formats/shader_script.hpp"

namespace q3rt {
namespace {

/// Control characters and, because characters are signed to this language, every byte from 128 on.
bool isScriptSpace(char c) { return static_cast<signed char>(c) <= ' '; }

bool startsComment(std::string_view text, char second) {
    return text.size() >= 2 && text[0] == '/' && text[1] == second;
}

/// Length of the block comment at the start of `text`; all of it if the comment never ends.
size_t blockCommentLength(std::string_view text) {
    const size_t end = text.find("*/", 2);
    return end == std::string_view::npos ? text.size() : end + 2;
}

size_t lineCommentLength(std::string_view text) { return std::min(text.find('\n'), text.size()); }

/// Skips white space and comments. True if a line ended outside a block comment.
bool skipScriptSpace(std::string_view& text, int& line) {
    bool lineEnded = false;
    while (!text.empty()) {
        size_t length = 1;
        if (startsComment(text, '/')) {
            length = lineCommentLength(text);
        } else if (startsComment(text, '*')) {
            length = blockCommentLength(text);
            line += static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(length), '\n'));
        } else if (isScriptSpace(text[0])) {
            if (text[0] == '\n') {
                ++line;
                lineEnded = true;
            }
        } else {
            break;
        }
        text.remove_prefix(length);
    }
    return lineEnded;
}

/// Cuts the token that `text` starts with; `text` is neither empty nor at white space.
std::string cutScriptToken(std::string_view& text, int& line) {
    if (text[0] == '"') {
        const size_t close = std::min(text.find('"', 1), text.size());
        std::string token(text.substr(1, close - 1));
        line += static_cast<int>(std::count(token.begin(), token.end(), '\n'));
        text.remove_prefix(std::min(close + 1, text.size()));
        return token;
    }
    const auto end = std::find_if(text.begin(), text.end(), isScriptSpace);
    std::string token(text.begin(), end);
    text.remove_prefix(token.size());
    return token;
}

/// Script text without comments, and the line of the file that each of its characters came from.
struct StrippedScript {
    std::string text;
    std::vector<int> lineOfCharacter;
};

StrippedScript stripComments(std::string_view source) {
    StrippedScript stripped;
    stripped.text.reserve(source.size());
    stripped.lineOfCharacter.reserve(source.size());
    int line = 1;
    const auto take = [&](size_t length, bool keep) {
        for (size_t i = 0; i < length; ++i) {
            const char c = source[i];
            if (keep) {
                stripped.text.push_back(c == '\r' ? '\n' : c);
                stripped.lineOfCharacter.push_back(line);
            }
            const bool loneReturn = c == '\r' && (i + 1 >= source.size() || source[i + 1] != '\n');
            if (c == '\n' || loneReturn) ++line;
        }
        source.remove_prefix(length);
    };
    while (!source.empty()) {
        if (startsComment(source, '/'))
            take(lineCommentLength(source), false);
        else if (startsComment(source, '*'))
            take(blockCommentLength(source), false);
        else if (source[0] == '"')
            take(std::min(std::min(source.find('"', 1), source.size()) + 1, source.size()), true);
        else
            take(1, true);
    }
    return stripped;
}

} // namespace

std::optional<std::string> nextScriptToken(std::string_view& text, int& line, bool stayOnLine) {
    const bool lineEnded = skipScriptSpace(text, line);
    if (text.empty() || (lineEnded && stayOnLine)) return std::nullopt;
    return cutScriptToken(text, line);
}

std::vector<ScriptToken> tokenizeScript(std::string_view text) {
    const StrippedScript stripped = stripComments(text);
    std::vector<ScriptToken> tokens;
    std::string_view rest = stripped.text;
    int unusedLine = 0;
    while (true) {
        const bool lineEnded = skipScriptSpace(rest, unusedLine);
        if (rest.empty()) return tokens;
        const size_t offset = stripped.text.size() - rest.size();
        ScriptToken token;
        token.line = stripped.lineOfCharacter[offset];
        token.firstOnLine = lineEnded;
        token.text = cutScriptToken(rest, unusedLine);
        tokens.push_back(std::move(token));
    }
}

float parseScriptNumber(std::string_view token) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
    // Words such as "inf" and "nan" are words here, not numbers.
    const size_t firstDigit = token.find_first_not_of("-.");
    if (firstDigit == std::string_view::npos || token[firstDigit] < '0' || token[firstDigit] > '9') return 0.0f;
    double value = 0.0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error == std::errc::invalid_argument) return 0.0f;
    if (error == std::errc::result_out_of_range) {
        const std::string_view number(token.data(), static_cast<size_t>(end - token.data()));
        const size_t exponent = number.find_first_of("eE");
        const std::string_view mantissa = number.substr(0, exponent);
        const bool tiny =
            exponent == std::string_view::npos
                ? mantissa.substr(0, mantissa.find('.')).find_first_of("123456789") == std::string_view::npos
                : number[std::min(exponent + 1, number.size() - 1)] == '-';
        if (tiny) return 0.0f;
        return token[0] == '-' ? -kLargest : kLargest;
    }
    return static_cast<float>(std::clamp(value, -static_cast<double>(kLargest), static_cast<double>(kLargest)));
}

} // namespace q3rt
