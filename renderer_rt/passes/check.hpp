#pragma once
// rt_checkFinite: after each pass, how many numbers of what it wrote are none or infinite.

#include <cstddef>

#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

/// What lies in a buffer: structures of 32-bit words, some of which are numbers.
struct ItemLayout {
    uint32_t words = 0;
    uint32_t floats = 0; ///< bit i: word i is a number
};

/// `count` numbers at a structure's byte `offset`.
constexpr uint32_t floatsAt(size_t offset, uint32_t count) {
    return ((1u << count) - 1u) << (offset / sizeof(uint32_t));
}

template <typename Item>
constexpr uint32_t wordsOf() {
    static_assert(sizeof(Item) % sizeof(uint32_t) == 0 && sizeof(Item) <= 32 * sizeof(uint32_t));
    return sizeof(Item) / sizeof(uint32_t);
}

inline constexpr ItemLayout kColorItem{4, 0xf}, kPairItem{2, 0x3};
inline constexpr ItemLayout kSumsItem{wordsOf<RtSums>(), (1u << wordsOf<RtSums>()) - 1u};
inline constexpr ItemLayout kGuideItem{wordsOf<RtGuide>(), floatsAt(offsetof(RtGuide, position), 3)};
inline constexpr ItemLayout kPastItem{wordsOf<RtPast>(), floatsAt(offsetof(RtPast, position), 3)};
inline constexpr ItemLayout kLookItem{wordsOf<RtLook>(),
                                      floatsAt(offsetof(RtLook, t), 1) | floatsAt(offsetof(RtLook, barycentric), 2)};
inline constexpr ItemLayout kPixelItem{
    wordsOf<RtPixel>(), floatsAt(offsetof(RtPixel, position), 3) | floatsAt(offsetof(RtPixel, error), 3) |
                            floatsAt(offsetof(RtPixel, normal), 3) | floatsAt(offsetof(RtPixel, geometricNormal), 3) |
                            floatsAt(offsetof(RtPixel, albedo), 3) | floatsAt(offsetof(RtPixel, emission), 3)};

/// Counts in what `pass` wrote into a buffer of one item for each of `extent`, if the view is checked.
void checkFinite(FrameGraph& graph, ViewResources& resources, const char* pass, BufferId buffer, ItemLayout item,
                 VkExtent2D extent);

} // namespace q3rt
