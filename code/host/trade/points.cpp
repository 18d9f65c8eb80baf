#include "host/trade/points.hpp"

#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "host/common/number_text.hpp"
#include "host/common/setting_checks.hpp"

namespace q3rt {
namespace {

constexpr const char *kSizeAxis = "size", *kFramesAxis = "frames";
constexpr const char *kTaa = "rt_taa", *kJitter = "rt_antialiasing";

bool jitterFollowsTaa(const TradePoint& point) {
    const auto jitter = point.cvars.find(kJitter), taa = point.cvars.find(kTaa);
    return jitter != point.cvars.end() && taa != point.cvars.end() && jitter->second == taa->second;
}

/// Values of the four standard settings.
struct Choice {
    int lights, cull, denoiser, taa;
};

/// Telling ones first: a sweep cut short still shows what each setting does.
std::vector<Choice> listChoices() {
    std::vector<Choice> choices = {{1, 1, 0, 0}, {1, 1, 1, 1}, {0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0},
                                   {1, 0, 1, 0}, {1, 1, 1, 0}, {4, 1, 0, 0}, {4, 1, 1, 1}, {0, 1, 1, 1}};
    for (const auto& [denoiser, taa] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        for (const int lights : {1, 0, 4, 16, 2, 8})
            choices.push_back({lights, 1, denoiser, taa});
    for (const auto& [denoiser, taa] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        for (const int lights : {1, 0, 4, 16, 2, 8})
            choices.push_back({lights, 0, denoiser, taa});
    return choices;
}

bool holds(const CvarList& cvars, const std::string& name) {
    return std::any_of(cvars.begin(), cvars.end(),
                       [&](const auto& cvar) { return equalsIgnoringCase(cvar.first, name); });
}

int parseFrames(const std::string& text) {
    if (const auto frames = parseNumber<int>(text); frames && *frames > 0) return *frames;
    throw UsageError("'" + text + "' is no number of frames; write 1 or more");
}

void setValue(TradePoint& point, const std::string& axis, const std::string& value) {
    if (axis == kSizeAxis)
        point.size = parseSize(value);
    else if (axis == kFramesAxis)
        point.frames = parseFrames(value);
    else if (const std::string complaint = complainOfText(axis, value); !complaint.empty())
        throw UsageError(complaint);
    else
        point.cvars[axis] = value;
}

/// The value's words, for the settings that have some.
std::string wordsOf(const std::string& name, const std::string& value) {
    const bool on = value != "0";
    if (name == "rt_numrandomdl") return !on ? "all lights" : value == "1" ? "1 light" : value + " lights";
    if (name == "rt_culllights") return !on ? "not culled" : value == "1" ? "culled by the PVS" : "culled";
    if (name == "rt_denoiser" && (value == "0" || value == "1")) return on ? "denoiser" : "";
    if (name == "rt_taa" && (value == "0" || value == "1")) return on ? "TAA" : "";
    if (name == "rt_antialiasing" && (value == "0" || value == "1")) return on ? "jitter" : "";
    if (name == "rt_backend") return value;
    return name + " " + value;
}

} // namespace

bool isPointAxis(const std::string& name) { return name == kSizeAxis || name == kFramesAxis; }

TradeAxis parseAxis(const std::string& text) {
    const size_t equals = text.find('=');
    TradeAxis axis;
    if (equals != std::string::npos) axis.name = text.substr(0, equals);
    for (size_t start = equals + 1; equals != std::string::npos && start <= text.size();) {
        const size_t end = std::min(text.find(',', start), text.size());
        axis.values.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    const bool hasEmpty = std::find(axis.values.begin(), axis.values.end(), "") != axis.values.end();
    if (axis.name.empty() || axis.values.empty() || hasEmpty)
        throw UsageError("'" + text + "' names no values; write CVAR=V1,V2,... or size=160x120,320x240");
    TradePoint trial;
    for (const std::string& value : axis.values)
        setValue(trial, axis.name, value);
    return axis;
}

std::vector<TradePoint> listStandardPoints(size_t count, const PictureSize& size, const CvarList& fixed,
                                           const std::function<bool(const std::string& name)>& isDeclared) {
    std::vector<TradePoint> points;
    for (const Choice& choice : listChoices()) {
        if (points.size() == count) break;
        TradePoint point{size, {fixed.begin(), fixed.end()}};
        for (const auto& [name, value] : {std::pair<std::string, int>{"rt_numRandomDL", choice.lights},
                                          {"rt_cullLights", choice.cull ? kCulled : 0},
                                          {"rt_denoiser", choice.denoiser},
                                          {"rt_taa", choice.taa}})
            if (isDeclared(name) && !holds(fixed, name)) point.cvars[name] = std::to_string(value);
        // TAA averages places within a pixel, if rays go there.
        if (point.cvars.contains(kTaa) && isDeclared(kJitter) && !holds(fixed, kJitter))
            point.cvars[kJitter] = point.cvars[kTaa];
        if (std::find(points.begin(), points.end(), point) == points.end()) points.push_back(std::move(point));
    }
    return points;
}

std::vector<TradePoint> crossAxes(std::span<const TradeAxis> axes, const PictureSize& size, const CvarList& fixed) {
    std::vector<TradePoint> points = {{size, {fixed.begin(), fixed.end()}}};
    CvarList taken = fixed;
    for (const TradeAxis& axis : axes) {
        if (holds(taken, axis.name))
            throw UsageError(axis.name + " is given twice; name it once");
        taken.emplace_back(axis.name, "");
        std::vector<TradePoint> crossed;
        for (const TradePoint& point : points)
            for (const std::string& value : axis.values) {
                crossed.push_back(point);
                setValue(crossed.back(), axis.name, value);
            }
        points = std::move(crossed);
    }
    return points;
}

TradeShard parseShard(const std::string& text) {
    const auto part = parsePair<unsigned>(text, "/");
    if (!part || part->first >= part->second)
        throw UsageError("'" + text + "' is no part of a sweep; write I/N with I from 0 to N - 1, such as 0/4");
    return {part->first, part->second};
}

std::vector<TradePoint> takeShard(std::span<const TradePoint> points, const TradeShard& shard) {
    std::vector<TradePoint> part;
    for (size_t i = shard.index; i < points.size(); i += shard.count)
        part.push_back(points[i]);
    return part;
}

std::string describePoint(const TradePoint& point, std::span<const TradePoint> all) {
    const auto differs = [&](const auto& same) { return !std::all_of(all.begin(), all.end(), same); };
    std::string text;
    const auto append = [&text](const std::string& words) {
        if (!words.empty()) text += (text.empty() ? "" : ", ") + words;
    };
    const auto appendIfSwept = [&](const std::string& name, const std::string& value) {
        const auto same = [&](const TradePoint& other) {
            const auto found = other.cvars.find(name);
            return found != other.cvars.end() && found->second == value;
        };
        if (differs(same)) append(wordsOf(toLowerAscii(name), value));
    };
    // The thesis' settings in the order in which a frame uses them, then the others by name.
    constexpr const char* kFirst[] = {"rt_numRandomDL", "rt_cullLights", "rt_denoiser", "rt_taa"};
    for (const char* name : kFirst)
        if (const auto found = point.cvars.find(name); found != point.cvars.end()) appendIfSwept(name, found->second);
    const bool jitterIsTaas = std::all_of(all.begin(), all.end(), jitterFollowsTaa);
    for (const auto& [name, value] : point.cvars) {
        const bool first = std::find(std::begin(kFirst), std::end(kFirst), name) != std::end(kFirst);
        if (!first && !(jitterIsTaas && name == kJitter)) appendIfSwept(name, value);
    }
    if (differs([&](const TradePoint& other) { return other.frames == point.frames; }))
        append(formatText("%d frame%s", point.frames, point.frames == 1 ? "" : "s"));
    const std::string size = formatText("%dx%d", point.size.width, point.size.height);
    if (differs([&](const TradePoint& other) {
            return other.size.width == point.size.width && other.size.height == point.size.height;
        }) ||
        text.empty())
        append(size);
    return text;
}

uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t start) {
    uint64_t hash = start;
    for (const std::byte byte : bytes)
        hash = (hash ^ static_cast<uint64_t>(byte)) * 0x100000001b3;
    return hash;
}

std::string hashText(const std::string& text) {
    return formatText("%016llx", static_cast<unsigned long long>(hashBytes(std::as_bytes(std::span(text)))));
}

} // namespace q3rt
