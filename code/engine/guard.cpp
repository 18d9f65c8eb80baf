#include "engine/guard.hpp"

#include <cstdio>
#include <new>

#include "base/error.hpp"

namespace q3rt {
namespace {

/// Address space for a body; drivers compile shaders on it. Only touched pages are committed.
constexpr size_t kStackBytes = size_t{64} << 20;

} // namespace

/// A fiber that runs one body after another, and what it wants from the engine's stack.
struct Guard::Slot {
    explicit Slot(Guard& guard)
        : fiber(kStackBytes, &Guard::fiberMain, this)
        , errorText(guard.m_errorText) {}

    Fiber fiber;
    Thunk body = nullptr;
    void* bodyData = nullptr;
    Thunk import = nullptr; ///< set while the body waits for an import
    void* importData = nullptr;
    ImportKind importKind = ImportKind::Normal;
    bool finished = false, abandoned = false;
    unsigned activation = 0; ///< changes when the body that waits in an import is given up
    Severity severity = Severity::None;
    std::array<char, 2048>& errorText;

    void fail(Severity level, const char* text) noexcept {
        severity = level;
        std::snprintf(errorText.data(), errorText.size(), "%s", text);
    }
};

Guard::Guard(RaiseError raiseError)
    : m_raiseError(raiseError)
    , m_engineThread(pthread_self()) {}
Guard::~Guard() = default;

void Guard::fiberMain(void* data) {
    Slot& slot = *static_cast<Slot*>(data);
    for (;;) {
        try {
            slot.body(slot.bodyData);
        } catch (const EngineJump&) {
            // The engine has reported its own error already.
        } catch (const ContentError& error) {
            slot.fail(Severity::Drop, error.what());
        } catch (const UsageError& error) {
            slot.fail(Severity::Drop, error.what());
        } catch (const std::exception& error) {
            slot.fail(Severity::Fatal, error.what());
        } catch (...) {
            slot.fail(Severity::Fatal, "unknown exception in the renderer");
        }
        slot.finished = true;
        slot.fiber.suspend();
    }
}

void Guard::pump(Slot& slot) {
    for (;;) {
        m_running = &slot;
        slot.fiber.resume();
        m_running = nullptr;
        if (slot.finished) return;
        const unsigned activation = slot.activation;
        slot.import(slot.importData); // may never come back
        if (slot.activation != activation) {
            m_raiseError(Severity::Fatal, "the engine called the renderer from within an import that doesn't allow it");
            return;
        }
    }
}

void Guard::abandonSuspended() {
    while (m_activeCount > 0) {
        Slot& slot = *m_slots[m_activeCount - 1];
        slot.abandoned = true;
        ++slot.activation;
        m_running = &slot;
        slot.fiber.resume();
        m_running = nullptr;
        --m_activeCount;
    }
}

bool Guard::provideSlot() {
    if (m_activeCount < m_slots.size()) return true;
    try {
        m_slots.push_back(std::make_unique<Slot>(*this));
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

bool Guard::runBody(Thunk body, void* data, EntryKind kind) {
    const bool failuresAreFatal = std::exchange(m_failuresAreFatal, false);
    if (m_running || !pthread_equal(pthread_self(), m_engineThread)) return false;
    const bool nested = m_activeCount > 0 && kind == EntryKind::Nested &&
                        m_slots[m_activeCount - 1]->importKind == ImportKind::Reentrant;
    if (!nested) abandonSuspended();
    if (!provideSlot()) {
        m_raiseError(Severity::Fatal, "the renderer can't get a stack: out of memory or address space");
        return true;
    }
    Slot& slot = *m_slots[m_activeCount++];
    slot.body = body;
    slot.bodyData = data;
    slot.finished = slot.abandoned = false;
    slot.severity = Severity::None;
    pump(slot);
    --m_activeCount;
    if (slot.severity == Severity::None) return true;
    m_raiseError(failuresAreFatal ? Severity::Fatal : slot.severity, m_errorText.data());
    return true;
}

void Guard::callImport(Thunk import, void* data, ImportKind kind) {
    if (!pthread_equal(pthread_self(), m_engineThread))
        throw UsageError("the engine was called from a worker thread of the renderer");
    if (!m_running) {
        import(data);
        return;
    }
    Slot& slot = *m_running;
    if (!slot.abandoned) {
        slot.import = import;
        slot.importData = data;
        slot.importKind = kind;
        slot.fiber.suspend();
        if (!slot.abandoned) return;
    }
    // Destructors that run while the fiber unwinds may come here again (to log): they must not throw.
    if (kind != ImportKind::NeverThrows && std::uncaught_exceptions() == 0) throw EngineJump();
}

} // namespace q3rt
