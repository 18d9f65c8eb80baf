// The line between shading and tracing. Above it: stages that are functions of a pixel. Below it, one of
//   trace_pipeline.glsl  VK_KHR_ray_tracing_pipeline, in ray-generation shaders
//   trace_query.glsl     VK_KHR_ray_query, in compute shaders
//   trace_compute.glsl   our own tree, in compute shaders
// Each gives
//   Hit traceClosest(vec3 origin, vec3 direction, float tMin, float tMax, uint mask, bool cullBack)
//   bool traceVisible(vec3 origin, vec3 direction, float tMax, uint mask)    nothing solid in (0, tMax)
//   LayerBatch traceLayers(vec3 origin, vec3 direction, float tMax, uint mask, LayerKey after)
//     a layer's key is nearer than its triangle: none is missed behind after.distance
// and asks the stage for
//   bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction)
//     of every non-opaque triangle, in any order and perhaps more than once: is there something at this point?
//   float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
//     where a blended surface stands in the drawing order along the ray; negative: it doesn't show.
// t is in units of |direction|.
#ifndef Q3RT_TRACE_GLSL
#define Q3RT_TRACE_GLSL
#include "shared/types.h"

struct Hit {
    float t; // 0: nothing was hit
    uint instance;
    uint triangle;
    vec2 barycentric; // weights of corners 1 and 2
};

// Layers in drawing order from the eye: by distance, then by number, so that no two keys are equal.
struct LayerKey {
    float distance;
    uint instance;
    uint triangle;
};

struct Layer {
    LayerKey key;
    float t;
    vec2 barycentric;
};

// As many nearest layers as one traversal collects; a full batch is followed by another one after its last key.
const uint kLayersPerBatch = 4u;
struct LayerBatch {
    LayerKey after;
    uint count;
    Layer layers[kLayersPerBatch];
};

bool isBefore(LayerKey a, LayerKey b)
{
    if (a.distance != b.distance)
        return a.distance < b.distance;
    if (a.instance != b.instance)
        return a.instance < b.instance;
    return a.triangle < b.triangle;
}

LayerBatch emptyBatch(LayerKey after)
{
    LayerBatch batch;
    batch.after = after;
    batch.count = 0u;
    for (uint i = 0u; i < kLayersPerBatch; ++i)
        batch.layers[i] = Layer(LayerKey(0.0f, 0u, 0u), 0.0f, vec2(0.0f));
    return batch;
}

// Insertion that keeps the nearest kLayersPerBatch after `after`; offered twice, a layer is kept once.
void insertLayer(INOUT(LayerBatch) batch, Layer layer)
{
    if (!isBefore(batch.after, layer.key))
        return;
    uint place = batch.count;
    while (place > 0u && isBefore(layer.key, batch.layers[place - 1u].key))
        --place;
    if (place > 0u && !isBefore(batch.layers[place - 1u].key, layer.key))
        return;
    if (place == kLayersPerBatch)
        return;
    uint last = min(batch.count, kLayersPerBatch - 1u);
    for (uint i = last; i > place; --i)
        batch.layers[i] = batch.layers[i - 1u];
    batch.layers[place] = layer;
    batch.count = min(batch.count + 1u, kLayersPerBatch);
}

#endif
