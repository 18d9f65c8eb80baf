// Drivers take much that the SPIR-V specification forbids, each something else: spirv-val reads all modules.

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

/// The numbers of an array as the shader compiler wrote it: `const uint32_t name[] = { 0x07230203, ... };`
std::vector<uint32_t> readWords(const std::string& file) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::vector<uint32_t> words;
    for (size_t at = text.find("0x"); at != std::string::npos; at = text.find("0x", at + 2))
        words.push_back(static_cast<uint32_t>(std::stoul(text.substr(at, 10), nullptr, 16)));
    return words;
}

TEST(Shaders, AreValid) {
    const std::filesystem::path folder = makeScratchFolder("spirv");
    const std::string module = (folder / "module.spv").string(), said = (folder / "said.txt").string();
    std::ifstream list(Q3RT_SHADER_ARRAY_LIST);
    size_t count = 0;
    for (std::string file; std::getline(list, file); ++count) {
        const std::vector<uint32_t> words = readWords(file);
        ASSERT_FALSE(words.empty()) << file;
        writeFile(module, {reinterpret_cast<const std::byte*>(words.data()),
                           reinterpret_cast<const std::byte*>(words.data() + words.size())});
        const std::string command =
            "spirv-val --target-env vulkan1.2 --scalar-block-layout '" + module + "' >'" + said + "' 2>&1";
        const int status = std::system(command.c_str());
        const std::vector<std::byte> text = readFile(said);
        EXPECT_EQ(status, 0) << file << ": " << std::string(reinterpret_cast<const char*>(text.data()), text.size());
    }
    EXPECT_GT(count, 0u);
}

} // namespace
} // namespace q3rt::test
