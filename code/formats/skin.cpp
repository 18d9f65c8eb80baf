#include "formats/skin.hpp"

#include <algorithm>

#include "formats/text_case.hpp"

namespace q3rt {
namespace {

bool isSkinSpace(char c) { return static_cast<signed char>(c) <= ' '; }

void skipSpaceAndComments(std::string_view& text) {
    while (!text.empty()) {
        if (text.starts_with("//")) {
            text.remove_prefix(std::min(text.find('\n'), text.size()));
        } else if (text.starts_with("/*")) {
            const size_t end = text.find("*/", 2);
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
        } else if (isSkinSpace(text[0])) {
            text.remove_prefix(1);
        } else {
            return;
        }
    }
}

/// A quoted string, or a word up to white space or a comma; a comma at the very start belongs to the word. Empty at the
/// end of the file.
std::string cutSkinToken(std::string_view& text) {
    skipSpaceAndComments(text);
    if (text.empty()) return {};
    if (text[0] == '"') {
        const size_t close = std::min(text.find('"', 1), text.size());
        std::string token(text.substr(1, close - 1));
        text.remove_prefix(std::min(close + 1, text.size()));
        return token;
    }
    const auto end = std::find_if(text.begin() + 1, text.end(), [](char c) { return isSkinSpace(c) || c == ','; });
    std::string token(text.begin(), end);
    text.remove_prefix(token.size());
    return token;
}

} // namespace

std::vector<SkinSurface> parseSkin(std::string_view text) {
    std::vector<SkinSurface> surfaces;
    while (true) {
        const std::string surface = cutSkinToken(text);
        if (surface.empty()) return surfaces;
        if (text.starts_with(',')) text.remove_prefix(1);
        if (surface.find("tag_") != std::string::npos) continue;
        surfaces.push_back({toLowerAscii(surface), cutSkinToken(text)});
    }
}

} // namespace q3rt
