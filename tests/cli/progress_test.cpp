// What a progress line says of the time that is left.

#include "host/common/progress.hpp"

#include <gtest/gtest.h>

namespace q3rt::test {
namespace {

TEST(Pacer, KnowsNoPaceAtItsFirstWord) {
    Pacer pacer;
    EXPECT_FALSE(pacer.secondsLeft(1000, 0.01));
    EXPECT_FALSE(pacer.secondsLeft(1005, 0.01));
}

// A map took 60 s to load, the first of 3,398 frames 5 s; the others take 0.1 s.
TEST(Pacer, DoesNotCountTheBeginning) {
    Pacer pacer;
    const auto shareOf = [](int frame) { return frame / 3398.0; };
    pacer.secondsLeft(65, shareOf(1));
    for (const int frame : {2, 100, 3397})
        EXPECT_NEAR(*pacer.secondsLeft(65 + 0.1 * (frame - 1), shareOf(frame)), 0.1 * (3398 - frame), 1e-6);
    EXPECT_EQ(*pacer.secondsLeft(405, 1), 0);
}

// A sweep that goes on where it was broken off is not so fast as its share says.
TEST(Pacer, BeginsWhereItsWorkBegan) {
    Pacer pacer;
    pacer.secondsLeft(0, 0.5);
    EXPECT_NEAR(*pacer.secondsLeft(10, 0.6), 40, 1e-9);
}

} // namespace
} // namespace q3rt::test
