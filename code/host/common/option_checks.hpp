#pragma once
// What an option's value must be. A wrong one gets a line that says what to write instead, and exit status 2.

#include <functional>
#include <limits>
#include <string>

#include "base/error.hpp"

namespace q3rt {

/// As CLI::Option::check takes it: what is wrong with a text, or nothing.
using OptionCheck = std::function<std::string(const std::string& text)>;

OptionCheck wholeNumber(long long least, long long most = std::numeric_limits<int>::max());
OptionCheck number(double least, double most = std::numeric_limits<double>::infinity());

/// What `parse` says of a text by throwing UsageError.
template <class Parse>
OptionCheck checkedBy(Parse parse) {
    return [parse](const std::string& text) {
        try {
            parse(text);
            return std::string();
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
    };
}

} // namespace q3rt
