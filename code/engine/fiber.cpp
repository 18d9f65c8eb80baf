// Jumps between stacks are meant here; the hardened longjmp takes each for an error.
#undef _FORTIFY_SOURCE

#include "engine/fiber.hpp"

#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <cxxabi.h>
#include <exception>
#include <new>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>
#include <utility>

#if defined(__SANITIZE_ADDRESS__)
#define Q3RT_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define Q3RT_ADDRESS_SANITIZER 1
#endif
#endif
#ifdef Q3RT_ADDRESS_SANITIZER
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif

namespace q3rt {
namespace {

/// The per-thread exception state of the Itanium C++ ABI (section 2.2.2): the stack of caught exceptions and the number
/// of uncaught ones.
struct ExceptionState {
    void* caught = nullptr;
    unsigned uncaughtCount = 0;
};

void exchangeExceptionState(ExceptionState& saved) {
    auto* current = reinterpret_cast<ExceptionState*>(abi::__cxa_get_globals());
    std::swap(*current, saved);
}

/// Leaves this stack at `here` and goes on where `there` was left. Signal masks stay: unlike swapcontext, no system
/// call.
[[gnu::noinline]] void switchStack(std::jmp_buf& here, std::jmp_buf& there) {
    if (_setjmp(here) == 0) _longjmp(there, 1);
}

size_t pageBytes() { return static_cast<size_t>(sysconf(_SC_PAGESIZE)); }

} // namespace

struct Fiber::State {
    std::jmp_buf own, resumer;
    std::byte* mapping = nullptr;
    size_t mappingBytes = 0;
    std::byte* stack = nullptr; ///< lowest usable byte, above the guard page
    size_t stackBytes = 0;
    Entry entry = nullptr;
    void* argument = nullptr;
    ExceptionState exceptions; ///< of the side that doesn't run now
#ifdef Q3RT_ADDRESS_SANITIZER
    void* fakeStack = nullptr;
    const void* resumerStack = nullptr;
    size_t resumerStackBytes = 0;
#endif
};

Fiber::Fiber(size_t stackBytes, Entry entry, void* argument)
    : m_state(std::make_unique<State>()) {
    State& state = *m_state;
    state.stackBytes = stackBytes;
    state.mappingBytes = stackBytes + pageBytes();
    void* mapping = mmap(nullptr, state.mappingBytes, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
    if (mapping == MAP_FAILED) throw std::bad_alloc();
    state.mapping = static_cast<std::byte*>(mapping);
    state.stack = state.mapping + pageBytes();
    mprotect(state.mapping, pageBytes(), PROT_NONE); // an overflow must fault, not run into a neighbour
    state.entry = entry;
    state.argument = argument;
    enterStack();
}

/// The first switch to the stack, which comes back at once: from then on it can be jumped to.
void Fiber::enterStack() {
    State& state = *m_state;
    ucontext_t first{}, unused{};
    getcontext(&first);
    first.uc_stack.ss_sp = state.stack;
    first.uc_stack.ss_size = state.stackBytes;
    // makecontext hands over ints only: the pointer travels in two halves.
    const auto address = reinterpret_cast<uintptr_t>(this);
    makecontext(&first, reinterpret_cast<void (*)()>(&Fiber::start), 2, static_cast<unsigned>(address),
                static_cast<unsigned>(address >> 32));
#ifdef Q3RT_ADDRESS_SANITIZER
    void* fakeStack = nullptr;
    __sanitizer_start_switch_fiber(&fakeStack, state.stack, state.stackBytes);
#endif
    if (_setjmp(state.resumer) == 0) swapcontext(&unused, &first);
#ifdef Q3RT_ADDRESS_SANITIZER
    __sanitizer_finish_switch_fiber(fakeStack, nullptr, nullptr);
#endif
}

Fiber::~Fiber() {
#ifdef Q3RT_ADDRESS_SANITIZER
    // The next mapping at this address must not inherit the frames' poison.
    __asan_unpoison_memory_region(m_state->stack, m_state->stackBytes);
#endif
    munmap(m_state->mapping, m_state->mappingBytes);
}

void Fiber::start(unsigned low, unsigned high) {
    auto* fiber = reinterpret_cast<Fiber*>(static_cast<uintptr_t>(high) << 32 | low);
    State& state = *fiber->m_state;
#ifdef Q3RT_ADDRESS_SANITIZER
    __sanitizer_finish_switch_fiber(nullptr, &state.resumerStack, &state.resumerStackBytes);
#endif
    fiber->suspend();
    state.entry(state.argument);
    std::terminate();
}

void Fiber::resume() {
    State& state = *m_state;
    exchangeExceptionState(state.exceptions);
#ifdef Q3RT_ADDRESS_SANITIZER
    void* fakeStack = nullptr;
    __sanitizer_start_switch_fiber(&fakeStack, state.stack, state.stackBytes);
#endif
    switchStack(state.resumer, state.own);
#ifdef Q3RT_ADDRESS_SANITIZER
    __sanitizer_finish_switch_fiber(fakeStack, nullptr, nullptr);
#endif
    exchangeExceptionState(state.exceptions);
}

void Fiber::suspend() {
    State& state = *m_state;
#ifdef Q3RT_ADDRESS_SANITIZER
    __sanitizer_start_switch_fiber(&state.fakeStack, state.resumerStack, state.resumerStackBytes);
#endif
    switchStack(state.own, state.resumer);
#ifdef Q3RT_ADDRESS_SANITIZER
    __sanitizer_finish_switch_fiber(state.fakeStack, &state.resumerStack, &state.resumerStackBytes);
#endif
}

} // namespace q3rt
