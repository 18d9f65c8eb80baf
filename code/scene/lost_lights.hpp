#pragma once
// lights/MAP.ent: the light that a map lost, in the words of map makers (docs/lost_light.md). An entity lump with a
// worldspawn, whose keys are those of the shader scripts, and light entities. What it says replaces what scripts and
// the map's own lump say; what it leaves out stays.

#include <string>
#include <string_view>
#include <vector>

#include "scene/lights.hpp"

namespace q3rt {

struct LostLights {
    /// q3map_surfacelight or q3map_skylight of one script, as its surfaces had it when the map was baked.
    struct Strength {
        std::string material;
        float value = 0;
        vec3 color{1}; ///< largest component 1
    };
    std::string lightmap;      ///< of which bake it is, see lightmapFingerprint()
    float compensate = 1;      ///< the bake was divided by this at the end (q3map2 -compensate)
    float faintest = 0;        ///< what a point light gives to a place is left out at or below this, luxel units
    float faintestSurface = 0; ///< the same of a triangle of a surface that shines
    float bounce = 0;       ///< of physics' diffuse bounces, what the bake had; the renderer has it from the light grid
    size_t stage = 0;       ///< of work that was broken off: stages done; 0: finished
    size_t budget = 0;      ///< of that work: lights that it may find
    float ambientValue = 0; ///< the same everywhere
    vec3 ambientColor{1};
    vec3 floor{0}; ///< no luxel is below it
    std::vector<Strength> surfaceLights, skyLights;
    std::vector<SunLight> suns;     ///< all that the map has
    std::vector<PointLight> points; ///< all that the map has
};

/// 16 hexadecimal digits that differ for every bake.
std::string lightmapFingerprint(const Bsp& bsp);

std::string formatLostLights(const LostLights& lights, std::string_view map);
/// `name` is used in messages. Throws ContentError with the line of the first thing that is wrong.
LostLights parseLostLights(std::string_view text, std::string_view name);
/// Puts what the file says in place of what the scripts say. What it says is dark is no light any more.
void applyLostLights(const LostLights& lost, const World& world, const MaterialLibrary& materials, LightSet& lights);

} // namespace q3rt
