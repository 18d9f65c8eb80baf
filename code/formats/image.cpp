#include "formats/image.hpp"

#include "base/error.hpp"
#include "formats/image_formats.hpp"
#include "formats/text_case.hpp"

namespace q3rt {

void failImage(const std::string& name, const std::string& what) {
    throw ContentError(name + ": " + what + "; replace the image");
}

void checkImageSize(int64_t width, int64_t height, size_t fileBytes, int64_t maxPixelsPerByte,
                    const std::string& name) {
    constexpr int64_t kMaxRgbaBytes = 0x7FFFFFFF;
    if (width < 1 || height < 1) failImage(name, "has no pixels");
    if (width > kMaxRgbaBytes / 4 / height) failImage(name, "has more pixels than an image can have");
    if (width * height / maxPixelsPerByte > static_cast<int64_t>(fileBytes))
        failImage(name, formatText("is too short for %lldx%lld pixels", static_cast<long long>(width),
                                   static_cast<long long>(height)));
}

Image decodeImage(std::span<const std::byte> file, std::string_view name) {
    const std::string fullName(name);
    const size_t dot = name.find_last_of("./");
    const std::string extension = dot == std::string_view::npos ? "" : toLowerAscii(name.substr(dot));
    if (extension == ".tga") return decodeTga(file, fullName);
    if (extension == ".jpg" || extension == ".jpeg") return decodeJpeg(file, fullName);
    if (extension == ".png") return decodePng(file, fullName);
    if (extension == ".pcx") return decodePcx(file, fullName);
    if (extension == ".bmp") return decodeBmp(file, fullName);
    failImage(fullName, "is of no known image type (tga, jpg, png, pcx, bmp)");
}

} // namespace q3rt
