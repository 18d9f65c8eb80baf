#pragma once
// A box in two SIMD registers for the builders' inner loops; the fourth lane is unused.

#include "math/lanes.hpp"
#include "math/vector.hpp"

namespace q3rt {

struct Box4 {
    Float4 mins{kEmpty, kEmpty, kEmpty, kEmpty};
    Float4 maxs{-kEmpty, -kEmpty, -kEmpty, -kEmpty};

    Box4() = default;
    explicit Box4(const Bounds& box)
        : mins{box.mins.x, box.mins.y, box.mins.z, 0}
        , maxs{box.maxs.x, box.maxs.y, box.maxs.z, 0} {}
    void add(const Box4& other) {
        mins = minimum(mins, other.mins);
        maxs = maximum(maxs, other.maxs);
    }
    void addPoint(Float4 point) {
        mins = minimum(mins, point);
        maxs = maximum(maxs, point);
    }
    /// Twice the centre: an order along each axis is all that the builders need.
    Float4 doubleCentre() const { return mins + maxs; }
    /// Half the surface area; 0 for an empty box.
    float halfArea() const {
        const Float4 size = maxs - mins;
        if (size[0] < 0) return 0;
        return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
    }
    vec3 low() const { return {mins[0], mins[1], mins[2]}; }
    vec3 high() const { return {maxs[0], maxs[1], maxs[2]}; }

  private:
    static constexpr float kEmpty = std::numeric_limits<float>::max();
};

} // namespace q3rt
