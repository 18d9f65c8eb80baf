#include "support/run_program.hpp"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sys/wait.h>
#include <unistd.h>

namespace q3rt::test {

namespace {

namespace fs = std::filesystem;

/// Removes everything at exit.
struct ScratchRoot {
    fs::path path = fs::temp_directory_path() / ("q3rt-cli-test." + std::to_string(getpid()));
    ScratchRoot() { fs::create_directories(path); }
    ~ScratchRoot() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

const fs::path& scratchRoot() {
    static const ScratchRoot root;
    return root.path;
}

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A process of q3rt whose output goes to files of its own.
class Process {
  public:
    Process(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
        std::vector<std::string> words = {"env"}, set; // env takes its options before its assignments
        for (const std::string& entry : environment) {
            if (!entry.ends_with('='))
                set.push_back(entry);
            else
                words.insert(words.end(), {"-u", entry.substr(0, entry.size() - 1)});
        }
        words.insert(words.end(), set.begin(), set.end());
        words.push_back(std::string(Q3RT_BUILD_DIR) + "/q3rt");
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& word : words)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const std::string output = m_output.string(), errors = m_errors.string();
        m_process = fork();
        if (m_process != 0) return;
        const auto redirect = [](const char* file, int flags, int number) {
            const int opened = open(file, flags, 0600);
            dup2(opened, number);
            close(opened);
        };
        redirect("/dev/null", O_RDONLY, STDIN_FILENO);
        redirect(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY, STDOUT_FILENO);
        redirect(errors.c_str(), O_CREAT | O_TRUNC | O_WRONLY, STDERR_FILENO);
        execvp("env", pointers.data());
        _exit(127);
    }
    void send(int signal) const { kill(m_process, signal); }
    bool hasEnded() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(m_process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
    }
    ProgramResult wait() {
        int status = 0;
        waitpid(m_process, &status, 0);
        ProgramResult result;
        if (WIFEXITED(status)) result.exitCode = WEXITSTATUS(status);
        result.output = readText(m_output);
        result.errors = readText(m_errors);
        return result;
    }

  private:
    const fs::path m_output = scratchRoot() / "stdout", m_errors = scratchRoot() / "stderr";
    pid_t m_process = -1;
};

} // namespace

bool ProgramResult::saysInOneLine(const std::string& part) const {
    return std::count(errors.begin(), errors.end(), '\n') == 1 && errors.ends_with('\n') &&
           errors.find(part) != std::string::npos;
}

ProgramResult runQ3rt(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
    return Process(arguments, environment).wait();
}

ProgramResult interruptQ3rt(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                            int signal, const std::function<bool()>& isUnderWay) {
    constexpr int kStepMs = 20, kMostMs = 60000;
    Process process(arguments, environment);
    for (int waitedMs = 0; waitedMs < kMostMs && !process.hasEnded() && !isUnderWay(); waitedMs += kStepMs)
        usleep(kStepMs * 1000);
    process.send(signal);
    return process.wait();
}

fs::path makeScratchFolder(const std::string& name) {
    const fs::path folder = scratchRoot() / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

std::vector<std::byte> readFile(const fs::path& path) {
    const std::string text = readText(path);
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

void writeFile(const fs::path& path, const std::vector<std::byte>& bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace q3rt::test
