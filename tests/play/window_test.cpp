// What happens to a window during play: full screen and back, minimised, waiting for the display, another renderer
// start; under validation.

#include <gtest/gtest.h>

#include "engine_rig.hpp"

namespace q3rt::test {

TEST(Window, LivesThroughItsChanges) {
    if (const std::string why = whyNoEngine(Display::X11); !why.empty()) GTEST_SKIP() << why;
    setenv("Q3RT_VALIDATION", "1", 1);
    EngineRig rig("vk", ModulePlace::BesideName, Display::X11);
    const int status =
        rig.run("wait 10\nset r_fullscreen 1\nwait 10\nset r_fullscreen 0\nwait 10\nscreenshotJPEG back\n"
                "wait 5\nminimize\nwait 10\nmodelist\nset r_swapInterval 1\nset r_allowResize 1\n"
                "set r_display 7\nset r_device llvmpipe\nset r_ext_multisample 4\nvid_restart\nwait 20\n"
                "gfxinfo\nscreenshotJPEG again\nwait 5\n");
    unsetenv("Q3RT_VALIDATION");
    if (rig.console().find("no Vulkan d") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(status, 0) << rig.console();
    for (const char* picture : {"screenshots/back.jpg", "screenshots/again.jpg"}) {
        EXPECT_EQ(rig.picture(picture).width, kRigWidth) << picture;
        EXPECT_EQ(rig.picture(picture).height, kRigHeight) << picture;
    }
    const std::string& console = rig.console();
    for (const char* line : {"Mode  3: 640x480", "r_display 7: there is no such display", "asked for as \"llvmpipe\"",
                             "4 samples each", "a frame a refresh"})
        EXPECT_NE(console.find(line), std::string::npos) << line << "\n" << console;
    EXPECT_EQ(console.find("Vulkan validation"), std::string::npos) << console;
}

} // namespace q3rt::test
