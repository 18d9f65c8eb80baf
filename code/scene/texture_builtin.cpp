// Pixels of the built-in textures (spec of materials, section 4.6).
#include <algorithm>
#include <cmath>

#include "scene/texture_upload.hpp"

namespace q3rt {

MipLevel makeSolidImage(int size, U8vec4 color) {
    MipLevel level{size, size, {}};
    for (int i = 0; i < size * size; ++i)
        level.rgba.insert(level.rgba.end(), {color.r, color.g, color.b, color.a});
    return level;
}

MipLevel makeDefaultImage() {
    constexpr int kSize = 16;
    MipLevel level{kSize, kSize, {}};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const bool border = x == 0 || y == 0 || x == kSize - 1 || y == kSize - 1;
            level.rgba.insert(level.rgba.end(), 4, border ? uint8_t{255} : uint8_t{32});
        }
    return level;
}

MipLevel makeDlightImage() {
    constexpr int kSize = 16;
    constexpr float kCentre = 7.5f;
    MipLevel level{kSize, kSize, {}};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const float dx = kCentre - static_cast<float>(x), dy = kCentre - static_cast<float>(y);
            const int fallOff = static_cast<int>(4000.0f / (dx * dx + dy * dy));
            const auto value = static_cast<uint8_t>(fallOff < 75 ? 0 : std::min(255, fallOff));
            level.rgba.insert(level.rgba.end(), {value, value, value, 255});
        }
    return level;
}

float fogDensity(float s, float t) {
    s -= 1.0f / 512.0f;
    if (s < 0 || t < 1.0f / 32.0f) return 0;
    if (t < 31.0f / 32.0f) s *= (t - 1.0f / 32.0f) / (30.0f / 32.0f);
    s = std::min(1.0f, s * 8.0f);
    return std::sqrt(std::trunc(s * 255.0f) / 255.0f);
}

MipLevel makeFogImage() {
    constexpr int kWidth = 256, kHeight = 32;
    MipLevel level{kWidth, kHeight, {}};
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float density =
                fogDensity((static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight);
            level.rgba.insert(level.rgba.end(), {255, 255, 255, static_cast<uint8_t>(255.0f * density)});
        }
    return level;
}

} // namespace q3rt
