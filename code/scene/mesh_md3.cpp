// MD3: whole vertices for each frame.

#include <algorithm>

#include "math/lanes.hpp"
#include "scene/animated_mesh.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kWhite = 0xffffffffu; // MD3 carries no colours

/// A surface between two frames.
class BlendedSurface {
  public:
    BlendedSurface(const Md3Surface& surface, const FramePair& frames)
        : m_st(surface.st.data())
        , m_now(surface.vertices.data() + static_cast<size_t>(frames.frame) * surface.vertexCount)
        , m_old(surface.vertices.data() + static_cast<size_t>(frames.oldFrame) * surface.vertexCount)
        , m_oldWeight(frames.backLerp) {}

    /// The fourth means nothing.
    Float4 position(size_t i) const {
        const Float4 now = stepsOf(m_now[i]) * kMd3Step;
        if (m_oldWeight == 0.0f) return now;
        return stepsOf(m_old[i]) * kMd3Step * m_oldWeight + now * (1.0f - m_oldWeight);
    }
    vec3 normal(size_t i) const {
        if (m_oldWeight == 0.0f) return m_now[i].normal();
        return fastNormalize(m_old[i].normal() * m_oldWeight + m_now[i].normal() * (1.0f - m_oldWeight));
    }
    Vertex vertex(size_t i) const {
        const Float4 at = position(i);
        return {vec3(at[0], at[1], at[2]), normal(i), m_st[i], vec2(0.0f), kWhite, 0};
    }

  private:
    static Float4 stepsOf(const Md3Vertex& vertex) {
        using Short4 = int16_t __attribute__((vector_size(8)));
        static_assert(sizeof(Md3Vertex) == sizeof(Short4));
        return __builtin_convertvector(std::bit_cast<Short4>(vertex), Float4);
    }
    const vec2* m_st;
    const Md3Vertex *m_now, *m_old;
    float m_oldWeight;
};

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
    bool findPositions(size_t surface, const FramePair& frames, std::vector<Float4>& out) const override;
    void appendSome(size_t surface, const FramePair& frames, std::span<const uint32_t> numbers,
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
    const BlendedSurface blended(m_model.surfaces[index], frames);
    const size_t first = out.size(), count = m_model.surfaces[index].vertexCount;
    out.resize(first + count);
    for (size_t i = 0; i < count; ++i)
        out[first + i] = blended.vertex(i);
}

bool Md3Mesh::findPositions(size_t index, const FramePair& frames, std::vector<Float4>& out) const {
    const BlendedSurface blended(m_model.surfaces[index], frames);
    out.resize(m_model.surfaces[index].vertexCount);
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = blended.position(i);
    return true;
}

void Md3Mesh::appendSome(size_t index, const FramePair& frames, std::span<const uint32_t> numbers,
                         std::vector<Vertex>& out) const {
    const BlendedSurface blended(m_model.surfaces[index], frames);
    for (const uint32_t number : numbers)
        out.push_back(blended.vertex(number));
}

} // namespace

std::unique_ptr<AnimatedMesh> makeMd3Mesh(Md3 model) { return std::make_unique<Md3Mesh>(std::move(model)); }

} // namespace q3rt
