// The script language: tokens, what belongs to a keyword, what fails a definition, which definition wins.

#include <gtest/gtest.h>

#include "formats/shader_script.hpp"

namespace q3rt {
namespace {

struct Reported {
    std::string file;
    int line;
    std::string what;
};

struct Parsed {
    std::vector<ScriptDefinition> definitions;
    std::vector<Reported> reports;
};

Parsed parse(std::string_view text) {
    Parsed parsed;
    parsed.definitions =
        parseShaderScript(text, "scripts/a.shader", [&](std::string_view file, int line, std::string_view what) {
            parsed.reports.push_back({std::string(file), line, std::string(what)});
        });
    return parsed;
}

/// Parses one definition named "s" with this body.
ScriptDefinition parseOne(const std::string& body) {
    const Parsed parsed = parse("s\n{\n" + body + "\n}\n");
    EXPECT_EQ(parsed.definitions.size(), 1u) << body;
    return parsed.definitions.empty() ? ScriptDefinition{} : parsed.definitions[0];
}

using Words = std::vector<std::string>;

TEST(ScriptTokens, QuotesCommentsAndBytesAbove127SeparateWords) {
    std::string_view text = "a//x\n \"b // c\" /* d\n */ e\xe9"
                            "f (1)";
    int line = 1;
    Words words;
    while (const auto token = nextScriptToken(text, line, false))
        words.push_back(*token);
    // Read raw, a comment inside a word is part of it; only the merged text has such comments cut.
    EXPECT_EQ(words, (Words{"a//x", "b // c", "e", "f", "(1)"}));
    EXPECT_EQ(line, 3);
}

TEST(ScriptTokens, StayingOnTheLineEndsThere) {
    std::string_view text = "a b\nc";
    int line = 1;
    EXPECT_EQ(nextScriptToken(text, line, true), "a");
    EXPECT_EQ(nextScriptToken(text, line, true), "b");
    EXPECT_EQ(nextScriptToken(text, line, true), std::nullopt);
    EXPECT_EQ(nextScriptToken(text, line, true), "c");
    EXPECT_EQ(line, 2);
}

TEST(ScriptNumbers, LeadingNumberOrZeroAndAlwaysFinite) {
    const std::pair<const char*, float> cases[] = {
        {"1.5", 1.5f},
        {"-2", -2.0f},
        {"+3", 3.0f},
        {".5", 0.5f},
        {"1)", 1.0f},
        {"1e2x", 100.0f},
        {"x1", 0.0f},
        {"", 0.0f},
        {"-", 0.0f},
        {"nan", 0.0f},
        {"inf", 0.0f},
        {"-inf", 0.0f},
        {"1e-400", 0.0f},
        {"1e400", 3.4028235e38f},
        {"-1e400", -3.4028235e38f},
        {"1e39", 3.4028235e38f},
        {"5.", 5.0f},
    };
    for (const auto& [text, value] : cases)
        EXPECT_EQ(parseScriptNumber(text), value) << text;
}

TEST(ShaderScript, KeepsKeywordsStagesAndTheirOrder) {
    const Parsed parsed = parse("textures/A/b // comment\n{\n  SurfaceParm nomarks\n  {\n    MAP $lightmap\n    rgbGen "
                                "identity\n  }\n  nopicmip\n  {\n map a.tga\n blendFunc GL_ONE GL_ZERO }\n}\n");
    ASSERT_EQ(parsed.definitions.size(), 1u);
    const ScriptDefinition& s = parsed.definitions[0];
    EXPECT_EQ(s.name, "textures/A/b");
    EXPECT_EQ(s.file, "scripts/a.shader");
    EXPECT_EQ(s.line, 1);
    EXPECT_FALSE(s.failed);
    ASSERT_EQ(s.lines.size(), 2u);
    EXPECT_EQ(s.lines[0].keyword, "surfaceparm");
    EXPECT_EQ(s.lines[0].arguments, Words{"nomarks"});
    EXPECT_EQ(s.lines[0].line, 3);
    EXPECT_EQ(s.lines[1].keyword, "nopicmip");
    ASSERT_EQ(s.stages.size(), 2u);
    EXPECT_EQ(s.stageAfterLine, (std::vector<size_t>{1, 2}));
    EXPECT_EQ(s.stages[0].lines[1].arguments, Words{"identity"});
    EXPECT_EQ(s.stages[1].lines[1].keyword, "blendfunc");
    EXPECT_EQ(s.stages[1].lines[1].arguments, (Words{"GL_ONE", "GL_ZERO"}));
    EXPECT_TRUE(parsed.reports.empty());
}

TEST(ShaderScript, CommentsAreCutInsideWordsButNotInQuotes) {
    const ScriptDefinition s = parseOne("{\nmap t//red.tga\n}\n{\nmap \"t//red.tga\"\n}\n{\nmap a/* x */b\n}");
    ASSERT_EQ(s.stages.size(), 3u);
    EXPECT_EQ(s.stages[0].lines[0].arguments, Words{"t"});
    EXPECT_EQ(s.stages[1].lines[0].arguments, Words{"t//red.tga"});
    EXPECT_EQ(s.stages[2].lines[0].arguments, Words{"ab"});
}

TEST(ShaderScript, CarriageReturnsEndLines) {
    const ScriptDefinition s = parseOne("surfaceparm\rnopicmip\r{\rmap a\r}\r");
    EXPECT_FALSE(s.failed);
    ASSERT_EQ(s.lines.size(), 2u);
    EXPECT_TRUE(s.lines[0].arguments.empty());
}

TEST(ShaderScript, EachKeywordTakesItsOwnArguments) {
    struct Case {
        const char* body;
        Words arguments; ///< of the first general line
    };
    const Case cases[] = {
        {"qer_editorimage a b c", {"a", "b", "c"}},
        {"q3map_lightRGB 1 2 3", {"1", "2", "3"}},
        {"tessSize 64 x", {"64", "x"}},
        {"q3map_sun 1 1 1 100 90 45", {"1", "1", "1", "100", "90", "45"}},
        {"q3map_sunExt 1 1 1 100 90 45 2 16", {"1", "1", "1", "100", "90", "45", "2", "16"}},
        {"fogparms ( 1 .5 0 ) 300 x", {"(", "1", ".5", "0", ")", "300", "x"}},
        {"deformVertexes wave 100 sin 0 1 0 2", {"wave", "100", "sin", "0", "1", "0", "2"}},
        {"deformVertexes move 1 2 3 sin 0 1 0 2", {"move", "1", "2", "3", "sin", "0", "1", "0", "2"}},
        {"deformVertexes bulge 1 2 3", {"bulge", "1", "2", "3"}},
        {"deformVertexes normal 1 2", {"normal", "1", "2"}},
        {"deformVertexes autosprite2", {"autosprite2"}},
        {"skyparms env/a 512 -", {"env/a", "512", "-"}},
        {"light 1", {"1"}},
        {"clampTime 2", {"2"}},
        {"cull none", {"none"}},
        {"sort additive", {"additive"}},
        {"portal", {}},
        {"entityMergable", {}},
    };
    for (const Case& c : cases) {
        const ScriptDefinition s = parseOne(std::string(c.body) + "\nnomipmaps\n{\nmap a\n}");
        EXPECT_FALSE(s.failed) << c.body << ": " << s.failure;
        ASSERT_EQ(s.lines.size(), 2u) << c.body;
        EXPECT_EQ(s.lines[0].arguments, c.arguments) << c.body;
    }
}

TEST(ShaderScript, EachStageKeywordTakesItsOwnArguments) {
    struct Case {
        const char* line;
        Words arguments;
    };
    const Case cases[] = {
        {"map a", {"a"}},
        {"clampmap a", {"a"}},
        {"animMap 10 a b c", {"10", "a", "b", "c"}},
        {"videoMap a.roq", {"a.roq"}},
        {"alphaFunc GE128", {"GE128"}},
        {"depthFunc equal", {"equal"}},
        {"depthWrite", {}},
        {"detail", {}},
        {"blendFunc add", {"add"}},
        {"blendfunc gl_one gl_src_alpha", {"gl_one", "gl_src_alpha"}},
        {"rgbGen const ( 1 0 .5 )", {"const", "(", "1", "0", ".5", ")"}},
        {"rgbGen wave sin 0 1 0 2", {"wave", "sin", "0", "1", "0", "2"}},
        {"alphaGen const .5", {"const", ".5"}},
        {"alphaGen portal 512", {"portal", "512"}},
        {"alphaGen lightingSpecular", {"lightingSpecular"}},
        {"tcGen vector ( 1 0 0 ) ( 0 1 0 )", {"vector", "(", "1", "0", "0", ")", "(", "0", "1", "0", ")"}},
        {"texGen environment", {"environment"}},
        {"tcMod turb sin 0 0 0 0", {"turb", "sin", "0", "0", "0", "0"}},
        {"tcMod transform 1 2 3 4 5 6", {"transform", "1", "2", "3", "4", "5", "6"}},
    };
    for (const Case& c : cases) {
        const ScriptDefinition s = parseOne("{\n" + std::string(c.line) + "\ndepthWrite\n}");
        EXPECT_FALSE(s.failed) << c.line << ": " << s.failure;
        ASSERT_EQ(s.stages.size(), 1u) << c.line;
        ASSERT_EQ(s.stages[0].lines.size(), 2u) << c.line;
        EXPECT_EQ(s.stages[0].lines[0].arguments, c.arguments) << c.line;
    }
}

TEST(ShaderScript, MistakesThatFailTheDefinition) {
    const char* const bodies[] = {
        "nonsense 1\n{\nmap a\n}",
        "{\nmap a\nnonsense\n}",
        "cull none foo\n{\nmap a\n}",
        "sort 3 4\n{\nmap a\n}",
        "nomipmaps 1\n{\nmap a\n}",
        "fogparms (1 1 1) 300\n{\nmap a\n}",
        "{\nmap\n}",
        "{\nclampmap\n}",
        "{\nanimMap\n}",
        "{\nvideoMap\n}",
        "{\nalphaFunc\n}",
        "{\ndepthFunc\n}",
        "{\nrgbGen const (0.5 0.25 1)\n}",
        "{ }\n{ }\n{ }\n{ }\n{ }\n{ }\n{ }\n{ }\n{ }",
        "surfaceparm nomarks",
        "skyparms env/a 512",
    };
    for (const char* body : bodies) {
        const ScriptDefinition s = parseOne(body);
        EXPECT_TRUE(s.failed) << body;
        EXPECT_FALSE(s.failure.empty()) << body;
    }
}

TEST(ShaderScript, MistakesThatOnlyWarn) {
    const char* const bodies[] = {
        "surfaceparm unheardof\n{\nmap a\n}",
        "cull\n{\nmap a\n}",
        "cull front\n{\nmap a\n}",
        "fogparms ( 1 1 1 )\n{\nmap a\n}",
        "skyparms env/a\n{\nmap a\n}",
        "deformVertexes unheardof\n{\nmap a\n}",
        "{\nmap a\nrgbGen\n}",
        "{\nmap a\nrgbGen unheardof\n}",
        "{\nmap a\nblendFunc\n}",
        "{\nmap a\nblendFunc gl_one\n}",
        "{\nmap a\nrgbGen const ( 0.5 0.25 1)\n}",
        "{\nmap a\ntcMod unheardof 1 2 3\n}",
        "{\nmap a\ndepthFunc unheardof\n}",
        "surfaceparm fog",
        "skyparms - 512 -",
    };
    for (const char* body : bodies) {
        const ScriptDefinition s = parseOne(body);
        EXPECT_FALSE(s.failed) << body << ": " << s.failure;
    }
}

TEST(ShaderScript, StagesBeforeAFailureAreKept) {
    const ScriptDefinition s = parseOne("{\nmap a\n}\n{\nmap b\nnonsense\n}\n{\nmap c\n}");
    EXPECT_TRUE(s.failed);
    ASSERT_EQ(s.stages.size(), 2u);
    EXPECT_EQ(s.stages[1].lines.size(), 1u);
}

TEST(ShaderScript, AnUnknownKeywordIsReportedWithFileAndLine) {
    const Parsed parsed = parse("s\n{\n  {\n    map a\n    shine 3\n  }\n}\nt\n{\n  glow\n}\n");
    ASSERT_EQ(parsed.reports.size(), 2u);
    EXPECT_EQ(parsed.reports[0].file, "scripts/a.shader");
    EXPECT_EQ(parsed.reports[0].line, 5);
    EXPECT_NE(parsed.reports[0].what.find("'shine'"), std::string::npos);
    EXPECT_EQ(parsed.reports[1].line, 10);
    EXPECT_NE(parsed.reports[1].what.find("'glow'"), std::string::npos);
}

TEST(ShaderScript, TwoMissingArgumentsEatTheNextLine) {
    const ScriptDefinition s = parseOne("q3map_sun 1 1 1 100\nsurfaceparm sky\nnopicmip\n{\nmap a\n}");
    EXPECT_FALSE(s.failed) << s.failure;
    ASSERT_EQ(s.lines.size(), 2u);
    EXPECT_EQ(s.lines[0].arguments, (Words{"1", "1", "1", "100", "", "surfaceparm", "sky"}));
    EXPECT_EQ(s.lines[1].keyword, "nopicmip");
}

TEST(ShaderScript, AFourthDeformLeavesItsArgumentsUnread) {
    const std::string three = "deformVertexes autosprite\ndeformVertexes autosprite\ndeformVertexes autosprite\n";
    EXPECT_FALSE(parseOne(three + "deformVertexes autosprite\n{\nmap a\n}").failed);
    EXPECT_TRUE(parseOne(three + "deformVertexes bulge 1 2 3\n{\nmap a\n}").failed);
}

TEST(ShaderScript, AnUnbalancedFileGivesNothing) {
    for (const char* text : {"good\n{\n{\nmap a\n}\n}\nbad\n{\n{\nmap a\n}\n", "good\n{\n{\nmap a\n}\n}\nbad{\n}\n",
                             "good\n{\n{\nmap a\n}\n}\nbad\n"}) {
        const Parsed parsed = parse(text);
        EXPECT_TRUE(parsed.definitions.empty()) << text;
        ASSERT_EQ(parsed.reports.size(), 1u) << text;
        EXPECT_NE(parsed.reports[0].what.find("bad"), std::string::npos) << parsed.reports[0].what;
    }
}

TEST(ScriptLibrary, FirstInAFileAndLastFileWin) {
    ScriptLibrary library;
    library.addFile("Textures/X\n{\n{\nmap one\n}\n}\ntextures/x\n{\n{\nmap two\n}\n}\n", "high.shader", {});
    EXPECT_EQ(library.find("textures/x")->stages[0].lines[0].arguments[0], "one");
    library.addFile("TEXTURES/X\n{\n{\nmap three\n}\n}\ny.tga\n{\n{\nmap a\n}\n}\n", "low.shader", {});
    EXPECT_EQ(library.find("Textures/x")->stages[0].lines[0].arguments[0], "three");
    EXPECT_EQ(library.size(), 2u);
    EXPECT_EQ(library.find("y"), nullptr); // a label with an extension is never asked for
    EXPECT_EQ(library.find("textures\\x"), nullptr);
    ASSERT_EQ(library.all().size(), 2u);
    EXPECT_EQ(library.all()[0]->name, "TEXTURES/X");
}

} // namespace
} // namespace q3rt
