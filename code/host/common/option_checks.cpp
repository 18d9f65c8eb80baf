#include "host/common/option_checks.hpp"

#include <cmath>

#include "host/common/number_text.hpp"

namespace q3rt {
namespace {

template <class Number>
bool isWithin(const std::string& text, Number least, Number most) {
    const auto value = parseNumber<Number>(text);
    return value && *value >= least && *value <= most;
}

} // namespace

OptionCheck wholeNumber(long long least, long long most) {
    return [=](const std::string& text) {
        if (isWithin(text, least, most)) return std::string();
        return formatText("'%s': write a whole number from %lld to %lld", text.c_str(), least, most);
    };
}

OptionCheck number(double least, double most) {
    return [=](const std::string& text) {
        if (isWithin(text, least, most)) return std::string();
        if (std::isinf(most)) return formatText("'%s': write a number of %g or more", text.c_str(), least);
        return formatText("'%s': write a number from %g to %g", text.c_str(), least, most);
    };
}

} // namespace q3rt
