#pragma once
// Wave functions and noise of the shader language. 1024-entry tables; sin uses a period of 1023 as the original does.

#include <cstdint>

namespace q3rt {

enum class WaveFunction : uint8_t { Sin, Square, Triangle, Sawtooth, InverseSawtooth, Noise };

struct Wave {
    WaveFunction function = WaveFunction::Sin;
    float base = 0, amplitude = 0, phase = 0, frequency = 0;
};

/// base + table[trunc((phase + time * frequency) * 1024) & 1023] * amplitude. `timeSeconds` in double: exact for weeks.
double evaluateWave(const Wave& wave, double timeSeconds);
/// The table entry alone, i in [0, 1023].
double waveTable(WaveFunction function, int i);
/// The sine table (period 1023): used by normals, light-grid directions, waves, turb, rotate, bulge.
float sineTable(int i);

/// Refills the noise tables from the C library's rand(), in the original's order, so that noise waves can agree with
/// it.
void seedNoiseFromCRand();
/// Quadrilinear lattice noise in [-1, 1].
double latticeNoise(double x, double y, double z, double t);

} // namespace q3rt
