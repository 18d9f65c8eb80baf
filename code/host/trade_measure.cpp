#include "host/trade_measure.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/engine_process.hpp"
#include "host/trade_reference.hpp"
#include "metrics/image_metrics.hpp"
#include "metrics/statistics.hpp"

namespace q3rt {
namespace {

constexpr const char* kAccumulate = "rt_accumulate";

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
    std::map<std::string, double> figures() const { return mediansOf(m_figures); }
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

} // namespace

TradeMeter::TradeMeter(TradeSession& session, const TradeSource& source, TradePlan plan)
    : m_session(session)
    , m_source(source)
    , m_plan(std::move(plan)) {}

int TradeMeter::framesOfPoint(const TradePoint& point) const {
    return static_cast<int>(m_source.viewNames().size()) *
           (m_plan.warmup + (m_plan.pictures + m_plan.frames) * point.frames);
}

std::string TradeMeter::keyOf(const TradePoint& point) const {
    std::string text = m_source.identity() + "\nmodule " + m_session.moduleHash();
    text += formatText("\nsize %dx%d warmup %d frames %d pictures %d reference %d", point.size.width, point.size.height,
                       m_plan.warmup, m_plan.frames, m_plan.pictures, m_plan.referenceFrames);
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
    const size_t viewCount = m_source.viewNames().size();
    Progress progress("reference frame", viewCount * static_cast<size_t>(m_plan.referenceFrames));
    size_t done = 0;
    const auto onFrames = [&](int count) { progress.advance(done += static_cast<size_t>(count)); };
    for (size_t view = 0; view < viewCount; ++view) {
        m_session.apply({size, m_plan.reference});
        const std::string dependsOn =
            m_source.identity() +
            formatText("\nview %s\nsize %dx%d\nframes %d\n", m_source.viewNames()[view].c_str(), size.width,
                       size.height, m_plan.referenceFrames) +
            m_session.describeState();
        std::optional<HostFrame> picture = cache.load(dependsOn, size);
        if (!picture) {
            picture = drawReference(view, onFrames);
            cache.store(dependsOn, *picture);
        }
        m_references.push_back(toMetricImage(*picture));
    }
    m_referenceSize = size;
}

/// The reference's cvars are in force.
HostFrame TradeMeter::drawReference(size_t view, const std::function<void(int)>& onFrames) {
    m_session.draw(view, false); // nothing of an earlier setting or view stays in what is averaged
    m_session.setCvar(kAccumulate, "1");
    for (int i = 1; i < m_plan.referenceFrames; ++i) {
        m_session.draw(view, false);
        onFrames(1);
    }
    DrawnFrame last = m_session.draw(view, true);
    onFrames(1);
    return std::move(*last.picture);
}

TradeErrors TradeMeter::comparePicture(size_t view, const HostFrame& picture) const {
    const MetricImage& reference = m_references[view];
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

TradeResult TradeMeter::measure(const TradePoint& point, const std::function<void(int)>& onFrames) {
    TradeResult result;
    result.key = keyOf(point);
    result.point = point;
    m_session.apply(point);
    FigureList figures;
    std::vector<double> wallMs;
    std::vector<TradeErrors> viewErrors, pictureErrors;
    for (size_t view = 0; view < m_source.viewNames().size(); ++view) {
        m_session.approach(view, m_plan.warmup);
        pictureErrors.clear();
        double ms = 0;
        for (int i = 0; i < m_plan.pictures; ++i)
            pictureErrors.push_back(comparePicture(view, *draw(point, view, true, ms)));
        onFrames(m_plan.warmup + m_plan.pictures * point.frames);
        std::vector<double> viewMs;
        for (int i = 0; i < m_plan.frames; ++i) {
            draw(point, view, false, ms);
            viewMs.push_back(ms);
            figures.addFrame(m_session.stats());
        }
        onFrames(m_plan.frames * point.frames);
        wallMs.insert(wallMs.end(), viewMs.begin(), viewMs.end());
        result.views.push_back({m_source.viewNames()[view], computeQuantile(viewMs, 0.5), {}});
        if (pictureErrors.empty()) continue;
        viewErrors.push_back(meanOf(pictureErrors));
        result.views.back().errors = viewErrors.back();
    }
    // Views are what the interval speaks of; of a single one, its pictures' noise.
    storeErrors(viewErrors.size() > 1 ? viewErrors : pictureErrors, result);
    result.wallMs = summarizeTrade(wallMs);
    result.passes = figures.passes();
    result.groups = figures.groups();
    result.figures = figures.figures();
    result.frameCount = wallMs.size();
    result.device = m_session.device();
    result.backend = m_session.backend();
    result.module = m_session.moduleHash();
    result.reference = m_plan.reference;
    result.referenceFrames = m_plan.referenceFrames;
    return result;
}

} // namespace q3rt
