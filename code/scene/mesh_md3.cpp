// MD3: whole vertices for each frame.

#include <algorithm>

#include "scene/animated_mesh.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kWhite = 0xffffffffu; // MD3 carries no colours

class Md3Mesh : public AnimatedMesh {
  public:
    explicit Md3Mesh(Md3 model);

    size_t frameCount() const override { return m_model.frames.size(); }
    FrameBox frameBox(int frame) const override {
        const Md3Frame& box = m_model.frames[static_cast<size_t>(frame)];
        return {{box.mins, box.maxs}, box.localOrigin, box.radius};
    }
    bool lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const override;
    size_t surfaceCount() const override { return m_model.surfaces.size(); }
    MeshSurface surface(size_t surface) const override {
        return {m_model.surfaces[surface].name, m_model.surfaces[surface].shaders};
    }
    size_t vertexCount(size_t surface) const override { return m_model.surfaces[surface].vertexCount; }
    std::span<const uint32_t> indices(size_t surface) const override { return m_model.surfaces[surface].indices; }
    Bounds surfaceBox(size_t surface, const FramePair& frames) const override;
    void pose(const FramePair&, std::vector<Affine>& bones) const override { bones.clear(); }
    void appendVertices(size_t surface, const FramePair& frames, std::span<const Affine> bones,
                        std::vector<Vertex>& out) const override;

  private:
    const Md3Tag* findTag(int frame, std::string_view name) const;
    Md3 m_model;
    std::vector<std::vector<Bounds>> m_boxes; ///< by surface, by frame; those in the file need not hold the vertices
};

Md3Mesh::Md3Mesh(Md3 model)
    : m_model(std::move(model)) {
    for (const Md3Surface& surface : m_model.surfaces) {
        std::vector<Bounds>& boxes = m_boxes.emplace_back(m_model.frames.size());
        for (size_t i = 0; i < surface.vertices.size(); ++i)
            boxes[i / surface.vertexCount].add(surface.vertices[i].position());
    }
}

Bounds Md3Mesh::surfaceBox(size_t surface, const FramePair& frames) const {
    if (!(frames.backLerp >= 0.0f && frames.backLerp <= 1.0f)) return {}; // beyond both frames
    Bounds box = m_boxes[surface][static_cast<size_t>(frames.frame)];
    if (frames.backLerp > 0.0f) box.add(m_boxes[surface][static_cast<size_t>(frames.oldFrame)]);
    return box;
}

const Md3Tag* Md3Mesh::findTag(int frame, std::string_view name) const {
    const auto row = static_cast<size_t>(std::clamp(frame, 0, static_cast<int>(m_model.frames.size()) - 1));
    for (size_t i = 0; i < m_model.tagCount; ++i) {
        const Md3Tag& tag = m_model.tags[row * m_model.tagCount + i];
        if (tag.name == name) return &tag;
    }
    return nullptr;
}

bool Md3Mesh::lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const {
    const Md3Tag *start = findTag(startFrame, name), *end = findTag(endFrame, name);
    if (!start || !end) return false;
    const float startWeight = 1.0f - fraction;
    out.origin = start->orientation.origin * startWeight + end->orientation.origin * fraction;
    for (int i = 0; i < 3; ++i)
        out.axis[i] = normalizeOrZero(start->orientation.axis[i] * startWeight + end->orientation.axis[i] * fraction);
    return true;
}

void Md3Mesh::appendVertices(size_t index, const FramePair& frames, std::span<const Affine>,
                             std::vector<Vertex>& out) const {
    const Md3Surface& surface = m_model.surfaces[index];
    const size_t count = surface.vertexCount;
    const size_t first = out.size();
    out.resize(first + count);
    const Md3Vertex* now = surface.vertices.data() + static_cast<size_t>(frames.frame) * count;
    Vertex* vertex = out.data() + first;
    if (frames.backLerp == 0.0f) {
        for (size_t i = 0; i < count; ++i)
            vertex[i] = {now[i].position(), now[i].normal(), surface.st[i], vec2(0.0f), kWhite, 0};
        return;
    }
    const Md3Vertex* old = surface.vertices.data() + static_cast<size_t>(frames.oldFrame) * count;
    const float weight = 1.0f - frames.backLerp;
    for (size_t i = 0; i < count; ++i) {
        vertex[i] = {old[i].position() * frames.backLerp + now[i].position() * weight,
                     fastNormalize(old[i].normal() * frames.backLerp + now[i].normal() * weight),
                     surface.st[i],
                     vec2(0.0f),
                     kWhite,
                     0};
    }
}

} // namespace

std::unique_ptr<AnimatedMesh> makeMd3Mesh(Md3 model) { return std::make_unique<Md3Mesh>(std::move(model)); }

} // namespace q3rt
