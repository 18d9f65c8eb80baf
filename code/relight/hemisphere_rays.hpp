#pragma once
// Rays over the hemisphere of each receiver, in proportion to the cosine: what each meets. Traced once, they carry
// bounces and the light of skies for any strengths.

#include "relight/light_columns.hpp"

namespace q3rt {

class HemisphereRays {
  public:
    HemisphereRays(const LightScene& scene, const std::vector<LightReceiver>& receivers, int rayCount);
    /// Irradiance at the receivers of patches with these radiosities.
    std::vector<vec3> gather(const std::vector<vec3>& radiosityOfPatch) const;
    /// Irradiance of skies of radiosity 1, by kind; empty columns for kinds that are none.
    std::vector<LightColumn> skyColumns(const LightScene& scene) const;

  private:
    static constexpr int kNothing = -1;
    size_t m_rayCount;
    size_t m_receiverCount;
    std::vector<int> m_hit;       ///< patch, kNothing, or -2 - surface of a sky
    std::vector<uint8_t> m_above; ///< the ray goes above the horizon
};

} // namespace q3rt
