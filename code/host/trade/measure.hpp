#pragma once
// Measures the points of a sweep: references first, from q3rt's cache where they were made before.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/trade/reference.hpp"
#include "host/trade/result.hpp"
#include "host/trade/session.hpp"
#include "metrics/metric_image.hpp"

namespace q3rt {

struct TradePlan {
    int warmup = 8;             ///< frames drawn before each view's measured ones, if the renderer remembers frames
    int frames = 20;            ///< timed frames a view, at most
    double secondsPerPoint = 0; ///< ends timing with fewer frames; 0: there is time for all
    double awakeSeconds = 0;    ///< drawn before frames are timed: a device's clock sleeps while pictures are compared
    int pictures = 1;           ///< compared pictures a view; 0: times alone, errors are infinite
    int referenceFrames = 1024; ///< at most
    double referenceError = 0.001; ///< 1 - SSIM to the truth, by the renderer's word, at which a reference is done
    std::map<std::string, std::string> reference; ///< the reference's cvars, but for rt_accumulate
};

class TradeMeter {
  public:
    /// Hears how much of a work is done, 0 to 1.
    using OnShare = std::function<void(double)>;

    TradeMeter(TradeSession& session, const TradeSource& source, TradePlan plan);

    /// The result's key: of everything that the numbers depend on, but for the device.
    std::string keyOf(const TradePoint& point) const;
    /// About how long measuring will take, in seconds, by one frame of the first view.
    double foretell(const TradePoint& point);
    double foretellReferences(const PictureSize& size); ///< if none is known, and all need all frames
    /// Makes or loads the references of this picture size. They stay in memory for one size at a time.
    void prepareReferences(const PictureSize& size);
    /// References of the point's size must be prepared, if pictures are compared.
    TradeResult measure(const TradePoint& point, const OnShare& onShare);
    /// The picture of a point's first view, as it is compared.
    HostFrame drawPicture(const TradePoint& point);

  private:
    struct Reference {
        MetricImage picture;
        int frames = 0;
        std::optional<double> error;
    };
    class ViewTimer;

    size_t viewCount() const { return m_source.viewNames().size(); }
    /// Rays of a frame of the first view, if the renderer counts any. The point is in force, with frames drawn of it.
    std::optional<double> countRays(const TradePoint& point);
    /// How long one frame takes from its first call until its picture is here, in seconds. The point is in force.
    double timeFrame();
    /// Does the renderer's last frame depend on those before it? Yes, if it doesn't say.
    bool remembersFrames() const;
    int warmupOf() const { return remembersFrames() ? m_plan.warmup : 0; }
    /// One picture of the setting in force: the mean of the point's frames. `wallMs` gets the time of all.
    std::optional<HostFrame> draw(const TradePoint& point, size_t view, bool capture, double& wallMs);
    ReferencePicture drawReference(size_t view, const std::function<void(int)>& onFrames);
    TradeErrors comparePicture(size_t view, const HostFrame& picture) const;

    TradeSession& m_session;
    const TradeSource& m_source;
    TradePlan m_plan;
    PictureSize m_referenceSize;
    std::vector<Reference> m_references; ///< a view each
};

} // namespace q3rt
