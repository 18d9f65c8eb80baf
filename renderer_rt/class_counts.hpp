#pragma once
// What a frame holds, by how often its structures are built (DESIGN: five classes).

#include <array>
#include <cstdint>

namespace q3rt {

enum class StructureClass : uint8_t {
    StaticWorld,   ///< built at load
    ChangingWorld, ///< built at load; materials change with time
    DynamicWorld,  ///< deformed: built each frame
    StaticEntity,  ///< movers and models with a single frame: built once, instanced
    DynamicEntity  ///< vertex animation, sprites, beams, polys: built each frame
};
inline constexpr size_t kStructureClassCount = 5;
inline constexpr std::array<const char*, kStructureClassCount> kStructureClassNames{
    "static_world", "changing_world", "dynamic_world", "static_entities", "dynamic_entities"};

/// Of one frame.
struct ClassCount {
    uint32_t surfaces = 0, triangles = 0, builds = 0;
};
using ClassCounts = std::array<ClassCount, kStructureClassCount>;

} // namespace q3rt
