#pragma once
// Letter case of content names: ASCII only, whatever the locale.

#include <string>
#include <string_view>

namespace q3rt {

inline char toLowerAscii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

inline std::string toLowerAscii(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        c = toLowerAscii(c);
    return lower;
}

inline bool equalsIgnoringCase(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    for (size_t i = 0; i < a.size(); ++i) {
        if (toLowerAscii(a[i]) != toLowerAscii(b[i])) return false;
    }
    return true;
}

} // namespace q3rt
