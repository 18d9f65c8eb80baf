#include "host/common/progress.hpp"

#include <cstdio>
#include <unistd.h>

#include "base/error.hpp"
#include "host/common/interrupt.hpp"

namespace q3rt {

std::optional<double> Pacer::secondsLeft(double seconds, double share) {
    if (!m_begun) {
        m_begun = true;
        m_firstSeconds = seconds;
        m_firstShare = share;
    }
    if (share <= m_firstShare) return std::nullopt;
    return (seconds - m_firstSeconds) / (share - m_firstShare) * (1 - share);
}

Progress::Progress(std::string what, size_t total)
    : m_what(std::move(what))
    , m_total(total)
    , m_terminal(isatty(STDERR_FILENO) != 0)
    , m_last(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    if (m_shown && m_terminal) std::fprintf(stderr, "\n");
}

void Progress::advance(size_t done) {
    if (done == 0) return throwIfInterrupted();
    const bool known = m_total >= done && m_total > 0;
    const std::string at = m_what + (known ? formatText(" %zu of %zu", done, m_total) : formatText(" %zu", done));
    advance(at, known ? static_cast<double>(done) / static_cast<double>(m_total) : 0);
}

void Progress::advance(const std::string& at, double share) {
    throwIfInterrupted();
    using namespace std::chrono;
    const auto now = steady_clock::now();
    const auto secondsLeft = m_pacer.secondsLeft(duration<double>(now.time_since_epoch()).count(), share);
    const auto interval = m_terminal ? milliseconds(200) : seconds(5);
    const bool isLastOfLine = share >= 1 && m_shown && m_terminal;
    if (now - m_last < interval && !isLastOfLine) return;
    m_last = now;
    m_shown = true;
    const std::string left = secondsLeft ? formatText(", %.0f s left", *secondsLeft) : "";
    std::fprintf(stderr, "%s%s%s%s", m_terminal ? "\r" : "", at.c_str(), left.c_str(), m_terminal ? "   " : "\n");
}

} // namespace q3rt
