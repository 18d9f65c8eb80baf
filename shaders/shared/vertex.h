// The one vertex of world, models, polys and 2D. Scalar layout, 48 bytes.
#ifndef Q3RT_SHARED_VERTEX_H
#define Q3RT_SHARED_VERTEX_H
#include "types.h"
SHARED_BEGIN
struct Vertex {
    vec3 position;   // qu; world, or model space of an instance
    vec3 normal;     // unit (may be 0 on degenerate geometry)
    vec2 st;         // texture
    vec2 lightmapSt; // page coordinates; 0 where there is none
    uint color;      // RGBA8, red in the low byte; baked light (shifted) or the caller's colour
    uint reserved;
};
SHARED_END
#endif
