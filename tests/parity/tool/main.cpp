// compare_rasters: one command that draws maps and demo frames by renderer_vk and by the original, and says how like
// they are. Exit status 0: compared; 1: failed; 2: bad arguments; 3: compared, and unlike beyond the limits.

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "comparison.hpp"
#include "host/common/file_bytes.hpp"

namespace {

using namespace q3rt;
using namespace q3rt::parity;

constexpr double kMedianLimit = 0.995, kWorstLimit = 0.97; // of SSIM
constexpr size_t kSheetPictures = 20;

/// The original opens a window: without a display everything runs below a virtual one. Returns only if that is here.
void needDisplay(char** argv) {
    if (std::getenv("DISPLAY")) return;
    std::vector<char*> words;
    std::string xvfb = "xvfb-run", automatic = "-a";
    words.push_back(xvfb.data());
    words.push_back(automatic.data());
    for (; *argv; ++argv)
        words.push_back(*argv);
    words.push_back(nullptr);
    execvp(words[0], words.data());
    throw UsageError("xvfb-run can't be started: install xvfb and xauth");
}

int report(const Comparison& comparison, const std::vector<Likeness>& all) {
    const std::string text = describeLikeness(all, kSheetPictures);
    writeFileBytes(comparison.folder / "likeness.md", std::as_bytes(std::span(text)));
    writeSheet(comparison.folder / "worst.jpg", comparison.folder, all, kSheetPictures);
    std::printf("\n%s", text.c_str());
    return isWithin(all, kMedianLimit, kWorstLimit) ? 0 : 3;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Draws maps and demo frames by renderer_vk and by the original, and says how like they are",
                 "compare_rasters");
    Comparison comparison;
    std::string folder, role, source;
    app.add_option("--out", folder, "Folder for pictures, likeness.md and worst.jpg; what is there is kept")
        ->required();
    app.add_option("--map", comparison.maps, "Only these maps")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--demo", comparison.demos, "Only these demos")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--cameras", comparison.camerasPerMap, "Cameras a map")->check(CLI::PositiveNumber);
    app.add_option("--frames", comparison.demoFrames, "Frames of all demos together")->check(CLI::PositiveNumber);
    app.add_option("--reference", comparison.reference, "Module that is right");
    app.add_flag("--again", comparison.again, "Draw the judged renderer's pictures anew");
    app.add_option("--draw", role, "Of one process of a comparison")->group("");
    app.add_option("--source", source, "Of one process of a comparison")->group("");
    addRendererOption(app, comparison.renderer);
    addSizeOption(app, comparison.draw.size);
    addSetOption(app, comparison.draw.cvars);
    addGameOptions(app, comparison.draw.game);
    try {
        app.parse(argc, argv);
        comparison.folder = folder;
        if (!role.empty()) {
            drawRole(comparison, source, role);
            return 0;
        }
        needDisplay(argv);
        return report(comparison, compareAll(comparison, argv[0], {argv + 1, argv + argc}));
    } catch (const CLI::Success& request) {
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "compare_rasters: %s; see --help\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "compare_rasters: %s\n", error.what());
        return 1;
    }
}
