#pragma once
// The shader functions of stages, compiled as C++ through GLM: what the tests check is the text that the device runs.

#include <cmath>

#include "shared/stage.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace q3rt::glsl {
namespace {
using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
#include "lib/material_affine.glsl"
} // namespace
} // namespace q3rt::glsl

#pragma GCC diagnostic pop
