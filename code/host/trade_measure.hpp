#pragma once
// Measures the points of a sweep: references first, from q3rt's cache where they were made before.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/trade_result.hpp"
#include "host/trade_session.hpp"
#include "metrics/metric_image.hpp"

namespace q3rt {

struct TradePlan {
    int warmup = 8;   ///< frames drawn before each view's measured ones
    int frames = 20;  ///< timed frames a view
    int pictures = 1; ///< compared pictures a view; 0: times alone, errors are infinite
    int referenceFrames = 1024;
    std::map<std::string, std::string> reference; ///< the reference's cvars, but for rt_accumulate
};

class TradeMeter {
  public:
    TradeMeter(TradeSession& session, const TradeSource& source, TradePlan plan);

    /// The result's key: of everything that the numbers depend on, but for the device.
    std::string keyOf(const TradePoint& point) const;
    /// Makes or loads the references of this picture size. They stay in memory for one size at a time.
    void prepareReferences(const PictureSize& size);
    /// References of the point's size must be prepared, if pictures are compared. `onFrames` hears how many frames more
    /// are drawn.
    TradeResult measure(const TradePoint& point, const std::function<void(int)>& onFrames);
    int framesOfPoint(const TradePoint& point) const;
    /// The picture of a point's first view, as it is compared.
    HostFrame drawPicture(const TradePoint& point);
    const MetricImage& reference(size_t view) const { return m_references[view]; }

  private:
    /// One picture of the setting in force: the mean of the point's frames. `wallMs` gets the time of all.
    std::optional<HostFrame> draw(const TradePoint& point, size_t view, bool capture, double& wallMs);
    HostFrame drawReference(size_t view, const std::function<void(int)>& onFrames);
    TradeErrors comparePicture(size_t view, const HostFrame& picture) const;

    TradeSession& m_session;
    const TradeSource& m_source;
    TradePlan m_plan;
    PictureSize m_referenceSize;
    std::vector<MetricImage> m_references; ///< a view each
};

} // namespace q3rt
