#include "formats/script_keywords.hpp"

#include <span>

namespace q3rt {
namespace {

struct KeywordRule {
    std::string_view keyword;
    ArgumentShape shape;
};

constexpr KeywordRule kGeneralKeywords[] = {
    {"clamptime", ArgumentShape::One},         {"cull", ArgumentShape::One},
    {"deformvertexes", ArgumentShape::Deform}, {"entitymergable", ArgumentShape::None},
    {"fogparms", ArgumentShape::FogParms},     {"light", ArgumentShape::One},
    {"nomipmaps", ArgumentShape::None},        {"nopicmip", ArgumentShape::None},
    {"polygonoffset", ArgumentShape::None},    {"portal", ArgumentShape::None},
    {"q3map_sun", ArgumentShape::Sun},         {"q3map_sunext", ArgumentShape::Sun},
    {"skyparms", ArgumentShape::SkyParms},     {"sort", ArgumentShape::One},
    {"surfaceparm", ArgumentShape::One},       {"tesssize", ArgumentShape::RestOfLine},
};

constexpr KeywordRule kStageKeywords[] = {
    {"alphafunc", ArgumentShape::OneRequired},
    {"alphagen", ArgumentShape::AlphaGen},
    {"animmap", ArgumentShape::RestOfLineNeedOne},
    {"blendfunc", ArgumentShape::BlendFunc},
    {"clampmap", ArgumentShape::OneRequired},
    {"depthfunc", ArgumentShape::OneRequired},
    {"depthwrite", ArgumentShape::None},
    {"detail", ArgumentShape::None},
    {"map", ArgumentShape::OneRequired},
    {"rgbgen", ArgumentShape::RgbGen},
    {"tcgen", ArgumentShape::TcGen},
    {"tcmod", ArgumentShape::RestOfLine},
    {"texgen", ArgumentShape::TcGen},
    {"videomap", ArgumentShape::OneRequired},
};

std::optional<ArgumentShape> findKeyword(std::span<const KeywordRule> rules, std::string_view keyword) {
    for (const KeywordRule& rule : rules) {
        if (rule.keyword == keyword) return rule.shape;
    }
    return std::nullopt;
}

} // namespace

std::optional<ArgumentShape> findGeneralKeyword(std::string_view keyword) {
    if (const auto shape = findKeyword(kGeneralKeywords, keyword)) return shape;
    // Two families belong to the editor and to the map compiler: any word with their prefix is one line of theirs.
    if (keyword.starts_with("qer") || keyword.starts_with("q3map")) return ArgumentShape::RestOfLine;
    return std::nullopt;
}

std::optional<ArgumentShape> findStageKeyword(std::string_view keyword) { return findKeyword(kStageKeywords, keyword); }

} // namespace q3rt
