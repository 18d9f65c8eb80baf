#include "host/trade/evaluation.hpp"

#include <algorithm>
#include <cstdio>

#include "base/error.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/headless/replayer.hpp"
#include "host/trade/evaluation_figures.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

void writeText(const fs::path& path, const std::string& text) { writeFileBytes(path, std::as_bytes(std::span(text))); }

/// Measures what the file doesn't hold yet.
class Measurer {
  public:
    Measurer(const EvaluationOptions& options, TradeSource& source)
        : m_options(options)
        , m_source(source)
        , m_file(options.folder / "evaluation.jsonl")
        , m_session(source, options.module, options.verbose) {
        m_session.apply({options.sampleSize, {options.fixed.begin(), options.fixed.end()}});
        for (const char* cvar : {"rt_numRandomDL", "rt_cullLights", "rt_denoiser", "rt_taa", "rt_accumulate"})
            if (!m_session.isDeclared(cvar))
                throw UsageError(formatText("--evaluation: the renderer has no %s; use --renderer rt", cvar));
    }

    void measureTimes(const std::vector<PictureSize>& sizes) {
        TradePlan plan = m_options.plan;
        plan.pictures = 0;
        TradeMeter meter(m_session, m_source, plan);
        for (const PictureSize& size : sizes)
            for (const EvaluationSetting& setting : listTimedSettings())
                measure(meter, setting, size, false);
    }

    void measureSamples(const PictureSize& size) {
        TradeMeter meter(m_session, m_source, m_options.plan);
        for (const EvaluationSetting& setting : listSampledSettings())
            measure(meter, setting, size, true);
    }

    /// The pictures of figure 7.10, a PNG each.
    void drawSamples(const PictureSize& size) {
        TradeMeter meter(m_session, m_source, m_options.plan);
        for (const EvaluationSetting& setting : listSampledSettings()) {
            std::string name = setting.name + ".png";
            std::replace(name.begin(), name.end(), ' ', '_');
            std::erase(name, ',');
            const fs::path path = m_options.folder / "figure_7_10" / name;
            OutputFolder folder(path.parent_path());
            writePng(path, meter.drawPicture(makePoint(setting, size, m_options.fixed)));
        }
    }

    const TradeResult& find(const EvaluationSetting& setting, const PictureSize& size) const {
        const TradePoint point = makePoint(setting, size, m_options.fixed);
        for (const TradeResult& result : m_results)
            if (result.point == point) return result;
        throw UsageError("the evaluation lacks " + setting.name);
    }
    const std::string& device() const { return m_session.device(); }

  private:
    void measure(TradeMeter& meter, const EvaluationSetting& setting, const PictureSize& size, bool compared) {
        const TradePoint point = makePoint(setting, size, m_options.fixed);
        const TradeResult* known = m_file.find(meter.keyOf(point), m_session.device());
        if (!known) {
            if (compared) meter.prepareReferences(size);
            std::fprintf(stderr, "%s, %dx%d\n", setting.name.c_str(), size.width, size.height);
            TradeResult result = meter.measure(point, [](int) {});
            result.command = m_options.command;
            m_file.append(result);
            known = &m_file.results().back();
        }
        // What was compared knows the time too, and comes later.
        std::erase_if(m_results, [&](const TradeResult& old) { return old.point == point; });
        m_results.push_back(*known);
    }

    const EvaluationOptions& m_options;
    TradeSource& m_source;
    TradeFile m_file;
    TradeSession m_session;
    std::vector<TradeResult> m_results;
};

FrameTrace replayTimes(const EvaluationOptions& options, const EvaluationSetting& setting) {
    Recording recording{fs::path(options.recording)};
    RecordedFiles files(recording, options.game);
    HeadlessEngine engine(files);
    engine.showsMessages = options.verbose;
    engine.loadModule(options.module);
    const TradePoint point = makePoint(setting, options.sizes.front(), options.fixed);
    Replayer replayer(recording, engine,
                      {point.size.width, point.size.height, {point.cvars.begin(), point.cvars.end()}});
    // The first frame waits for all that was loaded: no frame of play.
    const int first = static_cast<int>(recording.info().firstFrame);
    FrameTrace trace{setting.name, first + 1, {}};
    Progress progress("frame", recording.info().frameCount);
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        const Recording::Frame frame = recording.readFrame(i);
        const bool drawn = frame.number >= first;
        const Replayer::Result result = replayer.play(frame, drawn ? Replayer::Draw::Frame : Replayer::Draw::Nothing);
        if (frame.number > first) trace.wallMs.push_back(result.wallMs);
        progress.advance(trace.wallMs.size() + 1);
    }
    engine.unloadModule();
    return trace;
}

/// Frame times of the recording under the thesis' setting and under ours.
std::vector<FrameTrace> traceRecording(const EvaluationOptions& options) {
    std::vector<FrameTrace> traces;
    if (options.recording.empty()) return traces;
    for (const EvaluationSetting& setting :
         {EvaluationSetting{"all lights", 0},
          EvaluationSetting{.name = "1 light, denoiser, TAA", .denoiser = true, .taa = true}})
        traces.push_back(replayTimes(options, setting));
    std::string lines;
    for (const FrameTrace& trace : traces)
        for (size_t i = 0; i < trace.wallMs.size(); ++i)
            lines += formatText("{\"setting\":\"%s\",\"frame\":%zu,\"wall_ms\":%.4f}\n", trace.name.c_str(),
                                static_cast<size_t>(trace.firstFrame) + i, trace.wallMs[i]);
    writeText(options.folder / "figure_7_13.jsonl", lines);
    return traces;
}

/// Before hours of measuring, not after.
void checkRecording(const std::string& path) {
    if (Recording{fs::path(path)}.frameCount() < 2)
        throw UsageError("--evaluation: " + path + " holds one frame alone; record two or more for figure 7.13");
}

} // namespace

void runEvaluation(const EvaluationOptions& options) {
    if (!options.recording.empty()) checkRecording(options.recording);
    const OutputFolder folder(options.folder);
    const std::unique_ptr<TradeSource> source = openMapSource(options.map, options.game);
    std::string device, text;
    {
        Measurer measurer(options, *source);
        measurer.measureTimes(options.sizes);
        measurer.measureSamples(options.sampleSize);
        measurer.drawSamples(options.sampleSize);
        device = measurer.device();
        const auto resultOf = [&](const EvaluationSetting& setting, const PictureSize& size) -> const TradeResult& {
            return measurer.find(setting, size);
        };
        const std::string where = source->name() + ", " + device;
        const auto write = [&](const char* name, const std::string& svg) { writeText(options.folder / name, svg); };
        write("figure_7_07.svg", drawFrameTimes(where, options.sizes, resultOf));
        write("figure_7_08.svg", drawDenoiserTimes(where, options.sizes, resultOf));
        write("figure_7_09.svg", drawCulling(where, options.sizes, resultOf));
        write("figure_7_11_time.svg", drawSampleTimes(where, options.sampleSize, resultOf));
        write("figure_7_11_ssim.svg", drawSampleQuality(where, options.sampleSize, resultOf));
        text = formatEvaluation(options.sizes, options.sampleSize, resultOf);
    }
    // The interface allows one module at a time: the sweep's is gone by now.
    const std::vector<FrameTrace> traces = traceRecording(options);
    if (!traces.empty())
        writeText(options.folder / "figure_7_13.svg",
                  drawFrameTrace(fs::path(options.recording).filename().string() +
                                     formatText(", %dx%d, ", options.sizes[0].width, options.sizes[0].height) + device,
                                 traces));
    text = "`" + options.command + "`, " + device + ".\n\n" + text + formatTraces(traces);
    writeText(options.folder / "evaluation.md", text);
    std::printf("%s", text.c_str());
}

} // namespace q3rt
