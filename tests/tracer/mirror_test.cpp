// What a mirror shows is what a camera sees from the eye's image behind it.

#include <cmath>
#include <gtest/gtest.h>

#include "baseq3-test/bsp_writer.hpp"
#include "metrics/image_metrics.hpp"
#include "support/game_data.hpp"
#include "trace_harness.hpp"
#include "truth/test_game.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::TraceHarness;

/// A mirror without a colour of its own: what it shows is the reflection alone.
constexpr const char* kPureMirror =
    "\n{\nportal\nsurfaceparm nolightmap\n{\nmap $whiteimage\nblendFunc GL_ZERO GL_ONE\ndepthWrite\n}\n}\n";

std::vector<std::byte> toBytes(const std::string& text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

/// The game's files, with the script of one material replaced by a pure mirror.
class MirrorFiles : public FileSource {
  public:
    MirrorFiles(FileSource& files, std::string material)
        : m_files(files)
        , m_material(std::move(material)) {}
    std::optional<std::vector<std::byte>> read(std::string_view name) override {
        auto bytes = m_files.read(name);
        if (!bytes || !name.ends_with(".shader")) return bytes;
        std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        const size_t start = text.find(m_material + "\n") != std::string::npos ? text.find(m_material + "\n")
                                                                               : text.find(m_material + "\r\n");
        if (start == std::string::npos) return bytes;
        size_t end = text.find('{', start);
        int depth = 0;
        do {
            if (text[end] == '{') ++depth;
            if (text[end] == '}') --depth;
            ++end;
        } while (depth > 0 && end < text.size());
        text.replace(start, end - start, m_material + kPureMirror);
        ++m_replaced;
        return toBytes(text);
    }
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return m_files.list(directory, extension);
    }
    int replaced() const { return m_replaced; }

  private:
    FileSource& m_files;
    std::string m_material;
    int m_replaced = 0;
};

/// A room like that of the test maps, with a mirror in its floor.
class MirrorRoom : public test::TestGame {
  public:
    static constexpr IntBox kMirror{{-128, -64, 0}, {128, 192, 0}};
    MirrorRoom() {
        BoxMap map = describeSquareLightRoom();
        map.panels.push_back({kMirror, "textures/baseq3test/mirror"});
        add("maps/mirror_room.bsp", writeBsp(buildBoxMap(map)));
        addText("scripts/mirror.shader", std::string("textures/baseq3test/mirror") + kPureMirror);
    }
};

constexpr int kWidth = 96, kHeight = 72; ///< pixels

/// A horizontal mirror and a camera that looks down on it along +y.
struct MirrorView {
    IntBox mirror; ///< flat in z
    Camera camera;
};

refEntity_t mirrorEntity(const IntBox& mirror) {
    refEntity_t entity{};
    entity.reType = RT_PORTALSURFACE;
    const vec3 center = vec3(mirror.mins + mirror.maxs) * 0.5f;
    for (int i = 0; i < 3; ++i) {
        entity.origin[i] = entity.oldorigin[i] = center[i];
        entity.axis[i][i] = 1;
    }
    return entity;
}

/// Does the ray through a point of the picture (pixels) meet the mirror?
bool isInMirror(const MirrorView& view, double x, double y) {
    const double pitch = view.camera.pitch * M_PI / 180, tanX = std::tan(view.camera.fovX * M_PI / 360);
    const double along = 1 - 2 * y / kHeight, tanY = tanX * kHeight / kWidth;
    const dvec3 direction(-tanX * (1 - 2 * x / kWidth), std::cos(pitch) + std::sin(pitch) * tanY * along,
                          -std::sin(pitch) + std::cos(pitch) * tanY * along);
    if (direction.z >= 0) return false;
    const dvec3 eye(view.camera.eye);
    const dvec3 at = eye + direction * ((view.mirror.mins.z - eye.z) / direction.z);
    return at.x > view.mirror.mins.x && at.x < view.mirror.maxs.x && at.y > view.mirror.mins.y &&
           at.y < view.mirror.maxs.y;
}

bool isPixelInMirror(const MirrorView& view, int x, int y) {
    return isInMirror(view, x - 1, y - 1) && isInMirror(view, x + 2, y - 1) && isInMirror(view, x - 1, y + 2) &&
           isInMirror(view, x + 2, y + 2);
}

struct Likeness {
    double ssim = 0;
    int pixels = 0;
};

/// Of the mirror's picture and the one from the mirrored camera, whose rows are in the other order.
Likeness compareWithMirrored(TraceHarness& harness, const MirrorView& view, int frames) {
    harness.setEntities({mirrorEntity(view.mirror)});
    const FloatImage shown = harness.radiance(view.camera, frames);
    Camera behind = view.camera;
    behind.eye.z = 2.0f * static_cast<float>(view.mirror.mins.z) - behind.eye.z;
    behind.pitch = -behind.pitch;
    const FloatImage seen = harness.radiance(behind, frames);
    MetricImage test = metricImageFromFloats(kWidth, kHeight, shown.rgb);
    MetricImage reference = test;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3 && isPixelInMirror(view, x, y); ++c)
                reference.rgb[static_cast<size_t>(3 * (y * kWidth + x) + c)] =
                    static_cast<double>(seen.rgb[static_cast<size_t>(3 * ((kHeight - 1 - y) * kWidth + x) + c)]);
    const MetricMap map = computeSsim(reference, test);
    const int left = (kWidth - map.width) / 2, top = (kHeight - map.height) / 2;
    Likeness result;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            if (!isPixelInMirror(view, x + left, y + top)) continue;
            result.ssim += map.values[static_cast<size_t>(y * map.width + x)];
            ++result.pixels;
        }
    result.ssim /= std::max(result.pixels, 1);
    return result;
}

void useExactLight(TraceHarness& harness) {
    harness.set("rt_backend", "compute");
    harness.set("rt_accumulate", "1");
    harness.set("rt_numRandomDL", "0");
}

TEST(Mirror, ShowsTheRoomFromTheMirroredCamera) {
    MirrorRoom files;
    TraceHarness harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    useExactLight(harness);
    harness.loadMap("maps/mirror_room.bsp");
    const MirrorView view{MirrorRoom::kMirror, {.eye = {10, -150, 90}, .pitch = 30, .yaw = 90}};
    const Likeness likeness = compareWithMirrored(harness, view, 32);
    EXPECT_GE(likeness.pixels, 500);
    EXPECT_GE(likeness.ssim, 0.98);
    std::printf("%d pixels in the mirror, SSIM %.4f\n", likeness.pixels, likeness.ssim);
}

constexpr IntBox kDm2Mirrors[] = {{{2672, -2080, 104}, {2736, -2016, 104}}, {{2592, -520, 8}, {2656, -456, 8}},
                                  {{2528, -224, 8}, {2592, -160, 8}},       {{2512, -64, -88}, {2576, 0, -88}},
                                  {{1280, -1408, 120}, {1344, -1344, 120}}, {{1248, -1056, 328}, {1312, -992, 328}}};

/// Over the near edge of a mirror.
MirrorView lookInto(const IntBox& mirror) {
    const vec3 edge((mirror.mins.x + mirror.maxs.x) / 2, mirror.mins.y, mirror.mins.z);
    return {mirror, {.eye = edge + vec3(0, 2, 20), .pitch = 30, .yaw = 90}};
}

void compareDm2(const char* illumination, std::span<const IntBox> mirrors, int frames) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(game);
    MirrorFiles files(*game, "textures/proto2/mirrorfloor");
    TraceHarness harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    useExactLight(harness);
    harness.set("rt_illumination", illumination);
    harness.loadMap("maps/oa_dm2.bsp");
    ASSERT_EQ(files.replaced(), 1);
    for (const IntBox& mirror : mirrors) {
        const Likeness likeness = compareWithMirrored(harness, lookInto(mirror), frames);
        EXPECT_GE(likeness.pixels, 500);
        EXPECT_GE(likeness.ssim, 0.98);
        std::printf("mirror at z %d: %d pixels, SSIM %.4f\n", mirror.mins.z, likeness.pixels, likeness.ssim);
    }
}

TEST(Mirror, ShowsAllOfDm2FromTheMirroredCameraUnlit) { compareDm2("0", kDm2Mirrors, 1); }

// The second mirror stands in a dark corner, where noise decides for hundreds of frames.
TEST(Mirror, ShowsDm2FromTheMirroredCameraLit) { compareDm2("1", std::span(kDm2Mirrors).last(4), 24); }

} // namespace
} // namespace q3rt
