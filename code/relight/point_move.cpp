#include "relight/point_move.hpp"

#include <array>
#include <cmath>

namespace q3rt {
namespace {

constexpr float kMinPointDistanceQu = 16;
constexpr float kLongestMoveQu = 32, kLeastMoveQu = 1;
constexpr double kDamping = 1e-3;

constexpr size_t kUnknowns = 6; // place, then strength by channel
using Vector = std::array<double, kUnknowns>;
using Matrix = std::array<Vector, kUnknowns>;

/// Solves a symmetric positive definite system in place (Cholesky); false if it is not one.
bool solve(Matrix& a, Vector& b) {
    for (size_t i = 0; i < kUnknowns; ++i)
        for (size_t j = 0; j <= i; ++j) {
            double sum = a[i][j];
            for (size_t k = 0; k < j; ++k)
                sum -= a[i][k] * a[j][k];
            if (i == j && !(sum > 0)) return false;
            a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
        }
    for (size_t i = 0; i < kUnknowns; ++i) {
        for (size_t k = 0; k < i; ++k)
            b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (size_t i = kUnknowns; i-- > 0;) {
        for (size_t k = i + 1; k < kUnknowns; ++k)
            b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/// How the light at a receiver changes with the light's place, per unit of strength, unshadowed.
vec3 slopeAt(const LightReceiver& receiver, const vec3& origin, float& irradiance) {
    vec3 slope(0);
    irradiance = 0;
    for (int p = 0; p < LightReceiver::kPoints; ++p) {
        const vec3 to = origin - receiver.position[p];
        const float squared = glm::dot(to, to), height = glm::dot(to, receiver.normal[p]);
        if (!(height > 0)) continue;
        irradiance += pointIrradiance(receiver.position[p], receiver.normal[p], origin);
        const bool isNear = squared < kMinPointDistanceQu * kMinPointDistanceQu;
        const float counted = isNear ? kMinPointDistanceQu * kMinPointDistanceQu : squared;
        slope +=
            (receiver.normal[p] - (isNear ? 1.0f : 3.0f) * to * (height / squared)) / (std::sqrt(squared) * counted);
    }
    return slope;
}

} // namespace

vec3 moveOf(const LightScene& scene, const LightFit& fit, const FoundLight& light) {
    Matrix matrix{};
    Vector right{};
    const LightColumn& column = fit.column(light.source);
    const vec3& strength = fit.strength(light.source);
    for (size_t i = 0; i < column.receiver.size(); ++i) {
        const uint32_t at = column.receiver[i];
        const vec3 weight = fit.weightAt(at);
        float irradiance = 0;
        vec3 slope = slopeAt(scene.receivers[at], light.origin, irradiance);
        if (!(irradiance > 0)) continue;
        slope *= column.value[i] / irradiance; // what arrives, as shadows were
        for (int c = 0; c < 3; ++c) {
            Vector row{};
            for (int axis = 0; axis < 3; ++axis)
                row[static_cast<size_t>(axis)] = double(strength[c]) * slope[axis];
            row[static_cast<size_t>(3 + c)] = column.value[i];
            for (size_t a = 0; a < kUnknowns; ++a) {
                right[a] += double(weight[c]) * row[a] * fit.residual()[at][c];
                for (size_t b = 0; b < kUnknowns; ++b)
                    matrix[a][b] += double(weight[c]) * row[a] * row[b];
            }
        }
    }
    for (size_t a = 0; a < kUnknowns; ++a)
        matrix[a][a] *= 1 + kDamping;
    if (!solve(matrix, right)) return vec3(0);
    vec3 move(right[0], right[1], right[2]);
    const float length = glm::length(move);
    if (!(length >= kLeastMoveQu) || !std::isfinite(length)) return vec3(0);
    if (length > kLongestMoveQu) move *= kLongestMoveQu / length;
    const bool isFree =
        scene.world.clusterOf(light.origin + move) >= 0 && !scene.occluders.occluded(light.origin, move, 1);
    return isFree ? move : vec3(0);
}

} // namespace q3rt
