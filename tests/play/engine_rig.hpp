#pragma once
// The packaged engine as a user starts it: a script of console commands, the console's text, the pictures it wrote.

#include <string>
#include <vector>

#include "formats/image.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {

inline constexpr int kRigWidth = 160, kRigHeight = 120;

/// How the engine finds a module that is not installed.
enum class ModulePlace {
    BesideName, ///< in the folder that the program's name claims
    BasePath    ///< in fs_basepath, with the game's folder beside it
};
enum class Display { None, X11 };

/// Engine, game data and, for X11, Xvfb are installed; else why not.
std::string whyNoEngine(Display display);

class EngineRig {
  public:
    EngineRig(const std::string& module, ModulePlace place, Display display);
    /// Console commands, one a line, executed after the start. Returns the exit status; 124 after five minutes.
    int run(const std::string& commands);
    const std::string& console() const { return m_console; }
    std::filesystem::path file(const std::string& name) const { return m_folder / "home" / "baseoa" / name; }
    /// A picture that was written. Throws ContentError if it isn't there.
    Image picture(const std::string& name) const;

  private:
    std::filesystem::path m_folder;
    std::string m_module, m_console;
    ModulePlace m_place;
    Display m_display;
};

} // namespace q3rt::test
