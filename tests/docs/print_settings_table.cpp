// Prints docs/settings.md: build/print_settings_table > docs/settings.md

#include <cstdio>

#include "settings_table.hpp"

int main() {
    std::fputs(q3rt::test::renderSettingsPage().c_str(), stdout);
    return 0;
}
