// The exposed picture to display values: the output curve, onto the view's rectangle of the target. A compute pass:
// data-centre GPUs draw fragments with few of their processors.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/tonemap.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameTable { RtFrame value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PictureTable { vec4 at[]; };
layout(push_constant, scalar) uniform Push { RtOutput push; };
layout(set = 0, binding = 0, rgba8) uniform writeonly image2D target;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy + uvec2(push.firstColumn, 0u);
    if (any(greaterThanEqual(pixel, push.size)))
        return;
    uint index = pixel.y * push.size.x + pixel.x;
    vec3 picture = PictureTable(pixel.x < push.split ? push.picture : push.right).at[index].rgb;
    uint curve = FrameTable(push.frame).value.curve;
    float white = FrameTable(push.frame).value.curveWhite;
    bool linear = (FrameTable(push.frame).value.flags & kFrameLinear) != 0u;
    imageStore(target, ivec2(push.corner + pixel), vec4(displayColor(picture, curve, white, linear), 1.0));
}
