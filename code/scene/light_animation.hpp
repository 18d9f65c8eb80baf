#pragma once
// Emitters whose glow changes with time (animMap, colour waves): their light follows what they show. The map compilers
// baked a constant; it is taken for the mean over time.

#include <vector>

#include "scene/material.hpp"

namespace q3rt {

class LightAnimation {
  public:
    LightAnimation(const MaterialLibrary& materials, const TextureLibrary& textures)
        : m_materials(materials)
        , m_textures(textures) {}
    /// 1 + the number of a material's colour in evaluate(); 0 if its glow never changes.
    uint32_t find(MaterialId material);
    /// What the light of each is multiplied by, by channel; mean 1 over time.
    std::vector<vec3> evaluate(double shaderTimeSeconds) const;
    bool empty() const { return m_animated.empty(); }

  private:
    struct Animated {
        MaterialId material;
        vec3 meanGlow;
    };
    vec3 glowOf(MaterialId material, double shaderTimeSeconds) const;

    const MaterialLibrary& m_materials;
    const TextureLibrary& m_textures;
    std::vector<Animated> m_animated;
    std::vector<MaterialId> m_steady;
};

} // namespace q3rt
