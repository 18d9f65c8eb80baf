// The guard against an engine that jumps: a stand-in engine that calls exports, and imports that return, jump or
// re-enter.

#include <csetjmp>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "engine/guard.hpp"

namespace q3rt {
namespace {

int liveCount = 0;

/// Counts the objects that are alive.
struct Tracked {
    Tracked() { ++liveCount; }
    ~Tracked() { --liveCount; }
    std::string text = std::string(100, 'x');
    std::vector<int> numbers = std::vector<int>(1000);
};

struct Raised {
    Severity severity = Severity::None;
    std::string text;
    int count = 0;
} raised;

std::jmp_buf* mainLoop = nullptr;

void raise(Severity severity, const char* text) {
    raised.severity = severity;
    raised.text = text;
    ++raised.count;
    if (mainLoop) std::longjmp(*mainLoop, 1);
}

/// Runs `frame` as the engine's main loop does: a jump ends it. True if it came to its end.
template <class Frame>
bool runFrame(Frame&& frame) {
    std::jmp_buf here;
    mainLoop = &here;
    bool finished = false;
    if (setjmp(here) == 0) {
        frame();
        finished = true;
    }
    mainLoop = nullptr;
    return finished;
}

class GuardTest : public testing::Test {
  protected:
    void SetUp() override {
        raised = {};
        liveCount = 0;
    }
    void TearDown() override { EXPECT_EQ(liveCount, 0); }
    Guard guard{&raise};
};

[[noreturn]] void jumpAway() { std::longjmp(*mainLoop, 1); }

TEST_F(GuardTest, BodyRunsOnItsOwnStackAndImportsOnTheEngines) {
    char engineFrame = 0;
    const char* inBody = nullptr;
    const char* inImport = nullptr;
    guard.run([&] {
        char here = 0;
        inBody = &here;
        const int answer = guard.call([&] {
            char there = 0;
            inImport = &there;
            return 42;
        });
        EXPECT_EQ(answer, 42);
        EXPECT_TRUE(guard.running());
    });
    constexpr std::ptrdiff_t kNear = 1 << 20;
    EXPECT_LT(std::abs(inImport - &engineFrame), kNear);
    EXPECT_GT(std::abs(inBody - &engineFrame), kNear);
    EXPECT_FALSE(guard.running());
}

TEST_F(GuardTest, ObjectsOfABodyWhoseImportJumpedDieAtTheNextEntry) {
    EXPECT_FALSE(runFrame([&] {
        guard.run([&] {
            Tracked first;
            Tracked second;
            guard.call([] { jumpAway(); });
            ADD_FAILURE() << "the import must not return";
        });
    }));
    EXPECT_EQ(liveCount, 2);
    bool bodyRan = false;
    guard.run([&] {
        EXPECT_EQ(liveCount, 0);
        bodyRan = true;
    });
    EXPECT_TRUE(bodyRan);
    EXPECT_EQ(raised.count, 0);
}

// What the engine does inside a failing import; it may use nothing of the body, whose stack is gone after the first
// call.
Guard* engineGuard = nullptr;
std::vector<std::string> engineOrder;
[[noreturn]] void failInEngineOrder() {
    engineGuard->run([] { engineOrder.push_back(liveCount == 0 ? "shutdown, clean" : "shutdown, dirty"); });
    engineGuard->run([] { engineOrder.push_back("register"); });
    jumpAway();
}

TEST_F(GuardTest, EngineOrderShutdownRunsInsideTheFailingImport) {
    engineGuard = &guard;
    engineOrder.clear();
    EXPECT_FALSE(runFrame([&] {
        guard.run([&] {
            Tracked owner;
            guard.call([] { failInEngineOrder(); });
        });
    }));
    EXPECT_EQ(engineOrder, (std::vector<std::string>{"shutdown, clean", "register"}));
    guard.run([] {});
}

TEST_F(GuardTest, AnImportThatReturnsAfterItsBodyWasUnwoundIsFatal) {
    engineGuard = &guard;
    EXPECT_FALSE(runFrame([&] {
        guard.run([&] {
            Tracked owner;
            guard.call([] { engineGuard->run([] {}); });
        });
    }));
    EXPECT_EQ(raised.severity, Severity::Fatal);
}

TEST_F(GuardTest, ManyJumpsInARow) {
    constexpr int kRounds = 1000;
    for (int i = 0; i < kRounds; ++i)
        runFrame([&] {
            guard.run([&] {
                Tracked owner;
                guard.call([] { jumpAway(); });
            });
        });
    EXPECT_EQ(liveCount, 1);
    guard.run([] {});
}

TEST_F(GuardTest, ExceptionsBecomeErrorsWithNothingAlive) {
    const auto fail = [&](auto error) {
        runFrame([&] {
            guard.run([&] {
                Tracked owner;
                throw error;
            });
        });
        EXPECT_EQ(liveCount, 0);
        return raised;
    };
    EXPECT_EQ(fail(ContentError("maps/x.bsp: damaged")).severity, Severity::Drop);
    EXPECT_EQ(raised.text, "maps/x.bsp: damaged");
    EXPECT_EQ(fail(UsageError("bad call")).severity, Severity::Drop);
    EXPECT_EQ(fail(DeviceError("lost")).severity, Severity::Fatal);
    EXPECT_EQ(fail(std::runtime_error("other")).severity, Severity::Fatal);
    EXPECT_EQ(fail(7).severity, Severity::Fatal);
    EXPECT_EQ(raised.count, 5);
    EXPECT_EQ(std::current_exception(), nullptr);
}

TEST_F(GuardTest, RunOrDieMakesEveryFailureFatal) {
    runFrame([&] { guard.runOrDie([&] { throw ContentError("x"); }); });
    EXPECT_EQ(raised.severity, Severity::Fatal);
    runFrame([&] { guard.run([&] { throw ContentError("x"); }); });
    EXPECT_EQ(raised.severity, Severity::Drop);
}

TEST_F(GuardTest, LongTextIsCutNotOverrun) {
    runFrame([&] { guard.run([&] { throw ContentError(std::string(100000, 'y')); }); });
    EXPECT_EQ(raised.text.size(), 2047u);
}

TEST_F(GuardTest, UploadInsideItsImportIsNested) {
    bool resumed = false;
    guard.run([&] {
        Tracked outer;
        guard.call(
            [&] {
                guard.run([&] { EXPECT_EQ(liveCount, 1); }, EntryKind::Nested);
                guard.run([&] { EXPECT_EQ(liveCount, 1); }, EntryKind::Nested);
            },
            ImportKind::Reentrant);
        resumed = true;
    });
    EXPECT_TRUE(resumed);
}

TEST_F(GuardTest, ErrorInANestedBodyUnwindsBoth) {
    EXPECT_FALSE(runFrame([&] {
        guard.run([&] {
            Tracked outer;
            guard.call(
                [&] {
                    guard.run(
                        [&] {
                            Tracked inner;
                            throw ContentError("inner");
                        },
                        EntryKind::Nested);
                },
                ImportKind::Reentrant);
        });
    }));
    EXPECT_EQ(raised.text, "inner");
    EXPECT_EQ(liveCount, 1);
    guard.run([] { EXPECT_EQ(liveCount, 0); });
}

TEST_F(GuardTest, DestructorsMayPrintWhileABodyUnwinds) {
    struct Printer {
        Guard& guard;
        int& printed;
        ~Printer() {
            guard.call([this] { ++printed; }, ImportKind::NeverThrows);
        }
    };
    int printed = 0;
    runFrame([&] {
        guard.run([&] {
            Printer printer{guard, printed};
            guard.call([] { jumpAway(); });
        });
    });
    guard.run([] {});
    EXPECT_EQ(printed, 0) << "an import was called for a body whose engine frames are gone";
}

TEST_F(GuardTest, JumpFromADestructorThatRunsDuringAnException) {
    struct Caller {
        Guard& guard;
        ~Caller() {
            guard.call([] { jumpAway(); });
        }
    };
    runFrame([&] {
        guard.run([&] {
            Tracked owner;
            Caller caller{guard};
            throw ContentError("first");
        });
    });
    guard.run([] {
        // This stack's exception state is its own.
        EXPECT_EQ(std::uncaught_exceptions(), 0);
        try {
            throw 1;
        } catch (int) {
        }
    });
    EXPECT_EQ(raised.count, 0);
}

TEST_F(GuardTest, JumpOutOfACatchBlockKeepsTheCaughtException) {
    // Static: what unwinds after a jump may not reach for the engine frames that held the body.
    static std::string seen;
    runFrame([&] {
        guard.run([&] {
            try {
                throw ContentError("kept");
            } catch (const ContentError& error) {
                try {
                    guard.call([] { jumpAway(); });
                } catch (const EngineJump&) {
                    seen = error.what();
                    throw;
                }
            }
        });
    });
    guard.run([] { EXPECT_EQ(std::current_exception(), nullptr); });
    EXPECT_EQ(seen, "kept");
}

TEST_F(GuardTest, EntryWhileABodyRunsIsRefused) {
    bool inner = true;
    guard.run([&] { inner = guard.run([] { ADD_FAILURE() << "ran inside a running body"; }); });
    EXPECT_FALSE(inner);
}

TEST_F(GuardTest, DeepStackIsAvailable) {
    guard.run([] {
        std::array<volatile char, 16 << 20> big;
        for (size_t i = 0; i < big.size(); i += 4096)
            big[i] = 1;
        EXPECT_EQ(big[0], 1);
    });
}

} // namespace
} // namespace q3rt
