#pragma once
// Trees of what changes its shape from frame to frame. An animated model moves its triangles and keeps them: its tree
// is built when it is first seen, and later frames only fit the boxes to where the triangles are. The first tree is a
// quick one; a good one takes its place in a frame that has time for it, so that a crowd that comes into sight does not
// hold the frame up. What is known by nothing (polys, sprites, beams) gets a quick tree of its own in each frame.

#include <map>

#include "renderer_rt/scene_trees.hpp"

namespace q3rt {

class MovingTrees {
  public:
    struct Made {
        const TreeData& tree; ///< until the next call
        bool built = false;   ///< or fitted
    };
    /// Forgets trees that nobody has asked for in a while.
    void beginFrame();
    /// `key`: what the parts are made of; equal keys most likely have the same triangles. Empty: unknown.
    Made make(std::span<const uint64_t> key, std::span<const TreePart> parts);
    void clear() { m_models.clear(); }

  private:
    /// Where a triangle in leaf order finds its corners.
    struct Source {
        uint32_t part = 0;
        uint32_t index[3] = {}; ///< of vertices of the part
    };
    struct Model {
        TreeData tree; ///< as last fitted
        std::vector<Source> sources;
        std::vector<uint32_t> indices; ///< of all parts, as built
        uint64_t lastFrame = 0;
        bool isGood = false; ///< not a quick tree
    };
    static bool hasTriangles(const Model& model, std::span<const TreePart> parts);
    static bool fit(Model& model, std::span<const TreePart> parts);
    /// Good if this frame has time for it.
    void build(Model& model, std::span<const TreePart> parts);
    bool hasTimeFor(std::span<const TreePart> parts) const;

    std::map<std::vector<uint64_t>, Model> m_models;
    std::vector<uint64_t> m_key; ///< work space, as the next
    TreeData m_quick;
    uint64_t m_frame = 0;
    size_t m_goodTriangles = 0; ///< of good trees that this frame has built
};

} // namespace q3rt
