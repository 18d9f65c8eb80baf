// The functions that shaders leave to the driver, one value an invocation.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Arguments { float arguments[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer Results { float results[]; };
layout(push_constant) uniform Push { uint function; uint count; };

float evaluate(float x)
{
    switch (function) {
    case 0u:
        return inversesqrt(x);
    case 1u:
        return sqrt(x);
    case 2u:
        return 1.0 / x;
    case 3u:
        return exp(x);
    case 4u:
        return acos(x);
    case 5u:
        return sin(x);
    case 6u:
        return cos(x);
    case 7u:
        return length(normalize(vec3(x, 0.5 * x, 1.0)));
    default:
        return pow(x, 2.4);
    }
}

void main()
{
    if (gl_GlobalInvocationID.x < count)
        results[gl_GlobalInvocationID.x] = evaluate(arguments[gl_GlobalInvocationID.x]);
}
