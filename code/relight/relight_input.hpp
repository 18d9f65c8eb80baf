#pragma once
// What relighting computes of a map once: all that does not depend on strengths and found lights.

#include "relight/hemisphere_rays.hpp"
#include "relight/light_eyes.hpp"
#include "scene/lost_lights.hpp"

namespace q3rt {

struct RelightSettings {
    LuxelMapSettings luxels;
    int hemisphereRays = 96; ///< of each patch, for bounces and skies
    size_t openPoints = 6000;
    size_t budget = 256;     ///< point and spot lights at most
    double leastGain = 1e-4; ///< of the fit's cost, that a light must bring
    /// What light of value 1 costs, as a share of the cost of a map without any light: a light of value 300 has to
    /// explain three in ten thousand more than a weaker one that does as much.
    double price = 3e-7;
    double leastSunGain = 0.01; ///< of the fit's cost, that a sun must bring
};

struct RelightInput {
    RelightInput(const World& world, const MaterialLibrary& materials, const RelightSettings& settings);

    RelightSettings settings;
    LightScene scene;
    HemisphereRays rays;
    std::vector<LightColumn> kindColumns; ///< by kind, of radiosity 1, to any distance
    std::vector<LightEye> eyes;
    std::vector<bool> isShown; ///< by patch: somebody may see its luxels
    /// Irradiance over luxel: above 1 on maps that were compiled darker (their brightest luxel says so).
    float compensation = 1;
    vec3 floor{0};           ///< no luxel is below it (_minlight), as the lightmap has it
    vec3 ambient{0};         ///< light that is everywhere, as the map says (ambient)
    float ambientLimit = 0;  ///< the most of that: what the darkest luxels leave, or what the map says
    double price = 0;        ///< of a unit of intensity, in units of the fit's cost
    std::string fingerprint; ///< of the lightmap

    /// As kindColumns, where surfaces of such radiosity, by kind, give nothing that is as faint as that.
    std::vector<LightColumn> kindColumnsOf(const std::vector<float>& radiosities, float faintest) const;
    /// As the map compiler would have stored it.
    vec3 luxelOf(const vec3& irradiance) const;
    vec3 bakedIrradiance(size_t patch) const { return compensation * scene.luxels.patches[patch].baked; }
    std::vector<FitTarget> makeTargets() const;
    /// What the scripts and the map's entities say today.
    LostLights scripted() const;

  private:
    void findShown();
    void findAmbientLimit();
};

} // namespace q3rt
