#pragma once
// What a frame holds, by what becomes of its structures (DESIGN: five classes).

#include <array>
#include <cstdint>

namespace q3rt {

enum class StructureClass : uint8_t {
    StaticWorld,   ///< built at load
    ChangingWorld, ///< built at load; materials change with time
    DynamicWorld,  ///< deformed: built or updated each frame
    StaticEntity,  ///< movers and models with a single frame: built once, instanced
    DynamicEntity  ///< vertex animation, sprites, beams, polys: built or updated each frame
};
inline constexpr size_t kStructureClassCount = 5;
inline constexpr std::array<const char*, kStructureClassCount> kStructureClassNames{
    "static_world", "changing_world", "dynamic_world", "static_entities", "dynamic_entities"};

/// Of one frame.
struct ClassCount {
    uint32_t surfaces = 0, triangles = 0;
    uint32_t builds = 0;  ///< of structures
    uint32_t updates = 0; ///< of boxes alone
};
using ClassCounts = std::array<ClassCount, kStructureClassCount>;

} // namespace q3rt
