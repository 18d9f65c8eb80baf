// Pixels whose first look was all: the sky, or a solid behind no layer that lets nothing through, reflects nothing and
// leads nowhere. No rays are traced here: it is one text for all back ends, and one without a search in it, which takes
// more than half of a GPU's registers. What needs more rays is left to the primary stage.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/picture.glsl"
#include "rt/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// False: there is more to be seen.
bool addSolid(inout Picture picture, CameraRay ray, RtLook seen)
{
    SurfacePoint point = makeSurfacePoint(seen.instance, seen.triangle, seen.barycentric, ray.origin, ray.direction,
                                          ray.directionX, ray.directionY);
    bool leadsOn = (point.surface.flags & (kSurfaceWater | kSurfaceGlass)) != 0u ||
                   (point.surface.portal != 0u && point.frontFace);
    if (leadsOn)
        return false;
    addLayer(picture, ray, point, SurfacePlace(seen.instance, seen.triangle, seen.barycentric, seen.t),
             shadeSurface(point, ray.origin, ray.forward), 0.0);
    return picture.passed == vec3(0.0);
}

// False: only a ray can tell which sky it is.
bool addSky(inout Picture picture, CameraRay ray)
{
    if ((rtFrame.flags & kFrameSkySurfaces) != 0u)
        return false;
    if (rtFrame.skyCount > 0u)
        picture.pixel.emission +=
            skyColor(SkyTable(rtFrame.skies).at[0], ray.direction, ray.directionX, ray.directionY);
    return true;
}

void shadePixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtLook seen = loadLook(rtFrame.looks, index);
    if ((seen.state & kLookOn) != 0u)
        return;
    CameraPlace place = cameraPlace(pixelPosition);
    place.near = (seen.state & kLookNear) != 0u;
    Picture picture = beginPicture(place, pixelPosition);
    CameraRay ray = makeCameraRay(picture.at, picture.onLens);
    if (seen.t > 0.0 ? addSolid(picture, ray, seen) : addSky(picture, ray))
        keepPicture(picture, pixelPosition);
    else
        storeLookState(rtFrame.looks, index, seen.state | kLookOn);
}

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, rtFrame.size)))
        shadePixel(gl_GlobalInvocationID.xy);
}
