// q3rt compare: how far one picture is from another, as one JSON line.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "formats/image.hpp"
#include "formats/text_case.hpp"
#include "host/commands/commands.hpp"
#include "host/common/exr_file.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/option_checks.hpp"
#include "metrics/image_metrics.hpp"

namespace q3rt {

namespace {

struct CompareArguments {
    std::string reference, test, heatmap;
    double pixelsPerDegree = kFlipPixelsPerDegree;
};

/// PFM and EXR as they are; anything else as the engine would load it, 1.0 = byte 255. Alpha is ignored.
MetricImage loadMetricImage(const std::string& path) {
    const std::vector<std::byte> bytes = readFileBytes(path);
    const std::string extension = toLowerAscii(std::filesystem::path(path).extension().string());
    if (extension != ".pfm" && extension != ".exr") {
        const Image image = decodeImage(bytes, path);
        return metricImageFromBytes(image.width, image.height, 4, image.rgba);
    }
    const FloatImage image = extension == ".exr" ? decodeExr(bytes, path) : decodePfm(bytes, path);
    try {
        return metricImageFromFloats(image.width, image.height, image.rgb);
    } catch (const ContentError& error) {
        throw ContentError(path + ": " + error.what());
    }
}

/// Dark blue over red to pale yellow: brightness rises with the error, so it reads in grey too.
std::array<uint8_t, 3> colorOfError(double error) {
    constexpr double kStops[5][3] = {{0, 0, 16}, {64, 16, 112}, {184, 48, 96}, {248, 136, 64}, {255, 250, 200}};
    const double position = std::clamp(error, 0.0, 1.0) * 4.0;
    const size_t below = std::min<size_t>(static_cast<size_t>(position), 3);
    std::array<uint8_t, 3> color{};
    for (size_t c = 0; c < 3; ++c)
        color[c] = static_cast<uint8_t>(
            std::lround(std::lerp(kStops[below][c], kStops[below + 1][c], position - static_cast<double>(below))));
    return color;
}

void writeHeatmap(const std::string& path, const MetricMap& flip) {
    std::vector<uint8_t> rgb;
    for (const double value : flip.values)
        for (const uint8_t channel : colorOfError(value))
            rgb.push_back(channel);
    writeFileBytes(path, encodePng(flip.width, flip.height, 3, rgb));
}

/// JSON has no infinity: equal pictures have no finite PSNR.
std::string toJsonNumber(double value) { return std::isfinite(value) ? formatText("%.9g", value) : "null"; }

void runCompare(const CompareArguments& arguments) {
    const MetricImage reference = loadMetricImage(arguments.reference), test = loadMetricImage(arguments.test);
    if (reference.width != test.width || reference.height != test.height)
        throw UsageError(formatText("%s has %d x %d pixels but %s has %d x %d: compare pictures of one size",
                                    arguments.reference.c_str(), reference.width, reference.height,
                                    arguments.test.c_str(), test.width, test.height));
    const MetricImage shownReference = clampToDisplay(reference), shownTest = clampToDisplay(test);
    const MetricMap flip = computeFlip(shownReference, shownTest, arguments.pixelsPerDegree);
    const double ssim = computeSsim(shownReference, shownTest).mean;
    if (!arguments.heatmap.empty()) writeHeatmap(arguments.heatmap, flip);
    std::printf("{\"ssim\": %s, \"flip\": %s, \"psnr\": %s, \"mse\": %s, \"relmse\": %s}\n", toJsonNumber(ssim).c_str(),
                toJsonNumber(flip.mean).c_str(), toJsonNumber(computePsnr(shownReference, shownTest)).c_str(),
                toJsonNumber(computeMse(reference, test)).c_str(),
                toJsonNumber(computeRelativeMse(reference, test)).c_str());
}

} // namespace

void addCompareCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "compare",
        "Compare two pictures of one size (PNG, TGA, JPEG, EXR, PFM ...): one JSON line with ssim, flip, psnr "
        "(of what a display shows; null where equal), mse and relmse (of the values, 1 = full brightness)");
    const auto arguments = std::make_shared<CompareArguments>();
    command->add_option("reference", arguments->reference, "The picture that is right")->required();
    command->add_option("test", arguments->test, "The picture to judge")->required();
    command->add_option("--heatmap", arguments->heatmap, "Also write FLIP's error of every pixel as a PNG file")
        ->check(
            [](const std::string& name) { return name.ends_with(".png") ? "" : "'" + name + "' must end in .png"; });
    command->add_option("--ppd", arguments->pixelsPerDegree, "Pixels per degree of view that FLIP assumes, 1 to 1000")
        ->check(number(1, 1000))
        ->capture_default_str();
    command->add_flag("--json")->description("The output is JSON in any case");
    command->footer("Example: q3rt compare reference.png test.png --heatmap errors.png");
    command->callback([arguments, &exitCode] {
        runCompare(*arguments);
        exitCode = 0;
    });
}

} // namespace q3rt
