#pragma once
// How often anything in this process asked for memory by `new`: the program that links this, and the modules it loads.
// What drivers written in C do is their own.

#include <cstdint>

namespace q3rt::test {

/// Since the process began; all threads.
uint64_t allocationCount();

} // namespace q3rt::test
