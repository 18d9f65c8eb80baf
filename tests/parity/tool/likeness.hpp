#pragma once
// How like two folders of pictures are, and what a reader is shown of it: a table and a sheet of the worst.

#include <filesystem>
#include <string>
#include <vector>

namespace q3rt::parity {

struct Likeness {
    std::string source, picture;
    double ssim = -1, flip = 1; ///< ssim -1: one of the two was not drawn
};

/// One line a picture, "PICTURE SSIM FLIP". `folder` holds reference/ and test/.
std::vector<Likeness> comparePictures(const std::filesystem::path& folder, const std::string& source,
                                      const std::vector<std::string>& pictures);
void writeLikeness(const std::filesystem::path& file, const std::vector<Likeness>& pictures);
/// Empty if there is no such file.
std::vector<Likeness> readLikeness(const std::filesystem::path& file, const std::string& source);

/// Is the median SSIM at least `median`, and the worst at least `worst`?
bool isWithin(const std::vector<Likeness>& all, double median, double worst);
/// Median and worst, the numbers below the limits, and the worst pictures in the order of the sheet. Markdown.
std::string describeLikeness(const std::vector<Likeness>& all, size_t worstCount);
/// The worst pictures, two a row: reference, test, difference (8 times as strong). JPEG.
void writeSheet(const std::filesystem::path& file, const std::filesystem::path& root, const std::vector<Likeness>& all,
                size_t worstCount);

} // namespace q3rt::parity
