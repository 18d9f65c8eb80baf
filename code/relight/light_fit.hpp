#pragma once
// Non-negative strengths of sources that explain light at patches: weighted least squares, made robust by iterated
// weights (Huber 1964) and by counting a saturated patch only as a lower bound. Coordinate descent: each strength in
// turn takes its best value for the residual of the others; the residual is kept current. Channels are independent.
// A strength may have a price (the lasso; Tibshirani 1996): of sources that explain the same, the weakest is taken.

#include "relight/light_columns.hpp"

namespace q3rt {

struct FitTarget {
    vec3 light{0};        ///< to be explained, luxel units
    float weight = 0;     ///< area; 0: no part of the fit
    float tolerance = 1;  ///< a residual that says nothing, luxel units
    bool atLeast = false; ///< saturated: only too little light counts
    bool atMost = false;  ///< at the map's floor: only too much light counts
};

class LightFit {
  public:
    explicit LightFit(std::vector<FitTarget> targets);

    /// Adds a source with strength 0; its number. `price`: of a unit of strength, in units of the cost.
    size_t add(LightColumn column, double price = 0);
    void removeLast();
    void replaceColumn(size_t source, LightColumn column);
    void setStrength(size_t source, const vec3& strength);
    /// Strengths of this source stay at or below this.
    void setLimit(size_t source, float limit) { m_sources[source].limit = limit; }
    void setTargetLight(size_t patch, const vec3& light);

    /// Robust weights from the residual as it is.
    void reweigh();
    /// One round over all strengths; by how much they moved, as a share of all light.
    double sweep();
    /// Rounds until nothing moves by more than a thousandth, weights renewed a few times.
    void solve(int reweighings);
    /// Best strengths of some sources for what the others leave, nearly.
    void settleAmong(const std::vector<size_t>& sources);
    /// How alike two sources light the patches: cosine of their columns, by weight.
    double likeness(size_t a, size_t b) const;
    size_t sourceCount() const { return m_sources.size(); }
    /// Best strength of one source alone.
    vec3 bestStrength(size_t source) const;
    /// What a source with this column and price would take off the cost; it is not in the fit.
    double gainOf(const LightColumn& column, double price) const;

    const LightColumn& column(size_t source) const { return m_sources[source].column; }
    const vec3& strength(size_t source) const { return m_sources[source].strength; }
    /// Light to be explained less what the sources give.
    const std::vector<vec3>& residual() const { return m_residual; }
    const std::vector<FitTarget>& targets() const { return m_targets; }
    /// What a residual at the patch counts now, per luxel unit squared, channel by channel; 0 where it does not.
    vec3 weightAt(size_t patch) const;
    /// Weighted squares of the residual and twice all prices.
    double cost() const;

  private:
    struct Source {
        LightColumn column;
        vec3 strength{0};
        float limit;
        double price;
        bool meetsOneSided; ///< its column has patches that count on one side only
    };
    std::vector<FitTarget> m_targets;
    std::vector<Source> m_sources;
    std::vector<vec3> m_residual;
    std::vector<float> m_robust; ///< weight / tolerance^2 x Huber's factor

    struct Slope {
        dvec3 gradient{0}, square{0};
    };
    /// Of the cost, were a source with this column stronger by `more`.
    Slope slopeOf(const LightColumn& column, const vec3& more = vec3(0)) const;
    vec3 weightAt(size_t patch, const vec3& residual) const;
};

} // namespace q3rt
