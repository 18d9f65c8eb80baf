#pragma once
// A second stack that runs a function until it suspends itself. Made for engine/guard.hpp, which says why; nothing here
// knows the engine. Resuming and suspending are jumps without system calls: signal masks are shared by all stacks.
// Each fiber has its own C++ exception state, so one may be suspended inside a catch block or a destructor while code
// on another stack throws. Under AddressSanitizer the switches are announced to it.

#include <cstddef>
#include <memory>

namespace q3rt {

class Fiber {
  public:
    using Entry = void (*)(void* argument);

    /// Reserves `stackBytes` of address space and a guard page; memory is committed as it is touched. The entry must
    /// never return: it suspends for the last time instead. Throws std::bad_alloc.
    Fiber(size_t stackBytes, Entry entry, void* argument);
    /// Releases the stack without unwinding what is on it.
    ~Fiber();
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;

    /// Called on any other stack: runs the fiber until it suspends.
    void resume();
    /// Called on the fiber: returns into the latest resume().
    void suspend();

  private:
    struct State;
    static void start(unsigned low, unsigned high);
    void enterStack();
    std::unique_ptr<State> m_state;
};

} // namespace q3rt
