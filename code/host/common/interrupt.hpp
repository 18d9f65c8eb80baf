#pragma once
// Ctrl-C, a closed terminal and a polite kill end a command in order: at its next step it throws, temporary files go,
// the engine ends, and nothing half-written stays. A second Ctrl-C ends the program at once.

#include <exception>

namespace q3rt {

/// The user asked for the end. No failure: nothing is to be explained.
class Interrupted : public std::exception {
  public:
    explicit Interrupted(int signal)
        : m_signal(signal) {}
    const char* what() const noexcept override { return "interrupted"; }
    int exitCode() const { return 128 + m_signal; } ///< as shells count

  private:
    int m_signal;
};

/// Once, before anything else of the program (SDL would install handlers of its own).
void watchForInterrupts();

/// Throws Interrupted if the user asked for the end. Every long work calls it (Progress does).
void throwIfInterrupted();

} // namespace q3rt
