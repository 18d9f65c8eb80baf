#pragma once
// A linear map and a translation, as three rows: bones and joints. Not necessarily a rotation.

#include "math/vector.hpp"

namespace q3rt {

struct Affine {
    vec4 row[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}; ///< xyz linear part, w translation

    vec3 point(const vec3& p) const { return vector(p) + vec3(row[0].w, row[1].w, row[2].w); }
    vec3 vector(const vec3& v) const {
        return {glm::dot(vec3(row[0]), v), glm::dot(vec3(row[1]), v), glm::dot(vec3(row[2]), v)};
    }
    vec3 column(int i) const { return {row[0][i], row[1][i], row[2][i]}; }
    /// How normals turn under the linear part: its cofactors.
    vec3 normal(const vec3& n) const {
        const vec3 a(row[0]), b(row[1]), c(row[2]);
        return {glm::dot(glm::cross(b, c), n), glm::dot(glm::cross(c, a), n), glm::dot(glm::cross(a, b), n)};
    }
};

/// First `b`, then `a`.
inline Affine operator*(const Affine& a, const Affine& b) {
    Affine out;
    for (int r = 0; r < 3; ++r)
        out.row[r] = b.row[0] * a.row[r].x + b.row[1] * a.row[r].y + b.row[2] * a.row[r].z + vec4(0, 0, 0, a.row[r].w);
    return out;
}

/// Element by element.
inline Affine operator*(const Affine& a, float factor) {
    return {{a.row[0] * factor, a.row[1] * factor, a.row[2] * factor}};
}
inline Affine operator+(const Affine& a, const Affine& b) {
    return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}};
}

} // namespace q3rt
