#include "host/trade_reference.hpp"

#include <span>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/image.hpp"
#include "host/file_bytes.hpp"
#include "host/trade_points.hpp"

namespace q3rt {

namespace fs = std::filesystem;

fs::path ReferenceCache::pathOf(const std::string& dependsOn, const char* extension) const {
    return m_folder / (hashText(dependsOn) + extension);
}

std::optional<HostFrame> ReferenceCache::load(const std::string& dependsOn, const PictureSize& size) const {
    const fs::path picturePath = pathOf(dependsOn, ".png"), textPath = pathOf(dependsOn, ".txt");
    std::error_code error;
    if (!fs::exists(picturePath, error) || !fs::exists(textPath, error)) return std::nullopt;
    const std::vector<std::byte> text = readFileBytes(textPath);
    if (std::string(reinterpret_cast<const char*>(text.data()), text.size()) != dependsOn) return std::nullopt;
    try {
        const Image image = decodeImage(readFileBytes(picturePath), picturePath.string());
        if (image.width != size.width || image.height != size.height) return std::nullopt;
        HostFrame frame{image.width, image.height, {}};
        frame.rgb.reserve(image.rgba.size() / 4 * 3);
        for (size_t i = 0; i < image.rgba.size(); i += 4)
            frame.rgb.insert(frame.rgb.end(), &image.rgba[i], &image.rgba[i] + 3);
        return frame;
    } catch (const ContentError& damage) {
        logLine(LogLevel::Warning, "%s; the reference is made again", damage.what());
        return std::nullopt;
    }
}

void ReferenceCache::store(const std::string& dependsOn, const HostFrame& picture) const {
    writePng(pathOf(dependsOn, ".png"), picture);
    writeFileBytes(pathOf(dependsOn, ".txt"), std::as_bytes(std::span(dependsOn)));
}

} // namespace q3rt
