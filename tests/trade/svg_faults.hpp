#pragma once
// Is an SVG text well-formed?

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace q3rt::test {

/// What is wrong with an XML text of elements, quoted attributes and character data; empty: nothing.
inline std::string findXmlFault(const std::string& xml) {
    static const std::regex kTag(R"(<(/?)([A-Za-z][\w:-]*)((?:\s+[A-Za-z][\w:-]*="[^"<]*")*)\s*(/?)>)");
    static const std::regex kEntity("&(?:amp|lt|gt|quot);");
    std::vector<std::string> open;
    size_t at = 0, roots = 0;
    while (at < xml.size()) {
        const size_t tag = std::min(xml.find('<', at), xml.size());
        const std::string text = std::regex_replace(xml.substr(at, tag - at), kEntity, "");
        if (text.find_first_of("&>") != std::string::npos) return "bare character in '" + text + "'";
        if (open.empty() && text.find_first_not_of(" \n") != std::string::npos) return "text outside the root";
        if (tag == xml.size()) break;
        std::smatch match;
        const std::string rest = xml.substr(tag, 2000);
        if (!std::regex_search(rest, match, kTag, std::regex_constants::match_continuous)) return "bad tag: " + rest;
        if (std::regex_replace(match[3].str(), kEntity, "").find('&') != std::string::npos) return "bare & in a tag";
        if (match[1].length() > 0) {
            if (open.empty() || open.back() != match[2]) return "unexpected end of " + match[2].str();
            open.pop_back();
        } else {
            if (open.empty() && ++roots > 1) return "two roots";
            if (match[4].length() == 0) open.push_back(match[2]);
        }
        at = tag + static_cast<size_t>(match[0].length());
    }
    return open.empty() ? "" : "never ended: " + open.back();
}

} // namespace q3rt::test
