#pragma once
// The denoiser's and the anti-aliasing's shader functions compiled as C++.

#include <glm/glm.hpp>

#include "shaders/shared/constants.h"

namespace q3rt::shader {
namespace { // one copy a test file: the text defines functions

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/denoise.glsl"
#include "lib/projection.glsl"
#include "lib/ray.glsl"
#include "lib/taa.glsl"

} // namespace
} // namespace q3rt::shader
