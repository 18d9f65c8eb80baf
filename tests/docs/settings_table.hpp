#pragma once
// docs/settings.md from the settings lists.

#include <string>

namespace q3rt::test {

std::string renderSettingsPage();

} // namespace q3rt::test
