#pragma once
// The game folder of baseq3-test in memory, with files added by a test.

#include <map>

#include "base/file_source.hpp"
#include "baseq3-test/test_maps.hpp"

namespace q3rt::test {

class TestGame : public FileSource {
  public:
    TestGame() {
        for (auto& [name, bytes] : buildTestGameFiles())
            m_files[name] = std::move(bytes);
    }
    void add(const std::string& name, std::vector<std::byte> bytes) { m_files[name] = std::move(bytes); }
    void addText(const std::string& name, std::string_view text) {
        const auto* data = reinterpret_cast<const std::byte*>(text.data());
        add(name, {data, data + text.size()});
    }
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        const auto found = m_files.find(std::string(name));
        if (found == m_files.end()) return std::nullopt;
        return found->second;
    }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        std::vector<std::string> names;
        for (const auto& [name, bytes] : m_files)
            if (name.starts_with(std::string(directory) + "/") && name.ends_with(extension))
                names.push_back(name.substr(directory.size() + 1));
        return names;
    }

  private:
    std::map<std::string, std::vector<std::byte>> m_files;
};

} // namespace q3rt::test
