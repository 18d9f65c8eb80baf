// The compiler's layout of every struct that crosses the boundary is the engine's, or nothing is built.
#include <cstddef>

#include "abi/ref_tables.h"

#define Q3_SIZE(type, size) static_assert(sizeof(type) == (size), #type);
#define Q3_OFFSET(type, member, offset) static_assert(offsetof(type, member) == (offset), #type "." #member);
#include "abi/layout.def.h"
