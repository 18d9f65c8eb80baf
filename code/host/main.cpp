// q3rt: play, record, replay, view, measure. Exit status 0: done; 1: failed, and one line on stderr said why; 2: bad
// arguments; 128 + signal: the user ended it.

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "host/commands.hpp"
#include "host/interrupt.hpp"

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
        return exitCode;
    } catch (const CLI::Success& request) { // --help and --version
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "q3rt: %s; see 'q3rt --help'\n", error.what());
        return 2;
    } catch (const q3rt::Interrupted& end) {
        return end.exitCode();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "q3rt: %s\n", error.what());
        return 1;
    }
}
