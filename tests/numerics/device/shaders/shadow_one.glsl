// One shadow ray; a back end is included before.
void shadowRay(uint i)
{
    if (i >= push.count)
        return;
    ShadowInput ray = RayTable(push.rays).at[i];
    HitPoint point = makeHitPoint(ray.corner[0], ray.corner[1], ray.corner[2], ray.barycentric);
    if (push.instanced != 0u)
        point = transformHitPoint(push.worldFromModel[0], push.worldFromModel[1], push.worldFromModel[2], point,
                                  push.inverseError);
    vec3 origin = offsetOrigin(point.position, point.error, ray.normal);
    ResultTable(push.results).at[i] = traceSolid(origin, ray.light - origin, 1.0, 0xffu, false).t == 0.0 ? 1u : 0u;
}
