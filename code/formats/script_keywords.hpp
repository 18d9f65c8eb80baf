#pragma once
// The script language's keywords and the shape of each one's arguments: how many words belong to a keyword decides what
// is read as the next one.

#include <optional>
#include <string_view>

namespace q3rt {

enum class ArgumentShape {
    None,
    One,               ///< one word; a missing one only warns
    OneRequired,       ///< one word; a missing one fails the definition
    RestOfLine,        ///< everything up to the end of the line
    RestOfLineNeedOne, ///< as above, and no word at all fails the definition
    Sun,               ///< six words, then the rest of the line
    SkyParms,          ///< three words
    FogParms,          ///< a vector (a bad one fails the definition), a depth, then the rest of the line
    Deform,            ///< a kind, and what that kind takes
    BlendFunc,         ///< add, filter or blend; or two factors
    RgbGen,
    AlphaGen,
    TcGen,
};

/// Shape of a keyword outside a stage (`keyword` in lower case), or nullopt for an unknown one.
std::optional<ArgumentShape> findGeneralKeyword(std::string_view keyword);
/// Shape of a keyword inside a stage (`keyword` in lower case), or nullopt for an unknown one.
std::optional<ArgumentShape> findStageKeyword(std::string_view keyword);

} // namespace q3rt
