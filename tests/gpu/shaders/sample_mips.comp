#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require
// result[i]: the centre of mip level mips[i] of texture textures[indices[i]].
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform sampler2D textures[];
layout(set = 1, binding = 0, scalar) readonly buffer Queries { uvec2 queries[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Results { vec4 results[]; };
layout(push_constant, scalar) uniform Push { uint count; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    results[i] = textureLod(textures[nonuniformEXT(queries[i].x)], vec2(0.5), float(queries[i].y));
}
