// What a player does in a session: menu, a map, screenshots, vid_restart, the next map, back to the menu, a cinematic,
// a demo, a video. Both modules, found in both ways, without a display and in a window, under validation.

#include <cmath>
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

#include "engine_rig.hpp"

namespace q3rt::test {
namespace {

/// To a map and back: what differs between a window and none.
const std::string kVisit = "wait 10\ngfxinfo\nscreenshotJPEG menu\nwait 5\n"
                           "devmap oa_bases3cl\nwait 60\nscreenshot first\nscreenshotJPEG levelshot\nwait 5\n"
                           "vid_restart\nwait 40\ngfxinfo\nscreenshotJPEG restarted\nwait 5\n"
                           "disconnect\nwait 20\nscreenshotJPEG disconnected\nwait 5\n";
const std::string kShows = "map fan\nwait 60\nscreenshotJPEG second\nwait 5\ndisconnect\nwait 5\n"
                           "cinematic idlogo.RoQ\nwait 40\nscreenshotJPEG cinematic\nwait 5\n"
                           "demo demo088-test1\nwait 80\nscreenshotJPEG demo\nwait 5\n"
                           "set cl_aviMotionJpeg 0\nvideo raw\nwait 10\nstopvideo\nwait 5\n"
                           "set cl_aviMotionJpeg 1\nvideo mjpeg\nwait 10\nstopvideo\nwait 5\n";

struct Start {
    const char* module;
    ModulePlace place;
    Display display;
};

struct Spread {
    double mean = 0, deviation = 0; ///< of green, of 255
};
Spread measureSpread(const Image& image) {
    Spread spread;
    double squares = 0;
    const double count = image.width * image.height;
    for (size_t i = 1; i < image.rgba.size(); i += 4) {
        spread.mean += image.rgba[i] / count;
        squares += image.rgba[i] * image.rgba[i] / count;
    }
    spread.deviation = std::sqrt(std::max(0.0, squares - spread.mean * spread.mean));
    return spread;
}

double meanDifference(const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.rgba.size(); ++i)
        sum += std::abs(a.rgba[i] - b.rgba.at(i));
    return sum / static_cast<double>(a.rgba.size());
}

size_t countOf(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

/// The video frames of an AVI file: chunks called "00dc" inside its list "movi".
std::vector<std::string> framesOfAvi(const std::string& file) {
    std::vector<std::string> frames;
    const size_t movie = file.find("movi");
    if (!file.starts_with("RIFF") || movie == std::string::npos) return frames;
    for (size_t at = movie + 4; at + 8 <= file.size();) {
        uint32_t bytes = 0;
        std::memcpy(&bytes, file.data() + at + 4, sizeof bytes);
        if (file.compare(at, 4, "idx1") == 0) break;
        if (file.compare(at, 4, "00dc") == 0) frames.push_back(file.substr(at + 8, bytes));
        at += 8 + (bytes + 1) / 2 * 2;
    }
    return frames;
}

class Tour : public testing::TestWithParam<Start> {};

void checkSomethingShown(const EngineRig& rig, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const Image image = rig.picture(std::string("screenshots/") + name);
        EXPECT_EQ(image.width, kRigWidth) << name;
        EXPECT_EQ(image.height, kRigHeight) << name;
        EXPECT_GT(measureSpread(image).deviation, 8) << name << " shows nothing";
    }
}

void checkVisit(const EngineRig& rig) {
    checkSomethingShown(rig, {"menu.jpg", "first.tga", "restarted.jpg", "disconnected.jpg"});
    const Image menu = rig.picture("screenshots/menu.jpg");
    EXPECT_LT(meanDifference(menu, rig.picture("screenshots/disconnected.jpg")), 20);
    EXPECT_GT(meanDifference(menu, rig.picture("screenshots/restarted.jpg")), 8);
    const Image levelshot = rig.picture("levelshots/oa_bases3cl.tga");
    EXPECT_EQ(levelshot.width, 128);
    EXPECT_EQ(levelshot.height, 128);
    EXPECT_GT(measureSpread(levelshot).deviation, 8);
}

void checkShows(const EngineRig& rig) {
    checkSomethingShown(rig, {"second.jpg", "demo.jpg"});
    // A black mark on white.
    const Spread cinematic = measureSpread(rig.picture("screenshots/cinematic.jpg"));
    EXPECT_GT(cinematic.mean, 60);
    EXPECT_GT(cinematic.deviation, 20);
}

void checkVideos(const EngineRig& rig) {
    const auto framesOf = [&](const char* name) {
        const std::vector<std::byte> bytes = readFile(rig.file(std::string("videos/") + name));
        return framesOfAvi({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    const std::vector<std::string> raw = framesOf("raw.avi"), jpeg = framesOf("mjpeg.avi");
    EXPECT_GE(raw.size(), 3u);
    for (const std::string& frame : raw)
        EXPECT_EQ(frame.size(), size_t{kRigWidth * kRigHeight * 3});
    ASSERT_GE(jpeg.size(), 3u);
    for (const std::string& frame : jpeg) {
        const Image image = decodeImage(std::as_bytes(std::span(frame)), "frame.jpg");
        EXPECT_EQ(image.width, kRigWidth);
        EXPECT_EQ(image.height, kRigHeight);
        EXPECT_GT(measureSpread(image).deviation, 8);
    }
}

TEST_P(Tour, ShowsAndWritesEverything) {
    const Start& start = GetParam();
    if (const std::string why = whyNoEngine(start.display); !why.empty()) GTEST_SKIP() << why;
    const bool isLong = start.display == Display::None || std::getenv("Q3RT_LONG_TESTS");
    setenv("Q3RT_VALIDATION", "1", 1);
    EngineRig rig(start.module, start.place, start.display);
    const int status = rig.run(isLong ? kVisit + kShows : kVisit);
    unsetenv("Q3RT_VALIDATION");
    if (rig.console().find("no Vulkan d") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(status, 0) << rig.console();
    EXPECT_EQ(countOf(rig.console(), std::string("q3rt renderer_") + start.module), 2u) << rig.console();
    EXPECT_EQ(countOf(rig.console(), "Vulkan validation"), 0u) << rig.console();
    checkVisit(rig);
    if (!isLong) return;
    checkShows(rig);
    checkVideos(rig);
}

INSTANTIATE_TEST_SUITE_P(Starts, Tour,
                         testing::Values(Start{"vk", ModulePlace::BesideName, Display::None},
                                         Start{"vk", ModulePlace::BasePath, Display::X11},
                                         Start{"rt", ModulePlace::BasePath, Display::None},
                                         Start{"rt", ModulePlace::BesideName, Display::X11}),
                         [](const auto& info) {
                             return std::string(info.param.module) +
                                    (info.param.display == Display::X11 ? "_window" : "_headless");
                         });

} // namespace
} // namespace q3rt::test
