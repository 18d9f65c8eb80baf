#pragma once
// Shader scripts: text -> definitions, every keyword of the language kept, nothing interpreted beyond its own line.
// The rules of the tokeniser, of look-up order and of error tolerance are those that content was authored against.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace q3rt {

/// One keyword with the arguments of its line, in file order. Keyword lower case, arguments as written.
struct ScriptLine {
    std::string keyword;
    std::vector<std::string> arguments;
    int line = 0; ///< 1-based, in its file
};

struct ScriptStage {
    std::vector<ScriptLine> lines;
};

struct ScriptDefinition {
    std::string name; ///< as written
    std::string file;
    int line = 0;
    std::vector<ScriptLine> lines; ///< general keywords
    std::vector<ScriptStage> stages;
    /// Stages and general lines interleave; `stageAfterLine[i]` = how many general lines came before stage i
    /// (image flags depend on which of nomipmaps/nopicmip stood earlier in the text).
    std::vector<size_t> stageAfterLine;
    bool failed =
        false; ///< the engine's parser would have given up here: stages so far are kept, the shader is default
    std::string failure; ///< why
};

/// Called for each thing worth a warning: file, line, what. Unknown keywords are reported through it.
using ScriptReport = std::function<void(std::string_view file, int line, std::string_view what)>;

/// Parses one script file. An unbalanced file gives no definitions at all (the engine drops the whole file).
std::vector<ScriptDefinition> parseShaderScript(std::string_view text, std::string_view file,
                                                const ScriptReport& report);

/// The look-up that content relies on: files are added in the file system's listing order (highest priority pak first);
/// the file listed last wins between files, the first definition wins within one.
class ScriptLibrary {
  public:
    void addFile(std::string_view text, std::string_view file, const ScriptReport& report);
    /// `name` without extension, any case. nullptr if no script defines it.
    const ScriptDefinition* find(std::string_view name) const;
    size_t size() const { return m_byName.size(); }
    /// All winning definitions, sorted by name.
    std::vector<const ScriptDefinition*> all() const;

  private:
    std::unordered_map<std::string, ScriptDefinition> m_byName; ///< key lower case
};

/// One token of the engine's tokeniser (quotes, // and block comments); nullopt at the end. Advances `text`, counts
/// lines.
std::optional<std::string> nextScriptToken(std::string_view& text, int& line, bool stayOnLine);

/// C atof as the engine uses it: the leading number, 0 if none. Never NaN or infinite.
float parseScriptNumber(std::string_view token);

} // namespace q3rt
