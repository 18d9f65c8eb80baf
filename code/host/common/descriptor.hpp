#pragma once
// An open file descriptor with one owner.

#include <unistd.h>

namespace q3rt {

struct Descriptor {
    int number = -1; ///< -1: none
    Descriptor() = default;
    explicit Descriptor(int n)
        : number(n) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    void reset(int n = -1) {
        if (number >= 0) close(number);
        number = n;
    }
};

} // namespace q3rt
