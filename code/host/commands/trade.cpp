// q3rt trade: what each setting costs and what error it buys.

#include <algorithm>
#include <climits>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "host/commands/commands.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/output_file.hpp"
#include "host/still/map_stage.hpp"
#include "host/trade/evaluation.hpp"
#include "host/trade/front.hpp"
#include "host/trade/plot.hpp"
#include "host/trade/presets.hpp"
#include "host/trade/sweep.hpp"
#include "metrics/image_metrics.hpp"

namespace q3rt {
namespace {

struct TradeArguments {
    std::string recording, renderer = "rt", out, svg, presets, shard = "0/1", evaluation;
    MapSourceOptions map;
    std::vector<int> recordedFrames;
    PictureSize size{320, 240};
    std::vector<std::string> sizes = {"1280x720", "1600x900", "1920x1080", "2560x1440"};
    CvarList fixed, referenceSet;
    std::vector<std::string> axes;
    TradePlan plan;
    int pictures = 0; ///< 0: by the number of views
    size_t pointCount = kStandardPointCount;
    TradeClock clock = TradeClock::Wall;
    bool json = false, verbose = false;
    GameChoice game;
};

/// A single view's interval comes from several pictures of it.
constexpr int kPicturesOfSingleView = 4;

/// What every setting approaches: all that is random averaged out, nothing filtered, lights as many as pay.
constexpr std::pair<const char*, const char*> kReferenceCvars[] = {
    {"rt_numRandomDL", "4"}, {"rt_cullLights", "1"}, {"rt_denoiser", "0"}, {"rt_taa", "0"}};

void setCvar(std::map<std::string, std::string>& cvars, const std::string& name, const std::string& value) {
    std::erase_if(cvars, [&](const auto& cvar) { return equalsIgnoringCase(cvar.first, name); });
    cvars[name] = value;
}

std::unique_ptr<TradeSource> openSource(const TradeArguments& a) {
    if (a.recording.empty() == a.map.map.empty())
        throw CLI::ValidationError("trade", "name either a recording (F.q3t) or --map M");
    if (!a.map.map.empty() && !a.recordedFrames.empty())
        throw CLI::ValidationError("--frames", "chooses frames of a recording, not of a map");
    if (a.map.map.empty() && !a.map.places.empty())
        throw CLI::ValidationError("--at", "chooses views of a map, not of a recording; use --frames");
    if (a.map.map.empty()) return openRecordingSource(a.recording, a.recordedFrames, a.plan.warmup, a.game);
    MapSourceOptions map = a.map;
    if (map.places.empty()) map.places = {"spawn:0"};
    return openMapSource(map, a.game);
}

void checkComparable(const PictureSize& size) {
    if (size.width < kSsimWindow || size.height < kSsimWindow)
        throw UsageError(formatText("pictures of %d x %d pixels can't be compared: choose a --size of %d x %d or more",
                                    size.width, size.height, kSsimWindow, kSsimWindow));
}

std::vector<TradePoint> listPoints(const TradeArguments& a, const TradeSession& session) {
    const auto isDeclared = [&](const std::string& name) { return session.isDeclared(name); };
    std::vector<TradeAxis> axes;
    for (const std::string& text : a.axes)
        axes.push_back(parseAxis(text));
    if (axes.empty()) return listStandardPoints(a.pointCount, a.size, a.fixed, isDeclared);
    for (const TradeAxis& axis : axes)
        if (!isPointAxis(axis.name) && !isDeclared(axis.name))
            throw CLI::ValidationError("--axis " + axis.name, session.complaint(axis.name));
    try {
        return crossAxes(axes, a.size, a.fixed);
    } catch (const UsageError& error) {
        throw CLI::ValidationError("--axis", error.what());
    }
}

/// TAA averages places within a pixel: where a point uses it, the reference does so too.
std::map<std::string, std::string> chooseReference(const TradeArguments& a, const TradeSession& session,
                                                   const std::vector<TradePoint>& points) {
    if (!session.isDeclared("rt_accumulate"))
        throw UsageError("the renderer " + a.renderer +
                         " has no rt_accumulate, so there is no reference to measure against; use --renderer rt");
    std::map<std::string, std::string> cvars(a.fixed.begin(), a.fixed.end());
    for (const auto& [name, value] : kReferenceCvars)
        if (session.isDeclared(name)) setCvar(cvars, name, value);
    const auto usesTaa = [&](const TradePoint& point) {
        for (const auto& [name, value] : point.cvars)
            if (equalsIgnoringCase(name, "rt_taa")) return value != "0";
        return session.isDeclared("rt_taa") && session.defaultOf("rt_taa") != "0";
    };
    if (std::any_of(points.begin(), points.end(), usesTaa)) setCvar(cvars, "rt_antialiasing", "1");
    for (const auto& [name, value] : a.referenceSet)
        setCvar(cvars, name, value);
    return cvars;
}

std::string readCommandLine() {
    const std::vector<std::byte> bytes = readFileBytes("/proc/self/cmdline");
    std::string command, argument;
    for (const std::byte byte : bytes) {
        if (byte != std::byte{0}) {
            argument += static_cast<char>(byte);
            continue;
        }
        const bool plain = argument.find_first_of(" '\"$;&|<>*?()") == std::string::npos;
        command += (command.empty() ? "" : " ") + (plain ? argument : "'" + argument + "'");
        argument.clear();
    }
    return command;
}

/// All sizes of a list, as the axis "size" has them.
std::vector<PictureSize> parseSizes(const std::vector<std::string>& texts) {
    std::vector<PictureSize> sizes;
    for (const TradePoint& point : crossAxes(std::vector{TradeAxis{"size", texts}}, {}, {}))
        sizes.push_back(point.size);
    return sizes;
}

void evaluate(const TradeArguments& a) {
    if (a.map.map.empty()) throw CLI::ValidationError("trade", "--evaluation wants --map M, and may have a recording");
    EvaluationOptions options{.folder = a.evaluation,
                              .module = findModule(a.renderer),
                              .map = a.map,
                              .recording = a.recording,
                              .sizes = parseSizes(a.sizes),
                              .sampleSize = a.size,
                              .fixed = a.fixed,
                              .plan = a.plan,
                              .command = readCommandLine(),
                              .game = a.game,
                              .verbose = a.verbose};
    if (options.map.places.empty()) options.map.places = {"spawn:0"};
    const bool single = options.map.places.size() == 1 && expandPlace(options.map.places[0]).size() == 1;
    options.plan.pictures = a.pictures > 0 ? a.pictures : single ? kPicturesOfSingleView : 1;
    // Whole-pixel samples and TAA see places within a pixel: the reference does so too.
    std::map<std::string, std::string> reference(a.fixed.begin(), a.fixed.end());
    for (const auto& [name, value] : kReferenceCvars)
        setCvar(reference, name, value);
    setCvar(reference, "rt_antialiasing", "1");
    for (const auto& [name, value] : a.referenceSet)
        setCvar(reference, name, value);
    options.plan.reference = reference;
    runEvaluation(options);
}

std::string makeTitle(const TradeSource& source, const std::vector<TradeResult>& results, const std::string& device) {
    const size_t views = source.viewNames().size();
    std::string title = formatText("%s, %zu view%s", source.name().c_str(), views, views == 1 ? "" : "s");
    const PictureSize& size = results[0].point.size;
    const bool sameSize = std::all_of(results.begin(), results.end(), [&](const TradeResult& result) {
        return result.point.size.width == size.width && result.point.size.height == size.height;
    });
    if (sameSize) title += formatText(", %dx%d", size.width, size.height);
    return title + ", " + device;
}

void report(const TradeArguments& a, const std::string& title, const std::vector<TradePoint>& points,
            std::vector<TradeResult> results) {
    const auto isFaster = [&](const TradeResult& x, const TradeResult& y) {
        return x.times(a.clock).median < y.times(a.clock).median;
    };
    std::stable_sort(results.begin(), results.end(), isFaster);
    std::vector<std::string> labels;
    for (const TradeResult& result : results)
        labels.push_back(describePoint(result.point, points));
    if (!a.svg.empty()) {
        const std::string svg = drawTradePlot(title, results, labels, a.clock);
        writeFileBytes(a.svg, std::as_bytes(std::span(svg)));
    }
    if (!a.presets.empty()) {
        const std::string text = formatPresets(results, a.clock, title, readCommandLine());
        writeFileBytes(a.presets, std::as_bytes(std::span(text)));
    }
    if (!a.json) {
        std::printf("%s\n%s", title.c_str(), formatTradeTable(results, labels, a.clock).c_str());
        return;
    }
    const std::vector<size_t> front = findFront(costsOf(results, a.clock));
    for (size_t i = 0; i < results.size(); ++i) {
        const bool onFront = std::find(front.begin(), front.end(), i) != front.end();
        std::printf("{\"key\":\"%s\",\"ms\":%.6g,\"ssim\":%.6g,\"front\":%s}\n", results[i].key.c_str(),
                    results[i].times(a.clock).median, results[i].ssim.value, onFront ? "true" : "false");
    }
}

void runTrade(TradeArguments a) {
    const TradeShard shard = parseShard(a.shard);
    const std::filesystem::path module = findModule(a.renderer);
    const std::unique_ptr<TradeSource> source = openSource(a);
    for (const std::string& result : {a.svg, a.presets})
        if (!result.empty()) checkWritable(result);
    a.plan.pictures = a.pictures > 0 ? a.pictures : source->viewNames().size() > 1 ? 1 : kPicturesOfSingleView;
    TradeFile file(a.out);
    TradeSession session(*source, module, a.verbose);
    session.apply({a.size, {a.fixed.begin(), a.fixed.end()}});
    const std::vector<TradePoint> points = listPoints(a, session);
    for (const TradePoint& point : points)
        checkComparable(point.size);
    a.plan.reference = chooseReference(a, session, points);
    TradeMeter meter(session, *source, a.plan);
    const std::string device = session.device();
    measureMissing(session, meter, file, takeShard(points, shard), readCommandLine());
    std::vector<TradeResult> results;
    for (const TradePoint& point : points)
        if (const TradeResult* result = file.find(meter.keyOf(point), device)) results.push_back(*result);
    if (results.empty()) {
        // No failure: a batch of more parts than points is done all the same.
        std::fprintf(stderr, "part %s of the sweep holds none of its %zu points\n", a.shard.c_str(), points.size());
        return;
    }
    const std::string title = makeTitle(*source, results, device);
    report(a, title, points, std::move(results));
}

TradeClock parseClock(const std::string& name) {
    if (name == "wall") return TradeClock::Wall;
    if (name == "device") return TradeClock::Device;
    throw UsageError("'" + name + "' is no clock: write wall or device");
}

/// Where a sweep's time goes.
void addTimeOptions(CLI::App& command, TradeArguments& a) {
    command
        .add_option("--seconds-per-point", a.plan.secondsPerPoint,
                    "No more timed frames after so long, but 3 a view; 0: no limit")
        ->check(number(0))
        ->capture_default_str();
    command
        .add_option("--awake", a.plan.awakeSeconds,
                    "Seconds of drawing before a view's frames are timed: a GPU's clock sleeps while pictures are "
                    "compared")
        ->check(number(0))
        ->capture_default_str();
    command
        .add_option_function<std::string>(
            "--clock", [&a](const std::string& name) { a.clock = parseClock(name); },
            "The time that the front, the plot and presets are about: wall, or device: the sum of its passes")
        ->type_name("wall|device")
        ->default_str("wall")
        ->check(checkedBy(parseClock));
}

void addSweepOptions(CLI::App& command, TradeArguments& a) {
    command.add_option("--points", a.pointCount, "The first N of the standard sweep's points, the telling ones first")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command.add_flag_callback(
        "--smoke", [&a] { a.pointCount = kSmokePointCount; }, "10 points instead of 24: the most telling ones");
    command
        .add_option("--axis", a.axes,
                    "CVAR=V1,V2,..., size=160x120,320x240 or frames=1,4 (averaged): sweep every combination of these "
                    "instead; several times")
        ->type_name("CVAR=V1,V2,...")
        ->check(checkedBy(parseAxis))
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.add_option("--shard", a.shard, "Measure only part I of N: I/N, I from 0; results merge by concatenation")
        ->type_name("I/N")
        ->check(checkedBy(parseShard))
        ->capture_default_str();
    command
        .add_option("--warmup", a.plan.warmup,
                    "Frames drawn before a view's measured ones, if the settings remember earlier frames")
        ->check(wholeNumber(0))
        ->capture_default_str();
    command.add_option("--count", a.plan.frames, "Timed frames a view, at most")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command.add_option("--pictures", a.pictures, "Compared pictures a view (default: 1, of a single view 4)")
        ->check(wholeNumber(1));
    command.add_option("--reference-frames", a.plan.referenceFrames, "Frames that the reference averages, at most")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command
        .add_option("--reference-error", a.plan.referenceError,
                    "A reference needs no more frames when it is so near to the truth by its own word: 1 - SSIM")
        ->check(number(0))
        ->capture_default_str();
    addSetOption(command, a.referenceSet, "--reference-set",
                 "Set a cvar for the reference only; may be given several times");
}

} // namespace

void addTradeCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "trade", "Measure speed against error over settings: a line a point, a table, the front, a plot");
    const auto a = std::make_shared<TradeArguments>();
    command->add_option("recording", a->recording, "A .q3t file; or --map");
    command->add_option("--frames", a->recordedFrames, "World frames of the recording, such as 100,900 (default: 4)")
        ->delimiter(',')
        ->check(wholeNumber(0));
    addMapOption(*command, a->map.map);
    command
        ->add_option("--at", a->map.places,
                     "\"x y z pitch yaw\" (units, degrees), spawn:N or spawn:A..B; several times (default spawn:0)")
        ->check(checkedBy([](const std::string& place) { parsePlace(expandPlace(place).front()); }))
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->add_option("--fov", a->map.fovDegrees, "Horizontal field of view of a map's views in degrees, 1 to 179")
        ->check(number(1, 179))
        ->capture_default_str();
    command->add_option("--time", a->map.timeMs, "The clock of a map's views, in ms")
        ->check(wholeNumber(INT_MIN))
        ->capture_default_str();
    CLI::Option* out =
        command->add_option("--out", a->out, "File for one JSON object a point; points in it are not measured again");
    command
        ->add_option("--evaluation", a->evaluation,
                     "In place of a sweep: the thesis' figures 7.7 to 7.11 of a map, and 7.13 if a recording is named "
                     "too, as SVG and tables in this folder")
        ->type_name("FOLDER")
        ->excludes(out);
    command
        ->add_option("--sizes", a->sizes, "Picture sizes of the evaluation's figures 7.7 to 7.9; 7.13 takes the first")
        ->delimiter(',')
        ->check(checkedBy(parseSize))
        ->capture_default_str();
    command->add_option("--svg", a->svg, "Also draw time against error into this file");
    command->add_option("--presets", a->presets,
                        "Also write presets and the levels of rt_targetMs into this file: renderer_rt/presets.def.h");
    addRendererOption(*command, a->renderer);
    addSizeOption(*command, a->size);
    addSetOption(*command, a->fixed);
    addSweepOptions(*command, *a);
    addTimeOptions(*command, *a);
    command->add_flag("--json", a->json, "Print a JSON line a point instead of the table");
    command->add_flag("--verbose", a->verbose, "Show the renderer's messages");
    addGameOptions(*command, a->game);
    command->footer("Example: q3rt trade --map oa_dm1 --at spawn:0..3 --smoke --out oa_dm1.jsonl --svg oa_dm1.svg");
    command->callback([a, out, &exitCode] {
        if (a->evaluation.empty() && out->empty()) throw CLI::RequiredError("--out");
        if (a->evaluation.empty())
            runTrade(*a);
        else
            evaluate(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
