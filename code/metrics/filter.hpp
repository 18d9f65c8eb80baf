#pragma once
// Separable convolution of one-channel double pictures, shared by SSIM and FLIP.

#include <span>
#include <vector>

namespace q3rt {

struct Plane2d {
    int width = 0, height = 0;
    std::vector<double> values; ///< top row first
};

enum class Border {
    Valid,    ///< only where the kernel fits: the result is smaller by the kernel's size - 1
    Replicate ///< pixels beyond the edge repeat the edge: same size
};

/// Correlates rows with `horizontal`, then columns with `vertical` (both of odd size; index size / 2 is the centre).
Plane2d convolveSeparable(const Plane2d& source, std::span<const double> horizontal, std::span<const double> vertical,
                          Border border);

} // namespace q3rt
