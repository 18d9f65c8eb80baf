#pragma once
// The pixel work between a decoded image and a texture: resampling, shrinking, light scale, mip chain. Exact to the
// texel (behaviour: spec of materials, sections 4.2 and 4.3). Pure functions; safe on any thread.

#include <array>
#include <vector>

#include "scene/texture.hpp"

namespace q3rt {

/// Width and height to a power of two by four point samples a texel (fixed-point columns, float rows).
MipLevel resampleImage(const MipLevel& source, int width, int height);
/// The next smaller level: 2x2 mean, or the 4x4 kernel if not `simple`. Truncating integer arithmetic.
MipLevel halveImage(const MipLevel& source, bool simple);
/// All levels as they are uploaded; one level if not mip-mapped.
std::vector<MipLevel> buildTextureLevels(MipLevel image, TextureFlags flags, const TextureSettings& settings);
/// Colours toward their luma by `amount`: r_greyscale.
void convertToGrey(MipLevel& level, float amount);
/// The gamma table of a device without hardware gamma.
std::array<uint8_t, 256> buildGammaTable(float gamma, int overbrightBits);
/// Mean of the texels, [0, 1].
vec4 averageColor(const MipLevel& level);

/// Intensity of raw lightmap bytes as a hue from red over green and blue, saturation 1, value 0.5 (r_lightmap 2).
U8vec4 intensityColor(const uint8_t* rgb);

/// Pixels of the built-in textures.
MipLevel makeDefaultImage();
MipLevel makeSolidImage(int size, U8vec4 color);
MipLevel makeDlightImage();
MipLevel makeFogImage();
/// Fog density at fog coordinates (spec of world 6.3); 256 steps.
float fogDensity(float s, float t);

} // namespace q3rt
