#include "engine/setting_words.hpp"

#include "formats/text_case.hpp"

namespace q3rt {
namespace {

/// The first word, which goes from the list. Nothing is allocated: settings are read in every frame.
std::string_view takeWord(std::string_view& words) {
    const std::string_view word = words.substr(0, words.find('|'));
    words.remove_prefix(word.size() < words.size() ? word.size() + 1 : word.size());
    return word;
}

} // namespace

std::string_view findWord(std::string_view words, std::string_view text) {
    while (!words.empty())
        if (const std::string_view word = takeWord(words); equalsIgnoringCase(word, text)) return word;
    return {};
}

std::string complainOfWord(std::string_view name, std::string_view words, std::string_view text) {
    if (words.empty() || !findWord(words, text).empty()) return "";
    std::string list;
    for (bool isFirst = true; !words.empty(); isFirst = false) {
        const std::string_view word = takeWord(words);
        list += (isFirst ? "" : words.empty() ? " or " : ", ") + std::string(word);
    }
    return std::string(name) + " takes " + list + ", not '" + std::string(text) + "'";
}

} // namespace q3rt
