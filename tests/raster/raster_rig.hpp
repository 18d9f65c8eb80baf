#pragma once
// The rasteriser in a test: its messages in reach, frames as bytes.

#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include "formats/image.hpp"
#include "gpu/device.hpp"
#include "raster/test_services.hpp"
#include "renderer_vk/vk_renderer.hpp"

namespace q3rt::test {

inline constexpr int kWidth = 320, kHeight = 240;

/// The rasteriser with its messages in reach.
class TestRenderer final : public GpuRenderer {
  public:
    using GpuRenderer::GpuRenderer;
    std::vector<std::string> messages() { return *context().device().validationMessages(); }
    const World* map() const { return world(); }
    size_t pipelineCount() { return raster().pipelineCount(); }

  private:
    void drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                       const SceneView& scene) override {
        raster().addView(graph, targets, frame, scene, drawListSettings(), "world view");
    }
    const char* backendName() const override { return "raster"; }
    const char* rendererName() const override { return "test"; }
};

/// Draws what was asked for. Rows top first, RGB.
inline std::vector<uint8_t> endFrame(TestRenderer& renderer, TestServices& services) {
    renderer.takeVideoFrame(kWidth, kHeight, nullptr, nullptr, false);
    renderer.endFrame();
    std::vector<uint8_t> rgb;
    for (int y = kHeight - 1; y >= 0; --y) {
        for (int x = 0; x < kWidth; ++x) {
            const size_t at = static_cast<size_t>(y * kWidth + x) * 3;
            rgb.insert(rgb.end(), {services.video[at + 2], services.video[at + 1], services.video[at]});
        }
    }
    return rgb;
}

/// One frame: the view, and a picture of the console font over it; for each eye, or both at once. Rows top first, RGB.
inline std::vector<uint8_t> drawFrame(TestRenderer& renderer, TestServices& services, const SceneView& view, int shader,
                                      std::initializer_list<int> eyes = {0}) {
    for (const int eye : eyes) {
        renderer.beginFrame(eye);
        renderer.clearScene();
        renderer.renderScene(view);
        renderer.setColor(std::nullopt);
        renderer.drawPicture(8, 8, 64, 64, 0, 0, 1, 1, shader);
    }
    return endFrame(renderer, services);
}

/// For looking at: writes a PNG if Q3RT_TEST_IMAGES names a folder.
inline void keepImage(const std::string& name, const std::vector<uint8_t>& rgb) {
    const char* folder = std::getenv("Q3RT_TEST_IMAGES");
    if (!folder) return;
    const auto png = encodePng(kWidth, kHeight, 3, rgb);
    std::ofstream(std::string(folder) + "/" + name + ".png", std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
}

/// The size of pictures, no full screen.
inline void setPictureSize(TestServices& services) {
    services.setCvar("r_mode", "-1");
    services.setCvar("r_customwidth", std::to_string(kWidth));
    services.setCvar("r_customheight", std::to_string(kHeight));
    services.setCvar("r_fullscreen", "0");
}

} // namespace q3rt::test
