#pragma once
// What the lists of a frame are made for, so that play grows none of them: several times what the busiest frames of the
// recorded demos hold. They still grow where a frame holds more; memory that none needs is never touched.

#include <cstddef>

namespace q3rt::busyFrame {

inline constexpr size_t kEntities = 2048, kPolys = 4096, kLights = 128;
inline constexpr size_t kPictures = 2048; ///< of the 2D interface
inline constexpr size_t kVertices = size_t{1} << 16, kIndices = size_t{1} << 18;
inline constexpr size_t kSurfaces = 8192; ///< of entities; batches of a frame
inline constexpr size_t kStages = 4096;
inline constexpr size_t kWorkVertices = 8192; ///< of one surface at a time
inline constexpr size_t kSmall = 256;         ///< polygons, planes, bones

} // namespace q3rt::busyFrame
