#include "host/packaged/engine_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.hpp"
#include "host/common/descriptor.hpp"
#include "host/common/interrupt.hpp"
#include "host/packaged/engine_console.hpp"
#include "host/packaged/engine_setup.hpp"
#include "host/packaged/kept_configuration.hpp"

extern char** environ;

namespace q3rt {
namespace {

namespace fs = std::filesystem;

/// The longest silence of a healthy headless run: a frame, or a map load with its shaders, on a slow machine. In a
/// window the player may stay in the menu for ever.
constexpr int kPatienceMs = 300'000, kForeverMs = -1;

/// A child process that doesn't outlive its owner.
class Child {
  public:
    Child(const EngineCommand& command, int outputFile, int socket);
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    /// Exit status, or 128 + signal.
    int wait();

  private:
    bool hasEnded();
    pid_t m_process = -1;
    int m_status = 0;
};

/// Asks politely first: the engine puts the screen back and stops the sound. A hung one is killed.
Child::~Child() {
    constexpr int kStepMs = 10, kMostMs = 5000;
    if (m_process <= 0) return;
    kill(m_process, SIGTERM);
    for (int waitedMs = 0; waitedMs < kMostMs; waitedMs += kStepMs) {
        if (hasEnded()) return;
        poll(nullptr, 0, kStepMs);
    }
    kill(m_process, SIGKILL);
    waitpid(m_process, &m_status, 0);
}

bool Child::hasEnded() { return waitpid(m_process, &m_status, WNOHANG) == m_process; }

int Child::wait() {
    while (waitpid(m_process, &m_status, 0) < 0 && errno == EINTR)
        throwIfInterrupted();
    m_process = -1;
    return WIFEXITED(m_status) ? WEXITSTATUS(m_status) : 128 + WTERMSIG(m_status);
}

Child::Child(const EngineCommand& command, int outputFile, int socket) {
    // Everything is allocated before the fork: the child may only make system calls.
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable) {
        const std::string_view text = *variable;
        bool replaced = false;
        for (const auto& [name, value] : command.environment)
            replaced = replaced || text.starts_with(name + "=");
        if (!replaced) variables.emplace_back(text);
    }
    for (const auto& [name, value] : command.environment)
        variables.push_back(name + "=" + value);
    variables.push_back(std::string(kWatchSocket) + "=" + std::to_string(socket));
    std::vector<char*> arguments, environment;
    for (const std::string& argument : command.arguments)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    for (std::string& variable : variables)
        environment.push_back(variable.data());
    arguments.push_back(nullptr);
    environment.push_back(nullptr);
    m_process = fork();
    if (m_process < 0) throw UsageError(formatText("the engine can't be started: %s", std::strerror(errno)));
    if (m_process > 0) return;
    prctl(PR_SET_PDEATHSIG, outputFile >= 0 ? SIGKILL : SIGTERM); // a window asks for an orderly end
    const int input = open("/dev/null", O_RDONLY);
    if (outputFile >= 0) {
        setpgid(0, 0); // the terminal's Ctrl-C is for us, who then end the engine
        dup2(input, STDIN_FILENO);
        dup2(outputFile, STDOUT_FILENO);
        dup2(outputFile, STDERR_FILENO);
    }
    fcntl(socket, F_SETFD, 0);
    execve(command.program.c_str(), arguments.data(), environment.data());
    _exit(127);
}

/// What the interposer sends.
class Stream {
  public:
    Stream(int socket, int patienceMs)
        : m_socket(socket)
        , m_patienceMs(patienceMs) {}
    /// False at the end of the stream. Throws when nothing comes for too long.
    bool receive(void* data, size_t bytes) const;

  private:
    int m_socket, m_patienceMs;
};

bool Stream::receive(void* data, size_t bytes) const {
    char* at = static_cast<char*>(data);
    while (bytes > 0) {
        throwIfInterrupted();
        pollfd waiting = {m_socket, POLLIN, 0};
        const int ready = poll(&waiting, 1, m_patienceMs);
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0)
            throw DeviceError(
                formatText("the engine gave no sign of life for %d s and was ended", m_patienceMs / 1000));
        const ssize_t got = read(m_socket, at, bytes);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        bytes -= static_cast<size_t>(got);
    }
    return true;
}

void receiveFrames(const Stream& stream, const std::function<void(const WatchedFrame&)>& onFrame) {
    WatchMessage message;
    while (stream.receive(&message, sizeof message)) {
        if (message.magic != WatchMessage::kMagic) throw DeviceError("the engine's frame reports are garbled");
        WatchedFrame frame;
        frame.frame = message.frame;
        frame.wallMs = message.wallMs;
        frame.text.resize(message.textBytes);
        std::vector<uint8_t> picture(message.pictureBytes);
        if (!stream.receive(frame.text.data(), frame.text.size()) || !stream.receive(picture.data(), picture.size()))
            return;
        frame.picture = frameFromVideo(message.width, message.height, picture);
        onFrame(frame);
    }
}

} // namespace

void runEngine(const EngineRun& run, const std::function<void(const WatchedFrame&)>& onFrame) {
    const RunFolder home(run.headless);
    std::optional<KeptConfiguration> kept; // until the engine has ended
    if (!run.headless) kept.emplace(home.path() / findInstallation(run.game).game, listSettings(run));
    const EngineCommand command = prepareEngine(run, home.path());
    const fs::path console = home.path() / "console.txt";
    Descriptor output(run.headless ? open(console.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644) : -1);
    int pair[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
        throw UsageError(formatText("the engine can't be started: %s", std::strerror(errno)));
    Descriptor theirs(pair[1]);
    Child child(command, output.number, theirs.number);
    Descriptor ours(pair[0]); // closed before the child is waited for: it may be writing
    theirs.reset();
    std::string cvars;
    const auto take = [&](const WatchedFrame& frame) {
        if (frame.frame == WatchMessage::kCvars)
            cvars = frame.text;
        else
            onFrame(frame);
    };
    if (run.watched) receiveFrames({ours.number, run.headless ? kPatienceMs : kForeverMs}, take);
    const int status = child.wait();
    const std::string said = run.headless ? readConsole(console) : std::string();
    const std::string error = findLastError(said);
    for (const auto& complaints : {listComplaints(said, run.cvars), listUndeclared(cvars, run.cvars)})
        for (const std::string& complaint : complaints)
            if (complaint != error) std::fprintf(stderr, "q3rt: %s\n", complaint.c_str());
    if (error.starts_with(kRecordingEnded)) throw UsageError(error.substr(std::strlen(kRecordingEnded)));
    if (!error.empty() || status != 0)
        throw DeviceError(formatText("the engine failed (status %d)%s%s; 'q3rt doctor' looks for the cause", status,
                                     error.empty() ? "" : ": ", error.c_str()));
}

} // namespace q3rt
