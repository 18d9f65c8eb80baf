#pragma once
// The whole comparison: every picture drawn by both modules, each module in a process of its own, and judged. What was
// drawn is kept: a comparison that was broken off goes on where it was.

#include "likeness.hpp"
#include "picture_source.hpp"

namespace q3rt::parity {

struct Comparison {
    std::filesystem::path folder; ///< holds everything that is made
    std::string reference = "/usr/lib/ioquake3/renderer_opengl1_x86_64.so";
    std::string renderer = "vk";
    std::vector<std::string> maps, demos;   ///< both empty: all
    int camerasPerMap = 4, demoFrames = 60; ///< demoFrames: of all demos together
    bool again = false;                     ///< draw the judged renderer's pictures anew
    DrawSettings draw;
};

/// Demos of OpenArena whose map it has.
const std::vector<std::string>& playableDemos();
/// The process of one module: draws source `name` into its folder. `role`: "reference" or "test".
void drawRole(const Comparison& comparison, const std::string& name, const std::string& role);
/// All of it; `program` is called with `arguments` and --draw ROLE --source NAME for each run of a module.
std::vector<Likeness> compareAll(const Comparison& comparison, const std::string& program,
                                 const std::vector<std::string>& arguments);

} // namespace q3rt::parity
