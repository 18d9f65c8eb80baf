#version 460
#extension GL_EXT_scalar_block_layout : require
// sum[i] = a[i] + FACTOR * b[i] + addend
#ifndef FACTOR
#define FACTOR 1
#endif
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kAddend = 0;
layout(set = 0, binding = 0, scalar) readonly buffer A { uint a[]; };
layout(set = 0, binding = 1, scalar) readonly buffer B { uint b[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer Sum { uint sum[]; };
layout(push_constant, scalar) uniform Push { uint count; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) sum[i] = a[i] + FACTOR * b[i] + kAddend;
}
