#include "host/trade/result.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/json_text.hpp"
#include "metrics/statistics.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// JSON has no infinity.
Json toJson(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json toJson(const std::optional<double>& value) { return value ? toJson(*value) : Json(nullptr); }

Json toJson(const TradeEstimate& estimate) {
    Json json = {{"value", toJson(estimate.value)}, {"low", nullptr}, {"high", nullptr}};
    if (!estimate.interval) return json;
    json["low"] = toJson(estimate.interval->first);
    json["high"] = toJson(estimate.interval->second);
    return json;
}

double toNumber(const Json& json) { return json.is_null() ? INFINITY : json.get<double>(); }

TradeEstimate toEstimate(const Json& json) {
    TradeEstimate estimate{toNumber(json.at("value")), std::nullopt};
    if (!json.at("low").is_null() && !json.at("high").is_null())
        estimate.interval = {json["low"].get<double>(), json["high"].get<double>()};
    return estimate;
}

Json toJson(const TradeTimes& t) { return {{"median", t.median}, {"q1", t.q1}, {"q3", t.q3}, {"p99", t.p99}}; }

TradeTimes toTimes(const Json& json) { return {json.at("median"), json.at("q1"), json.at("q3"), json.at("p99")}; }

Json toJson(const TradeResult::View& view) {
    return {{"view", view.name},
            {"wall_ms", view.medianMs},
            {"ssim", toJson(view.errors.ssim)},
            {"flip", toJson(view.errors.flip)},
            {"psnr", toJson(view.errors.psnr)},
            {"relmse", toJson(view.errors.relmse)},
            {"reference_frames", view.referenceFrames},
            {"reference_error", toJson(view.referenceError)}};
}

/// How every line of ours begins: nothing else is ever cut off a file.
constexpr const char* kLineStart = "{\"key\":\"";

bool isCutLine(const std::string& line) {
    const std::string start = kLineStart;
    return line.starts_with(start) || start.starts_with(line);
}

std::string sizeText(const PictureSize& size) { return formatText("%dx%d", size.width, size.height); }

} // namespace

TradeEstimate estimateMean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    TradeEstimate estimate{sum / static_cast<double>(values.size()), std::nullopt};
    if (values.size() < 2 || !std::isfinite(estimate.value)) return estimate;
    const Interval interval = computeMeanInterval(values);
    estimate.interval = {interval.low, interval.high};
    return estimate;
}

TradeTimes summarizeTrade(std::span<const double> ms) {
    return {computeQuantile(ms, 0.5), computeQuantile(ms, 0.25), computeQuantile(ms, 0.75), computeQuantile(ms, 0.99)};
}

std::string toJsonLine(const TradeResult& result) {
    Json settings = {{"size", sizeText(result.point.size)}};
    if (result.point.frames > 1) settings["frames"] = std::to_string(result.point.frames);
    for (const auto& [name, value] : result.point.cvars)
        settings[name] = value;
    Json line = {{"key", result.key},
                 {"settings", settings},
                 {"wall_ms", toJson(result.wallMs)},
                 {"gpu_ms", result.gpuMs ? toJson(*result.gpuMs) : Json(nullptr)},
                 {"ssim", toJson(result.ssim)},
                 {"flip", toJson(result.flip)},
                 {"psnr", toJson(result.psnr)},
                 {"relmse", toJson(result.relmse)},
                 {"passes", result.passes}};
    line["pass_groups"] = Json::object();
    for (const auto& [name, times] : result.groups)
        line["pass_groups"][name] = toJson(times);
    for (const auto& [name, value] : result.figures)
        line[name] = value;
    line["frames"] = result.frameCount;
    line["views"] = Json::array();
    for (const TradeResult::View& view : result.views)
        line["views"].push_back(toJson(view));
    line["width"] = result.point.size.width;
    line["height"] = result.point.size.height;
    line["device"] = result.device;
    line["backend"] = result.backend;
    line["module"] = result.module;
    line["reference"] = {
        {"frames", result.referenceFrames}, {"error", toJson(result.referenceError)}, {"settings", result.reference}};
    line["command"] = result.command;
    return toJsonText(line);
}

std::optional<TradeResult> parseResult(const std::string& line) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    try {
        TradeResult result;
        result.key = json.at("key");
        result.device = json.at("device");
        result.backend = json.at("backend");
        result.module = json.value("module", "");
        result.point.size = {json.at("width"), json.at("height")};
        for (const auto& [name, value] : json.at("settings").items())
            if (name == "frames")
                result.point.frames = std::stoi(value.get<std::string>());
            else if (name != "size")
                result.point.cvars[name] = value;
        result.wallMs = toTimes(json.at("wall_ms"));
        if (const Json gpuMs = json.value("gpu_ms", Json()); gpuMs.is_object()) result.gpuMs = toTimes(gpuMs);
        const Json reference = json.value("reference", Json::object());
        result.referenceFrames = reference.value("frames", 0);
        if (const Json error = reference.value("error", Json()); error.is_number()) result.referenceError = error;
        const Json groups = json.value("pass_groups", Json::object());
        for (const auto& [name, times] : groups.items())
            result.groups[name] = toTimes(times);
        result.ssim = toEstimate(json.at("ssim"));
        result.flip = toEstimate(json.at("flip"));
        result.psnr = toEstimate(json.at("psnr"));
        result.relmse = toEstimate(json.at("relmse"));
        for (const auto& [name, value] : json.items())
            if (value.is_number() && name != "width" && name != "height" && name != "frames")
                result.figures[name] = value;
        return result;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

TradeFile::TradeFile(const fs::path& path)
    : m_path(path)
    , m_lines(path, LineFile::Old::Continue) {
    readExisting();
}

void TradeFile::readExisting() {
    if (!fs::is_regular_file(m_path)) return; // /dev/stdout
    const std::vector<std::byte> bytes = readFileBytes(m_path);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    size_t number = 0;
    for (size_t start = 0; start < text.size(); ++number) {
        const size_t end = text.find('\n', start);
        const std::string line = text.substr(start, end - start);
        if (end == std::string::npos && isCutLine(line)) {
            fs::resize_file(m_path, start);
            return;
        }
        start = end == std::string::npos ? text.size() : end + 1;
        if (line.empty()) continue;
        auto result = end == std::string::npos ? std::nullopt : parseResult(line);
        if (!result)
            throw ContentError(
                formatText("%s: line %zu is no point of a sweep; choose another --out", m_path.c_str(), number + 1));
        m_results.push_back(std::move(*result));
    }
}

const TradeResult* TradeFile::find(const std::string& key, const std::string& device) const {
    for (const TradeResult& result : m_results)
        if (result.key == key && result.device == device) return &result;
    return nullptr;
}

void TradeFile::append(const TradeResult& result) {
    m_lines.append(toJsonLine(result));
    m_results.push_back(result);
}

} // namespace q3rt
