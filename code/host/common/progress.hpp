#pragma once
// How far a long work is, and when it ends.

#include <chrono>
#include <optional>
#include <string>

namespace q3rt {

/// Tells the rest of a work's time by the pace since it was first asked: what came before (a map being loaded, the
/// first frame with its shaders) does not come again.
class Pacer {
  public:
    /// At `seconds` of any clock `share` of the whole is done, 0 to 1. Seconds left; nullopt: there is no pace yet.
    std::optional<double> secondsLeft(double seconds, double share);

  private:
    bool m_begun = false;
    double m_firstSeconds = 0, m_firstShare = 0;
};

/// A line on stderr that says how far a long work is and when it ends; on a terminal it stays one line. The place where
/// the user's Ctrl-C takes effect: advance() throws Interrupted.
class Progress {
  public:
    Progress(std::string what, size_t total);
    ~Progress();
    void advance(size_t done);
    /// Of work whose steps differ in length: `at` names the step, `share` of the whole is done, 0 to 1.
    void advance(const std::string& at, double share);

  private:
    std::string m_what;
    size_t m_total;
    bool m_terminal;
    bool m_shown = false;
    Pacer m_pacer;
    std::chrono::steady_clock::time_point m_last;
};

} // namespace q3rt
