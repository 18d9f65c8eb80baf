// Models that move keep their history: whole, or corner by corner.

#include <gtest/gtest.h>

#include "picture_tools.hpp"
#include "tests/scene/md3_builder.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::TestGame;
using test::TraceHarness;

constexpr int kWidth = 48, kHeight = 36; ///< pixels
constexpr int kFrameCount = 24;
constexpr float kScale = 24, kStepQu = 0.5f; ///< of the model; its motion in a frame
const Camera kCamera{.eye = {60, 60, 180}, .pitch = 89, .yaw = 0};

/// How the model gets from frame to frame.
enum class Motion { Whole, Corners, Restart };

class MovingModelTest : public testing::Test {
  protected:
    MovingModelTest() {
        std::vector<test::Md3TestFrame> poses(2);
        poses[1].height = kFrameCount * kStepQu / kScale;
        m_game.add("models/sheet.md3", test::buildMd3(poses, "textures/baseq3test/white.tga"));
    }
    /// A sheet that rises above the floor, `step` of kFrameCount steps from its start.
    refEntity_t sheetAt(int step, Motion motion) const {
        refEntity_t sheet{};
        sheet.reType = RT_MODEL;
        sheet.hModel = m_model;
        sheet.nonNormalizedAxes = 1;
        for (int i = 0; i < 3; ++i)
            sheet.axis[i][i] = kScale;
        sheet.origin[2] = 40;
        sheet.frame = 1;
        const float share = static_cast<float>(step) / kFrameCount;
        if (motion == Motion::Whole)
            sheet.origin[2] += kFrameCount * kStepQu * (share - 1);
        else
            sheet.backlerp = 1 - share;
        // Another shader every time: nobody the denoiser knows.
        if (motion == Motion::Restart) sheet.skinNum = step;
        return sheet;
    }
    FloatImage draw(const std::vector<std::pair<std::string, std::string>>& settings, Motion motion, int first,
                    int last, bool withSheet = true) {
        TraceHarness harness(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
        for (const auto& [name, value] : settings)
            harness.set(name, value);
        harness.loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
        harness.engine().enter(
            [this](const refexport_t& module) { m_model = module.RegisterModel("models/sheet.md3"); });
        for (int step = first;; ++step) {
            const int shown = std::min(step, kFrameCount);
            harness.setEntities(withSheet ? std::vector{sheetAt(shown, motion)} : std::vector<refEntity_t>{});
            if (step == last) return harness.radiance(kCamera, 1);
            harness.draw(kCamera, 1);
        }
    }
    TestGame m_game;
    qhandle_t m_model = 0;
};

TEST_F(MovingModelTest, KeepsItsHistory) {
    const FloatImage floorAlone = draw({}, Motion::Whole, 0, kFrameCount, false);
    double squares[3] = {};
    int count = 0;
    for (const Motion motion : {Motion::Whole, Motion::Corners, Motion::Restart}) {
        // Two runs that differ by their noise alone.
        const FloatImage a = draw({{"rt_seed", "1"}}, motion, 0, kFrameCount);
        const FloatImage b = draw({{"rt_seed", "2"}}, motion, 0, kFrameCount);
        count = 0;
        for (size_t i = 0; i < a.rgb.size(); i += 3) {
            // The sheet is nearer to the light.
            if (a.rgb[i] < 1.1f * floorAlone.rgb[i]) continue;
            squares[static_cast<size_t>(motion)] += std::pow(a.rgb[i] / b.rgb[i] - 1, 2) / 2;
            ++count;
        }
        ASSERT_GT(count, 300) << "pixels of the sheet";
    }
    const auto noiseOf = [&](Motion motion) { return std::sqrt(squares[static_cast<size_t>(motion)] / count); };
    std::printf("relative noise: moved whole %.4f, by corners %.4f, unknown %.4f\n", noiseOf(Motion::Whole),
                noiseOf(Motion::Corners), noiseOf(Motion::Restart));
    EXPECT_LT(noiseOf(Motion::Whole), 0.7 * noiseOf(Motion::Restart));
    EXPECT_LT(noiseOf(Motion::Corners), 0.7 * noiseOf(Motion::Restart));
    EXPECT_LT(noiseOf(Motion::Corners), 1.2 * noiseOf(Motion::Whole));
}

} // namespace
} // namespace q3rt
