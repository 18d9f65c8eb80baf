// Scalar block layout of everything that C++ and GLSL share: both sides place members without gaps as long as C++ needs
// none. So padding in any shared structure fails this file's compilation; add a reserved member there.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "math/vector.hpp"
#include "shared/types.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wpadded"
#include "shared/bvh.h"
#include "shared/constants.h"
#include "shared/raster.h"
#include "shared/rt_denoise.h"
#include "shared/rt_exposure.h"
#include "shared/rt_motion.h"
#include "shared/rt_output.h"
#include "shared/rt_report.h"
#include "shared/rt_scene.h"
#include "shared/rt_sums.h"
#include "shared/rt_taa.h"
#include "shared/stage.h"
#include "shared/vertex.h"
#pragma GCC diagnostic pop

namespace q3rt {
namespace {

template <typename... Types>
constexpr bool areTriviallyCopyable() {
    return (std::is_trivially_copyable_v<Types> && ...) && (std::is_standard_layout_v<Types> && ...);
}

TEST(SharedLayout, StructuresCanBeCopiedToTheDevice) {
    EXPECT_TRUE((areTriviallyCopyable<Vertex, StageState, BvhNode, BvhTriangle, BvhInstance, RasterEntity, RasterLight,
                                      RasterFog, RasterDraw, RtInstance, RtSurface, RtEntity, RtTriangleLight, RtLight,
                                      RtNode, RtFog, RtPixel, RtFrame, RtMotion, RtGuide, RtPast, RtDenoise, RtTaa,
                                      RtOutput, RtSums, RtReport, RtExposure>()));
    EXPECT_EQ(alignof(vec2), 4u);
    EXPECT_EQ(alignof(vec3), 4u);
    EXPECT_EQ(alignof(vec4), 4u);
    EXPECT_EQ(alignof(mat4), 4u);
}

} // namespace
} // namespace q3rt
