#include "host/trade/measure.hpp"

#include <algorithm>
#include <chrono>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/common/interrupt.hpp"
#include "host/common/progress.hpp"
#include "metrics/image_metrics.hpp"
#include "metrics/statistics.hpp"

namespace q3rt {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr const char *kAccumulate = "rt_accumulate", *kCountWork = "rt_countWork";
/// What a module calls the device's time of all its passes.
constexpr const char* kDeviceTime = "gpu_ms";
/// Frames until a frame's time is that of one among others: two are under way, and after a picture was fetched none is.
constexpr int kSettle = 2;
constexpr int kLeastTimed = 3; ///< of a view, however long they take
/// Frames from which a reference's word about itself is believed: it comes from the spread of its samples.
constexpr int kLeastReference = 64;

double secondsSince(SteadyClock::time_point start) {
    return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

MetricImage toMetricImage(const HostFrame& frame) {
    return metricImageFromBytes(frame.width, frame.height, 3, frame.rgb);
}

/// Numbers of many frames, by name; a frame need not have all.
class FigureList {
  public:
    void addFrame(const std::string& stats) {
        const auto json = nlohmann::json::parse(stats, nullptr, false);
        if (!json.is_object()) return;
        for (const auto& [name, value] : json.items())
            if (value.is_number()) m_figures[name].push_back(value);
        const auto passes = json.find("passes");
        if (passes == json.end() || !passes->is_object()) return;
        std::map<std::string, double> groups;
        for (const auto& [name, value] : passes->items()) {
            if (!value.is_number()) continue;
            m_passes[name].push_back(value);
            groups[name.substr(0, name.find(' '))] += value.get<double>();
        }
        for (const auto& [name, ms] : groups)
            m_groups[name].push_back(ms);
    }
    std::map<std::string, double> figures() const {
        std::map<std::string, double> medians = mediansOf(m_figures);
        medians.erase(kDeviceTime);
        return medians;
    }
    std::optional<TradeTimes> deviceTimes() const {
        const auto found = m_figures.find(kDeviceTime);
        if (found == m_figures.end() || computeQuantile(found->second, 1) <= 0) return std::nullopt;
        return summarizeTrade(found->second);
    }
    std::map<std::string, double> passes() const { return mediansOf(m_passes); }
    std::map<std::string, TradeTimes> groups() const {
        std::map<std::string, TradeTimes> times;
        for (const auto& [name, ms] : m_groups)
            times[name] = summarizeTrade(ms);
        return times;
    }

  private:
    static std::map<std::string, double> mediansOf(const std::map<std::string, std::vector<double>>& lists) {
        std::map<std::string, double> medians;
        for (const auto& [name, values] : lists)
            medians[name] = computeQuantile(values, 0.5);
        return medians;
    }
    std::map<std::string, std::vector<double>> m_figures, m_passes, m_groups;
};

TradeErrors meanOf(const std::vector<TradeErrors>& errors) {
    TradeErrors mean;
    const double share = 1.0 / static_cast<double>(errors.size());
    for (const TradeErrors& e : errors) {
        mean.ssim += share * e.ssim;
        mean.flip += share * e.flip;
        mean.psnr += share * e.psnr;
        mean.relmse += share * e.relmse;
    }
    return mean;
}

void storeErrors(const std::vector<TradeErrors>& samples, TradeResult& result) {
    if (samples.empty()) {
        result.ssim = result.flip = result.psnr = result.relmse = {INFINITY, std::nullopt};
        return;
    }
    const auto estimate = [&](double TradeErrors::*member) {
        std::vector<double> values;
        for (const TradeErrors& sample : samples)
            values.push_back(sample.*member);
        return estimateMean(values);
    };
    result.ssim = estimate(&TradeErrors::ssim);
    result.flip = estimate(&TradeErrors::flip);
    result.psnr = estimate(&TradeErrors::psnr);
    result.relmse = estimate(&TradeErrors::relmse);
}

/// What the last view was compared with.
void storeReference(int frames, std::optional<double> error, TradeResult& result) {
    TradeResult::View& view = result.views.back();
    view.referenceFrames = frames;
    view.referenceError = error;
    result.referenceFrames = std::max(result.referenceFrames, frames);
    if (error) result.referenceError = std::max(result.referenceError.value_or(0), *error);
}

} // namespace

/// Draws one view of the point that is in force, and keeps the times that count.
class TradeMeter::ViewTimer {
  public:
    ViewTimer(TradeMeter& meter, const TradePoint& point, size_t view, FigureList& figures)
        : m_meter(meter)
        , m_plan(meter.m_plan)
        , m_point(point)
        , m_view(view)
        , m_figures(figures)
        , m_start(SteadyClock::now()) {}

    /// Of a view that stands still the later half is timed too, as far as times are wanted: every setting's memory is
    /// under way by then. The pictures' memory is always `frames` long.
    void warmUp(int frames) {
        const bool timed = m_meter.m_source.approachIsView() && m_point.frames == 1 && m_plan.awakeSeconds <= 0;
        const int first = timed ? std::max(kSettle, frames / 2) : frames;
        m_meter.m_session.approach(m_view, std::min(first, frames));
        for (int i = first; i < frames; ++i)
            if (wantsMore())
                timeFrame();
            else
                m_meter.m_session.draw(m_view, false);
    }
    /// They are compared when the times are known: the device does not wait meanwhile.
    std::vector<HostFrame> takePictures() {
        std::vector<HostFrame> pictures;
        double ms = 0;
        for (int i = 0; i < m_plan.pictures; ++i)
            pictures.push_back(*m_meter.draw(m_point, m_view, true, ms));
        return pictures;
    }
    void takeTimes() {
        if (!wantsMore()) return;
        for (int i = 0; i < kSettle || secondsSince(m_start) < m_plan.awakeSeconds; ++i)
            m_meter.m_session.draw(m_view, false);
        while (wantsMore())
            timeFrame();
    }
    const std::vector<double>& wallMs() const { return m_wallMs; }

  private:
    bool wantsMore() const {
        const auto count = static_cast<int>(m_wallMs.size());
        if (count >= m_plan.frames) return false;
        const double seconds = m_plan.secondsPerPoint / static_cast<double>(m_meter.viewCount());
        return seconds <= 0 || count < kLeastTimed || secondsSince(m_start) < seconds;
    }
    void timeFrame() {
        m_meter.draw(m_point, m_view, false, m_wallMs.emplace_back());
        m_figures.addFrame(m_meter.m_session.stats());
        throwIfInterrupted();
    }

    TradeMeter& m_meter;
    const TradePlan& m_plan;
    const TradePoint& m_point;
    size_t m_view;
    FigureList& m_figures;
    SteadyClock::time_point m_start;
    std::vector<double> m_wallMs;
};

TradeMeter::TradeMeter(TradeSession& session, const TradeSource& source, TradePlan plan)
    : m_session(session)
    , m_source(source)
    , m_plan(std::move(plan)) {}

bool TradeMeter::remembersFrames() const {
    const auto stats = nlohmann::json::parse(m_session.stats(), nullptr, false);
    return !stats.is_object() || stats.value("history", true);
}

std::optional<double> TradeMeter::countRays(const TradePoint& point) {
    const bool counts = m_session.isDeclared(kCountWork);
    if (counts) m_session.setCvar(kCountWork, "1");
    // Statistics are those of the frame that is done.
    for (int i = 0; i <= kSettle; ++i)
        m_session.draw(0, false);
    const auto stats = nlohmann::json::parse(m_session.stats(), nullptr, false);
    // Counting takes time: no frame that is timed does it unless the point asks for it.
    m_session.apply(point);
    if (!counts || !stats.is_object() || !stats.contains("rays")) return std::nullopt;
    return stats["rays"].get<double>();
}

double TradeMeter::timeFrame() {
    const auto start = SteadyClock::now();
    m_session.draw(0, true);
    return secondsSince(start);
}

double TradeMeter::foretell(const TradePoint& point) {
    m_session.apply(point);
    const double seconds = timeFrame() * point.frames;
    const auto views = static_cast<double>(viewCount());
    const double fixed = seconds * (warmupOf() + m_plan.pictures + kSettle) + m_plan.awakeSeconds;
    const double least = fixed + seconds * std::min(kLeastTimed, m_plan.frames);
    const double all = fixed + seconds * m_plan.frames;
    const double counted = seconds * (kSettle + 1);
    if (m_plan.secondsPerPoint <= 0) return counted + views * all;
    return counted + views * std::clamp(m_plan.secondsPerPoint / views, least, all);
}

double TradeMeter::foretellReferences(const PictureSize& size) {
    m_session.apply({size, m_plan.reference});
    return timeFrame() * m_plan.referenceFrames * static_cast<double>(viewCount());
}

std::string TradeMeter::keyOf(const TradePoint& point) const {
    std::string text = m_source.identity() + "\nmodule " + m_session.moduleHash();
    text += formatText("\nsize %dx%d warmup %d frames %d in %g s awake %g s pictures %d reference %d error %g",
                       point.size.width, point.size.height, m_plan.warmup, m_plan.frames, m_plan.secondsPerPoint,
                       m_plan.awakeSeconds, m_plan.pictures, m_plan.referenceFrames, m_plan.referenceError);
    if (point.frames > 1) text += formatText("\nmean of %d", point.frames);
    for (const auto& [name, value] : point.cvars)
        text += "\n" + name + " " + value;
    text += "\nreference";
    for (const auto& [name, value] : m_plan.reference)
        text += "\n" + name + " " + value;
    return hashText(text);
}

void TradeMeter::prepareReferences(const PictureSize& size) {
    if (m_referenceSize.width == size.width && m_referenceSize.height == size.height) return;
    m_references.clear();
    const ReferenceCache cache(cacheFolder() / "references");
    Progress progress("reference frame", viewCount() * static_cast<size_t>(m_plan.referenceFrames));
    size_t done = 0;
    const auto onFrames = [&](int count) { progress.advance(done += static_cast<size_t>(count)); };
    for (size_t view = 0; view < viewCount(); ++view) {
        m_session.apply({size, m_plan.reference});
        const std::string dependsOn =
            m_source.identity() +
            formatText("\nview %s\nsize %dx%d\nframes %d error %g\n", m_source.viewNames()[view].c_str(), size.width,
                       size.height, m_plan.referenceFrames, m_plan.referenceError) +
            m_session.describeState();
        std::optional<ReferencePicture> reference = cache.load(dependsOn, size);
        if (!reference) {
            reference = drawReference(view, onFrames);
            cache.store(dependsOn, *reference);
        }
        m_references.push_back({toMetricImage(reference->picture), reference->frames, reference->error});
    }
    m_referenceSize = size;
}

/// The reference's cvars are in force.
ReferencePicture TradeMeter::drawReference(size_t view, const std::function<void(int)>& onFrames) {
    m_session.draw(view, false); // nothing of an earlier setting or view stays in what is averaged
    m_session.setCvar(kAccumulate, "1");
    ReferencePicture reference;
    for (int i = 1;; ++i) {
        const bool near = i > kLeastReference && reference.error && *reference.error <= m_plan.referenceError;
        const bool last = near || i >= m_plan.referenceFrames;
        DrawnFrame drawn = m_session.draw(view, last);
        const auto stats = nlohmann::json::parse(m_session.stats(), nullptr, false);
        if (stats.is_object() && stats.contains("expected_ssim"))
            reference.error = 1.0 - stats["expected_ssim"].get<double>();
        onFrames(last ? m_plan.referenceFrames - i + 1 : 1);
        if (!last) continue;
        reference.picture = std::move(*drawn.picture);
        reference.frames = i;
        return reference;
    }
}

TradeErrors TradeMeter::comparePicture(size_t view, const HostFrame& picture) const {
    const MetricImage& reference = m_references[view].picture;
    const MetricImage test = toMetricImage(picture);
    return {computeSsim(reference, test).mean, computeFlip(reference, test).mean, computePsnr(reference, test),
            computeRelativeMse(reference, test)};
}

std::optional<HostFrame> TradeMeter::draw(const TradePoint& point, size_t view, bool capture, double& wallMs) {
    wallMs = 0;
    if (point.frames > 1) {
        m_session.setCvar(kAccumulate, "0");
        m_session.draw(view, false); // the mean begins anew
        m_session.setCvar(kAccumulate, "1");
    }
    std::optional<HostFrame> picture;
    for (int i = 1; i <= point.frames; ++i) {
        DrawnFrame drawn = m_session.draw(view, capture && i == point.frames);
        wallMs += drawn.wallMs;
        picture = std::move(drawn.picture);
    }
    return picture;
}

HostFrame TradeMeter::drawPicture(const TradePoint& point) {
    double wallMs = 0;
    m_session.apply(point);
    m_session.approach(0, m_plan.warmup);
    return *draw(point, 0, true, wallMs);
}

TradeResult TradeMeter::measure(const TradePoint& point, const OnShare& onShare) {
    TradeResult result;
    result.key = keyOf(point);
    result.point = point;
    m_session.apply(point);
    const std::optional<double> rays = countRays(point);
    const int warmup = warmupOf();
    FigureList figures;
    std::vector<double> wallMs;
    std::vector<TradeErrors> viewErrors, pictureErrors;
    for (size_t view = 0; view < viewCount(); ++view) {
        ViewTimer timer(*this, point, view, figures);
        timer.warmUp(warmup);
        const std::vector<HostFrame> pictures = timer.takePictures();
        timer.takeTimes();
        wallMs.insert(wallMs.end(), timer.wallMs().begin(), timer.wallMs().end());
        result.views.push_back({m_source.viewNames()[view], computeQuantile(timer.wallMs(), 0.5), {}, 0, {}});
        pictureErrors.clear();
        for (const HostFrame& picture : pictures)
            pictureErrors.push_back(comparePicture(view, picture));
        onShare(static_cast<double>(view + 1) / static_cast<double>(viewCount()));
        if (pictureErrors.empty()) continue;
        viewErrors.push_back(meanOf(pictureErrors));
        result.views.back().errors = viewErrors.back();
        storeReference(m_references[view].frames, m_references[view].error, result);
    }
    // Views are what the interval speaks of; of a single one, its pictures' noise.
    storeErrors(viewErrors.size() > 1 ? viewErrors : pictureErrors, result);
    result.wallMs = summarizeTrade(wallMs);
    result.gpuMs = figures.deviceTimes();
    result.passes = figures.passes();
    result.groups = figures.groups();
    result.figures = figures.figures();
    if (rays) result.figures["rays"] = *rays;
    result.frameCount = wallMs.size();
    result.device = m_session.device();
    result.backend = m_session.backend();
    result.module = m_session.moduleHash();
    result.reference = m_plan.reference;
    return result;
}

} // namespace q3rt
