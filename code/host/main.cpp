// q3rt: play, record, replay, view, measure. Exit status 0: done; 1: failed, and one line on stderr said why; 2: bad
// arguments; 128 + signal: the user ended it.

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>

#include "host/commands/commands.hpp"
#include "host/common/interrupt.hpp"

namespace {

/// "q3rt view" of a command line that names a command, else "q3rt".
std::string nameCommand(const CLI::App& app) {
    const auto commands = app.get_subcommands();
    return commands.empty() ? app.get_name() : app.get_name() + " " + commands.front()->get_name();
}

int refuse(const CLI::App& app, const CLI::ParseError& error, const char* firstArgument) {
    const bool isUnknown = app.get_subcommands().empty() && firstArgument != nullptr && *firstArgument != '-';
    const std::string problem = isUnknown                  ? "'" + std::string(firstArgument) + "' is no command"
                                : firstArgument == nullptr ? "a command is missing"
                                                           : error.what();
    std::fprintf(stderr, "q3rt: %s; see '%s --help'\n", problem.c_str(), nameCommand(app).c_str());
    return 2;
}

/// What was printed may be all that a command was called for.
int finishOutput(int exitCode) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exitCode;
    std::fprintf(stderr, "q3rt: standard output can't be written: %s; choose a place with space\n",
                 std::strerror(errno));
    return 1;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Ray-traced and rasterised Quake III: plays the packaged engine, records, replays and measures",
                 "q3rt");
    app.require_subcommand(1);
    app.set_version_flag("--version", "q3rt " Q3RT_VERSION);
    q3rt::watchForInterrupts();
    int exitCode = 1;
    q3rt::addDoctorCommand(app, exitCode);
    q3rt::addPlayCommand(app, exitCode);
    q3rt::addRecordCommand(app, exitCode);
    q3rt::addReplayCommand(app, exitCode);
    q3rt::addViewCommand(app, exitCode);
    q3rt::addCompareCommand(app, exitCode);
    q3rt::addTradeCommand(app, exitCode);
    q3rt::addInfoCommand(app, exitCode);
    q3rt::addRelightCommand(app, exitCode);
    q3rt::addSubsetCommand(app, exitCode);
    try {
        app.parse(argc, argv);
        return finishOutput(exitCode);
    } catch (const CLI::Success& request) { // --help and --version
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        return refuse(app, error, argv[1]);
    } catch (const q3rt::Interrupted& end) {
        return end.exitCode();
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "q3rt: not enough memory; choose a smaller --size or a smaller input\n");
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "q3rt: %s\n", error.what());
        return 1;
    }
}
