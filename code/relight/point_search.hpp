#pragma once
// Point and spot lights that the map lost: found greedily where they improve the fit most (orthogonal matching pursuit
// with non-negative strengths; Pati, Rezaiifar and Krishnaprasad 1993), moved to their best places by Gauss-Newton
// steps, and dropped again where they turn out to explain nothing.

#include <functional>

#include "relight/light_eyes.hpp"
#include "relight/spot_cone.hpp"

namespace q3rt {

struct FoundLight {
    vec3 origin{0};
    LightCone cone;
    size_t source = 0;     ///< in the fit
    bool staysPut = false; ///< the map itself still has it
    LightColumn column;    ///< without its cone
    float faintest = 0;    ///< that the column was traced with
};

class PointSearch {
  public:
    /// `price`: of a unit of intensity, in the fit's cost.
    PointSearch(const LightScene& scene, const std::vector<LightEye>& eyes, LightFit& fit, double price);

    /// A light that is known already, with its strength.
    void addKnown(const vec3& origin, const LightCone& cone, const vec3& intensity, bool staysPut);
    /// Adds up to `count` lights; fewer when none is left that improves the fit by `leastGain` of its cost.
    /// `found` is told how many there are after each round.
    void add(size_t count, double leastGain, const std::function<void(size_t)>& found);
    /// Columns anew for lights whose strength, and with it their reach, is no longer what they were traced for.
    void retrace();
    /// One Gauss-Newton step for each light, kept where the fit improves.
    void refinePlaces();
    /// Cones for lights that shine one way only, and better ones for those that have some.
    void refineCones();
    /// Makes one of lights that are halves of one, and drops lights whose light others can give for no more than
    /// `leastGain` of the fit's cost.
    void prune(double leastGain);
    /// Adds what the lights give to other receivers than the fit's, traced anew.
    void addLightAt(const std::vector<LightReceiver>& receivers, std::vector<vec3>& irradiance) const;
    const std::vector<FoundLight>& lights() const { return m_lights; }

  private:
    struct Candidate {
        vec3 origin{0};
        size_t place = 0; ///< an eye's number, or their count + a patch's
        double gain = 0;
        LightColumn column{};
        LightCone cone{};
        float faintest = 0;
    };
    const LightScene& m_scene;
    const std::vector<LightEye>& m_eyes;
    LightFit& m_fit;
    double m_price;
    std::vector<int> m_restUntil; ///< by place: one that kept no promise is left alone for some rounds
    int m_round = 0;
    std::vector<FoundLight> m_lights;

    LightEye::Worth worthAt(const vec3& origin, const SeenResidual& seen) const;
    std::vector<Candidate> findCandidates(const SeenResidual& seen, double leastGain) const;
    void addEyes(const SeenResidual& seen, double leastGain, std::vector<Candidate>& candidates) const;
    void addPeaks(std::vector<Candidate>& candidates) const;
    void climb(Candidate& candidate, const SeenResidual& seen) const;
    bool take(Candidate& candidate, double leastGain);
    void rest(size_t place);
    /// Do others take over what the source gives, at a cost no more than `leastGain` above `cost`? Then they have.
    bool isTakenOver(size_t source, const std::vector<size_t>& heirs, double cost, double leastGain);
    /// Sources that light the same places.
    std::vector<size_t> heirsOf(size_t source) const;
    /// Makes one of two lights, between them, if that explains as much.
    bool mergeInto(FoundLight& light, const FoundLight& other, double leastGain);
    vec3 axisOf(const FoundLight& light) const;
};

} // namespace q3rt
