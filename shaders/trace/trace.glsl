// The line between shading and tracing. Above it: stages that are functions of a pixel. Below it, one of
//   trace_pipeline.glsl  VK_KHR_ray_tracing_pipeline, in ray-generation shaders
//   trace_query.glsl     VK_KHR_ray_query, in compute shaders
//   trace_compute.glsl   our own tree, in compute shaders
// Each gives
//   Sight traceSight(vec3 origin, vec3 direction, float tMin, float tMax, uint solidMask, uint layerMask,
//                    LayerKey after)
//     what a ray that looks sees: the closest solid of an instance with a bit of solidMask in (tMin, tMax), back faces
//     culled, and of the layers of layerMask behind `after` in drawing order those that are drawn first, as far as the
//     solid. A mask of 0: none is looked for. A layer's key is nearer than its triangle: none is missed behind
//     after.distance.
//   Hit traceSolid(vec3 origin, vec3 direction, float tMax, uint mask, bool first)
//     a solid in (0, tMax), from either side: the first one, or any, which takes less time
// and asks the stage for
//   bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction)
//     of non-opaque triangles, in any order and perhaps more than once: is there something at this point?
//   uint coverAt(uint instance, uint triangle, vec2 barycentric)
//     the same as far as it can be told with few registers: kCover*
//   float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
//     where a blended surface stands in the drawing order along the ray; negative: it doesn't show.
//   float layerReach(float t, vec3 origin)
//     how far triangles of layers may lie that are drawn before a solid at t.
// t is in units of |direction|.
#ifndef Q3RT_TRACE_GLSL
#define Q3RT_TRACE_GLSL
#include "shared/types.h"

const uint kCoverHole = 0u;
const uint kCoverSolid = 1u;
const uint kCoverUnsure = 2u; // acceptHit() knows

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

// As many first layers as one traversal collects; a full batch is followed by another one after its last key. Layers
// are reached by constant indices only, so that they need not live in memory.
#ifndef LAYERS_PER_BATCH
#define LAYERS_PER_BATCH 4u
#endif
const uint kLayersPerBatch = LAYERS_PER_BATCH;
struct LayerBatch {
    LayerKey after;
    uint count;
    Layer layers[kLayersPerBatch];
};

struct Sight {
    Hit solid;
    LayerBatch layers;
};

const float kNoLayer = 3.4e38f; // distance of an empty place

Hit noHit() { return Hit(0.0f, 0u, 0u, vec2(0.0f)); }
Layer noLayer() { return Layer(LayerKey(kNoLayer, 0u, 0u), 0.0f, vec2(0.0f)); }

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
    UNROLL for (uint i = 0u; i < kLayersPerBatch; ++i)
        batch.layers[i] = noLayer();
    return batch;
}

// Insertion that keeps the first kLayersPerBatch after `after`; offered twice, a layer is kept once.
void insertLayer(INOUT(LayerBatch) batch, Layer layer)
{
    if (!isBefore(batch.after, layer.key))
        return;
    bool known = false;
    bool placed = false;
    UNROLL for (uint i = 0u; i < kLayersPerBatch; ++i) {
        Layer held = batch.layers[i];
        known = known || (!placed && held.key.instance == layer.key.instance &&
                          held.key.triangle == layer.key.triangle && held.key.distance == layer.key.distance);
        if (!known && isBefore(layer.key, held.key)) {
            batch.layers[i] = layer;
            layer = held;
            placed = true;
        }
    }
    if (placed)
        batch.count = min(batch.count + 1u, kLayersPerBatch);
}

// The first of a batch that has any; the batch goes on behind it.
Layer takeLayer(INOUT(LayerBatch) batch)
{
    Layer first = batch.layers[0];
    batch.after = first.key;
    --batch.count;
    UNROLL for (uint i = 1u; i < kLayersPerBatch; ++i)
        batch.layers[i - 1u] = batch.layers[i];
    batch.layers[kLayersPerBatch - 1u] = noLayer();
    return first;
}

#endif
