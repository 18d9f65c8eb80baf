#include "likeness.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "formats/image.hpp"
#include "host/common/file_bytes.hpp"
#include "metrics/image_metrics.hpp"
#include "metrics/statistics.hpp"

namespace q3rt::parity {

namespace {

namespace fs = std::filesystem;

constexpr double kLookAt = 0.985; ///< below it a picture is looked at and explained

Image readPicture(const fs::path& path) { return decodeImage(readFileBytes(path), path.string()); }

/// The worst first; ties by name.
std::vector<Likeness> sortedByLikeness(std::vector<Likeness> all) {
    std::ranges::sort(all, {}, [](const Likeness& l) { return std::tuple(l.ssim, l.source, l.picture); });
    return all;
}

/// A picture of the sheet: half of 640x480.
constexpr int kThumbWidth = 320, kThumbHeight = 240, kThumbsAcross = 6;

/// Box-filtered to the size of a thumbnail.
std::vector<uint8_t> shrink(const Image& image) {
    std::vector<uint8_t> small;
    for (int y = 0; y < kThumbHeight; ++y) {
        for (int x = 0; x < kThumbWidth; ++x) {
            const int left = x * image.width / kThumbWidth, top = y * image.height / kThumbHeight;
            const int right = std::max((x + 1) * image.width / kThumbWidth, left + 1);
            const int bottom = std::max((y + 1) * image.height / kThumbHeight, top + 1);
            for (int channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (int v = top; v < bottom; ++v)
                    for (int u = left; u < right; ++u)
                        sum += image.rgba[static_cast<size_t>((v * image.width + u) * 4 + channel)];
                small.push_back(static_cast<uint8_t>(sum / ((right - left) * (bottom - top))));
            }
        }
    }
    return small;
}

Image differenceOf(const Image& a, const Image& b) {
    Image result = a;
    constexpr int kStrength = 8;
    for (size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
        result.rgba[i] = static_cast<uint8_t>(std::min(255, kStrength * std::abs(int{a.rgba[i]} - int{b.rgba[i]})));
    return result;
}

void paste(const std::vector<uint8_t>& thumb, size_t place, std::vector<uint8_t>& sheet) {
    const size_t column = place % kThumbsAcross, row = place / kThumbsAcross;
    constexpr size_t kThumbPitch = kThumbWidth * 3, kSheetPitch = kThumbPitch * kThumbsAcross;
    for (size_t y = 0; y < kThumbHeight; ++y)
        std::copy_n(thumb.begin() + static_cast<ptrdiff_t>(y * kThumbPitch), kThumbPitch,
                    sheet.begin() +
                        static_cast<ptrdiff_t>((row * kThumbHeight + y) * kSheetPitch + column * kThumbPitch));
}

} // namespace

std::vector<Likeness> comparePictures(const fs::path& folder, const std::string& source,
                                      const std::vector<std::string>& pictures) {
    std::vector<Likeness> result;
    for (const std::string& picture : pictures) {
        Likeness likeness{source, picture};
        const fs::path reference = folder / "reference" / (picture + ".png"),
                       test = folder / "test" / (picture + ".png");
        if (fs::exists(reference) && fs::exists(test)) {
            const Image a = readPicture(reference), b = readPicture(test);
            const MetricImage left = metricImageFromBytes(a.width, a.height, 4, a.rgba);
            const MetricImage right = metricImageFromBytes(b.width, b.height, 4, b.rgba);
            likeness.ssim = computeSsim(left, right).mean;
            likeness.flip = computeFlip(left, right).mean;
        }
        result.push_back(likeness);
    }
    return result;
}

void writeLikeness(const fs::path& file, const std::vector<Likeness>& pictures) {
    std::string text;
    for (const Likeness& likeness : pictures)
        text += formatText("%s %.6f %.6f\n", likeness.picture.c_str(), likeness.ssim, likeness.flip);
    writeFileBytes(file, std::as_bytes(std::span(text)));
}

std::vector<Likeness> readLikeness(const fs::path& file, const std::string& source) {
    std::vector<Likeness> result;
    std::ifstream stream(file);
    Likeness likeness{source, ""};
    while (stream >> likeness.picture >> likeness.ssim >> likeness.flip)
        result.push_back(likeness);
    return result;
}

bool isWithin(const std::vector<Likeness>& all, double median, double worst) {
    std::vector<double> ssim;
    for (const Likeness& likeness : all)
        ssim.push_back(likeness.ssim);
    return !ssim.empty() && computeQuantile(ssim, 0.5) >= median && std::ranges::min(ssim) >= worst;
}

std::string describeLikeness(const std::vector<Likeness>& all, size_t worstCount) {
    if (all.empty()) return "nothing was compared\n";
    std::vector<double> ssim, flip;
    std::set<std::string> sources;
    size_t low = 0;
    for (const Likeness& likeness : all) {
        ssim.push_back(likeness.ssim);
        flip.push_back(likeness.flip);
        sources.insert(likeness.source);
        if (likeness.ssim < kLookAt) ++low;
    }
    std::string text = formatText("%zu pictures of %zu maps and demos, %zu below SSIM %g.\n\n", all.size(),
                                  sources.size(), low, kLookAt);
    text += "| | median | worst |\n|---|---|---|\n";
    text += formatText("| SSIM | %.5f | %.5f |\n", computeQuantile(ssim, 0.5), std::ranges::min(ssim));
    text += formatText("| FLIP | %.5f | %.5f |\n\n", computeQuantile(flip, 0.5), std::ranges::max(flip));
    const std::vector<Likeness> worst = sortedByLikeness(all);
    for (size_t i = 0; i < std::min(worstCount, worst.size()); ++i)
        text += formatText("%zu. %s %s: SSIM %.5f, FLIP %.5f\n", i + 1, worst[i].source.c_str(),
                           worst[i].picture.c_str(), worst[i].ssim, worst[i].flip);
    return text;
}

void writeSheet(const fs::path& file, const fs::path& root, const std::vector<Likeness>& all, size_t worstCount) {
    std::vector<Likeness> worst = sortedByLikeness(all);
    std::erase_if(worst, [](const Likeness& likeness) { return likeness.ssim < 0; });
    worst.resize(std::min(worst.size(), worstCount));
    if (worst.empty()) return;
    constexpr size_t kThumbsEach = 3;
    const size_t rows = (worst.size() * kThumbsEach + kThumbsAcross - 1) / kThumbsAcross;
    std::vector<uint8_t> sheet(rows * kThumbHeight * kThumbWidth * kThumbsAcross * 3);
    for (size_t i = 0; i < worst.size(); ++i) {
        const fs::path folder = root / worst[i].source;
        const Image reference = readPicture(folder / "reference" / (worst[i].picture + ".png"));
        const Image test = readPicture(folder / "test" / (worst[i].picture + ".png"));
        paste(shrink(reference), i * kThumbsEach, sheet);
        paste(shrink(test), i * kThumbsEach + 1, sheet);
        paste(shrink(differenceOf(reference, test)), i * kThumbsEach + 2, sheet);
    }
    constexpr int kQuality = 80;
    writeFileBytes(file,
                   encodeJpeg(kThumbWidth * kThumbsAcross, static_cast<int>(rows) * kThumbHeight, sheet, kQuality));
}

} // namespace q3rt::parity
