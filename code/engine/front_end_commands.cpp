// Console commands of every renderer of ours, and what they write: screenshots, levelshots, lists.

#include <algorithm>
#include <array>
#include <numeric>

#include "base/error.hpp"
#include "base/log.hpp"
#include "engine/front_end.hpp"
#include "formats/image.hpp"

namespace q3rt {

/// The engine's commands are plain functions, so the one live front end must be reachable from them.
struct FrontEndCommands {
    static inline FrontEnd* current = nullptr;

    static void run(void (*action)(FrontEnd&)) {
        if (current && current->registered()) action(*current);
    }
    static void screenshot() {
        run([](FrontEnd& f) { f.requestScreenshot(FrontEnd::CaptureKind::Tga); });
    }
    static void screenshotJpeg() {
        run([](FrontEnd& f) { f.requestScreenshot(FrontEnd::CaptureKind::Jpeg); });
    }
    static void shaderList() {
        run([](FrontEnd& f) { f.printShaderList(); });
    }
    static void imageList() {
        run([](FrontEnd& f) { f.printImageList(); });
    }
    static void modelList() {
        run([](FrontEnd& f) { f.printModelList(); });
    }
    static void skinList() {
        run([](FrontEnd& f) { f.printSkinList(); });
    }
    static void minimize() {
        run([](FrontEnd& f) { f.onMinimize(); });
    }
    static void gfxInfo() {
        run([](FrontEnd& f) { f.printDisplayInfo(); });
    }
    static void modeList() {
        run([](FrontEnd& f) {
            for (const std::string& line : f.modeLines())
                f.m_engine.print(LogLevel::Info, line);
        });
    }

    struct Entry {
        const char* name;
        void (*function)();
    };
    static constexpr Entry kTable[] = {{"screenshot", screenshot}, {"screenshotJPEG", screenshotJpeg},
                                       {"shaderlist", shaderList}, {"imagelist", imageList},
                                       {"modellist", modelList},   {"skinlist", skinList},
                                       {"gfxinfo", gfxInfo},       {"minimize", minimize},
                                       {"modelist", modeList}};
};

namespace {

constexpr int kLevelshotSize = 128; // texels a side; each is the mean of 3 x 4 samples of a 512 x 384 grid
constexpr int kLastScreenshot = 9999;

std::vector<uint8_t> shrinkToLevelshot(const FrameImage& image) {
    std::vector<uint8_t> small(static_cast<size_t>(kLevelshotSize * kLevelshotSize * 3));
    const float stepX = static_cast<float>(image.width) / 512.0f, stepY = static_cast<float>(image.height) / 384.0f;
    for (int y = 0; y < kLevelshotSize; ++y) {
        for (int x = 0; x < kLevelshotSize; ++x) {
            std::array<int, 3> sum{};
            for (int sub = 0; sub < 12; ++sub) {
                const int px = static_cast<int>(stepX * static_cast<float>(x * 4 + sub % 4));
                const int py = static_cast<int>(stepY * static_cast<float>(y * 3 + sub / 4));
                const size_t at =
                    (static_cast<size_t>(py) * static_cast<size_t>(image.width) + static_cast<size_t>(px)) * 3;
                for (size_t c = 0; c < 3; ++c)
                    sum[c] += image.rgb[at + c];
            }
            for (size_t c = 0; c < 3; ++c)
                small[(static_cast<size_t>(y) * kLevelshotSize + static_cast<size_t>(x)) * 3 + c] =
                    static_cast<uint8_t>(sum[c] / 12);
        }
    }
    return small;
}

} // namespace

void FrontEnd::addCommands() {
    FrontEndCommands::current = this;
    for (const auto& entry : FrontEndCommands::kTable)
        m_engine.addCommand(entry.name, entry.function);
    m_commandsAdded = true;
}

void FrontEnd::removeCommands() {
    if (!m_commandsAdded) return;
    m_commandsAdded = false;
    for (const auto& entry : FrontEndCommands::kTable)
        m_engine.removeCommand(entry.name);
    if (FrontEndCommands::current == this) FrontEndCommands::current = nullptr;
}

void FrontEnd::requestScreenshot(CaptureKind kind) {
    const std::vector<std::string> arguments = m_engine.commandArguments();
    CaptureRequest request{kind, "", false, 0, 0};
    if (arguments.size() > 1 && arguments[1] == "levelshot")
        request.kind = CaptureKind::Levelshot;
    else if (arguments.size() > 1 && arguments[1] == "silent")
        request.silent = true;
    else if (arguments.size() > 1)
        request.file = "screenshots/" + arguments[1] + (kind == CaptureKind::Tga ? ".tga" : ".jpg");
    m_captures.push_back(std::move(request));
}

void FrontEnd::takeVideoFrame(int width, int height, uint8_t*, uint8_t*, bool motionJpeg) {
    if (!registered() || width <= 0 || height <= 0) return;
    m_captures.push_back({motionJpeg ? CaptureKind::VideoJpeg : CaptureKind::VideoRaw, "", true, width, height});
}

void FrontEnd::writeCaptures(const FrameImage& image) {
    std::vector<CaptureRequest> requests;
    requests.swap(m_captures);
    if (image.width <= 0 || image.height <= 0) return;
    for (const CaptureRequest& request : requests) {
        if (request.kind == CaptureKind::VideoRaw || request.kind == CaptureKind::VideoJpeg)
            writeVideo(request, image);
        else
            writeScreenshot(request, image);
    }
}

std::string FrontEnd::nextScreenshotName(const char* extension) {
    for (; m_nextScreenshot <= kLastScreenshot; ++m_nextScreenshot) {
        std::string name = formatText("screenshots/shot%04d.%s", m_nextScreenshot, extension);
        if (!m_engine.fileExists(name)) {
            ++m_nextScreenshot;
            return name;
        }
    }
    return "";
}

void FrontEnd::writeScreenshot(const CaptureRequest& request, const FrameImage& image) {
    std::string file = request.file;
    std::vector<std::byte> bytes;
    if (request.kind == CaptureKind::Levelshot) {
        if (!m_world) return;
        std::string map = m_world->name;
        if (const size_t slash = map.rfind('/'); slash != std::string::npos) map.erase(0, slash + 1);
        if (const size_t dot = map.rfind('.'); dot != std::string::npos) map.erase(dot);
        file = "levelshots/" + map + ".tga";
        bytes = encodeTga24(kLevelshotSize, kLevelshotSize, shrinkToLevelshot(image));
    } else {
        const bool jpeg = request.kind == CaptureKind::Jpeg;
        if (file.empty()) file = nextScreenshotName(jpeg ? "jpg" : "tga");
        if (file.empty()) {
            logLine(LogLevel::Warning, "screenshots: all numbers to %d are taken; move some away", kLastScreenshot);
            return;
        }
        bytes = jpeg ? encodeJpeg(image.width, image.height, image.rgb, m_settings.r_screenshotJpegQuality)
                     : encodeTga24(image.width, image.height, image.rgb);
    }
    m_engine.writeFile(file, bytes);
    // Of a file that it could not write the engine tells the player alone.
    if (!request.silent && m_engine.fileExists(file))
        m_engine.print(LogLevel::Info, formatText("Wrote %s", file.c_str()));
}

void FrontEnd::writeVideo(const CaptureRequest& request, const FrameImage& image) {
    // The lower-left width x height of the picture, as the engine's writer expects.
    const int width = std::min(request.width, image.width), height = std::min(request.height, image.height);
    const int top = image.height - height;
    if (request.kind == CaptureKind::VideoJpeg) {
        std::vector<uint8_t> rgb;
        rgb.reserve(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
        for (int y = 0; y < height; ++y) {
            const auto row = image.rgb.begin() + static_cast<ptrdiff_t>(top + y) * image.width * 3;
            rgb.insert(rgb.end(), row, row + static_cast<ptrdiff_t>(width) * 3);
        }
        const std::vector<std::byte> jpeg = encodeJpeg(width, height, rgb, m_settings.r_aviMotionJpegQuality);
        m_engine.writeVideoFrame({reinterpret_cast<const uint8_t*>(jpeg.data()), jpeg.size()});
        return;
    }
    const size_t pitch = (static_cast<size_t>(request.width) * 3 + 3) & ~size_t{3};
    std::vector<uint8_t> bgr(pitch * static_cast<size_t>(request.height));
    for (int y = 0; y < height; ++y) {
        const uint8_t* source =
            image.rgb.data() + static_cast<size_t>(image.height - 1 - y) * static_cast<size_t>(image.width) * 3;
        uint8_t* target = bgr.data() + static_cast<size_t>(y) * pitch;
        for (size_t x = 0; x < static_cast<size_t>(width); ++x) {
            target[x * 3 + 0] = source[x * 3 + 2];
            target[x * 3 + 1] = source[x * 3 + 1];
            target[x * 3 + 2] = source[x * 3 + 0];
        }
    }
    m_engine.writeVideoFrame(bgr);
}

void FrontEnd::printDisplayInfo() {
    const DisplayInfo& d = m_display;
    m_engine.print(LogLevel::Info, formatText("%s, %s", d.rendererText.c_str(), d.versionText.c_str()));
    m_engine.print(LogLevel::Info, formatText("%d x %d pixels%s, %d Hz", d.width, d.height,
                                              d.fullscreen ? ", full screen" : "", d.frequency));
    m_engine.print(LogLevel::Info, formatText("colours: %s, gamma %g, %d overbright bits",
                                              d.supportsGamma ? "ramp over the picture" : "as they are",
                                              static_cast<double>(m_settings.r_gamma), m_overbrightBits));
    m_engine.print(LogLevel::Info,
                   formatText("textures: picmip %d, at most %d pixels, detail stages %s", m_settings.r_picmip,
                              d.maxTextureSize, m_settings.r_detailtextures != 0 ? "kept" : "left out"));
    for (const std::string& line : displayLines())
        m_engine.print(LogLevel::Info, line);
}

/// In the order of creation, or with an argument in that of drawing.
void FrontEnd::printShaderList() {
    std::vector<MaterialId> order(m_materials->count());
    std::iota(order.begin(), order.end(), MaterialId{0});
    if (m_engine.commandArguments().size() > 1)
        std::ranges::sort(order, {}, [&](MaterialId id) { return m_materials->get(id).sortRank; });
    for (const MaterialId id : order) {
        const Material& material = m_materials->get(id);
        m_engine.print(LogLevel::Info,
                       formatText("%zu %c sort %g %s%s", material.stages.size(), material.explicitScript ? 'E' : ' ',
                                  static_cast<double>(material.sort), material.name.c_str(),
                                  material.isDefault ? " (DEFAULTED)" : ""));
    }
    m_engine.print(LogLevel::Info, formatText("%zu shaders", m_materials->count()));
}

void FrontEnd::printImageList() {
    size_t bytes = 0;
    for (size_t i = 0; i < m_textures->count(); ++i) {
        const Texture& texture = m_textures->get(static_cast<TextureId>(i));
        for (const MipLevel& level : texture.levels)
            bytes += static_cast<size_t>(level.width) * static_cast<size_t>(level.height) * 4;
        m_engine.print(LogLevel::Info, formatText("%4zu: %4d x %4d %s%s", i, texture.levels.front().width,
                                                  texture.levels.front().height, texture.name.c_str(),
                                                  texture.missing ? " (missing)" : ""));
    }
    m_engine.print(LogLevel::Info, formatText("%zu images, %zu bytes", m_textures->count(), bytes));
}

void FrontEnd::printModelList() {
    for (size_t i = 1; i < m_models->count(); ++i) {
        const Model& model = m_models->get(static_cast<int>(i));
        m_engine.print(LogLevel::Info,
                       formatText("%zu: %zu levels of detail %s", i, model.lods.size(), model.name.c_str()));
    }
    m_engine.print(LogLevel::Info, formatText("%zu models", m_models->count() - 1));
}

void FrontEnd::printSkinList() {
    for (int i = 1; const Skin* skin = m_models->skin(i); ++i)
        m_engine.print(LogLevel::Info,
                       formatText("%d: %s, %zu surfaces", i, skin->name.c_str(), skin->surfaces.size()));
}

} // namespace q3rt
