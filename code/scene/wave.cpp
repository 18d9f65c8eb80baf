// Wave tables and lattice noise (behaviour: spec of materials, sections 2.5 and 2.6).
#include "scene/wave.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

namespace q3rt {
namespace {

constexpr int kTableSize = 1024;
constexpr int kNoiseSize = 256;

struct SineTable {
    std::array<float, kTableSize> value;
    SineTable() {
        // The original divides the circle by 1023, not by 1024: content is timed by it.
        for (int i = 0; i < kTableSize; ++i)
            value[static_cast<size_t>(i)] = static_cast<float>(std::sin(2.0 * std::numbers::pi * i / (kTableSize - 1)));
    }
};

const SineTable& sineTableInstance() {
    static const SineTable table;
    return table;
}

struct NoiseTables {
    std::array<float, kNoiseSize> value;
    std::array<uint8_t, kNoiseSize> permutation;
    /// Until the engine's generator is asked for, a fixed sequence: the same frame on every run.
    NoiseTables() {
        std::mt19937 generator(1);
        for (size_t i = 0; i < kNoiseSize; ++i) {
            value[i] = static_cast<float>(generator() / 4294967295.0 * 2.0 - 1.0);
            permutation[i] = static_cast<uint8_t>(generator() >> 24);
        }
    }
};

NoiseTables& noiseTables() {
    static NoiseTables tables;
    return tables;
}

float noiseAt(const NoiseTables& tables, int64_t x, int64_t y, int64_t z, int64_t t) {
    auto permute = [&](int64_t i) { return static_cast<int64_t>(tables.permutation[static_cast<size_t>(i & 255)]); };
    return tables.value[static_cast<size_t>(permute(x + permute(y + permute(z + permute(t)))))];
}

} // namespace

float sineTable(int i) { return sineTableInstance().value[static_cast<size_t>(i & (kTableSize - 1))]; }

double waveTable(WaveFunction function, int i) {
    constexpr int kQuarter = kTableSize / 4, kHalf = kTableSize / 2;
    i &= kTableSize - 1;
    switch (function) {
    case WaveFunction::Square:
        return i < kHalf ? 1.0 : -1.0;
    case WaveFunction::Triangle: {
        const int half = i & (kHalf - 1);
        const double rise = half < kQuarter ? half / double(kQuarter) : 1.0 - (half - kQuarter) / double(kQuarter);
        return i < kHalf ? rise : -rise;
    }
    case WaveFunction::Sawtooth:
        return i / double(kTableSize);
    case WaveFunction::InverseSawtooth:
        return 1.0 - i / double(kTableSize);
    case WaveFunction::Sin:
    case WaveFunction::Noise:
        break;
    }
    return sineTable(i);
}

double evaluateWave(const Wave& wave, double timeSeconds) {
    if (wave.function == WaveFunction::Noise)
        return wave.base + wave.amplitude * latticeNoise(0, 0, 0, (timeSeconds + wave.phase) * wave.frequency);
    // Reduced before the conversion: finite for any time, and the same entry as the plain truncation gives.
    const double position = (wave.phase + timeSeconds * wave.frequency) * kTableSize;
    const int index = static_cast<int>(std::fmod(std::trunc(position), double(kTableSize)));
    return wave.base + waveTable(wave.function, index) * wave.amplitude;
}

void seedNoiseFromCRand() {
    NoiseTables& tables = noiseTables();
    for (size_t i = 0; i < kNoiseSize; ++i) {
        tables.value[i] = static_cast<float>(std::rand() / static_cast<float>(RAND_MAX) * 2.0 - 1.0);
        tables.permutation[i] = static_cast<uint8_t>(std::rand() / static_cast<float>(RAND_MAX) * 255.0f);
    }
}

double latticeNoise(double x, double y, double z, double t) {
    const NoiseTables& tables = noiseTables();
    const double corner[4] = {std::floor(x), std::floor(y), std::floor(z), std::floor(t)};
    const double fraction[4] = {x - corner[0], y - corner[1], z - corner[2], t - corner[3]};
    // Lattice coordinates enter modulo 256 only.
    int64_t base[4];
    for (int k = 0; k < 4; ++k)
        base[k] = static_cast<int64_t>(std::fmod(corner[k], double(kNoiseSize)));
    double value[16];
    for (int corner16 = 0; corner16 < 16; ++corner16)
        value[corner16] = noiseAt(tables, base[0] + (corner16 & 1), base[1] + (corner16 >> 1 & 1),
                                  base[2] + (corner16 >> 2 & 1), base[3] + (corner16 >> 3 & 1));
    int count = 16;
    for (int k = 0; k < 4; ++k) {
        count /= 2;
        for (int i = 0; i < count; ++i)
            value[i] = value[2 * i] + (value[2 * i + 1] - value[2 * i]) * fraction[k];
    }
    return value[0];
}

} // namespace q3rt
