#pragma once
// Rows of docs/numerics.md: every claim prints what was measured beside its bound, and fails beyond it.

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace q3rt::test {

/// `row` as in the first column of the page. NaN fails.
inline void expectWithin(const std::string& row, double measured, double bound, const char* unit) {
    std::printf("numerics | %s | %.3g | bound %.3g %s\n", row.c_str(), measured, bound, unit);
    EXPECT_TRUE(measured <= bound) << row << ": " << measured << " is beyond " << bound << " " << unit;
}

/// Counts: none of `cases` may be wrong, or `allowed` of them.
inline void expectCount(const std::string& row, size_t wrong, size_t cases, size_t allowed = 0) {
    std::printf("numerics | %s | %zu of %zu | bound %zu\n", row.c_str(), wrong, cases, allowed);
    EXPECT_LE(wrong, allowed) << row << ", of " << cases;
    EXPECT_GT(cases, 0u) << row << ": nothing was tried";
}

} // namespace q3rt::test
