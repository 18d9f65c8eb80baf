// Resampling, shrinking, light scale and mip chain.
#include "scene/texture_upload.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace q3rt {
namespace {

constexpr int kMaxResampledWidth = 2048;

int toPowerOfTwo(int size, bool roundDown) {
    const int above = static_cast<int>(std::bit_ceil(static_cast<unsigned>(size)));
    return roundDown && above > size ? above >> 1 : above;
}

void applyLightScale(MipLevel& level, bool mipmapped, const TextureSettings& settings) {
    const std::array<uint8_t, 256> gamma = buildGammaTable(settings.gamma, settings.overbrightBits);
    const float intensity = std::max(1.0f, settings.intensity);
    std::array<uint8_t, 256> table;
    bool identity = true;
    for (int i = 0; i < 256; ++i) {
        int value = mipmapped ? std::min(255, static_cast<int>(static_cast<float>(i) * intensity)) : i;
        if (settings.softwareGamma) value = gamma[static_cast<size_t>(value)];
        table[static_cast<size_t>(i)] = static_cast<uint8_t>(value);
        identity = identity && value == i;
    }
    if (identity) return;
    for (size_t i = 0; i + 3 < level.rgba.size(); i += 4)
        for (size_t k = 0; k < 3; ++k)
            level.rgba[i + k] = table[level.rgba[i + k]];
}

void tintLevel(MipLevel& level, size_t number) {
    const size_t channel = (number - 1) % 3;
    for (size_t i = 0; i + 3 < level.rgba.size(); i += 4)
        for (size_t k = 0; k < 3; ++k) {
            const int tint = k == channel ? 255 : 0;
            level.rgba[i + k] = static_cast<uint8_t>((level.rgba[i + k] * 127 + tint * 128) >> 9);
        }
}

MipLevel halveByKernel(const MipLevel& source) {
    constexpr int kWeight[4] = {1, 2, 2, 1};
    MipLevel result{std::max(1, source.width / 2), std::max(1, source.height / 2), {}};
    result.rgba.resize(static_cast<size_t>(result.width) * static_cast<size_t>(result.height) * 4);
    if (source.width == 1 || source.height == 1) {
        std::copy_n(source.rgba.begin(), result.rgba.size(), result.rgba.begin());
        return result;
    }
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x)
            for (int k = 0; k < 4; ++k) {
                int sum = 0;
                for (int dy = 0; dy < 4; ++dy)
                    for (int dx = 0; dx < 4; ++dx) {
                        const int sx = (2 * x + dx - 1) & (source.width - 1);
                        const int sy = (2 * y + dy - 1) & (source.height - 1);
                        sum += kWeight[dx] * kWeight[dy] *
                               source.rgba[static_cast<size_t>((sy * source.width + sx) * 4 + k)];
                    }
                result.rgba[static_cast<size_t>((y * result.width + x) * 4 + k)] = static_cast<uint8_t>(sum / 36);
            }
    return result;
}

} // namespace

MipLevel resampleImage(const MipLevel& source, int width, int height) {
    MipLevel result{width, height, {}};
    result.rgba.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    const unsigned step = static_cast<unsigned>(65536.0 * source.width / width);
    const unsigned quarter = step >> 2;
    std::vector<size_t> first(static_cast<size_t>(width)), second(static_cast<size_t>(width));
    for (size_t j = 0; j < first.size(); ++j) {
        first[j] = 4 * ((quarter + j * step) >> 16);
        second[j] = 4 * ((3 * quarter + j * step) >> 16);
    }
    for (int i = 0; i < height; ++i) {
        const auto rowAt = [&](double offset) {
            const auto row = static_cast<size_t>((i + offset) * source.height / height);
            return source.rgba.data() + row * static_cast<size_t>(source.width) * 4;
        };
        const uint8_t *upper = rowAt(0.25), *lower = rowAt(0.75);
        uint8_t* out = result.rgba.data() + static_cast<size_t>(i) * static_cast<size_t>(width) * 4;
        for (size_t j = 0; j < first.size(); ++j, out += 4)
            for (size_t k = 0; k < 4; ++k)
                out[k] = static_cast<uint8_t>(
                    (upper[first[j] + k] + upper[second[j] + k] + lower[first[j] + k] + lower[second[j] + k]) >> 2);
    }
    return result;
}

MipLevel halveImage(const MipLevel& source, bool simple) {
    if (!simple) return halveByKernel(source);
    MipLevel result{std::max(1, source.width / 2), std::max(1, source.height / 2), {}};
    result.rgba.resize(static_cast<size_t>(result.width) * static_cast<size_t>(result.height) * 4);
    if (source.width == 1 && source.height == 1) {
        result.rgba = source.rgba;
        return result;
    }
    uint8_t* out = result.rgba.data();
    if (source.width == 1 || source.height == 1) {
        for (size_t i = 0; i < result.rgba.size() / 4; ++i)
            for (size_t k = 0; k < 4; ++k)
                *out++ = static_cast<uint8_t>((source.rgba[8 * i + k] + source.rgba[8 * i + 4 + k]) >> 1);
        return result;
    }
    const size_t row = static_cast<size_t>(source.width) * 4;
    for (int y = 0; y < result.height; ++y) {
        const uint8_t* in = source.rgba.data() + static_cast<size_t>(2 * y) * row;
        for (int x = 0; x < result.width; ++x, in += 8, out += 4)
            for (size_t k = 0; k < 4; ++k)
                out[k] = static_cast<uint8_t>((in[k] + in[4 + k] + in[row + k] + in[row + 4 + k]) >> 2);
    }
    return result;
}

void convertToGrey(MipLevel& level, float amount) {
    for (size_t i = 0; i + 3 < level.rgba.size(); i += 4) {
        uint8_t* c = &level.rgba[i];
        const float luma = std::trunc(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]);
        for (int k = 0; k < 3; ++k)
            c[k] = static_cast<uint8_t>(c[k] + (luma - c[k]) * amount);
    }
}

std::array<uint8_t, 256> buildGammaTable(float gamma, int overbrightBits) {
    gamma = std::clamp(gamma, 0.5f, 3.0f);
    std::array<uint8_t, 256> table;
    for (int i = 0; i < 256; ++i) {
        const int value = gamma == 1.0f ? i : static_cast<int>(255.0 * std::pow(i / 255.0, 1.0 / gamma) + 0.5);
        table[static_cast<size_t>(i)] = static_cast<uint8_t>(std::clamp(value << overbrightBits, 0, 255));
    }
    return table;
}

std::vector<MipLevel> buildTextureLevels(MipLevel image, TextureFlags flags, const TextureSettings& settings) {
    const int fullWidth = std::min(toPowerOfTwo(image.width, settings.roundImagesDown), kMaxResampledWidth);
    const int fullHeight = toPowerOfTwo(image.height, settings.roundImagesDown);
    if (fullWidth != image.width || fullHeight != image.height) image = resampleImage(image, fullWidth, fullHeight);
    int width = fullWidth, height = fullHeight;
    if (flags.picmip) {
        width = std::max(1, width >> settings.picmip);
        height = std::max(1, height >> settings.picmip);
    }
    while (width > settings.maxSize || height > settings.maxSize) {
        width = std::max(1, width >> 1);
        height = std::max(1, height >> 1);
    }
    if (settings.greyscale > 0) convertToGrey(image, std::min(1.0f, settings.greyscale));

    std::vector<MipLevel> levels;
    const bool shrunk = width != fullWidth || height != fullHeight;
    while (image.width > width || image.height > height)
        image = halveImage(image, settings.simpleMipMaps);
    if (shrunk || flags.mipmap) applyLightScale(image, flags.mipmap, settings);
    levels.push_back(std::move(image));
    while (flags.mipmap && (levels.back().width > 1 || levels.back().height > 1))
        levels.push_back(halveImage(levels.back(), settings.simpleMipMaps));
    if (settings.colorMipLevels)
        for (size_t n = 1; n < levels.size(); ++n)
            tintLevel(levels[n], n);
    return levels;
}

U8vec4 intensityColor(const uint8_t* rgb) {
    constexpr float kValue = 0.5f, kSextants = 5;
    const float intensity = std::min(1.0f, (0.33f * rgb[0] + 0.685f * rgb[1] + 0.063f * rgb[2]) / 255.0f);
    const float hue = intensity * kSextants, sextant = std::floor(hue);
    const float falling = kValue * (1 - (hue - sextant)), rising = kValue * (hue - sextant);
    const vec3 colors[6] = {{kValue, rising, 0},  {falling, kValue, 0}, {0, kValue, rising},
                            {0, falling, kValue}, {rising, 0, kValue},  {kValue, 0, falling}};
    return {U8vec4(vec4(colors[static_cast<int>(sextant)] * 255.0f, 255.0f))};
}

vec4 averageColor(const MipLevel& level) {
    uint64_t sum[4] = {0, 0, 0, 0};
    for (size_t i = 0; i + 3 < level.rgba.size(); i += 4)
        for (size_t k = 0; k < 4; ++k)
            sum[k] += level.rgba[i + k];
    const double scale = 255.0 * std::max<size_t>(1, level.rgba.size() / 4);
    vec4 mean;
    for (int k = 0; k < 4; ++k)
        mean[k] = static_cast<float>(double(sum[k]) / scale);
    return mean;
}

} // namespace q3rt
