#pragma once
// Which settings a sweep tries, in which order, and what each is called. Pure: no renderer, no files.

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "host/common/session.hpp"

namespace q3rt {

/// One point of a sweep: a picture size and every cvar that the sweep sets, fixed ones included.
struct TradePoint {
    PictureSize size;
    std::map<std::string, std::string> cvars;
    int frames = 1; ///< whose mean (rt_accumulate) is a picture: whole-pixel samples
    friend bool operator==(const TradePoint& a, const TradePoint& b) {
        return a.size.width == b.size.width && a.size.height == b.size.height && a.cvars == b.cvars &&
               a.frames == b.frames;
    }
};

/// One setting and the values to try. "size" stands for the picture's size, its values are WIDTHxHEIGHT; "frames" for
/// the number of frames whose mean is a picture.
struct TradeAxis {
    std::string name;
    std::vector<std::string> values;
};
/// Is the axis no cvar?
bool isPointAxis(const std::string& name);
/// From CVAR=V1,V2,... Throws UsageError.
TradeAxis parseAxis(const std::string& text);

/// rt_cullLights: as narrow as the renderer has it.
inline constexpr int kCulled = 2;
inline constexpr size_t kSmokePointCount = 10, kStandardPointCount = 24;

/// The first `count` different points of the standard sweep: lights per pixel, culling, denoiser and TAA, the telling
/// combinations first. Settings that the renderer doesn't declare or that `fixed` holds fast are not swept.
std::vector<TradePoint> listStandardPoints(size_t count, const PictureSize& size, const CvarList& fixed,
                                           const std::function<bool(const std::string& name)>& isDeclared);
/// Every combination of the axes' values. Throws UsageError if an axis is given twice or is fixed as well.
std::vector<TradePoint> crossAxes(std::span<const TradeAxis> axes, const PictureSize& size, const CvarList& fixed);

/// Part `index` of `count` of a sweep: every count-th point, so that parts take about equally long.
struct TradeShard {
    size_t index = 0, count = 1;
};
/// From i/n, i from 0. Throws UsageError.
TradeShard parseShard(const std::string& text);
std::vector<TradePoint> takeShard(std::span<const TradePoint> points, const TradeShard& shard);

/// In words, what sets the point apart from the others: "4 lights, culled, denoiser, 320x240".
std::string describePoint(const TradePoint& point, std::span<const TradePoint> all);

/// 64-bit FNV-1a: tells settings and files apart; not safe against forgery, which nothing here needs.
uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t start = 0xcbf29ce484222325);
std::string hashText(const std::string& text); ///< 16 hexadecimal digits

} // namespace q3rt
