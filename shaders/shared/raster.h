// What the rasteriser's shaders read besides stages: entities of a view, dynamic lights, fogs, and a draw's constants.
#ifndef Q3RT_SHARED_RASTER_H
#define Q3RT_SHARED_RASTER_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST kPassStage = 0u; // a material stage
SHARED_CONST kPassLight = 1u; // a dynamic light over it
SHARED_CONST kPassFog = 2u;   // fog over it
SHARED_CONST kPassDepth = 3u; // depth alone, before all

// A stage that is laid over the first of its pass, in one word: source factor, destination factor, alpha test (values
// of stage.h), whether its colour is 1 everywhere.
SHARED_CONST kLayerDestinationShift = 4u;
SHARED_CONST kLayerTestShift = 8u;
SHARED_CONST kLayerWhite = 1024u;

// An entity in one view; the world is one of them.
struct RasterEntity {
    mat4 clipFromModel;
    vec4 worldRow0; // rows of worldFromModel
    vec4 worldRow1;
    vec4 worldRow2;
    vec4 clipPlane; // world space; kept where dot(xyz, p) - w >= 0; all 0: nothing is clipped
    vec3 eyeInModel;
    float reserved0;
    vec3 eyeInWorld;
    float reserved1;
    vec3 ambient; // 0..255
    float reserved2;
    vec3 directed; // 0..255
    float reserved3;
    vec3 lightDirection; // in model axes
    float reserved4;
};

// A dynamic light in the space of the entity it falls on.
struct RasterLight {
    vec3 origin;
    float radius; // qu
    vec3 color;   // about 0..1; a product above 255 wraps as a byte would
    uint reserved;
};

// A fog volume in one view.
struct RasterFog {
    vec3 color;   // [0, 1], whole bytes
    float scale;  // texture coordinate s a qu of depth along the view: 1 / (8 depthForOpaque)
    vec3 forward; // of the view
    float eyeDepth; // of the eye below the fog's surface, qu; negative outside
    vec3 eye;
    uint hasSurface;
    vec3 planeNormal;
    float planeDistance;
};

// Push constants of a draw.
struct RasterDraw {
    uint entity;
    uint stage;
    uint pass;  // kPass*
    uint light; // kPassLight: index of the light
    uint fog;   // index of the fog; used if useFog
    uint useFog;
    uint layerStage; // of the first layer over `stage`; the others follow
    uint reserved1;
};

SHARED_END
#endif
