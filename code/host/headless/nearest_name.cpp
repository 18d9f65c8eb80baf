#include "host/headless/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "formats/text_case.hpp"

namespace q3rt {
namespace {

/// Letters put in, left out or changed, at least (V. Levenshtein 1966), row by row.
size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i + 1);
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string hintAtNearest(const std::string& name, std::span<const std::string> names) {
    // A slip leaves two thirds of a name standing.
    size_t nearest = name.size() / 3 + 1;
    const std::string* found = nullptr;
    for (const std::string& candidate : names) {
        const size_t distance = editDistance(toLowerAscii(name), toLowerAscii(candidate));
        if (distance >= nearest) continue;
        nearest = distance;
        found = &candidate;
    }
    return found ? " (did you mean " + *found + "?)" : "";
}

} // namespace q3rt
