#pragma once
// Can a pixel of a picture show what lies in a box, or between points?

#include <algorithm>
#include <cmath>

#include "math/vector.hpp"

namespace q3rt {

/// Where things are drawn. No size: nothing is judged by it.
struct PictureOfView {
    mat4 clipFromWorld{1.0f};
    mat4 clipFromWorldHeld{1.0f}; ///< of what is held before the eye (entityFlag::kDepthHack)
    vec2 sizePx{0};
};

/// False only if no pixel's middle lies where what these points span is drawn: it is outside the picture, or so small
/// or far away that it falls between them. `pointAt(i)` is a point, `clipFromModel` takes it to Vulkan's clip space.
template <typename PointAt>
bool hullShows(const mat4& clipFromModel, const vec2& sizePx, size_t count, const PointAt& pointAt) {
    constexpr float kLeastW = 1.0f;          // qu: what reaches nearer is not judged
    constexpr float kSlackPx = 1.0f / 32.0f; // the driver's grid of 1/256, and rounding
    vec2 least(sizePx), greatest(-1.0f);
    for (size_t i = 0; i < count; ++i) {
        const vec4 clip = clipFromModel * vec4(vec3(pointAt(i)), 1.0f);
        if (!(clip.w > kLeastW)) return true;
        const vec2 px = (vec2(clip) / clip.w + 1.0f) * (0.5f * sizePx);
        least = glm::min(least, px);
        greatest = glm::max(greatest, px);
    }
    const vec2 first = glm::max(glm::ceil(least - kSlackPx - 0.5f), vec2(0.0f));
    const vec2 last = glm::min(glm::floor(greatest + kSlackPx - 0.5f), sizePx - 1.0f);
    return first.x <= last.x && first.y <= last.y;
}

inline bool boxShows(const mat4& clipFromModel, const vec2& sizePx, const Bounds& box) {
    return hullShows(clipFromModel, sizePx, 8, [&](size_t i) {
        return vec3(i & 1 ? box.maxs.x : box.mins.x, i & 2 ? box.maxs.y : box.mins.y, i & 4 ? box.maxs.z : box.mins.z);
    });
}

} // namespace q3rt
