#pragma once
// The denoiser's and the anti-aliasing's shader functions compiled as C++.

#include <glm/glm.hpp>

#include "shaders/shared/constants.h"
#include "shaders/shared/rt_exposure.h"
#include "shaders/shared/rt_output.h"

namespace q3rt::shader {
namespace { // one copy a test file: the text defines functions

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

// The shaders' word for operations that must not be rearranged; this code is compiled so anyway.
#define precise
#include "lib/denoise.glsl"
#include "lib/exposure.glsl"
#include "lib/projection.glsl"
#include "lib/ray.glsl"
#include "lib/report.glsl"
#include "lib/sums.glsl"
#include "lib/taa.glsl"
#include "lib/tonemap.glsl"
#undef precise

} // namespace
} // namespace q3rt::shader
