/* The structs that cross the renderer boundary of ioquake3 (API version 8), in the engine's own layout and spelling.
 * C99 and C++. Sizes and offsets are listed in layout.def.h and asserted by layout_checks.cpp and by tests/abi. */
#ifndef Q3RT_ABI_REF_TYPES_H
#define Q3RT_ABI_REF_TYPES_H

#include <stdint.h>

/* Four bytes, 0 or 1: never a C++ bool, the engine reads all four. */
typedef int32_t qboolean;
typedef int32_t qhandle_t;
typedef uint8_t byte;
typedef float vec3_t[3];

enum {
    REF_API_VERSION = 8,
    Q3_MAX_QPATH = 64,
    Q3_MAX_AREA_BYTES = 32,
    Q3_TEXT_COUNT = 8,
    Q3_TEXT_LENGTH = 32,
    Q3_GLYPH_COUNT = 256
};

/* refEntity_t.reType */
typedef enum {
    RT_MODEL,
    RT_POLY,
    RT_SPRITE,
    RT_BEAM,
    RT_RAIL_CORE,
    RT_RAIL_RINGS,
    RT_LIGHTNING,
    RT_PORTALSURFACE,
    RT_MAX_REF_ENTITY_TYPE
} refEntityType_t;

typedef struct {
    int32_t reType; /* refEntityType_t; an int because the game may hand over any value */
    int32_t renderfx;
    qhandle_t hModel;
    vec3_t lightingOrigin; /* used with the lighting-origin flag */
    float shadowPlane;
    vec3_t axis[3];
    qboolean nonNormalizedAxes; /* axes carry a scale */
    vec3_t origin;
    int32_t frame;
    vec3_t oldorigin; /* second point of beams and portals */
    int32_t oldframe;
    float backlerp; /* weight of oldframe: 0 is wholly frame, 1 wholly oldframe */
    int32_t skinNum;
    qhandle_t customSkin;
    qhandle_t customShader;
    byte shaderRGBA[4];
    float shaderTexCoord[2];
    float shaderTime; /* seconds, subtracted from the view's time */
    float radius;     /* qu, sprites */
    float rotation;   /* degrees, sprites */
} refEntity_t;

typedef struct {
    vec3_t xyz;
    float st[2];
    byte modulate[4];
} polyVert_t;

typedef struct {
    int32_t x, y, width, height; /* pixels, origin top left */
    float fov_x, fov_y;          /* degrees */
    vec3_t vieworg;
    vec3_t viewaxis[3]; /* forward, left, up */
    int32_t time;       /* ms */
    int32_t rdflags;
    byte areamask[Q3_MAX_AREA_BYTES]; /* a set bit hides that area */
    char text[Q3_TEXT_COUNT][Q3_TEXT_LENGTH];
} refdef_t;

typedef struct {
    char renderer_string[1024];
    char vendor_string[1024];
    char version_string[1024];
    char extensions_string[8192];
    int32_t maxTextureSize;
    int32_t numTextureUnits;
    int32_t colorBits, depthBits, stencilBits;
    int32_t driverType;   /* 0: installable client driver */
    int32_t hardwareType; /* 0: generic */
    qboolean deviceSupportsGamma;
    int32_t textureCompression;
    qboolean textureEnvAddAvailable;
    int32_t vidWidth, vidHeight; /* pixels */
    float windowAspect;
    int32_t displayFrequency; /* Hz, 0 unknown */
    qboolean isFullscreen;
    qboolean stereoEnabled;
    qboolean smpActive;
} glconfig_t;

typedef struct {
    int32_t firstPoint;
    int32_t numPoints;
} markFragment_t;

typedef struct {
    vec3_t origin;
    vec3_t axis[3];
} orientation_t;

typedef struct {
    int32_t height, top, bottom, pitch, xSkip;
    int32_t imageWidth, imageHeight;
    float s, t, s2, t2;
    qhandle_t glyph;
    char shaderName[32];
} glyphInfo_t;

typedef struct {
    glyphInfo_t glyphs[Q3_GLYPH_COUNT];
    float glyphScale;
    char name[Q3_MAX_QPATH];
} fontInfo_t;

/* Owned by the engine and changed by it at any time; a renderer writes nothing but `modified`. */
typedef struct cvar_s {
    char* name;
    char* string;
    char* resetString;
    char* latchedString;
    int32_t flags;
    qboolean modified;
    int32_t modificationCount;
    float value;
    int32_t integer;
    qboolean validate;
    qboolean integral;
    float min, max;
    char* description;
    struct cvar_s* next;
    struct cvar_s* prev;
    struct cvar_s* hashNext;
    struct cvar_s* hashPrev;
    int32_t hashIndex;
} cvar_t;

#endif
