#include "engine_rig.hpp"

#include <cstdlib>
#include <fstream>
#include <sys/wait.h>

#include "base/error.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

constexpr const char *kEngine = "/usr/lib/ioquake3/ioquake3", *kGameBase = "/usr/lib/openarena";

/// The user's own, where the fetched driver and compiled shaders are.
fs::path userCache() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache && *cache) return cache;
    return fs::path(home ? home : "/") / ".cache";
}

} // namespace

std::string whyNoEngine(Display display) {
    if (!findGameFolder() || !fs::exists(kEngine) || !fs::exists(kGameBase)) return kNoGameData;
    if (display == Display::X11 && !fs::exists("/usr/bin/xvfb-run")) return "needs xvfb-run: install xvfb";
    return "";
}

EngineRig::EngineRig(const std::string& module, ModulePlace place, Display display)
    : m_folder(makeScratchFolder("engine"))
    , m_module(module)
    , m_place(place)
    , m_display(display) {
    fs::create_directories(m_folder / "home" / "baseoa");
    std::ofstream(file("autoexec.cfg")) << "set r_mode -1\nset r_customwidth " << kRigWidth << "\nset r_customheight "
                                        << kRigHeight << "\nset r_fullscreen 0\n";
    if (place != ModulePlace::BasePath) return;
    const std::string name = "renderer_" + module + "_x86_64.so";
    fs::create_directories(m_folder / "base");
    fs::create_symlink(fs::path(Q3RT_BUILD_DIR) / name, m_folder / "base" / name);
    fs::create_symlink(fs::path(kGameBase) / "baseoa", m_folder / "base" / "baseoa");
}

int EngineRig::run(const std::string& commands) {
    const bool besideName = m_place == ModulePlace::BesideName;
    std::ofstream(file("rig.cfg")) << commands << "\nquit\n";
    std::ofstream script(m_folder / "run.sh");
    script << "export HOME='" << (m_folder / "home").string() << "' XDG_CACHE_HOME='" << userCache().string() << "'\n"
           << "export SDL_VIDEODRIVER=" << (m_display == Display::X11 ? "x11" : "dummy")
           << " SDL_AUDIODRIVER=dummy\n"
           // Without a display also without a hint where the driver is: the module looks for it.
           << (m_display == Display::X11 ? "" : "unset VK_DRIVER_FILES VK_ADD_DRIVER_FILES VK_ICD_FILENAMES\n")
           << "exec -a '" << (besideName ? fs::path(Q3RT_BUILD_DIR) / "ioquake3" : fs::path(kEngine)).string() << "' "
           << kEngine << " +set com_basegame baseoa +set com_homepath .openarena +set com_legacyprotocol 71"
           << " +set com_protocol 71 +set cl_motd 0 +set ttycon 0 +set sv_pure 0 +set cl_renderer " << m_module
           << " +set fs_homepath '" << (m_folder / "home").string() << "' +set fs_basepath '"
           << (besideName ? fs::path(kGameBase) : m_folder / "base").string() << "' +exec rig.cfg\n";
    script.close();
    const fs::path log = m_folder / "console.txt";
    const std::string server = m_display == Display::X11 ? "xvfb-run -a -s '-screen 0 640x480x24' " : "";
    const std::string command = "timeout -k 5 300 " + server + "bash '" + (m_folder / "run.sh").string() +
                                "' </dev/null >'" + log.string() + "' 2>&1";
    const int status = std::system(command.c_str());
    const std::vector<std::byte> text = readFile(log);
    m_console.assign(reinterpret_cast<const char*>(text.data()), text.size());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Image EngineRig::picture(const std::string& name) const {
    const std::vector<std::byte> bytes = readFile(file(name));
    if (bytes.empty()) throw ContentError(name + " was not written");
    return decodeImage(bytes, name);
}

} // namespace q3rt::test
