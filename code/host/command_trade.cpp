// q3rt trade: what each setting costs and what error it buys.

#include <memory>

#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "host/commands.hpp"

namespace q3rt {

void addTradeCommand(CLI::App& app, int& exitCode) {
    CLI::App* command =
        app.add_subcommand("trade", "Measure speed against error over settings (comes in a later version)");
    command->allow_extras();
    command->callback([&exitCode]() -> void {
        exitCode = 1;
        throw UsageError("trade comes in a later version; until then use 'q3rt replay --stats' and 'q3rt compare'");
    });
}

} // namespace q3rt
