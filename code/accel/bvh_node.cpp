// Boxes of a node's children on a grid of 256 cells an axis: origin + q x cell, cell a power of two.
//
// What is stored holds the given box whole, exactly. s = fl(x - origin) and its rounding error e are known exactly
// (Knuth 1969, TAOCP 2, section 4.2.2, theorem B), so x - origin = s + e. q x cell is a binary32 number for every
// q <= 255, and rounding is monotonic: s > q cell proves that s + e >= q cell, s < q cell that s + e <= q cell; where
// s = q cell, the sign of e decides. (tests/accel/node_test.cpp compares in 113 bits.)

#include "accel/bvh_node.hpp"

#include <bit>
#include <cmath>

namespace q3rt {
namespace {

using Int4 = int32_t __attribute__((vector_size(16)));

constexpr uint32_t kExponentBias = 127, kMantissaBits = 23;
/// 255 cells of 2^(k - 7) are 1.9921875 x 2^k.
constexpr uint32_t kLargestMantissa = 0x7f0000u;

struct Difference {
    Float4 value, error; // exactly: a - b = value + error
};

Difference subtract(Float4 a, Float4 b) {
    const Float4 value = a - b;
    const Float4 bPart = a - value, aPart = value + bPart;
    return {value, (a - aPart) - (b - bPart)};
}

/// Exponent byte of the smallest cell of which 255 are at least value + error.
uint32_t cellExponent(float value, float error) {
    const auto bits = std::bit_cast<uint32_t>(value);
    const uint32_t exponent = bits >> kMantissaBits, mantissa = bits & 0x7fffffu;
    const bool fits = mantissa < kLargestMantissa || (mantissa == kLargestMantissa && error <= 0);
    const uint32_t wanted = exponent + (fits ? 0u : 1u);
    return wanted > 7 ? wanted - 7 : 1; // at least 2^-126
}

float powerOfTwo(uint32_t exponent) { return std::bit_cast<float>(exponent << kMantissaBits); }

Float4 splat(float x) { return Float4{x, x, x, x}; }

/// A length >= 0 in whole cells, down or up.
class Cells {
  public:
    Cells(const Difference& length, uint32_t exponent)
        : m_error(length.error) {
        const Float4 whole = length.value * splat(powerOfTwo(2 * kExponentBias - exponent));
        m_whole = __builtin_convertvector(whole, Int4);
        // Compared as lengths: the quotient of a tiny one underflows.
        m_exact = __builtin_convertvector(m_whole, Float4) * splat(powerOfTwo(exponent)) == length.value;
    }
    Int4 down() const { return m_whole + (m_exact & (m_error < Float4{})); }
    Int4 up() const { return m_whole - (~m_exact | (m_error > Float4{})); }

  private:
    Float4 m_error;
    Int4 m_whole, m_exact;
};

uint32_t packBytes(Int4 q) {
    return static_cast<uint32_t>(q[0]) | static_cast<uint32_t>(q[1]) << 8 | static_cast<uint32_t>(q[2]) << 16 |
           static_cast<uint32_t>(q[3]) << 24;
}

struct AxisWords {
    uint32_t exponent, low, high;
};

/// `lows`, `highs`: of the four children on one axis; absent ones lie at `origin`.
AxisWords packAxis(Float4 lows, Float4 highs, float origin) {
    const Difference low = subtract(lows, splat(origin)), high = subtract(highs, splat(origin));
    int last = 0;
    for (int i = 1; i < 4; ++i)
        if (high.value[i] > high.value[last] || (high.value[i] == high.value[last] && high.error[i] > high.error[last]))
            last = i;
    const uint32_t exponent = cellExponent(high.value[last], high.error[last]);
    return {exponent, packBytes(Cells(low, exponent).down()), packBytes(Cells(high, exponent).up())};
}

} // namespace

void repackBoxes(BvhNode& node, const Box4 (&box)[kBvhWidth]) {
    Box4 all;
    for (const Box4& b : box)
        all.add(b);
    const bool empty = all.mins[0] > all.maxs[0];
    const Float4 origin = empty ? Float4{} : all.mins;
    node.origin = vec3(origin[0], origin[1], origin[2]);
    uint32_t exponents = 0;
    for (int axis = 0; axis < 3; ++axis) {
        Float4 lows{}, highs{};
        for (int i = 0; i < 4; ++i) {
            const bool absent = box[i].mins[0] > box[i].maxs[0];
            lows[i] = absent ? origin[axis] : box[i].mins[axis];
            highs[i] = absent ? origin[axis] : box[i].maxs[axis];
        }
        const AxisWords words = packAxis(lows, highs, origin[axis]);
        exponents |= words.exponent << (8 * axis);
        (axis == 0 ? node.lowX : axis == 1 ? node.lowY : node.lowZ) = words.low;
        (axis == 0 ? node.highX : axis == 1 ? node.highY : node.highZ) = words.high;
    }
    node.scales = (node.scales & 0xff000000u) | exponents;
}

void setGroups(BvhNode& node, uint32_t slot, uint32_t groups) {
    const uint32_t solid = 1u << (kBvhGroupShift + slot), other = solid << kBvhWidth;
    node.scales &= ~(solid | other);
    if (groups & kBvhSolidGroup) node.scales |= solid;
    if (groups & kBvhOtherGroup) node.scales |= other;
}

BvhNode packNode(const NodeContent& content) {
    BvhNode node{};
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        node.child[slot] = content.groups[slot] ? content.child[slot] : leafWord(0, 0);
        setGroups(node, slot, content.groups[slot]);
    }
    repackBoxes(node, content.box);
    return node;
}

Bounds childBounds(const BvhNode& node, uint32_t slot) {
    Bounds box;
    if (groupsOf(node, slot) == 0) return box;
    const uint32_t lows[3] = {node.lowX, node.lowY, node.lowZ}, highs[3] = {node.highX, node.highY, node.highZ};
    constexpr float kEndless = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = node.origin[axis], cell = powerOfTwo(node.scales >> (8 * axis) & 0xffu);
        box.mins[axis] = static_cast<float>(origin + (lows[axis] >> (8 * slot) & 0xffu) * cell);
        box.maxs[axis] = static_cast<float>(origin + (highs[axis] >> (8 * slot) & 0xffu) * cell);
        box.mins[axis] = std::nextafter(box.mins[axis], -kEndless);
        box.maxs[axis] = std::nextafter(box.maxs[axis], kEndless);
    }
    return box;
}

} // namespace q3rt
