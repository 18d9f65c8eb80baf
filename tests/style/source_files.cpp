#include "source_files.hpp"

#include <algorithm>
#include <fstream>

namespace q3rt::test {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders[] = {"code",        "renderer_vk", "renderer_rt", "shaders", "tests",
                                    "baseq3-test", "cmake",       "scripts",     ".ci"};
constexpr const char* kExtensions[] = {".cpp",  ".hpp",   ".h",     ".c",     ".glsl", ".vert",  ".frag", ".comp",
                                       ".rgen", ".rchit", ".rahit", ".rmiss", ".rint", ".cmake", ".sh",   ".txt"};

bool isSource(const fs::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".txt") return path.filename() == "CMakeLists.txt";
    return extension.empty()
               ? path.parent_path().filename() == ".ci"
               : std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions);
}

SourceFile loadFile(const fs::path& path, const fs::path& root) {
    SourceFile file{fs::relative(path, root).generic_string(), {}};
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);)
        file.lines.push_back(line);
    return file;
}

/// The text with comments and the inside of literals made blank; lines keep their numbers.
std::string blankOut(const SourceFile& file) {
    enum class In { Code, LineComment, BlockComment, String, Character } in = In::Code;
    std::string text;
    for (const std::string& line : file.lines) {
        for (size_t i = 0; i < line.size(); ++i) {
            const char c = line[i], next = i + 1 < line.size() ? line[i + 1] : '\0';
            const char before = i > 0 ? line[i - 1] : '\0';
            const In was = in;
            if (in == In::Code) {
                if (c == '/' && next == '/')
                    in = In::LineComment;
                else if (c == '/' && next == '*')
                    in = In::BlockComment;
                else if (c == '"')
                    in = In::String;
                else if (c == '\'' && !isalnum(static_cast<unsigned char>(before)))
                    in = In::Character;
            } else if (in == In::BlockComment) {
                if (c == '/' && before == '*') in = In::Code;
            } else if ((in == In::String && c == '"') || (in == In::Character && c == '\'')) {
                in = In::Code;
            } else if (in != In::LineComment && c == '\\') {
                text += ' ';
                ++i;
            }
            text += was == In::Code && in == In::Code ? c : ' ';
        }
        if (in == In::LineComment || (in == In::String && !line.ends_with('\\'))) in = In::Code;
        text += '\n';
    }
    return text;
}

enum class Scope { Namespace, Type, Function, Data };

bool hasWord(const std::string& text, const std::string& word) {
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const auto isPart = [&](size_t i) {
            return i < text.size() && (isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_');
        };
        if ((at == 0 || !isPart(at - 1)) && !isPart(at + word.size())) return true;
    }
    return false;
}

/// What a brace opens, from the text since the last one or semicolon.
Scope classify(const std::string& header) {
    if (hasWord(header, "namespace") || hasWord(header, "extern")) return Scope::Namespace;
    const bool hasParentheses = header.find('(') != std::string::npos;
    if (!hasParentheses &&
        (hasWord(header, "struct") || hasWord(header, "class") || hasWord(header, "union") || hasWord(header, "enum")))
        return Scope::Type;
    const size_t last = header.find_last_not_of(" \n\t");
    if (last != std::string::npos && header[last] == '=') return Scope::Data;
    return hasParentheses || last == std::string::npos ? Scope::Function : Scope::Data;
}

std::string lastLine(const std::string& header) {
    const size_t end = header.find_last_not_of(" \n\t");
    if (end == std::string::npos) return "";
    const size_t start = header.rfind('\n', end);
    return header.substr(start == std::string::npos ? 0 : start + 1,
                         end - (start == std::string::npos ? 0 : start + 1) + 1);
}

} // namespace

std::vector<SourceFile> loadSourceFiles() {
    const fs::path root = Q3RT_SOURCE_DIR;
    std::vector<SourceFile> files;
    for (const char* name : {"run", "test", "CMakeLists.txt"})
        if (fs::exists(root / name)) files.push_back(loadFile(root / name, root));
    for (const char* folder : kFolders)
        if (fs::exists(root / folder))
            for (const auto& entry : fs::recursive_directory_iterator(root / folder))
                if (entry.is_regular_file() && isSource(entry.path())) files.push_back(loadFile(entry.path(), root));
    std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    return files;
}

std::vector<FunctionSize> measureFunctions(const SourceFile& file) {
    const std::string text = blankOut(file);
    struct Open {
        Scope scope;
        size_t line;
        std::string header;
    };
    std::vector<Open> open;
    std::vector<FunctionSize> functions;
    std::string header;
    size_t line = 1;
    for (const char c : text) {
        if (c == '\n') ++line;
        if (c == '{') {
            open.push_back({classify(header), line, lastLine(header)});
            header.clear();
        } else if (c == '}' && !open.empty()) {
            const Open closed = open.back();
            open.pop_back();
            const bool nested =
                std::any_of(open.begin(), open.end(), [](const Open& o) { return o.scope == Scope::Function; });
            if (closed.scope == Scope::Function && !nested)
                functions.push_back({closed.header, closed.line, line - closed.line + 1});
            header.clear();
        } else if (c == ';') {
            header.clear();
        } else {
            header += c;
        }
    }
    return functions;
}

} // namespace q3rt::test
