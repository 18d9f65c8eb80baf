#pragma once
// What this machine has and lacks for playing, recording and replaying, each with the command that gets it.

#include <string>
#include <vector>

#include "host/common/installation.hpp"

namespace q3rt {

enum class Finding { Good, Note, Problem }; ///< Problem: play is impossible as asked

struct Check {
    std::string subject; ///< such as "engine"
    Finding finding = Finding::Good;
    std::string text;   ///< what was found
    std::string remedy; ///< what to do about it; empty where nothing is wrong
};

struct DoctorOptions {
    GameChoice game;
    std::string demo = "demo088-test1"; ///< to look for; empty: none
    bool demoNeeded = false;            ///< its absence is a problem
    std::string map;                    ///< to load; empty: none
    std::string recording;              ///< to read whole; empty: none
    std::string outputFolder;           ///< to try to write into; empty: none
    bool deep = false;                  ///< read every file of every archive and check its sum
};

std::vector<Check> examineMachine(const DoctorOptions& options);
bool isPlayable(const std::vector<Check>& checks);

} // namespace q3rt
