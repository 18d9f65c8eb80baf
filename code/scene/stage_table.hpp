#pragma once
// The one table of evaluated stages of a frame. A (material, shader time, entity colours) triple is evaluated once, in
// double precision; both renderers read the result.

#include <vector>

#include "scene/busy_frame.hpp"
#include "scene/material.hpp"
#include "shaders/shared/stage.h"

namespace q3rt {

struct StageRange {
    uint32_t first = 0, count = 0;
};

/// What of an entity enters a stage.
struct StageInputs {
    double shaderTimeSeconds = 0; ///< scene time - entity shader time (the material's own offset is subtracted here)
    U8vec4 entityColor{255};
    vec2 entityTexCoord{0};
    bool hasEntity = false; ///< false: world, polys, 2D: entity colours are 0
};

/// Stages that nothing changes stay: they come first, and keep their places from the frame on that follows their first.
class StageTable {
  public:
    StageTable(const MaterialLibrary& materials, const TextureLibrary& textures, float identityLight)
        : m_materials(materials)
        , m_textures(textures)
        , m_identityLight(identityLight) {
        m_states.reserve(busyFrame::kStages);
        m_keys.reserve(busyFrame::kStages);
    }
    /// Forgets the last frame but for what stays. Keeps its memory.
    void beginFrame();
    /// Follows remapping (one level): pass the surface's own material. Materials that share stages share ranges.
    StageRange evaluate(MaterialId material, const StageInputs& inputs);
    const std::vector<StageState>& states() const { return m_states; }
    /// How many of the states are what they were at their places in every earlier frame that had as many.
    size_t lastingCount() const { return m_lastingCount; }
    const TextureLibrary& textures() const { return m_textures; }
    float identityLight() const { return m_identityLight; }

  private:
    const MaterialLibrary& m_materials;
    const TextureLibrary& m_textures;
    float m_identityLight;
    std::vector<StageState> m_states;
    /// What was evaluated this frame, in chains by hash: nothing is allocated once the frame's number has been reached.
    struct Key {
        MaterialId material;
        StageInputs inputs;
        StageRange range;
        uint32_t next; ///< of the chain
        bool lasts;    ///< no stage reads time or entity
    };
    void addToChain(Key& key);
    static constexpr uint32_t kNoKey = ~0u;
    static constexpr size_t kBuckets = 1024; ///< several times the evaluations of a usual frame
    std::vector<Key> m_keys;
    std::vector<uint32_t> m_heads; ///< by hash: newest key of the chain
    size_t m_lastingCount = 0;     ///< of m_states
};

/// One stage at one time; pure.
StageState evaluateStage(const Material& material, const Stage& stage, const StageInputs& inputs, float identityLight);

} // namespace q3rt
