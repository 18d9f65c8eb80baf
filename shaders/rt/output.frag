// The exposed picture to display values: the output curve.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/tonemap.glsl"
#include "shared/rt_output.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PictureTable { vec4 at[]; };
layout(push_constant, scalar) uniform Push { RtOutput push; };
layout(location = 0) out vec4 color;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy) - push.corner;
    vec3 radiance = PictureTable(push.picture).at[pixel.y * push.width + pixel.x].rgb;
    color = vec4(push.curve == kCurveFilmic ? reinhardKeepingHue(radiance, push.white) : clampKeepingHue(radiance),
                 1.0);
}
