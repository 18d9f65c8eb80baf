// Scalar block layout of everything that C++ and GLSL share: a change on one side fails here.
#include <cstddef>

#include "shaders/shared/stage.h"
#include "shaders/shared/vertex.h"

namespace q3rt {

static_assert(sizeof(vec2) == 8 && alignof(vec2) == 4);
static_assert(sizeof(vec3) == 12 && alignof(vec3) == 4);
static_assert(sizeof(vec4) == 16 && alignof(vec4) == 4);

static_assert(sizeof(Vertex) == 48);
static_assert(offsetof(Vertex, normal) == 12 && offsetof(Vertex, st) == 24 && offsetof(Vertex, lightmapSt) == 32);
static_assert(offsetof(Vertex, color) == 40 && offsetof(Vertex, reserved) == 44);

static_assert(sizeof(TexModState) == 32);
static_assert(offsetof(TexModState, translate) == 16 && offsetof(TexModState, kind) == 24);

static_assert(sizeof(TextureUnitState) == 176);
static_assert(offsetof(TextureUnitState, vectorS) == 128 && offsetof(TextureUnitState, texture) == 140);
static_assert(offsetof(TextureUnitState, vectorT) == 144 && offsetof(TextureUnitState, coord) == 156);
static_assert(offsetof(TextureUnitState, modCount) == 160 && offsetof(TextureUnitState, isLightmap) == 164);
static_assert(offsetof(TextureUnitState, clamped) == 168 && offsetof(TextureUnitState, reserved) == 172);

static_assert(sizeof(StageState) == 416);
static_assert(offsetof(StageState, color) == 352 && offsetof(StageState, rgbGen) == 368);
static_assert(offsetof(StageState, alphaGen) == 372 && offsetof(StageState, combine) == 376);
static_assert(offsetof(StageState, bakedLight) == 380 && offsetof(StageState, sourceBlend) == 384);
static_assert(offsetof(StageState, destinationBlend) == 388 && offsetof(StageState, blended) == 392);
static_assert(offsetof(StageState, alphaTest) == 396 && offsetof(StageState, fogFade) == 400);
static_assert(offsetof(StageState, portalRange) == 404 && offsetof(StageState, depthEqual) == 408);

} // namespace q3rt
