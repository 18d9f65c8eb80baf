// IQM: a skeleton with a rest pose; frames place each joint in its parent.

#include <algorithm>
#include <cmath>

#include "scene/animated_mesh.hpp"

namespace q3rt {
namespace {

constexpr float kUnknownHalfSizeQu = 8; ///< of a model without bounds, where fog asks for them
/// Quaternions nearer than this (cosine of half the angle between them) are blended without arcs.
constexpr float kNearlyEqual = 0.999999f;

Affine toAffine(const IqmTransform& t) {
    const vec4& q = t.rotate;
    const float xx = 2 * q.x * q.x, yy = 2 * q.y * q.y, zz = 2 * q.z * q.z;
    const float xy = 2 * q.x * q.y, xz = 2 * q.x * q.z, yz = 2 * q.y * q.z;
    const float wx = 2 * q.w * q.x, wy = 2 * q.w * q.y, wz = 2 * q.w * q.z;
    const vec3 rows[3] = {
        {1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}};
    Affine result;
    for (int r = 0; r < 3; ++r)
        result.row[r] = vec4(rows[r] * t.scale[r], t.translate[r]);
    return result;
}

/// Of a rotation with a uniform scale; what else a file holds is inverted the same way, as the format's users do.
Affine invert(const Affine& a) {
    Affine result;
    const vec3 translate = a.column(3);
    for (int r = 0; r < 3; ++r) {
        const vec3 column = a.column(r);
        const float square = glm::dot(column, column);
        const vec3 row = square > 0 ? column / square : vec3(0.0f);
        result.row[r] = vec4(row, -glm::dot(row, translate));
    }
    return result;
}

/// From `a` to `b` on the shorter arc.
vec4 slerp(const vec4& a, const vec4& b, float fraction) {
    const float cosine = glm::dot(a, b);
    const float sign = cosine < 0 ? -1.0f : 1.0f, size = std::abs(cosine);
    if (size >= kNearlyEqual) return a * (1 - fraction) + b * (sign * fraction);
    const float angle = std::acos(size), inverse = 1 / std::sin(angle);
    return a * (std::sin((1 - fraction) * angle) * inverse) + b * (sign * std::sin(fraction * angle) * inverse);
}

uint32_t pack(const std::array<uint8_t, 4>& c) {
    return uint32_t{c[0]} | uint32_t{c[1]} << 8 | uint32_t{c[2]} << 16 | uint32_t{c[3]} << 24;
}

class IqmMesh3d : public AnimatedMesh {
  public:
    explicit IqmMesh3d(Iqm model);

    size_t frameCount() const override { return std::max<size_t>(m_model.frameCount, 1); }
    FrameBox frameBox(int frame) const override;
    bool lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const override;
    size_t surfaceCount() const override { return m_model.meshes.size(); }
    MeshSurface surface(size_t surface) const override {
        return {m_model.meshes[surface].name, {m_model.meshes[surface].material}};
    }
    size_t vertexCount(size_t surface) const override { return m_model.meshes[surface].vertexCount; }
    std::span<const uint32_t> indices(size_t surface) const override { return m_model.meshes[surface].indices; }
    void pose(const FramePair& frames, std::vector<Affine>& bones) const override;
    void appendVertices(size_t surface, const FramePair& frames, std::span<const Affine> bones,
                        std::vector<Vertex>& out) const override;

  private:
    bool moves() const { return !m_model.poses.empty() && m_model.frameCount > 0; }
    Affine blendWeights(size_t vertex, std::span<const Affine> bones) const;

    Iqm m_model;
    Bounds m_restBox;                                       ///< of all vertices
    std::vector<Affine> m_modelFromJoint, m_jointFromModel; ///< at rest
};

IqmMesh3d::IqmMesh3d(Iqm model)
    : m_model(std::move(model)) {
    for (const vec3& position : m_model.positions)
        m_restBox.add(position);
    for (const IqmJoint& joint : m_model.joints) {
        const Affine local = toAffine(joint.bind), inverse = invert(local);
        const auto parent = static_cast<size_t>(joint.parent);
        m_modelFromJoint.push_back(joint.parent < 0 ? local : m_modelFromJoint[parent] * local);
        m_jointFromModel.push_back(joint.parent < 0 ? inverse : inverse * m_jointFromModel[parent]);
    }
}

FrameBox IqmMesh3d::frameBox(int frame) const {
    FrameBox result;
    if (m_model.frameCount == 0)
        result.box = m_restBox;
    else if (!m_model.bounds.empty())
        result.box = m_model.bounds[static_cast<size_t>(frame)];
    const vec3 half = result.box.empty() ? vec3(kUnknownHalfSizeQu) : (result.box.maxs - result.box.mins) * 0.5f;
    if (!result.box.empty()) result.centre = (result.box.mins + result.box.maxs) * 0.5f;
    result.radius = glm::length(half);
    return result;
}

/// What a joint's movement does to vertices at rest: to the joint's place, through the pose, up through its parents.
void IqmMesh3d::pose(const FramePair& frames, std::vector<Affine>& bones) const {
    bones.clear();
    if (!moves()) return;
    for (size_t i = 0; i < m_model.poses.size(); ++i) {
        IqmTransform at = m_model.poseAt(static_cast<size_t>(frames.frame), i);
        if (frames.backLerp != 0.0f) {
            const IqmTransform old = m_model.poseAt(static_cast<size_t>(frames.oldFrame), i);
            const float fraction = 1.0f - frames.backLerp;
            at.translate = old.translate * frames.backLerp + at.translate * fraction;
            at.scale = old.scale * frames.backLerp + at.scale * fraction;
            at.rotate = slerp(old.rotate, at.rotate, fraction);
        }
        const Affine local = toAffine(at) * m_jointFromModel[i];
        const int parent = m_model.joints[i].parent;
        const auto above = static_cast<size_t>(parent);
        bones.push_back(parent < 0 ? local : bones[above] * m_modelFromJoint[above] * local);
    }
}

bool IqmMesh3d::lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const {
    const auto joint = std::ranges::find(m_model.joints, name, &IqmJoint::name);
    if (joint == m_model.joints.end()) return false;
    const auto index = static_cast<size_t>(joint - m_model.joints.begin());
    Affine place = m_modelFromJoint[index];
    if (moves()) {
        const int last = static_cast<int>(frameCount()) - 1;
        std::vector<Affine> bones;
        pose({std::clamp(startFrame, 0, last), std::clamp(endFrame, 0, last), fraction}, bones);
        place = bones[index] * place;
    }
    out.origin = place.column(3);
    for (int i = 0; i < 3; ++i)
        out.axis[i] = place.column(i);
    return true;
}

/// Weights stop at the first that is not above 0; a vertex without any stays at rest.
Affine IqmMesh3d::blendWeights(size_t vertex, std::span<const Affine> bones) const {
    const vec4& weights = m_model.blendWeights[vertex];
    if (weights.x <= 0) return {};
    Affine sum = bones[m_model.blendIndexes[vertex][0]] * weights.x;
    for (int i = 1; i < 4 && weights[i] > 0; ++i)
        sum = sum + bones[m_model.blendIndexes[vertex][static_cast<size_t>(i)]] * weights[i];
    return sum;
}

void IqmMesh3d::appendVertices(size_t index, const FramePair&, std::span<const Affine> bones,
                               std::vector<Vertex>& out) const {
    const IqmMesh& mesh = m_model.meshes[index];
    for (size_t i = mesh.firstVertex; i < mesh.firstVertex + mesh.vertexCount; ++i) {
        Vertex vertex{};
        vertex.position = m_model.positions[i];
        vertex.normal = m_model.normals[i];
        if (!bones.empty()) {
            const Affine blended = blendWeights(i, bones);
            vertex.position = blended.point(vertex.position);
            vertex.normal = blended.normal(vertex.normal);
        }
        vertex.st = m_model.st[i];
        if (!m_model.colors.empty()) vertex.color = pack(m_model.colors[i]);
        out.push_back(vertex);
    }
}

} // namespace

std::unique_ptr<AnimatedMesh> makeIqmMesh(Iqm model) { return std::make_unique<IqmMesh3d>(std::move(model)); }

} // namespace q3rt
