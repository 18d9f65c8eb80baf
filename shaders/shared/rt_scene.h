// What the ray tracer's shaders read: one text for C++ and GLSL, scalar layout. Tables are reached by device address
// from RtFrame, so that a frame needs one push constant, the texture array and the acceleration structure.
#ifndef Q3RT_SHARED_RT_SCENE_H
#define Q3RT_SHARED_RT_SCENE_H
#include "rt_lights.h"
#include "types.h"
#ifdef __cplusplus
#define SHARED_ADDRESS uint64_t
#define SHARED_UVEC2 glm::uvec2
#else
#define SHARED_ADDRESS uvec2
#define SHARED_UVEC2 uvec2
#endif
SHARED_BEGIN

// Visibility classes, the instance masks. A ray names the classes that it may meet.
SHARED_CONST kMaskSolid = 0x01u;       // opaque and alpha-tested, seen by the eye
SHARED_CONST kMaskLayer = 0x02u;       // blended, seen by the eye
SHARED_CONST kMaskSolidMirror = 0x04u; // the same as secondary rays see them: the own body, not the view weapon
SHARED_CONST kMaskLayerMirror = 0x08u;
SHARED_CONST kMaskShadow = 0x10u; // blocks light
SHARED_CONST kMaskSky = 0x20u;
SHARED_CONST kMaskNearSolid = 0x40u; // depth hack: wins over everything that is not
SHARED_CONST kMaskNearLayer = 0x80u;
SHARED_CONST kMasksOfSolids = kMaskSolid | kMaskSolidMirror | kMaskShadow | kMaskNearSolid;

// Hit groups of the pipeline back end.
SHARED_CONST kHitGroupRecord = 0u; // closest: fill the record; any: the shared accept function
SHARED_CONST kHitGroupLayers = 1u; // any: collect
SHARED_CONST kHitGroupCount = 2u;
SHARED_CONST kMissRecord = 0u;
SHARED_CONST kMissLayers = 1u;

// One instance of the top-level structure; its number is the instance's custom index.
struct RtInstance {
    SHARED_ADDRESS vertices;          // Vertex[]
    SHARED_ADDRESS indices;           // uint[3] a triangle, absolute in `vertices`, in the structure's own order
    SHARED_ADDRESS surfaceOfTriangle; // uint[], relative to firstSurface
    uint firstSurface;
    uint entity;
};

SHARED_CONST kSurfaceTested = 0x1u;   // has alpha-tested stages: the accept function decides
SHARED_CONST kSurfaceCullBack = 0x2u; // back faces don't show (the engine's front-sided)
SHARED_CONST kSurfaceCullFront = 0x4u;
SHARED_CONST kSurfaceSky = 0x8u;
SHARED_CONST kSurfaceFogged = 0x10u; // the fog covers it after its stages; others fade stage by stage
SHARED_CONST kSurfaceWater = 0x20u;  // reflects by Fresnel's law as the boundary of a volume of water
SHARED_CONST kSurfaceGlass = 0x40u;  // the same as a thin pane
SHARED_CONST kSurfaceThin = 0x80u;   // takes light from both sides
SHARED_CONST kSurfacePartly = 0x200u; // a square that holds its texture once; most of it is that one's margin
SHARED_CONST kSurfaceModel = 0x100u; // lit by the light grid in the engine, and never less than kModelLeastLight

// A run of triangles of one material, evaluated for this frame.
struct RtSurface {
    uint firstStage; // in the stage table
    uint stageCount;
    uint flags; // kSurface*
    uint fog;   // 0 none
    uint drawOrder; // among blended and decal surfaces: later drawn is higher, at least 1; 0 for ordinary solids
    uint sky;       // index of RtSky if kSurfaceSky
    uint portal;    // 1 + index of RtPortal; 0: it leads nowhere
    uint cover;     // where one texel tells whether a point is covered: kCover* and the texture; 0: it takes the stages
    uint shown[8];  // if kSurfacePartly: cells of texture coordinates in which it leaves something, a bit each, by rows
};

SHARED_CONST kShownSide = 16u; // cells

SHARED_CONST kCoverTest = 0x3u; // kTest*, never kTestNone
SHARED_CONST kCoverClamped = 0x4u;
SHARED_CONST kCoverTextureShift = 3u;

// A mirror or portal: rows of the affine map from what is in front of it to what is seen in it.
struct RtPortal {
    vec4 rows[3];
};

struct RtEntity {
    vec4 worldFromModel[3]; // rows
    vec3 eyeInModel;        // view origin in model space
    vec3 ambient;           // the engine's entity light, 0..255: what traced light replaces
    vec3 directed;
    vec3 lightDirection; // model space
};

struct RtPlane {
    vec3 normal;
    float distance;
};

struct RtNode {
    RtPlane plane;
    int front; // >= 0 a node; c < 0: cluster -2 - c (so -1 is "outside" as in the map)
    int back;
    SHARED_UVEC2 reserved;
};

struct RtSky {
    uint box[6]; // textures rt lf bk ft up dn
    uint hasBox;
    uint firstStage; // clouds
    uint stageCount;
    float cloudHeightQu;
};

struct RtFog {
    vec3 color;
    float depthForOpaque;
    vec3 normal; // surface plane; depth below it = distance - dot(normal, p)
    float distance;
    uint hasSurface;
};

// RtPixel::lit; 0: nothing here takes light.
SHARED_CONST kLitStraight = 0x1u; // seen along a straight line
SHARED_CONST kLitTurned = 0x2u;   // seen in a mirror or portal
SHARED_CONST kLitThin = 0x4u;     // kSurfaceThin
SHARED_CONST kLitModel = 0x8u;    // kSurfaceModel

// What the primary stage leaves for the others; one a pixel, row by row.
// In rows of 16 bytes, which a GPU moves at once; what the composite reads is one of its sectors of 32 bytes.
struct RtPixel {
    vec3 position; // of the lit layer
    uint lit;      // kLit*
    vec3 error;    // of position, see lib/offset.glsl
    uint keyPixel; // of the direct stage's random numbers: x | y << 16
    vec3 normal;   // unit, shading, on the eye's side
    uint keyFrame;
    vec3 geometricNormal; // unit, on the eye's side
    uint instance; // of the lit layer: with the next two its place on the surface, whatever becomes of that
    vec3 albedo;   // A, times what the layers in front let through
    uint triangle;
    vec3 emission;    // B of all layers
    uint barycentric; // packUnorm2x16(), of corners 1 and 2
};

SHARED_CONST kFrameNearEntities = 0x1u;
SHARED_CONST kFrameLayers = 0x2u;
SHARED_CONST kFrameIllumination = 0x4u;
SHARED_CONST kFrameSoftShadows = 0x8u;
SHARED_CONST kFrameGrid = 0x10u;
SHARED_CONST kFrameSkySurfaces = 0x20u;
SHARED_CONST kFrameAntialiasing = 0x40u;
SHARED_CONST kFrameSharedJitter = 0x80u; // all rays at RtFrame::jitter of their pixels
SHARED_CONST kFrameClampLight = 0x100u;  // the picture shows light as the engine shows a lightmap: at most 1, hue kept
SHARED_CONST kFrameHistory = 0x200u;     // guides and pasts are wanted
SHARED_CONST kFrameKeepRadiance = 0x400u; // the composite's radiance is wanted
SHARED_CONST kFrameLinear = 0x800u;       // colours are decoded to light
SHARED_CONST kFrameBlueNoise = 0x1000u;   // rt_blueNoise
SHARED_CONST kFrameLens = 0x2000u;        // the eye has a lens of some size
SHARED_CONST kFrameRefraction = 0x4000u;  // rt_refraction
SHARED_CONST kFrameCountWork = 0x10000u;  // into RtReport::work
SHARED_CONST kFrameCountRays = 0x20000u;  // into RtReport::rays

struct RtFrame {
    SHARED_ADDRESS instances;
    SHARED_ADDRESS surfaces;
    SHARED_ADDRESS entities;
    SHARED_ADDRESS stages;
    SHARED_ADDRESS triangleLights;
    SHARED_ADDRESS pointLights; // RtLight[]: those that stay; numbered on after the triangle lights
    SHARED_ADDRESS lightRows;
    SHARED_ADDRESS lightEntries;
    SHARED_ADDRESS lightColors; // vec3[]: what animated lights are multiplied by in this frame
    SHARED_ADDRESS lights; // RtLight[]: suns and the frame's dynamic lights, in no row
    SHARED_ADDRESS nodes;
    SHARED_ADDRESS nodeStarts; // int[], by cell of a grid: where the search among nodes begins
    SHARED_ADDRESS grid; // uvec4[]: two rows a cell, as surfaces and as models take it (lib/grid_cell.glsl)
    SHARED_ADDRESS skies;
    SHARED_ADDRESS fogs;
    SHARED_ADDRESS noise; // RtNoise[]: kBlueNoiseSide rows
    SHARED_ADDRESS portals;
    SHARED_ADDRESS treeNodes;     // back end `compute`: scene tree over the instances
    SHARED_ADDRESS treeInstances; // in its leaf order
    SHARED_ADDRESS motionToPrevious; // RtMotion[], by instance of this frame
    SHARED_ADDRESS guides;           // RtGuide[]
    SHARED_ADDRESS pasts;            // RtPast[]
    SHARED_ADDRESS looks; // RtLook[]
    SHARED_ADDRESS pixels;
    SHARED_ADDRESS shadowRays;  // RtShadowRay[]
    SHARED_ADDRESS shadowBins;  // uint[], one a pixel: the ray's place among lights, kNoShadowRay
    SHARED_ADDRESS shadowOrder; // uint[]: kShadowTilePixels a tile: numbers of its pixels with a ray, by light
    SHARED_ADDRESS irradiance; // vec4[]: traced L (1.0 = irradiance 63.75), one a pixel
    SHARED_ADDRESS ambientL;   // vec4[]: L of the light grid, without noise
    SHARED_ADDRESS lighting;   // vec4[]: traced L that the picture shows: `irradiance`, or what a denoiser made of it
    SHARED_ADDRESS radiance;   // vec4[], one a pixel: of the frame, or the mean of all samples so far
    SHARED_ADDRESS picture;    // vec4[]: what is shown of it, exposed
    SHARED_ADDRESS sums;       // RtSums[]: of plain samples
    SHARED_ADDRESS reference;  // vec4[]: what is shown of their means, exposed
    SHARED_ADDRESS autoExposure; // RtExposure; 0: there is none
    SHARED_ADDRESS report;       // RtReport
    vec3 eye;
    uint flags; // kFrame*
    vec3 forward;
    float farQu; // longer than any line inside the map
    vec3 left;   // scaled by the tangent of half the horizontal field of view
    vec3 up; // scaled, vertical
    vec2 lens; // its radius in lengths of `left` and `up`; 0: the eye is a point
    vec2 lensTurn; // the same over the distance along forwardUnit that is sharp
    uint seed;
    SHARED_UVEC2 size; // pixels
    uint sampleNumber; // of this view: 0 starts a new mean
    uint frame; // of random numbers
    uint triangleLightCount;
    uint pointLightCount;
    uint lightCount; // in no row
    uint clusterCount;
    uint lightsPerPixel; // rt_numRandomDL; 0: all
    uint candidatesPerChoice;
    float ambient; // rt_ambient
    uint layerOrderCount; // highest drawOrder of the frame
    vec3 nodeStartOrigin;
    float nodeStartCellQu;
    ivec3 nodeStartCounts; // 0: there are none
    vec3 gridOrigin;
    vec3 gridCellSize;
    uint skyCount;
    ivec3 gridCounts;
    uint cullLights; // rt_cullLights
    uint reflectionDepth; // rt_reflectionDepth: mirrors, portals and reflections one after the other
    vec3 forwardUnit;
    vec3 previousEye;
    vec2 jitter; // in a pixel, [0, 1)
    vec4 nearArea; // pixels: what is in the near depth range shows from .xy to .zw
    float footprint; // what texture detail is chosen for, pixels: less than 1 where the result has more pixels
    float exposure;  // factor, rt_exposure
    float lightScale; // factor of L, r_mapOverBrightBits
    float leastLight; // rt_minLight: L is shown as at least this
    uint curve;       // kCurve*
    float curveWhite; // radiance that the curve shows as full white
    float inverseError; // of the back end's transform of rays into instances, see lib/offset.glsl
    uint reserved;
};

struct RtPush {
    SHARED_ADDRESS frame;
};

SHARED_END
#endif
