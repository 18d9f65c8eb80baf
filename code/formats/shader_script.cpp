#include "formats/shader_script.hpp"

#include <algorithm>
#include <span>
#include <unordered_set>

#include "base/error.hpp"
#include "formats/script_keywords.hpp"
#include "formats/script_tokens.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

// Limits of the language itself: content was authored against them, and exceeding one changes what a script means.
constexpr size_t kMaxStages = 8;
constexpr size_t kMaxDeforms = 3;

/// Reads keywords across lines and arguments within one.
class TokenCursor {
  public:
    explicit TokenCursor(std::span<const ScriptToken> tokens)
        : m_tokens(tokens) {}

    int line() const {
        if (m_tokens.empty()) return 0;
        return m_tokens[std::min(m_next, m_tokens.size() - 1)].line;
    }

    /// The next token on any line, or an empty word at the end.
    std::string keyword() {
        m_lineLeft = false;
        return m_next < m_tokens.size() ? m_tokens[m_next++].text : std::string();
    }

    /// The next word of this line, or an empty one. Asking for a missing word moves on to the next line, so that asking
    /// again reads from there: lines with two arguments missing lose words of the next line, as they always did.
    std::string argument() {
        if (m_next >= m_tokens.size()) return {};
        if (m_tokens[m_next].firstOnLine && !m_lineLeft) {
            m_lineLeft = true;
            return {};
        }
        m_lineLeft = false;
        return m_tokens[m_next++].text;
    }

    void appendRestOfLine(std::vector<std::string>& arguments) {
        while (m_next < m_tokens.size() && (m_lineLeft || !m_tokens[m_next].firstOnLine)) {
            m_lineLeft = false;
            arguments.push_back(m_tokens[m_next++].text);
        }
    }

  private:
    std::span<const ScriptToken> m_tokens;
    size_t m_next = 0;
    bool m_lineLeft = false;
};

/// Parses the body of one definition, from behind its opening brace to its closing one.
class DefinitionParser {
  public:
    DefinitionParser(std::span<const ScriptToken> body, ScriptDefinition& definition, const ScriptReport& report)
        : m_cursor(body)
        , m_definition(definition)
        , m_report(report) {}

    void parse() {
        if (parseGeneral()) checkStages();
    }

  private:
    bool fail(int line, std::string why) {
        m_definition.failed = true;
        m_definition.failure = std::move(why);
        if (m_report) m_report(m_definition.file, line, "shader " + m_definition.name + ": " + m_definition.failure);
        return false;
    }

    void warn(const ScriptLine& line, std::string_view what) {
        if (!m_report) return;
        m_report(m_definition.file, line.line,
                 "shader " + m_definition.name + ": " + line.keyword + ": " + std::string(what));
    }

    bool parseGeneral() {
        while (true) {
            const int lineNumber = m_cursor.line();
            const std::string word = m_cursor.keyword();
            if (word.empty()) return fail(lineNumber, "no closing brace");
            if (word[0] == '}') return true;
            if (word[0] == '{') {
                if (!parseStage(lineNumber)) return false;
                continue;
            }
            ScriptLine line{toLowerAscii(word), {}, lineNumber};
            const auto shape = findGeneralKeyword(line.keyword);
            if (!shape) return fail(lineNumber, "unknown keyword '" + word + "'");
            const bool complete = readArguments(*shape, line);
            m_definition.lines.push_back(std::move(line));
            if (!complete) return false;
        }
    }

    bool parseStage(int openingLine) {
        if (m_definition.stages.size() == kMaxStages) return fail(openingLine, "more than 8 stages");
        m_definition.stageAfterLine.push_back(m_definition.lines.size());
        ScriptStage& stage = m_definition.stages.emplace_back();
        while (true) {
            const int lineNumber = m_cursor.line();
            const std::string word = m_cursor.keyword();
            if (word.empty()) return fail(lineNumber, "a stage has no closing brace");
            if (word[0] == '}') return true;
            ScriptLine line{toLowerAscii(word), {}, lineNumber};
            const auto shape = findStageKeyword(line.keyword);
            if (!shape) return fail(lineNumber, "unknown stage keyword '" + word + "'");
            const bool complete = readArguments(*shape, line);
            stage.lines.push_back(std::move(line));
            if (!complete) return false;
        }
    }

    /// A definition that draws nothing fails unless it is a sky or a fog. No warning: tool shaders (caulk, clip and so
    /// on) are written like that on purpose.
    void checkStages() {
        if (!m_definition.stages.empty()) return;
        for (const ScriptLine& line : m_definition.lines) {
            if (line.keyword == "skyparms" && line.arguments.size() == 3) return;
            if (line.keyword == "surfaceparm" && !line.arguments.empty() &&
                equalsIgnoringCase(line.arguments[0], "fog"))
                return;
        }
        m_definition.failed = true;
        m_definition.failure = "no stage, and neither a sky nor a fog";
    }

    /// Reads one argument. False (after a warning) if the line has no more.
    bool readOne(ScriptLine& line) {
        std::string word = m_cursor.argument();
        if (word.empty()) {
            warn(line, "an argument is missing");
            return false;
        }
        line.arguments.push_back(std::move(word));
        return true;
    }

    bool readCount(ScriptLine& line, int count) {
        for (int i = 0; i < count; ++i) {
            if (!readOne(line)) return false;
        }
        return true;
    }

    /// "( x y z )", each parenthesis a word of its own; a missing last one spoils nothing but the return value.
    bool readVector(ScriptLine& line) {
        if (!readOne(line)) return false;
        if (line.arguments.back() != "(") {
            warn(line, "a vector must start with '(' as a word of its own");
            return false;
        }
        if (!readCount(line, 3) || !readOne(line)) return false;
        if (line.arguments.back() == ")") return true;
        warn(line, "a vector must end with ')' as a word of its own");
        return false;
    }

    /// Function word, base, amplitude, phase, frequency.
    void readWave(ScriptLine& line) { readCount(line, 5); }

    void readDeform(ScriptLine& line) {
        if (!readOne(line)) return;
        const auto isDeform = [](const ScriptLine& other) {
            return other.keyword == "deformvertexes" && !other.arguments.empty();
        };
        const auto& lines = m_definition.lines;
        if (static_cast<size_t>(std::count_if(lines.begin(), lines.end(), isDeform)) >= kMaxDeforms) {
            warn(line, "only the first 3 deforms count");
            return;
        }
        const std::string kind = toLowerAscii(line.arguments[0]);
        if (kind == "bulge") readCount(line, 3);
        if (kind == "normal") readCount(line, 2);
        if (kind == "wave" && readOne(line)) readWave(line);
        if (kind == "move" && readCount(line, 3)) readWave(line);
    }

    void readGenerator(ArgumentShape shape, ScriptLine& line) {
        if (!readOne(line)) return;
        const std::string kind = toLowerAscii(line.arguments[0]);
        if (shape == ArgumentShape::TcGen) {
            if (kind == "vector" && readVector(line)) readVector(line);
            return;
        }
        if (kind == "wave") readWave(line);
        if (shape == ArgumentShape::RgbGen && kind == "const") readVector(line);
        if (shape == ArgumentShape::AlphaGen && (kind == "const" || kind == "portal")) readOne(line);
    }

    void readBlendFunc(ScriptLine& line) {
        if (!readOne(line)) return;
        const std::string word = toLowerAscii(line.arguments[0]);
        if (word != "add" && word != "filter" && word != "blend") readOne(line);
    }

    void readSun(ScriptLine& line) {
        for (int i = 0; i < 6; ++i)
            line.arguments.push_back(m_cursor.argument());
        m_cursor.appendRestOfLine(line.arguments);
        if (std::find(line.arguments.begin(), line.arguments.end(), "") != line.arguments.end())
            warn(line, "needs red green blue intensity degrees elevation");
    }

    /// False if the definition fails here.
    bool readArguments(ArgumentShape shape, ScriptLine& line) {
        switch (shape) {
        case ArgumentShape::None:
            return true;
        case ArgumentShape::One:
            readOne(line);
            return true;
        case ArgumentShape::OneRequired:
            if (readOne(line)) return true;
            return fail(line.line, line.keyword + " has no argument");
        case ArgumentShape::RestOfLine:
            m_cursor.appendRestOfLine(line.arguments);
            return true;
        case ArgumentShape::RestOfLineNeedOne:
            m_cursor.appendRestOfLine(line.arguments);
            if (!line.arguments.empty()) return true;
            return fail(line.line, line.keyword + " has no argument");
        case ArgumentShape::Sun:
            readSun(line);
            return true;
        case ArgumentShape::SkyParms:
            readCount(line, 3);
            return true;
        case ArgumentShape::FogParms:
            if (!readVector(line)) return fail(line.line, "fogparms needs ( red green blue ) depth");
            if (readOne(line)) m_cursor.appendRestOfLine(line.arguments);
            return true;
        case ArgumentShape::Deform:
            readDeform(line);
            return true;
        case ArgumentShape::BlendFunc:
            readBlendFunc(line);
            return true;
        case ArgumentShape::RgbGen:
        case ArgumentShape::AlphaGen:
        case ArgumentShape::TcGen:
            readGenerator(shape, line);
            return true;
        }
        return true;
    }

    TokenCursor m_cursor;
    ScriptDefinition& m_definition;
    const ScriptReport& m_report;
};

/// +1, -1 or 0: only a token that is exactly one brace counts when definitions are told apart.
int braceDepthChange(std::string_view token) { return token == "{" ? 1 : token == "}" ? -1 : 0; }

/// The check that decides whether a file is used at all: { name, "{", ... matching "}" }. Returns why not, or nothing.
std::optional<std::string> findImbalance(std::string_view text, int& line) {
    while (true) {
        const auto name = nextScriptToken(text, line, false);
        if (!name || name->empty()) return std::nullopt;
        const int nameLine = line;
        if (nextScriptToken(text, line, false) != "{") return "no opening brace behind the name " + *name;
        int depth = 1;
        while (depth > 0) {
            const auto token = nextScriptToken(text, line, false);
            if (!token) {
                line = nameLine;
                return "no closing brace for the definition of " + *name;
            }
            depth += braceDepthChange(*token);
        }
    }
}

} // namespace

std::vector<ScriptDefinition> parseShaderScript(std::string_view text, std::string_view file,
                                                const ScriptReport& report) {
    int line = 1;
    if (const auto why = findImbalance(text, line)) {
        if (report) report(file, line, *why + "; the whole file is ignored");
        return {};
    }
    std::vector<ScriptDefinition> definitions;
    const std::vector<ScriptToken> tokens = tokenizeScript(text);
    size_t next = 0;
    while (next + 1 < tokens.size() && !tokens[next].text.empty()) {
        ScriptDefinition& definition = definitions.emplace_back();
        definition.name = tokens[next].text;
        definition.file = file;
        definition.line = tokens[next].line;
        const size_t bodyStart = next + 2;
        int depth = 0;
        size_t end = next + 1;
        do
            depth += braceDepthChange(tokens[end++].text);
        while (depth > 0 && end < tokens.size());
        const std::span<const ScriptToken> body(tokens.begin() + static_cast<long>(bodyStart),
                                                tokens.begin() + static_cast<long>(std::max(end, bodyStart)));
        DefinitionParser(body, definition, report).parse();
        next = end;
    }
    return definitions;
}

void ScriptLibrary::addFile(std::string_view text, std::string_view file, const ScriptReport& report) {
    std::unordered_set<std::string> definedHere;
    for (ScriptDefinition& definition : parseShaderScript(text, file, report)) {
        std::string key = toLowerAscii(definition.name);
        if (definedHere.insert(key).second) m_byName[std::move(key)] = std::move(definition);
    }
}

const ScriptDefinition* ScriptLibrary::find(std::string_view name) const {
    const auto found = m_byName.find(toLowerAscii(name));
    return found == m_byName.end() ? nullptr : &found->second;
}

std::vector<const ScriptDefinition*> ScriptLibrary::all() const {
    std::vector<std::pair<std::string_view, const ScriptDefinition*>> sorted;
    sorted.reserve(m_byName.size());
    for (const auto& [key, definition] : m_byName)
        sorted.emplace_back(key, &definition);
    std::sort(sorted.begin(), sorted.end());
    std::vector<const ScriptDefinition*> definitions;
    definitions.reserve(sorted.size());
    for (const auto& entry : sorted)
        definitions.push_back(entry.second);
    return definitions;
}

} // namespace q3rt
