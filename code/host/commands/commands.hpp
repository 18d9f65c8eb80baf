// The subcommands of q3rt. Each adds itself to the program's command line with a callback that does the work and stores
// the exit code: 0 done, 1 failed (one line on stderr said why). Bad arguments are 2, decided by the dispatcher.
// A callback may throw ContentError, DeviceError or UsageError: the dispatcher prints the message as that one line.
#pragma once

namespace CLI {
class App;
}

namespace q3rt {

void addPlayCommand(CLI::App& app, int& exitCode);
void addRecordCommand(CLI::App& app, int& exitCode);
void addReplayCommand(CLI::App& app, int& exitCode);
void addViewCommand(CLI::App& app, int& exitCode);
void addCompareCommand(CLI::App& app, int& exitCode);
void addTradeCommand(CLI::App& app, int& exitCode);
void addInfoCommand(CLI::App& app, int& exitCode);
void addDoctorCommand(CLI::App& app, int& exitCode);
void addRelightCommand(CLI::App& app, int& exitCode);
void addSubsetCommand(CLI::App& app, int& exitCode);

} // namespace q3rt
