#include <cmath>

#include "formats/shader_script.hpp"
#include "fuzz_input.hpp"

using namespace q3rt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const std::string_view text = fuzz::asText(data, size);
        const ScriptReport report = [](std::string_view file, int line, std::string_view what) {
            fuzz::require(!file.empty() && line >= 0 && !what.empty());
        };
        ScriptLibrary library;
        library.addFile(text, "input.shader", report);
        for (const ScriptDefinition* definition : library.all()) {
            fuzz::require(definition->stages.size() == definition->stageAfterLine.size());
            fuzz::require(definition->failed == !definition->failure.empty());
            for (const ScriptLine& line : definition->lines) {
                for (const std::string& argument : line.arguments)
                    fuzz::require(std::isfinite(parseScriptNumber(argument)));
            }
        }
        std::string_view rest = text;
        int line = 1;
        while (nextScriptToken(rest, line, line % 2 == 0) || !rest.empty())
            fuzz::require(rest.size() <= text.size());
    });
}
