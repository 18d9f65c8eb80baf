#include "formats/md3.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "formats/byte_reader.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

constexpr int kMd3Version = 15;
constexpr size_t kNameBytes = 64;
constexpr size_t kHeaderBytes = 108;
constexpr size_t kFrameBytes = 56, kFrameNameBytes = 16;
constexpr size_t kTagBytes = 112;
constexpr size_t kSurfaceHeaderBytes = 108;
constexpr size_t kShaderBytes = 68;
constexpr size_t kTriangleBytes = 12;
constexpr size_t kStBytes = 8;
constexpr size_t kVertexBytes = 8;

/// The sine that model normals were encoded against: 1024 steps, yet divided by 1023.
const std::array<float, 1024> kSines = [] {
    std::array<float, 1024> sines{};
    for (size_t i = 0; i < sines.size(); ++i)
        sines[i] = static_cast<float>(std::sin(static_cast<double>(i) * 2.0 * std::numbers::pi / 1023.0));
    return sines;
}();

struct SurfaceHeader {
    std::string name;
    uint32_t frameCount, shaderCount, vertexCount, triangleCount;
    uint32_t trianglesOffset, shadersOffset, stOffset, verticesOffset, endOffset; ///< from the surface's start
};

class Md3Parser {
  public:
    Md3Parser(std::span<const std::byte> file, std::string_view name)
        : m_file(file)
        , m_name(name) {}

    Md3 parse() {
        ByteReader header(m_file, m_name);
        if (m_file.size() < kHeaderBytes || std::memcmp(header.take(4).data(), "IDP3", 4) != 0) fail("is no MD3 model");
        const int version = header.i32();
        if (version != kMd3Version)
            fail(formatText("is an MD3 model of version %d, only version %d can be used", version, kMd3Version));
        header.skip(kNameBytes + 4); // name, flags
        m_frameCount = header.read<uint32_t>();
        const auto tagCount = header.read<uint32_t>();
        const auto surfaceCount = header.read<uint32_t>();
        header.skip(4); // skin count: unused
        const auto framesOffset = header.read<uint32_t>();
        const auto tagsOffset = header.read<uint32_t>();
        const auto surfacesOffset = header.read<uint32_t>();
        if (m_frameCount == 0) fail("has no frames");
        Md3 model;
        readFrames(array(m_file, framesOffset, m_frameCount, kFrameBytes, "frames"), model);
        readTags(array(m_file, tagsOffset, uint64_t{tagCount} * m_frameCount, kTagBytes, "tags"), tagCount, model);
        readSurfaces(surfacesOffset, surfaceCount, model);
        return model;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw ContentError(m_name + ": " + what + "; the model is damaged, get it again");
    }

    /// `count` records of `recordBytes` at `offset` of `block`, checked against the block's end without overflow.
    std::span<const std::byte> array(std::span<const std::byte> block, uint32_t offset, uint64_t count,
                                     size_t recordBytes, const char* what) const {
        if (count == 0) return {};
        if (offset > block.size() || count > (block.size() - offset) / recordBytes)
            fail(std::string("its ") + what + " lie outside the file");
        return block.subspan(offset, static_cast<size_t>(count) * recordBytes);
    }

    float readNeeded(ByteReader& reader, const char* what) const {
        const float value = reader.f32();
        if (!std::isfinite(value)) fail(std::string("its ") + what + " hold a number that is not finite");
        return value;
    }
    vec3 readNeededVec3(ByteReader& reader, const char* what) const {
        vec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = readNeeded(reader, what);
        return v;
    }

    void readFrames(std::span<const std::byte> bytes, Md3& model) const {
        ByteReader reader(bytes, m_name);
        model.frames.resize(m_frameCount);
        for (Md3Frame& frame : model.frames) {
            frame.mins = readNeededVec3(reader, "frames");
            frame.maxs = readNeededVec3(reader, "frames");
            frame.localOrigin = readNeededVec3(reader, "frames");
            frame.radius = readNeeded(reader, "frames");
            reader.skip(kFrameNameBytes);
        }
    }

    void readTags(std::span<const std::byte> bytes, size_t tagCount, Md3& model) const {
        ByteReader reader(bytes, m_name);
        model.tagCount = tagCount;
        model.tags.resize(tagCount * m_frameCount);
        for (Md3Tag& tag : model.tags) {
            tag.name = reader.text(kNameBytes);
            tag.orientation.origin = readNeededVec3(reader, "tags");
            for (vec3& axis : tag.orientation.axis)
                axis = readNeededVec3(reader, "tags");
        }
    }

    SurfaceHeader readSurfaceHeader(std::span<const std::byte> bytes) const {
        ByteReader reader(bytes, m_name);
        reader.skip(4); // identifier
        SurfaceHeader header{};
        header.name = reader.text(kNameBytes);
        reader.skip(4); // flags
        for (uint32_t* field : {&header.frameCount, &header.shaderCount, &header.vertexCount, &header.triangleCount,
                                &header.trianglesOffset, &header.shadersOffset, &header.stOffset,
                                &header.verticesOffset, &header.endOffset})
            *field = reader.read<uint32_t>();
        return header;
    }

    /// Each surface's arrays must lie between its own start and end: many surfaces that share one array could otherwise
    /// blow a small file up without bound.
    void readSurfaces(uint32_t offset, uint32_t count, Md3& model) const {
        if (count == 0) return;
        if (offset > m_file.size()) fail("its surfaces lie outside the file");
        std::span<const std::byte> rest = m_file.subspan(offset);
        for (uint32_t i = 0; i < count; ++i) {
            if (rest.size() < kSurfaceHeaderBytes) fail("its surfaces lie outside the file");
            const SurfaceHeader header = readSurfaceHeader(rest);
            if (header.endOffset < kSurfaceHeaderBytes || header.endOffset > rest.size())
                fail("the end of surface '" + header.name + "' lies outside the file");
            if (header.frameCount != m_frameCount) fail("surface '" + header.name + "' has another number of frames");
            model.surfaces.push_back(readSurface(rest.first(header.endOffset), header));
            rest = rest.subspan(header.endOffset);
        }
    }

    static std::string cleanSurfaceName(const std::string& name) {
        std::string clean = toLowerAscii(name);
        // Exporters number parts "_1"; skins name them without.
        if (clean.size() > 2 && clean[clean.size() - 2] == '_') clean.resize(clean.size() - 2);
        return clean;
    }

    Md3Surface readSurface(std::span<const std::byte> block, const SurfaceHeader& header) const {
        Md3Surface surface;
        surface.name = cleanSurfaceName(header.name);
        surface.vertexCount = header.vertexCount;
        ByteReader shaders(array(block, header.shadersOffset, header.shaderCount, kShaderBytes, "shaders"), m_name);
        for (uint32_t i = 0; i < header.shaderCount; ++i) {
            surface.shaders.push_back(shaders.text(kNameBytes));
            shaders.skip(kShaderBytes - kNameBytes);
        }
        ByteReader triangles(array(block, header.trianglesOffset, header.triangleCount, kTriangleBytes, "triangles"),
                             m_name);
        surface.indices.resize(size_t{3} * header.triangleCount);
        for (uint32_t& index : surface.indices) {
            index = triangles.read<uint32_t>();
            if (index >= header.vertexCount) fail("a triangle of surface '" + header.name + "' has no such vertex");
        }
        ByteReader st(array(block, header.stOffset, header.vertexCount, kStBytes, "texture coordinates"), m_name);
        surface.st.resize(header.vertexCount);
        for (vec2& coordinate : surface.st) {
            for (int i = 0; i < 2; ++i) {
                const float value = st.f32();
                coordinate[i] = std::isfinite(value) ? value : 0.0f;
            }
        }
        const uint64_t vertexTotal = uint64_t{header.vertexCount} * m_frameCount;
        ByteReader vertices(array(block, header.verticesOffset, vertexTotal, kVertexBytes, "vertices"), m_name);
        surface.vertices.resize(static_cast<size_t>(vertexTotal));
        for (Md3Vertex& vertex : surface.vertices) {
            for (int16_t& step : vertex.steps)
                step = vertices.read<int16_t>();
            vertex.normalCode = vertices.read<uint16_t>();
        }
        return surface;
    }

    std::span<const std::byte> m_file;
    std::string m_name;
    uint32_t m_frameCount = 0;
};

} // namespace

vec3 Md3Vertex::normal() const {
    // High byte: latitude, low byte: longitude, 256 steps a turn.
    const size_t latitude = size_t{4} * (normalCode >> 8), longitude = size_t{4} * (normalCode & 255);
    const auto cosine = [&](size_t step) { return kSines[(step + 256) & 1023]; };
    return {cosine(latitude) * kSines[longitude], kSines[latitude] * kSines[longitude], cosine(longitude)};
}

Md3 parseMd3(std::span<const std::byte> file, std::string_view name) { return Md3Parser(file, name).parse(); }

} // namespace q3rt
