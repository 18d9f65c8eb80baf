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
    // Light has been clamped with its hue kept; the sum of all layers is clamped channel by channel, as the engine's
    // blending into bytes does: flames on flames become yellow, not orange.
    color = vec4(push.curve == kCurveFilmic ? reinhardKeepingHue(radiance, push.white) : min(radiance, vec3(1.0)), 1.0);
}
