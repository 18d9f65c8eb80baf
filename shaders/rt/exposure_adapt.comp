// Automatic exposure, second pass: the middle of the histogram says what the exposure should be; it goes there at a
// bounded speed. Leaves an empty histogram.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/exposure.glsl"

layout(local_size_x = 1) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExposureTable { RtExposure value; };
layout(push_constant, scalar) uniform Push { RtExposurePush push; };

void main()
{
    uint bins[kExposureBinCount];
    for (uint i = 0u; i < kExposureBinCount; ++i) {
        bins[i] = ExposureTable(push.exposure).value.bins[i];
        ExposureTable(push.exposure).value.bins[i] = 0u;
    }
    float stops = ExposureTable(push.exposure).value.stops;
    ExposureTable(push.exposure).value.previousStops = stops;
    ExposureTable(push.exposure).value.stops = adaptStops(stops, wantedStops(bins, stops), push.mostStops);
}
