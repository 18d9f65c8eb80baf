#pragma once
// The wall between C++ and the engine's longjmp.
//
// The engine reports errors by calling Error, which first calls back into our own Shutdown and BeginRegistration and
// then longjmps over every frame between its main loop and the call. Nearly every import (file, cvar, memory, command
// calls) can do the same. A jump over frames that own something is undefined behaviour and leaks in practice. So no
// frame that owns anything ever lies on the engine's stack:
//
// - Each export's body runs on its own stack, a fiber (engine/fiber.hpp). The engine's stack holds only the guard's
//   frames, which own nothing.
// - A body calls an import through Guard::call: the fiber suspends, the import runs on the engine's stack, the fiber
//   resumes with the result.
// - If the import jumps away, the fiber stays suspended, its objects intact. The next entry into any export (normally
// the
//   Shutdown that the engine makes before it jumps) resumes it as *abandoned*: Guard::call throws EngineJump at the
//   place of the import, the body unwinds like after any exception, and only then the new body runs. Several suspended
//   fibers are unwound innermost first.
// - The one legal re-entry while a body waits in an import is UploadCinematic inside CIN_UploadCinematic; both sides
// say
//   so (EntryKind::Nested, ImportKind::Reentrant), everything else is taken for a jump.
// - An exception that leaves a body ends at the bottom of the fiber and becomes a severity and a text in a static
// buffer.
//   Back on the engine's stack, with nothing alive in the fiber, Error is the last thing called. ContentError and
//   UsageError end the game (ERR_DROP); anything else ends the program (ERR_FATAL).
// - An export entered while a body *runs* comes from a signal handler on top of that body (or on a worker thread): it
// is
//   refused. The program is about to end, and taking a device apart under a driver call that is in progress would
//   crash or hang it; the module pins itself in memory instead (export_table.cpp).
//
// Rules for bodies: what they capture lies on the engine's stack and may be gone while they unwind, so no destructor
// uses it; catch (...) must rethrow; code that calls imports is not noexcept, except for those that
// destructors need (print, remove a command, shut input down): these are ImportKind::NeverThrows and return even when
// abandoned. Any import called while an abandoned fiber unwinds is skipped and yields a zero. Only the engine's thread
// may call.

#include <array>
#include <exception>
#include <memory>
#include <pthread.h>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/fiber.hpp"

namespace q3rt {

/// Thrown at an import call that never returned. Deliberately no std::exception: only the guard may end it.
class EngineJump {};

enum class Severity { None, Drop, Fatal };
enum class EntryKind { TopLevel, Nested };
enum class ImportKind { Normal, Reentrant, NeverThrows };

class Guard {
  public:
    /// Raises an error in the engine; usually doesn't return.
    using RaiseError = void (*)(Severity severity, const char* text);

    explicit Guard(RaiseError raiseError);
    ~Guard();
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

    /// Runs an export's body. Reports its failure to the engine, so this may not return; then nothing is left behind.
    /// False: refused, a body is running beneath us (signal) or this isn't the engine's thread.
    template <class Body>
    bool run(Body&& body, EntryKind kind = EntryKind::TopLevel) {
        static_assert(std::is_trivially_destructible_v<std::remove_reference_t<Body>>,
                      "the engine may jump over the body object");
        return runBody([](void* data) { (*static_cast<std::remove_reference_t<Body>*>(data))(); }, &body, kind);
    }

    /// Same, but a failure counts as fatal whatever its type.
    template <class Body>
    bool runOrDie(Body&& body) {
        m_failuresAreFatal = true;
        return run(std::forward<Body>(body));
    }

    /// From a body: calls `function` on the engine's stack and returns its result. From the engine's stack: just calls.
    template <class Function>
    auto call(Function&& function, ImportKind kind = ImportKind::Normal) -> std::invoke_result_t<Function&> {
        using Result = std::invoke_result_t<Function&>;
        if constexpr (std::is_void_v<Result>) {
            auto request = [&] { function(); };
            callErased(request, kind);
        } else {
            static_assert(std::is_trivially_destructible_v<Result>, "imports return plain values");
            Result result{};
            auto request = [&] { result = function(); };
            callErased(request, kind);
            return result;
        }
    }

    /// A body is executing now (not waiting in an import).
    bool running() const { return m_running != nullptr; }
    /// Unwinds every body whose import never returned.
    void abandonSuspended();

  private:
    using Thunk = void (*)(void*);
    struct Slot;

    template <class Request>
    void callErased(Request& request, ImportKind kind) {
        callImport([](void* data) { (*static_cast<Request*>(data))(); }, &request, kind);
    }
    bool provideSlot();
    bool runBody(Thunk body, void* data, EntryKind kind);
    void callImport(Thunk import, void* data, ImportKind kind);
    void pump(Slot& slot);
    static void fiberMain(void* slot);

    RaiseError m_raiseError;
    pthread_t m_engineThread;
    std::vector<std::unique_ptr<Slot>> m_slots; ///< one a nesting level: [0, m_activeCount) wait in imports or run
    size_t m_activeCount = 0;
    Slot* m_running = nullptr;
    bool m_failuresAreFatal = false;         ///< for the next body
    std::array<char, 2048> m_errorText = {}; ///< the engine itself prints at most 4096 characters
};

} // namespace q3rt
