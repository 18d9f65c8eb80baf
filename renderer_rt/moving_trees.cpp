#include "renderer_rt/moving_trees.hpp"

#include <algorithm>

namespace q3rt {

namespace {

/// A fitted tree that costs a ray more than this times what it cost when it was built is built anew. Of 26,300 fits in
/// two demos the median was 1.00, the 99th of a hundred 1.7 (docs/tracing.md).
constexpr float kWorstFit = 2.0f;
/// Of good trees, a frame: about 0.7 ms. One is built whatever its size.
constexpr size_t kGoodTrianglesOfFrame = 1000;
/// Some seconds of play.
constexpr uint64_t kFramesToRemember = 512;

} // namespace

void MovingTrees::beginFrame() {
    ++m_frame;
    m_goodTriangles = 0;
    if (m_frame % kFramesToRemember != 0) return;
    std::erase_if(m_models, [this](const auto& entry) { return entry.second.lastFrame + kFramesToRemember < m_frame; });
}

MovingTrees::Made MovingTrees::make(std::span<const uint64_t> key, std::span<const TreePart> parts) {
    if (key.empty()) {
        m_quick = buildTree(parts, false);
        return {m_quick, true};
    }
    m_key.assign(key.begin(), key.end());
    Model& model = m_models[m_key];
    model.lastFrame = m_frame;
    const bool fitted = hasTriangles(model, parts) && (model.isGood || !hasTimeFor(parts)) && fit(model, parts);
    if (!fitted) build(model, parts);
    return {model.tree, !fitted};
}

bool MovingTrees::hasTriangles(const Model& model, std::span<const TreePart> parts) {
    std::span<const uint32_t> rest(model.indices);
    for (const TreePart& part : parts) {
        if (rest.size() < part.indices.size()) return false;
        if (!std::ranges::equal(part.indices, rest.first(part.indices.size()))) return false;
        rest = rest.subspan(part.indices.size());
    }
    // A builder leaves triangles out that are at no place; they may be at one now.
    return rest.empty() && model.tree.bvh.rejectedCount == 0;
}

bool MovingTrees::fit(Model& model, std::span<const TreePart> parts) {
    for (size_t i = 0; i < model.sources.size(); ++i) {
        const Source& source = model.sources[i];
        const std::span<const Vertex> vertices = parts[source.part].vertices;
        BvhTriangle& triangle = model.tree.triangles[i];
        triangle.corner0 = vertices[source.index[0]].position;
        triangle.corner1 = vertices[source.index[1]].position;
        triangle.corner2 = vertices[source.index[2]].position;
    }
    const std::optional<float> cost = refit(model.tree.bvh, model.tree.triangles);
    return cost && *cost <= kWorstFit;
}

bool MovingTrees::hasTimeFor(std::span<const TreePart> parts) const {
    size_t triangles = m_goodTriangles;
    for (const TreePart& part : parts)
        triangles += part.indices.size() / 3;
    return m_goodTriangles == 0 || triangles <= kGoodTrianglesOfFrame;
}

void MovingTrees::build(Model& model, std::span<const TreePart> parts) {
    model.isGood = hasTimeFor(parts);
    model.tree = buildTree(parts, model.isGood);
    if (model.isGood) m_goodTriangles += model.tree.triangles.size();
    model.indices.clear();
    for (const TreePart& part : parts)
        model.indices.insert(model.indices.end(), part.indices.begin(), part.indices.end());
    model.sources.clear();
    for (const BvhTriangle& triangle : model.tree.triangles) {
        Source& source = model.sources.emplace_back();
        source.part = triangle.flags >> kBvhPartShift;
        for (uint32_t corner = 0; corner < 3; ++corner)
            source.index[corner] = parts[source.part].indices[3 * triangle.number + corner];
    }
}

} // namespace q3rt
