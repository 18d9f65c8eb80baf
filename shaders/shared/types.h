// One spelling of types for C++ and GLSL. Scalar block layout everywhere; no bool in shared structures.
#ifndef Q3RT_SHARED_TYPES_H
#define Q3RT_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstdint>
#include "math/vector.hpp"
namespace q3rt {
using uint = uint32_t;
}
#define SHARED_BEGIN namespace q3rt {
#define SHARED_END }
#define SHARED_CONST inline constexpr uint
#define SHARED_FLOAT inline constexpr float
#define INOUT(type) type&
#define OUT(type) type&
#define PRECISE
#define UNROLL
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONST const uint
#define SHARED_FLOAT const float
#define INOUT(type) inout type
#define OUT(type) out type
#define UNROLL [[unroll]]
#define PRECISE precise // what follows is not reassociated or fused
#endif
#endif
