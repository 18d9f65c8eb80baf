#include "settings_table.hpp"

#include <vector>

namespace q3rt::test {

namespace {

struct Row {
    std::string name, type, standard, minimum, maximum, flags, unit, meaning;
};

/// The lists are C++: "1.0f" is 1.0 to a reader.
std::string plainNumber(std::string text) {
    if (text.size() > 1 && text.back() == 'f' && text.find_first_not_of("-.0123456789") == text.size() - 1)
        text.pop_back();
    return text;
}

/// Of a text the words that it takes.
std::string describeWords(std::string words) {
    for (size_t at = 0; (at = words.find('|', at)) != std::string::npos;)
        words.replace(at, 1, ", ");
    return words;
}

std::string describeRange(const Row& row) {
    if (row.type == "Text") return describeWords(row.unit);
    const std::string low = plainNumber(row.minimum), high = plainNumber(row.maximum);
    return low == high ? "" : low + " to " + high;
}

std::string describeFlags(const std::string& flags) {
    if (flags == "none") return "";
    std::string words;
    for (const char letter : flags) {
        const char* word = letter == 'A'   ? "archived"
                           : letter == 'L' ? "latched"
                           : letter == 'C' ? "cheat"
                                           : "read-only";
        words += (words.empty() ? "" : ", ") + std::string(word);
    }
    return words;
}

std::string renderTable(const std::vector<Row>& rows) {
    std::string text = "| name | default | range | unit | kind | meaning |\n|---|---|---|---|---|---|\n";
    for (const Row& row : rows)
        text += "| `" + row.name + "` | " + plainNumber(row.standard) + " | " + describeRange(row) + " | " +
                (row.type == "Text" ? "" : row.unit) + " | " + describeFlags(row.flags) + " | " + row.meaning + " |\n";
    return text;
}

// The macro's type and defaults stay text here.
#define SETTING(name, type, standard, minimum, maximum, flags, unit, meaning)                                          \
    {#name, #type, #standard, #minimum, #maximum, #flags, unit, meaning},

const std::vector<Row> kTracerRows = {
#include "renderer_rt/settings.def.h"
};
const std::vector<Row> kRasterRows = {
#include "renderer_vk/settings.def.h"
};
const std::vector<Row> kSharedRows = {
#include "code/engine/front_end_settings.def.h"
};

#undef SETTING

} // namespace

std::string renderSettingsPage() {
    return "# Settings\n\n"
           "Every setting is a cvar: type it at the console, or give it to `q3rt` for one run as `--set NAME=VALUE`.\n"
           "*archived*: kept in the engine's configuration; *latched*: takes effect at `vid_restart` or the next map; "
           "*cheat*:\n"
           "only with `sv_cheats 1` or in a demo. A name or value that the renderer does not take ends the run (exit "
           "status 2).\n"
           "Of the engine's and the game's own cvars, which only they know, `play` and `record` say at their end which "
           "nobody took.\n"
           "This page is made from the lists in the source by `build/print_settings_table`.\n\n"
           "## Ray tracer\n\n" +
           renderTable(kTracerRows) + "\n## Rasteriser and window (both renderers)\n\n" + renderTable(kRasterRows) +
           "\n## Content and scenes (both renderers)\n\n" + renderTable(kSharedRows);
}

} // namespace q3rt::test
