#pragma once
// Game content written in the test itself.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/file_source.hpp"
#include "math/vector.hpp"

namespace q3rt::test {

/// Files by exact name; listed in the order in which they were added.
class MemoryFiles : public FileSource {
  public:
    void add(std::string name, std::vector<std::byte> bytes) {
        m_files.emplace_back(std::move(name), std::move(bytes));
    }
    void addText(std::string name, std::string_view text);
    /// A 32-bit TGA; `pixel(x, y)` with y downwards.
    void addTga(std::string name, int width, int height, const std::function<U8vec4(int, int)>& pixel);
    void addTga(std::string name, U8vec4 color = U8vec4(255)) {
        addTga(std::move(name), 2, 2, [color](int, int) { return color; });
    }
    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override;

  private:
    std::vector<std::pair<std::string, std::vector<std::byte>>> m_files;
};

std::vector<std::byte> makeTga(int width, int height, const std::function<U8vec4(int, int)>& pixel);

} // namespace q3rt::test
