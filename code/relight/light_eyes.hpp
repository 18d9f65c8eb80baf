#pragma once
// Where a lost light may have been. From a point in open space, rays in all directions meet luxels; the light that is
// still unexplained there, averaged over the sphere, is how much a point light at that point would improve the fit:
// a light's column is a = cos / d^2, the area of a luxel seen within a solid angle w is w d^2 / cos, so that the sum of
// a x residual over areas is the sum of residuals over solid angles. So one set of rays a point, traced once, tells the
// worth of that point for any residual, by look-ups alone; and the rays within a cone tell the worth of a spot light.

#include "relight/light_fit.hpp"

namespace q3rt {

/// A spot light must gain so many times what a point light does at the same place: it has more to choose.
inline constexpr double kSpotHandicap = 2.2;

/// Residuals and weights per area, in the form that eyes read: by patch, current as of the fit's state.
struct SeenResidual {
    /// `price`: of a unit of a light's strength.
    SeenResidual(const LightFit& fit, const LuxelMap& luxels, double price);
    std::vector<vec3> weighted; ///< weight x residual
    std::vector<float> weight;
    double price;
};

class LightEye {
  public:
    /// Looks around from a point.
    LightEye(const LightScene& scene, const vec3& origin, int rayCount, uint32_t key);

    struct Worth {
        double gain = 0; ///< off the fit's cost, with the best strength
        vec3 strength{0};
        vec3 axis{0}; ///< of a spot light; zero: a point light
    };
    /// The better of a point light and of spot lights along the grid's axes and diagonals.
    Worth worth(const SeenResidual& seen) const;
    const vec3& origin() const { return m_origin; }

  private:
    struct Look {
        uint32_t patch;
        float irradiance; ///< of intensity 1
        uint32_t bin;     ///< the nearest of the axes
    };
    vec3 m_origin;
    std::vector<Look> m_looks;
    float m_solidAngle; ///< of one ray
};

/// Eyes all over the open space of the map.
std::vector<LightEye> openEyes(const LightScene& scene);

} // namespace q3rt
