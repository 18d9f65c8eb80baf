// q3rt doctor: prints what examineMachine found; exit 1 if play is impossible.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "host/commands/commands.hpp"
#include "host/common/json_text.hpp"
#include "host/common/session.hpp"
#include "host/inspect/doctor.hpp"

namespace q3rt {

namespace {

struct DoctorArguments {
    DoctorOptions options;
    bool json = false;
};

const char* nameFinding(Finding finding) {
    switch (finding) {
    case Finding::Good:
        return "ok";
    case Finding::Note:
        return "note";
    case Finding::Problem:
        return "problem";
    }
    return "";
}

void printText(const std::vector<Check>& checks) {
    for (const Check& check : checks) {
        std::printf("%-8s %-12s %s\n", nameFinding(check.finding), check.subject.c_str(), check.text.c_str());
        if (!check.remedy.empty()) std::printf("%-8s %-12s -> %s\n", "", "", check.remedy.c_str());
    }
    std::printf("%s\n", isPlayable(checks) ? "q3rt can play here." : "q3rt can't play here: see the problems above.");
}

void printJson(const std::vector<Check>& checks) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Check& check : checks)
        list.push_back({{"subject", check.subject},
                        {"finding", nameFinding(check.finding)},
                        {"text", check.text},
                        {"remedy", check.remedy}});
    const nlohmann::ordered_json report{{"playable", isPlayable(checks)}, {"checks", list}};
    std::printf("%s\n", toJsonText(report).c_str());
}

} // namespace

void addDoctorCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "doctor", "Say what this machine has and lacks: engine, game data, renderer modules, Vulkan devices; with the "
                  "command that gets what is missing");
    const auto arguments = std::make_shared<DoctorArguments>();
    DoctorOptions& options = arguments->options;
    addGameOptions(*command, options.game);
    CLI::Option* demo = command->add_option("--demo", options.demo, "A demo to look for")->capture_default_str();
    addMapOption(*command, options.map)->description("A map to load as a test");
    command->add_option("--recording", options.recording, "A recording (.q3t) to read whole");
    command->add_option("--out", options.outputFolder, "A folder to try to write into");
    command->add_flag("--deep", options.deep, "Read every file of every archive and check its sum");
    command->add_flag("--json", arguments->json, "One JSON object instead of text");
    command->footer("Example: q3rt doctor --basepath ~/quake3 --game baseq3 --map q3dm1");
    command->callback([arguments, demo, &exitCode] {
        arguments->options.demoNeeded = demo->count() > 0;
        const std::vector<Check> checks = examineMachine(arguments->options);
        arguments->json ? printJson(checks) : printText(checks);
        exitCode = isPlayable(checks) ? 0 : 1;
    });
}

} // namespace q3rt
