#pragma once
// An engine for one renderer in a test: files from the search path, cvars in a map, no window.

#include <map>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "engine/services.hpp"
#include "formats/pk3_file_source.hpp"

namespace q3rt::test {

class TestCvar final : public Cvar {
  public:
    explicit TestCvar(std::string text)
        : m_text(std::move(text)) {}
    std::string_view string() const override { return m_text; }
    float value() const override { return std::strtof(m_text.c_str(), nullptr); }
    int integer() const override { return static_cast<int>(std::strtol(m_text.c_str(), nullptr, 10)); }
    bool takeModified() override { return false; }
    void set(std::string_view text) { m_text = text; }

  private:
    std::string m_text;
};

class TestServices final : public EngineServices {
  public:
    explicit TestServices(FileSource& files)
        : m_files(files) {}

    std::optional<std::vector<std::byte>> read(std::string_view name) override { return m_files.read(name); }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return m_files.list(directory, extension);
    }
    void print(LogLevel, std::string_view line) override { printed.emplace_back(line); }
    int milliseconds() override { return clockMs; }
    Cvar& cvar(std::string_view name, std::string_view defaultValue, int) override {
        auto& slot = m_cvars[std::string(name)];
        if (!slot) slot = std::make_unique<TestCvar>(std::string(defaultValue));
        return *slot;
    }
    void describeCvar(std::string_view, std::string_view) override {}
    void limitCvar(std::string_view, float, float, bool) override {}
    void setCvar(std::string_view name, std::string_view value) override {
        auto& slot = m_cvars[std::string(name)];
        if (!slot) slot = std::make_unique<TestCvar>("");
        slot->set(value);
    }
    void addCommand(std::string_view name, void (*function)()) override { commands[std::string(name)] = function; }
    void removeCommand(std::string_view name) override { commands.erase(std::string(name)); }
    std::vector<std::string> commandArguments() override { return arguments; }
    void executeText(std::string_view) override {}
    void writeFile(std::string_view name, std::span<const std::byte> bytes) override {
        written[std::string(name)].assign(bytes.begin(), bytes.end());
    }
    bool fileExists(std::string_view name) override { return written.contains(std::string(name)); }
    int playCinematic(std::string_view, int, int, int, int, int) override { return -1; }
    int runCinematic(int) override { return 0; }
    void uploadCinematic(int) override {}
    void writeVideoFrame(std::span<const uint8_t> bytes) override { video.assign(bytes.begin(), bytes.end()); }
    bool wantsWindow() override { return false; }
    void inputInit(void*) override {}
    void inputShutdown() override {}
    void inputRestart() override {}

    int clockMs = 1000;
    std::map<std::string, void (*)()> commands;
    std::vector<std::string> arguments, printed;
    std::map<std::string, std::vector<std::byte>> written;
    std::vector<uint8_t> video; ///< bottom-up BGR rows, padded to 4 bytes

  private:
    FileSource& m_files;
    std::map<std::string, std::unique_ptr<TestCvar>> m_cvars;
};

} // namespace q3rt::test
