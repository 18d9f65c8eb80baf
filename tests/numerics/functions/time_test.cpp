// What depends on the clock, at its start, after a day and after 24 days (the engine's clock is a 32-bit count of
// milliseconds and ends a day later), against long double.

#include <cmath>
#include <random>

#include "numerics/measured.hpp"
#include "scene/deform.hpp"
#include "scene/stage_table.hpp"
#include "scene/wave.hpp"

namespace q3rt::test {
namespace {

constexpr int kHourMs = 3600 * 1000;
constexpr int kClocksMs[] = {0, 24 * kHourMs, 24 * 24 * kHourMs};
constexpr int kSamples = 20000;
constexpr float kSpeeds[] = {0.01f, 0.1f, -0.3f, 1.0f, 7.3f, -40.0f};

/// Clock values in the 10 seconds from `fromMs` on.
template <typename Visit>
void visitClocks(int fromMs, const Visit& visit) {
    std::mt19937 random(static_cast<uint32_t>(fromMs) + 1);
    for (int i = 0; i < kSamples; ++i)
        visit(fromMs + static_cast<int>(random() % 10000));
}

long double secondsOf(int ms) { return static_cast<long double>(ms) / 1000; }

/// Distance on a circle of circumference 1.
double distanceOnCircle(long double a, long double b) {
    const long double d = std::abs(a - b - std::floor(a - b));
    return static_cast<double>(std::min(d, 1 - d));
}

Stage makeStage(TexModKind kind, float s, float t) {
    Stage stage;
    TexMod mod;
    mod.kind = kind;
    mod.value[0] = s;
    mod.value[1] = t;
    stage.unit[0].mods.push_back(mod);
    return stage;
}

StageState evaluateAt(const Stage& stage, int ms) {
    StageInputs inputs;
    inputs.shaderTimeSeconds = ms * 0.001;
    return evaluateStage(Material(), stage, inputs, 1.0f);
}

/// Error bound of a product with the time that is reduced to [0, 1) and stored as a float: the time and the product
/// have a rounding each in double, the result half a step below 1.
double wrappedBound(float speed, int ms) {
    return 2 * 0x1p-53 * std::abs(double(speed)) * static_cast<double>(secondsOf(ms)) + 0x1p-25;
}

TEST(Time, ScrollKeepsItsPrecision) {
    for (const int clock : kClocksMs) {
        double worst = 0, worstOfBound = 0;
        for (const float speed : kSpeeds) {
            const Stage stage = makeStage(TexModKind::Scroll, speed, -0.5f * speed);
            visitClocks(clock, [&](int ms) {
                const vec2 moved = evaluateAt(stage, ms).unit[0].mods[0].translate;
                for (int k = 0; k < 2; ++k) {
                    const float v = k == 0 ? speed : -0.5f * speed;
                    const double error = distanceOnCircle(moved[k], static_cast<long double>(v) * secondsOf(ms));
                    worst = std::max(worst, error);
                    worstOfBound = std::max(worstOfBound, error / wrappedBound(v, ms));
                }
            });
        }
        std::printf("numerics | scroll after %d h: %.2g of a texture\n", clock / kHourMs, worst);
        expectWithin("texture scroll after " + std::to_string(clock / kHourMs) + " h", worstOfBound, 1, "of the bound");
    }
}

TEST(Time, TurbulenceKeepsItsPhase) {
    double worstOfBound = 0;
    for (const int clock : kClocksMs)
        for (const float frequency : kSpeeds) {
            Stage stage = makeStage(TexModKind::Turb, 0, 0);
            stage.unit[0].mods[0].wave = {WaveFunction::Sin, 0, 0.1f, 0.25f, frequency};
            visitClocks(clock, [&](int ms) {
                const float phase = evaluateAt(stage, ms).unit[0].mods[0].matrix.y;
                const long double exact = 0.25L + static_cast<long double>(frequency) * secondsOf(ms);
                worstOfBound = std::max(worstOfBound, distanceOnCircle(phase, exact) / wrappedBound(frequency, ms));
            });
        }
    expectWithin("phase of turbulence, 0 to 24 days", worstOfBound, 1, "of the bound");
}

/// The entry that a wave reads; `margin`: how near its position is to the next entry's, in entries.
int exactEntry(const Wave& wave, int ms, long double& margin) {
    const long double position =
        (static_cast<long double>(wave.phase) + secondsOf(ms) * static_cast<long double>(wave.frequency)) * 1024;
    margin = std::abs(position - std::round(position));
    return static_cast<int>(std::fmod(std::trunc(position), 1024.0L));
}

TEST(Time, WavesReadTheirEntry) {
    size_t wrong = 0, cases = 0;
    for (const int clock : kClocksMs)
        for (const WaveFunction function : {WaveFunction::Sin, WaveFunction::Square, WaveFunction::Triangle,
                                            WaveFunction::Sawtooth, WaveFunction::InverseSawtooth})
            for (const float frequency : kSpeeds) {
                const Wave wave{function, 0.5f, 0.25f, 0.125f, frequency};
                visitClocks(clock, [&](int ms) {
                    long double margin = 0;
                    const int entry = exactEntry(wave, ms, margin);
                    // Three roundings in double of the position; nearer than that to a step either side is right.
                    if (margin < 3 * 0x1p-53L * 1024 * std::abs(frequency * secondsOf(ms))) return;
                    ++cases;
                    const double expected = 0.5 + waveTable(function, entry) * 0.25;
                    if (evaluateWave(wave, ms * 0.001) != expected) ++wrong;
                });
            }
    expectCount("waves that read another entry, 0 to 24 days", wrong, cases);
}

TEST(Time, AnimationsShowTheirFrame) {
    size_t wrong = 0, cases = 0;
    for (const int clock : kClocksMs)
        for (const float fps : {0.5f, 3.0f, 10.0f, 29.97f}) {
            Stage stage;
            stage.unit[0].framesPerSecond = fps;
            for (TextureId frame = 0; frame < 7; ++frame)
                stage.unit[0].frames.push_back(frame);
            visitClocks(clock, [&](int ms) {
                const long double steps = secondsOf(ms) * static_cast<long double>(fps) * 1024;
                if (std::abs(steps - std::round(steps)) < 3 * 0x1p-53L * steps) return;
                ++cases;
                const auto frame = static_cast<TextureId>(std::fmod(std::floor(std::trunc(steps) / 1024), 7.0L));
                if (evaluateAt(stage, ms).unit[0].texture != frame) ++wrong;
            });
        }
    expectCount("animations that show another frame, 0 to 24 days", wrong, cases);
}

TEST(Time, RotationReadsItsEntry) {
    double worst = 0;
    for (const int clock : kClocksMs)
        for (const float degrees : {10.0f, -90.0f, 360.0f}) {
            const Stage stage = makeStage(TexModKind::Rotate, degrees, 0);
            visitClocks(clock, [&](int ms) {
                const vec4 m = evaluateAt(stage, ms).unit[0].mods[0].matrix;
                const long double turns = static_cast<long double>(-degrees) * secondsOf(ms) / 360;
                // The table divides the circle by 1023 and is read by 1024ths: its own angle.
                const long double entry = std::fmod(std::trunc(turns * 1024), 1024.0L);
                const double angle = 2 * M_PI * (static_cast<int>(entry) & 1023) / 1023;
                // A step of the table where the position lies on its border.
                const long double margin = std::abs(turns * 1024 - std::round(turns * 1024));
                if (margin < 4 * 0x1p-53L * 1024 * std::abs(turns)) return;
                worst = std::max(worst, std::abs(double(m.y) - std::sin(angle)));
            });
        }
    expectWithin("sine of a rotation, 0 to 24 days", worst, 0x1p-23, "");
}

TEST(Time, DeformedVerticesKeepTheirPlace) {
    Material material;
    Deform deform;
    deform.kind = DeformKind::Wave;
    deform.spread = 0.01f;
    deform.wave = {WaveFunction::Triangle, 0, 8, 0, 0.7f};
    material.deforms.push_back(deform);
    double worst = 0;
    for (const int clock : kClocksMs)
        visitClocks(clock, [&](int ms) {
            std::vector<Vertex> vertices(1);
            vertices[0].position = vec3(100, 20, 3);
            vertices[0].normal = vec3(0, 0, 1);
            std::vector<uint32_t> indices;
            DeformContext context;
            context.shaderTimeSeconds = ms * 0.001;
            deformVertices(material, context, vertices, indices);
            Wave wave = deform.wave;
            wave.phase = 123.0f * deform.spread;
            long double margin = 0;
            const int entry = exactEntry(wave, ms, margin);
            if (margin < 3 * 0x1p-53L * 1024 * secondsOf(ms)) return;
            const double expected = 3 + 8 * waveTable(WaveFunction::Triangle, entry);
            worst = std::max(worst, std::abs(double(vertices[0].position.z) - expected));
        });
    expectWithin("place of a deformed vertex, 0 to 24 days", worst, 16 * 0x1p-24, "qu");
}

} // namespace
} // namespace q3rt::test
