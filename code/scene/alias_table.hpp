#pragma once
// One of n things with given probabilities in constant time (Walker 1974, "New fast method for generating discrete
// random numbers with arbitrary frequency distributions"; Vose 1991, "A linear algorithm for generating random numbers
// with a given distribution").

#include <cstdint>
#include <span>
#include <vector>

namespace q3rt {

/// A column is drawn uniformly; with `chance` it is the result, else `other` is.
struct AliasColumn {
    float chance = 1;
    uint32_t other = 0;
};

/// `weights` not negative, at least one positive.
std::vector<AliasColumn> buildAliasTable(std::span<const double> weights);

/// The probabilities that a table really has, rounded chances included.
std::vector<double> aliasProbabilities(std::span<const AliasColumn> columns);

} // namespace q3rt
