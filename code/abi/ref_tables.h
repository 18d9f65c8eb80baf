/* The two function tables exchanged by GetRefAPI (API version 8 of ioquake3): what the engine calls, and what it
 * offers. C99 and C++. The argument table given to GetRefAPI lies on the engine's stack: copy it. */
#ifndef Q3RT_ABI_REF_TABLES_H
#define Q3RT_ABI_REF_TABLES_H

#include "ref_types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    void (*Shutdown)(qboolean destroyWindow);
    void (*BeginRegistration)(glconfig_t* config);
    qhandle_t (*RegisterModel)(const char* name);
    qhandle_t (*RegisterSkin)(const char* name);
    qhandle_t (*RegisterShader)(const char* name);
    qhandle_t (*RegisterShaderNoMip)(const char* name);
    void (*LoadWorld)(const char* name);
    void (*SetWorldVisData)(const byte* vis);
    void (*EndRegistration)(void);
    void (*ClearScene)(void);
    void (*AddRefEntityToScene)(const refEntity_t* entity);
    void (*AddPolyToScene)(qhandle_t shader, int vertexCount, const polyVert_t* vertices, int polyCount);
    int (*LightForPoint)(vec3_t point, vec3_t ambient, vec3_t directed, vec3_t direction);
    void (*AddLightToScene)(const vec3_t origin, float radius, float r, float g, float b);
    void (*AddAdditiveLightToScene)(const vec3_t origin, float radius, float r, float g, float b);
    void (*RenderScene)(const refdef_t* view);
    void (*SetColor)(const float* rgba);
    void (*DrawStretchPic)(float x, float y, float w, float h, float s1, float t1, float s2, float t2,
                           qhandle_t shader);
    void (*DrawStretchRaw)(int x, int y, int w, int h, int columns, int rows, const byte* rgba, int client,
                           qboolean dirty);
    void (*UploadCinematic)(int w, int h, int columns, int rows, const byte* rgba, int client, qboolean dirty);
    void (*BeginFrame)(int stereoFrame);
    void (*EndFrame)(int* frontMs, int* backMs);
    int (*MarkFragments)(int pointCount, const vec3_t* points, const vec3_t projection, int maxPoints, vec3_t outPoints,
                         int maxFragments, markFragment_t* outFragments);
    int (*LerpTag)(orientation_t* out, qhandle_t model, int startFrame, int endFrame, float fraction, const char* tag);
    void (*ModelBounds)(qhandle_t model, vec3_t mins, vec3_t maxs);
    void (*RegisterFont)(const char* name, int pointSize, fontInfo_t* font);
    void (*RemapShader)(const char* from, const char* to, const char* timeOffset);
    qboolean (*GetEntityToken)(char* buffer, int size);
    qboolean (*inPVS)(const vec3_t a, const vec3_t b);
    void (*TakeVideoFrame)(int width, int height, byte* capture, byte* encode, qboolean motionJpeg);
} refexport_t;

/* refimport_t.Error codes that a renderer raises: FATAL ends the program, DROP ends the game and shows the menu. */
enum { Q3_ERR_FATAL = 0, Q3_ERR_DROP = 1 };
/* refimport_t.Printf levels */
enum { Q3_PRINT_ALL = 0, Q3_PRINT_DEVELOPER = 1, Q3_PRINT_WARNING = 2, Q3_PRINT_ERROR = 3 };
/* refimport_t.Cmd_ExecuteText: now, before, or after what the command buffer holds */
enum { Q3_EXEC_NOW = 0, Q3_EXEC_INSERT = 1, Q3_EXEC_APPEND = 2 };

typedef struct {
    void (*Printf)(int level, const char* format, ...);
    void (*Error)(int code, const char* format, ...); /* does not return */
    int (*Milliseconds)(void);
    void* (*Hunk_Alloc)(int size, int preference);
    void* (*Hunk_AllocateTempMemory)(int size);
    void (*Hunk_FreeTempMemory)(void* memory);
    void* (*Malloc)(int size);
    void (*Free)(void* memory);
    cvar_t* (*Cvar_Get)(const char* name, const char* value, int flags);
    void (*Cvar_Set)(const char* name, const char* value);
    void (*Cvar_SetValue)(const char* name, float value);
    void (*Cvar_CheckRange)(cvar_t* cvar, float minimum, float maximum, qboolean integral);
    void (*Cvar_SetDescription)(cvar_t* cvar, const char* description);
    int (*Cvar_VariableIntegerValue)(const char* name);
    void (*Cmd_AddCommand)(const char* name, void (*command)(void));
    void (*Cmd_RemoveCommand)(const char* name);
    int (*Cmd_Argc)(void);
    char* (*Cmd_Argv)(int index);
    void (*Cmd_ExecuteText)(int when, const char* text);
    byte* (*CM_ClusterPVS)(int cluster);
    void (*CM_DrawDebugSurface)(void (*drawPoly)(int color, int pointCount, float* points));
    int (*FS_FileIsInPAK)(const char* name, int* checksum);
    long (*FS_ReadFile)(const char* name, void** buffer);
    void (*FS_FreeFile)(void* buffer);
    char** (*FS_ListFiles)(const char* directory, const char* extension, int* count);
    void (*FS_FreeFileList)(char** list);
    void (*FS_WriteFile)(const char* name, const void* bytes, int size);
    qboolean (*FS_FileExists)(const char* name);
    void (*CIN_UploadCinematic)(int handle);
    int (*CIN_PlayCinematic)(const char* name, int x, int y, int w, int h, int bits);
    int (*CIN_RunCinematic)(int handle);
    void (*CL_WriteAVIVideoFrame)(const byte* bytes, int size);
    void (*IN_Init)(void* sdlWindow);
    void (*IN_Shutdown)(void);
    void (*IN_Restart)(void);
    long (*ftol)(float value);
    void (*Sys_SetEnv)(const char* name, const char* value);
    void (*Sys_GLimpSafeInit)(void);
    void (*Sys_GLimpInit)(void);
    qboolean (*Sys_LowPhysicalMemory)(void);
} refimport_t;

/* The one symbol that a renderer module exports. NULL: that version isn't served. */
typedef refexport_t* (*GetRefAPI_t)(int apiVersion, refimport_t* imports);

#ifdef __cplusplus
}
#endif

#endif
