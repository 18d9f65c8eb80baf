// The exposed picture to display values: the output curve.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/tonemap.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameTable { RtFrame value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PictureTable { vec4 at[]; };
layout(push_constant, scalar) uniform Push { RtOutput push; };
layout(location = 0) out vec4 color;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy) - push.corner;
    uint index = pixel.y * push.width + pixel.x;
    vec3 picture = PictureTable(pixel.x < push.split ? push.picture : push.right).at[index].rgb;
    uint curve = FrameTable(push.frame).value.curve;
    float white = FrameTable(push.frame).value.curveWhite;
    bool linear = (FrameTable(push.frame).value.flags & kFrameLinear) != 0u;
    color = vec4(displayColor(picture, curve, white, linear), 1.0);
}
