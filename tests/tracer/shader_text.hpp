#pragma once
// The shader library compiled as C++: the tests run the very text that the GPU runs.

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "shaders/shared/constants.h"
#include "shaders/shared/rt_scene.h"

namespace q3rt::shader {
namespace { // one copy a test file: the text defines functions

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/light.glsl"
#include "lib/offset.glsl"
#include "lib/random.glsl"
#include "lib/ray.glsl"

} // namespace
} // namespace q3rt::shader
