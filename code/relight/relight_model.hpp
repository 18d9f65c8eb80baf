#pragma once
// Lights of a map with what they explain: a fit that begins with given lights and is improved step by step.

#include <functional>
#include <memory>

#include "relight/light_score.hpp"
#include "relight/point_search.hpp"
#include "relight/relight_input.hpp"

namespace q3rt {

class RelightModel {
  public:
    /// The same lights, the same model: what came before them does not matter.
    RelightModel(const RelightInput& input, const LostLights& lights);

    /// Strengths for lights that nothing is known of: bounces as the baked light itself has them.
    void solveFirst();
    void addSuns();
    /// Up to `count` point and spot lights more; tells how many it has found now and then.
    void addPoints(size_t count, const std::function<void(size_t)>& found);
    /// Best strengths, places and cones for the lights that are there, and bounces of what they give.
    void settle();

    LostLights lights() const;
    size_t pointCount() const { return m_points->lights().size(); }
    double bounceScale() const { return m_bounceScale; }
    double cost() const { return m_fit.cost(); }
    /// At the patches that the fit saw.
    LightScore score() const;
    /// At luxels that no fit saw, evenly over the area; sources are traced anew.
    LightScore scoreHeldOut(size_t count) const;

  private:
    struct Sun {
        SunLight sun;
        size_t source;
    };
    const RelightInput& m_input;
    LightFit m_fit;
    std::vector<size_t> m_kindSources;
    float m_faintestSurface;
    size_t m_ambientSource = 0;
    std::vector<Sun> m_suns;
    std::unique_ptr<PointSearch> m_points;
    std::vector<vec3> m_bounced; ///< irradiance by patch, at scale 1
    double m_bounceScale;

    void addSun(const SunLight& sun);
    void addKinds(const LostLights& lights);
    /// Light of all sources without bounces, by patch.
    std::vector<vec3> direct() const;
    /// The fit explains what bounces leave.
    void setBounced(std::vector<vec3> bounced, double scale);
    std::vector<vec3> bouncesOf(const std::vector<vec3>& irradiance) const;
    double bestBounceScale() const;

    std::vector<vec3> irradianceAt(const std::vector<LightReceiver>& receivers) const;
};

} // namespace q3rt
