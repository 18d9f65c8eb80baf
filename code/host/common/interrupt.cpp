#include "host/common/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace q3rt {
namespace {

volatile std::sig_atomic_t caughtSignal = 0;

void noteSignal(int signal) { caughtSignal = signal; }

} // namespace

void watchForInterrupts() {
    struct sigaction action {};
    action.sa_handler = noteSignal;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // the second one ends the program
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
}

void throwIfInterrupted() {
    if (caughtSignal != 0) throw Interrupted(caughtSignal);
}

} // namespace q3rt
