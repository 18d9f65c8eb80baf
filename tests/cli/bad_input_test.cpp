// What bad input gets: one line that names the file or device and the remedy, exit status 1 (2 for arguments), nothing
// left half-written. And `q3rt doctor` finds it beforehand.

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <sys/wait.h>

#include <gtest/gtest.h>

#include "bad_input.hpp"
#include "support/game_data.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

/// One way of being wrong. In `commands` each line is a command; IN is the folder of bad input, OUT one for results.
struct Situation {
    const char* name;
    std::vector<const char*> commands;
    const char *named, *remedy; ///< parts of the error line
    const char* doctor;         ///< arguments with which doctor reports a problem that holds `named`; or null
    bool needsEngine = false;   ///< some of the commands start it
    std::vector<std::string> environment = {};
    int exitCode = 1;
};

#define MAP_COMMANDS(game)                                                                                             \
    "view --basepath IN/" game " --map room_square_light --renderer null --size 64x48 --out OUT/a.png",                \
        "info --basepath IN/" game " --map room_square_light",                                                         \
        "relight --basepath IN/" game " --map room_square_light --out OUT",                                            \
        "subset --basepath IN/" game " --map room_square_light --out OUT/a.pk3",                                       \
        "trade --basepath IN/" game " --map room_square_light --smoke --out OUT/a.jsonl",                              \
        "play --basepath IN/" game " --map room_square_light --headless --frames 2 --renderer null --out OUT"
#define DEMO_COMMANDS(game)                                                                                            \
    "play --basepath IN/" game " --demo demo088-test1 --headless --renderer null --out OUT",                           \
        "record --basepath IN/" game " --demo demo088-test1 --out OUT/a.q3t"
#define RECORDING_COMMANDS(file)                                                                                       \
    "replay --basepath IN/good IN/" file " --renderer null --out OUT --stats OUT/a.jsonl",                             \
        "subset --basepath IN/good --trace IN/" file " --out OUT/a.pk3",                                               \
        "trade --basepath IN/good IN/" file " --smoke --out OUT/a.jsonl"

const std::vector<Situation> kSituations = {
    {"no_data",
     {MAP_COMMANDS("none"), DEMO_COMMANDS("none"), "replay --basepath IN/none IN/good.q3t --renderer null --out OUT"},
     "none/baseoa",
     "install openarena-data",
     "--basepath IN/none"},
    {"cut_archive",
     {MAP_COMMANDS("cut_archive"), DEMO_COMMANDS("cut_archive")},
     "cut_archive/baseoa/pak0.pk3",
     "get it again",
     "--basepath IN/cut_archive"},
    {"spoiled_entry",
     {MAP_COMMANDS("spoiled_entry")},
     "spoiled_entry/baseoa/pak0.pk3: maps/room_square_light.bsp",
     "get it again",
     "--basepath IN/spoiled_entry --deep"},
    {"cut_map",
     {MAP_COMMANDS("cut_map")},
     "maps/room_square_light.bsp",
     "get it again",
     "--basepath IN/cut_map --map room_square_light"},
    {"hostile_map",
     {MAP_COMMANDS("hostile_map")},
     "maps/room_square_light.bsp",
     "get it again",
     "--basepath IN/hostile_map --map room_square_light"},
    {"empty_map",
     {MAP_COMMANDS("empty_map")},
     "maps/room_square_light.bsp",
     "get it again",
     "--basepath IN/empty_map --map room_square_light"},
    {"missing_map",
     {"view --basepath IN/good --map nosuch --renderer null --out OUT/a.png", "info --basepath IN/good --map nosuch",
      "relight --basepath IN/good --map nosuch --out OUT", "subset --basepath IN/good --map nosuch --out OUT/a.pk3",
      "trade --basepath IN/good --map nosuch --smoke --out OUT/a.jsonl",
      "play --basepath IN/good --map nosuch --headless --frames 2 --renderer null --out OUT"},
     "maps/nosuch.bsp",
     "choose another --map",
     "--basepath IN/good --map nosuch"},
    {"missing_demo",
     {DEMO_COMMANDS("good")},
     "demo088-test1",
     "there are: none",
     "--basepath IN/good --demo demo088-test1"},
    {"cut_recording", {RECORDING_COMMANDS("cut.q3t")}, "cut.q3t", "q3rt record", "--recording IN/cut.q3t"},
    {"spoiled_recording",
     {RECORDING_COMMANDS("spoiled.q3t")},
     "spoiled.q3t",
     "q3rt record",
     "--recording IN/spoiled.q3t"},
    {"empty_recording", {RECORDING_COMMANDS("empty.q3t")}, "empty.q3t", "q3rt record", "--recording IN/empty.q3t"},
    {"no_recording", {RECORDING_COMMANDS("text.q3t")}, "text.q3t", "q3rt record", "--recording IN/text.q3t"},
    {"missing_recording", {RECORDING_COMMANDS("nosuch.q3t")}, "nosuch.q3t", "", "--recording IN/nosuch.q3t"},
    {"no_driver",
     {"view --basepath IN/good --map room_square_light --renderer vk --out OUT/a.png",
      "view --basepath IN/good --map room_square_light --renderer rt --out OUT/a.exr",
      "replay --basepath IN/good IN/good.q3t --renderer vk --out OUT",
      "trade --basepath IN/good --map room_square_light --smoke --out OUT/a.jsonl"},
     "VK_DRIVER_FILES=/nosuch.json",
     "correct or unset it",
     "",
     false,
     {"VK_DRIVER_FILES=/nosuch.json"}},
    {"no_driver_in_the_engine",
     {"play --demo demo088-test1 --headless --renderer vk --frames 2 --out OUT",
      "record --demo demo088-test1 --renderer rt --count 2 --out OUT/a.q3t"},
     "VK_DRIVER_FILES=/nosuch.json",
     "correct or unset it",
     "",
     true,
     {"VK_DRIVER_FILES=/nosuch.json"}},
    {"no_place_for_the_engines_home",
     {"play --demo demo088-test1 --headless --renderer null --frames 2 --out OUT",
      "record --demo demo088-test1 --count 2 --out OUT/a.q3t"},
     "no place for temporary files",
     "XDG_CACHE_HOME",
     "",
     true,
     {"HOME=", "XDG_CACHE_HOME="}},
    {"no_place_for_results",
     {"view --basepath IN/good --map room_square_light --renderer null --out /proc/nowhere/a.png",
      "subset --basepath IN/good --map room_square_light --out /proc/nowhere/a.pk3",
      "relight --basepath IN/good --map room_square_light --out /proc/nowhere",
      "trade --basepath IN/good --map room_square_light --smoke --out /proc/nowhere/a.jsonl",
      "replay --basepath IN/good IN/good.q3t --renderer null --out /proc/nowhere",
      "replay --basepath IN/good IN/good.q3t --renderer null --stats /proc/nowhere/a.jsonl",
      "compare IN/good.png IN/good.png --heatmap /proc/nowhere/a.png"},
     "/proc/nowhere",
     "choose a folder",
     "--out /proc/nowhere"},
    {"a_file_in_place_of_a_folder",
     {"view --basepath IN/good --map room_square_light --renderer null --out IN/good.png/a.png",
      "subset --basepath IN/good --map room_square_light --out IN/good.png/a.pk3",
      "relight --basepath IN/good --map room_square_light --out IN/good.png",
      "replay --basepath IN/good IN/good.q3t --renderer null --out IN/good.png"},
     "good.png",
     "choose a folder",
     "--out IN/good.png"},
    {"no_place_for_the_engines_results",
     {"play --demo demo088-test1 --headless --renderer null --frames 2 --out /proc/nowhere",
      "record --demo demo088-test1 --count 2 --out /proc/nowhere/a.q3t"},
     "/proc/nowhere",
     "choose a folder",
     nullptr,
     true},
    {"no_renderer",
     {"view --basepath IN/good --map room_square_light --renderer nosuch --out OUT/a.png",
      "replay --basepath IN/good IN/good.q3t --renderer nosuch --out OUT"},
     "renderer_nosuch_x86_64.so",
     "use rt, vk, or the path",
     nullptr},
    {"a_renderer_that_is_none",
     {"view --basepath IN/good --map room_square_light --renderer IN/good.png --out OUT/a.png",
      "replay --basepath IN/good IN/good.q3t --renderer IN/text.q3t --out OUT"},
     "not a renderer module",
     "",
     nullptr},
    {"missing_picture", {"compare IN/nosuch.png IN/good.png"}, "nosuch.png", "check the path", nullptr},
    {"cut_png", {"compare IN/good.png IN/cut.png"}, "cut.png", "", nullptr},
    {"cut_jpeg", {"compare IN/good.png IN/cut.jpg"}, "cut.jpg", "", nullptr},
    {"cut_tga", {"compare IN/good.png IN/cut.tga"}, "cut.tga", "", nullptr},
    {"cut_pfm", {"compare IN/good.png IN/cut.pfm"}, "cut.pfm", "", nullptr},
    {"no_exr", {"compare IN/good.png IN/text.exr"}, "text.exr", "", nullptr},
    {"sizes_differ", {"compare IN/good.png IN/small.png"}, "small.png", "compare pictures of one size", nullptr},
    {"frames_out_of_range",
     {"replay --basepath IN/good IN/good.q3t --renderer null --first 9 --out OUT",
      "replay --basepath IN/good IN/good.q3t --renderer null --first 1 --count 9 --out OUT",
      "replay --basepath IN/good IN/good.q3t --renderer null --first 1 --count 2147483647 --out OUT"},
     "good.q3t has world frames 0 to 3",
     "choose --first and --count",
     nullptr},
    {"the_recording_in_place_of_statistics",
     {"replay --basepath IN/good IN/good.q3t --renderer null --stats IN/good.q3t --out OUT"},
     "good.q3t",
     "choose another --stats",
     nullptr},
    {"a_device_in_place_of_a_recording",
     {"record --demo demo088-test1 --count 2 --out /dev/null"},
     "/dev/null",
     "name a regular file",
     nullptr,
     true},
    {"a_device_in_place_of_a_picture", {"compare IN/good.png /dev/zero"}, "/dev/zero", "check the path", nullptr},
    {"no_such_place",
     {"view --basepath IN/good --map room_square_light --renderer null --at spawn:99 --out OUT/a.png",
      "trade --basepath IN/good --map room_square_light --smoke --at spawn:99 --out OUT/a.jsonl"},
     "--at",
     "",
     nullptr},
    {"bad_arguments",
     {"",
      "nosuch",
      "view",
      "view --map a",
      "view --map a --out a.gif",
      "view --map a --out a.png --size 0x0",
      "view --map a --out a.png --size 3x4097",
      "view --map a --out a.png --size 4294967936x480",
      "view --map a --out a.png --size +640x480",
      "view --map a --out a.png --at spawn:4294967296",
      "view --map a --out a.png --at spawn:-1",
      "view --map a --out a.png --frames 0",
      "view --map a --out a.png --time 9999999999",
      "view --map a --out a.png --fov nan",
      "view --map a --out a.png --fov 90,5",
      "view --map a --out a.png --at nowhere",
      "view --map a --out a.png --set novalue",
      "replay",
      "replay a.q3t --count 0",
      "replay a.q3t --every 0",
      "replay a.q3t --accumulate 0",
      "replay a.q3t --warmup -1",
      "record",
      "record --demo a",
      "record --demo a --out a.q3t --count 0",
      "record --demo a --out a.q3t --first 2000000000",
      "play --demo a --map b",
      "play --demo a --relight",
      "play --frames 0",
      "play --headless --frames 2",
      "play --every 0",
      "play --map a --timedemo",
      "compare a.png",
      "compare a.png b.png --ppd 0",
      "compare a.png b.png --ppd nan",
      "compare a.png b.png --heatmap c.jpg",
      "trade --out a.jsonl",
      "trade a.q3t",
      "trade --map a --out a.jsonl --axis nonsense",
      "trade --map a --out a.jsonl --axis size=0x1",
      "trade --map a --out a.jsonl --axis rt_preset=fast,nice",
      "trade --map a --out a.jsonl --at spawn:0..4000000000",
      "trade --map a --out a.jsonl --frames 1",
      "trade a.q3t --out a.jsonl --at spawn:0",
      "trade --map a --out a.jsonl --clock sun",
      "trade --map a --out a.jsonl --shard 0/4294967297",
      "trade --map a --out a.jsonl --shard 0/-2",
      "trade --map a --out a.jsonl --axis frames=4294967297",
      "info",
      "info --map a --all",
      "info --map a --points 1",
      "relight",
      "relight --map a --all",
      "relight --map a --budget -1",
      "subset --out a.pk3",
      "subset --map a --trace b --out c",
      "doctor --nosuch"},
     "q3rt: ",
     "",
     nullptr,
     false,
     {},
     2},
};

std::vector<std::string> wordsOf(std::string text, const fs::path& in, const fs::path& out) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) {
        for (const auto& [mark, folder] : {std::pair{"IN", in}, {"OUT", out}})
            if (word == mark || word.starts_with(std::string(mark) + "/"))
                word.replace(0, std::string(mark).size(), folder.string());
        words.push_back(word);
    }
    return words;
}

class BadInput : public testing::TestWithParam<Situation> {
  protected:
    static void SetUpTestSuite() {
        s_in = makeScratchFolder("bad_input");
        makeBadInput(s_in);
    }
    static inline fs::path s_in;
};

TEST_P(BadInput, GetsOneLineAndLeavesNothing) {
    const Situation& situation = GetParam();
    if (situation.needsEngine && (!findGameFolder() || !fs::exists("/usr/lib/ioquake3/ioquake3")))
        GTEST_SKIP() << kNoGameData;
    const fs::path out = makeScratchFolder("bad_results") / "new";
    for (const char* command : situation.commands) {
        SCOPED_TRACE(command);
        const ProgramResult result = runQ3rt(wordsOf(command, s_in, out), situation.environment);
        EXPECT_EQ(result.exitCode, situation.exitCode) << result.errors;
        EXPECT_TRUE(result.saysInOneLine(situation.named)) << result.errors;
        EXPECT_NE(result.errors.find(situation.remedy), std::string::npos) << result.errors;
        EXPECT_EQ(result.errors.find("q3rt: "), 0u) << result.errors;
        EXPECT_FALSE(fs::exists(out)) << fs::directory_iterator(out)->path();
    }
}

TEST(BadArguments, AreAnsweredWithTheCommandsOwnHelp) {
    EXPECT_NE(runQ3rt({"view"}).errors.find("see 'q3rt view --help'"), std::string::npos);
    EXPECT_NE(runQ3rt({"nosuch"}).errors.find("'nosuch' is no command"), std::string::npos);
    for (const char* command :
         {"play", "record", "replay", "view", "compare", "trade", "info", "doctor", "relight", "subset"})
        EXPECT_NE(runQ3rt({command, "--help"}).output.find("Example: q3rt " + std::string(command)), std::string::npos)
            << command;
}

TEST(FullOutput, IsAFailure) {
    const fs::path in = makeScratchFolder("full_output");
    makeBadInput(in);
    const std::string picture = "'" + (in / "good.png").string() + "'", errors = (in / "errors").string();
    const std::string command =
        Q3RT_BUILD_DIR "/q3rt compare " + picture + " " + picture + " >/dev/full 2>'" + errors + "'";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    const std::vector<std::byte> text = readFile(errors);
    const std::string said(reinterpret_cast<const char*>(text.data()), text.size());
    EXPECT_EQ(said.find("q3rt: standard output can't be written: No space left"), 0u) << said;
}

TEST(MapName, MayBeItsFilesOrNearlyIt) {
    const fs::path in = makeScratchFolder("map_name");
    makeBadInput(in);
    const auto info = [&](const std::string& map) {
        return runQ3rt({"info", "--basepath", (in / "good").string(), "--map", map});
    };
    const ProgramResult plain = info(kBadMap);
    EXPECT_EQ(plain.exitCode, 0) << plain.errors;
    EXPECT_EQ(info(std::string("maps/") + kBadMap + ".bsp").output, plain.output);
    EXPECT_TRUE(info("rom_square_light").saysInOneLine("(did you mean room_square_light?)"));
}

TEST(OutputName, OfAFolderIsNoFile) {
    const fs::path in = makeScratchFolder("folder_name");
    makeBadInput(in);
    for (const std::string& out : {in.string(), in.string() + "/", in.string() + "/new/"}) {
        const ProgramResult result =
            runQ3rt({"subset", "--basepath", (in / "good").string(), "--map", kBadMap, "--out", out});
        EXPECT_EQ(result.exitCode, 1) << out;
        EXPECT_TRUE(result.saysInOneLine("name a file in it")) << result.errors;
    }
    EXPECT_FALSE(fs::exists(in / "new"));
}

class DoctorFinds : public BadInput {};

TEST_P(DoctorFinds, ItBeforehand) {
    const Situation& situation = GetParam();
    std::vector<std::string> words = wordsOf(situation.doctor, s_in, {});
    words.insert(words.begin(), "doctor");
    const ProgramResult result = runQ3rt(words, situation.environment);
    EXPECT_EQ(result.exitCode, 1) << result.output;
    bool isNamed = false;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);)
        isNamed = isNamed || (line.starts_with("problem") && line.find(situation.named) != std::string::npos);
    EXPECT_TRUE(isNamed) << result.output;
    EXPECT_TRUE(result.errors.empty()) << result.errors;
}

INSTANTIATE_TEST_SUITE_P(Situations, BadInput, testing::ValuesIn(kSituations),
                         [](const auto& info) { return std::string(info.param.name); });

/// Not arguments, but states of the machine.
std::vector<Situation> situationsOfTheMachine() {
    std::vector<Situation> chosen;
    std::copy_if(kSituations.begin(), kSituations.end(), std::back_inserter(chosen),
                 [](const Situation& situation) { return situation.doctor != nullptr; });
    return chosen;
}

INSTANTIATE_TEST_SUITE_P(Situations, DoctorFinds, testing::ValuesIn(situationsOfTheMachine()),
                         [](const auto& info) { return std::string(info.param.name); });

// In a running game a missing or damaged asset is a warning and the engine's default look.
TEST(BadContent, IsAWarningAndThePictureIsDrawn) {
    const fs::path in = makeScratchFolder("bad_content");
    makeBadInput(in);
    const fs::path out = makeScratchFolder("bad_content_results") / "a.png";
    const ProgramResult result = runQ3rt({"view", "--basepath", (in / "spoiled_content").string(), "--map", kBadMap,
                                          "--renderer", "vk", "--size", "64x48", "--verbose", "--out", out.string()});
    if (result.errors.find("no Vulkan d") != std::string::npos) GTEST_SKIP() << result.errors;
    EXPECT_EQ(result.exitCode, 0) << result.errors;
    EXPECT_NE(result.errors.find("grey.tga"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("zz.shader"), std::string::npos) << result.errors;
    EXPECT_TRUE(fs::exists(out));
    const ProgramResult brief = runQ3rt({"view", "--basepath", (in / "spoiled_content").string(), "--map", kBadMap,
                                         "--renderer", "vk", "--size", "64x48", "--out", out.string()});
    EXPECT_TRUE(brief.saysInOneLine("more: --verbose shows them)")) << brief.errors;
}

} // namespace
} // namespace q3rt::test
