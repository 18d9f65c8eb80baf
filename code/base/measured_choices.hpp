#pragma once
// Choices that were measured once on this machine, kept in the user's cache: which back end of the ray tracer is
// fastest. A file that is damaged counts as absent: everything in it is measured again.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace q3rt {

struct MeasuredChoice {
    std::string key;    ///< what it depends on, such as device, driver and build; one line
    std::string choice; ///< one word
    std::string reason; ///< the figures, for people; one line
};

/// Empty if there is no cache folder: nothing is kept then.
std::filesystem::path measuredChoicesFile();

std::vector<MeasuredChoice> readMeasuredChoices(const std::filesystem::path& file);
std::optional<MeasuredChoice> findMeasuredChoice(const std::filesystem::path& file, std::string_view key);
/// Adds or replaces one; of very many the oldest go. The file changes at once or not at all; false, with a log line, if
/// it can't be written.
bool keepMeasuredChoice(const std::filesystem::path& file, const MeasuredChoice& choice);

} // namespace q3rt
