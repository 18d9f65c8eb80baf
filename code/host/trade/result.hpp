#pragma once
// What a sweep measured at one point, as a line of its JSONL file, and that file: appended line by line, so that a
// killed sweep goes on where it stopped.

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/common/output_file.hpp"
#include "host/trade/points.hpp"

namespace q3rt {

/// A mean and, where there are two values or more, its 95 % confidence interval. Infinite: equal pictures' PSNR.
struct TradeEstimate {
    double value = 0;
    std::optional<std::pair<double, double>> interval; ///< low, high
};
/// Mean over `values`, which must not be empty.
TradeEstimate estimateMean(std::span<const double> values);

struct TradeTimes {
    double median = 0, q1 = 0, q3 = 0, p99 = 0; ///< ms
};
TradeTimes summarizeTrade(std::span<const double> ms);

/// Which time a sweep is judged by.
enum class TradeClock {
    Wall,  ///< what a player waits
    Device ///< what the device's timers say of all passes; wall time where it has none
};

struct TradeErrors {
    double ssim = 0, flip = 0, psnr = 0, relmse = 0;
};

struct TradeResult {
    std::string key; ///< of everything that the numbers depend on, but for the device
    TradePoint point;
    TradeTimes wallMs;
    std::optional<TradeTimes> gpuMs; ///< all passes; nullopt: the device has no timers
    TradeEstimate ssim, flip, psnr, relmse;
    std::map<std::string, double> passes;     ///< median ms on the device, by pass
    std::map<std::string, TradeTimes> groups; ///< ms on the device of all passes whose names begin with this word
    std::map<std::string, double> figures;    ///< medians of the module's other numbers: rays, lights ...
    struct View {
        std::string name;
        double medianMs = 0;
        TradeErrors errors;
        int referenceFrames = 0;
        std::optional<double> referenceError; ///< 1 - SSIM, as ReferencePicture has it
    };
    std::vector<View> views;
    size_t frameCount = 0; ///< measured
    std::string device, backend, module, command;
    std::map<std::string, std::string> reference; ///< the reference's settings
    int referenceFrames = 0;                      ///< most of a view
    std::optional<double> referenceError;         ///< largest of a view

    const TradeTimes& times(TradeClock clock) const { return clock == TradeClock::Device && gpuMs ? *gpuMs : wallMs; }
};

/// One line without its end.
std::string toJsonLine(const TradeResult& result);
/// What the table and the plot need of a line, or nullopt if it isn't one of a sweep.
std::optional<TradeResult> parseResult(const std::string& line);

class TradeFile {
  public:
    /// Reads what is there. A last line that was cut off while being written is removed from the file; any other line
    /// that is no point of a sweep is a ContentError.
    explicit TradeFile(const std::filesystem::path& path);
    const std::vector<TradeResult>& results() const { return m_results; }
    /// Null if there is none.
    const TradeResult* find(const std::string& key, const std::string& device) const;
    void append(const TradeResult& result);

  private:
    void readExisting();
    std::filesystem::path m_path;
    LineFile m_lines;
    std::vector<TradeResult> m_results;
};

} // namespace q3rt
