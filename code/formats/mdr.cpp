#include "formats/mdr.hpp"

#include <cmath>

#include "formats/byte_reader.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

constexpr int kMdrVersion = 2;
constexpr size_t kNameBytes = 64, kFrameNameBytes = 16, kTagNameBytes = 32;
constexpr size_t kHeaderBytes = 104;
constexpr size_t kFrameBytes = 56, kBoneBytes = 48;
constexpr size_t kCompressedFrameBytes = 40, kCompressedBoneBytes = 24;
constexpr size_t kLodBytes = 12, kSurfaceBytes = 168, kTriangleBytes = 12, kTagBytes = 36;
constexpr size_t kVertexBytes = 24, kWeightBytes = 20;
// Steps of a compressed bone: translations in qu, the linear part from -1 to 1.
constexpr float kMiddle = 32768, kTranslationUnit = 1.0f / 64.0f, kLinearUnit = 1.0f / 32766.0f;

class MdrParser {
  public:
    MdrParser(std::span<const std::byte> file, std::string_view name)
        : m_file(file)
        , m_name(name) {}

    Mdr parse() {
        ByteReader header(m_file, m_name);
        if (m_file.size() < kHeaderBytes || std::memcmp(header.take(4).data(), "RDM5", 4) != 0) fail("is no MDR model");
        if (const int version = header.i32(); version != kMdrVersion)
            fail(formatText("is an MDR model of version %d, only version %d can be used", version, kMdrVersion));
        header.skip(kNameBytes);
        const auto frameCount = header.read<uint32_t>();
        m_model.boneCount = header.read<uint32_t>();
        const int framesOffset = header.i32();
        const auto lodCount = header.read<uint32_t>();
        const auto lodsOffset = header.read<uint32_t>();
        const auto tagCount = header.read<uint32_t>();
        const auto tagsOffset = header.read<uint32_t>();
        if (frameCount == 0) fail("has no frames");
        readFrames(framesOffset, frameCount);
        readLods(lodsOffset, lodCount);
        readTags(array(m_file, tagsOffset, tagCount, kTagBytes, "tags"), tagCount);
        return std::move(m_model);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw ContentError(m_name + ": " + what + "; the model is damaged, get it again");
    }

    /// `count` records of `recordBytes` at `offset` of `block`, checked against the block's end without overflow.
    std::span<const std::byte> array(std::span<const std::byte> block, uint64_t offset, uint64_t count,
                                     uint64_t recordBytes, const char* what) const {
        if (count == 0) return {};
        if (offset > block.size() || count > (block.size() - offset) / recordBytes)
            fail(std::string("its ") + what + " lie outside the file");
        return block.subspan(static_cast<size_t>(offset), static_cast<size_t>(count * recordBytes));
    }

    float finite(ByteReader& reader, const char* what) const {
        const float value = reader.f32();
        if (!std::isfinite(value)) fail(std::string("its ") + what + " hold a number that is not finite");
        return value;
    }
    vec3 finiteVec3(ByteReader& reader, const char* what) const {
        vec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = finite(reader, what);
        return v;
    }

    Affine readBone(ByteReader& reader) const {
        Affine bone;
        for (vec4& row : bone.row)
            for (int c = 0; c < 4; ++c)
                row[c] = finite(reader, "bones");
        return bone;
    }

    static Affine readCompressedBone(ByteReader& reader) {
        Affine bone;
        for (vec4& row : bone.row)
            row.w = (static_cast<float>(reader.read<uint16_t>()) - kMiddle) * kTranslationUnit;
        for (vec4& row : bone.row)
            for (int c = 0; c < 3; ++c)
                row[c] = (static_cast<float>(reader.read<uint16_t>()) - kMiddle) * kLinearUnit;
        return bone;
    }

    /// A negative offset says that the frames are compressed.
    void readFrames(int offset, uint32_t count) {
        const bool compressed = offset < 0;
        const uint64_t frameBytes = compressed ? kCompressedFrameBytes + uint64_t{kCompressedBoneBytes} * boneCount()
                                               : kFrameBytes + uint64_t{kBoneBytes} * boneCount();
        const auto start = static_cast<uint64_t>(std::abs(int64_t{offset}));
        ByteReader reader(array(m_file, start, count, frameBytes, "frames"), m_name);
        m_model.frames.resize(count);
        m_model.bones.reserve(size_t{count} * boneCount());
        for (MdrFrame& frame : m_model.frames) {
            frame.mins = finiteVec3(reader, "frames");
            frame.maxs = finiteVec3(reader, "frames");
            frame.localOrigin = finiteVec3(reader, "frames");
            frame.radius = finite(reader, "frames");
            if (!compressed) reader.skip(kFrameNameBytes);
            for (size_t bone = 0; bone < boneCount(); ++bone)
                m_model.bones.push_back(compressed ? readCompressedBone(reader) : readBone(reader));
        }
    }

    /// Levels and surfaces follow each other; each lies between its own start and end, so that a small file can't name
    /// one array many times.
    void readLods(uint32_t offset, uint32_t count) {
        if (count == 0) return;
        if (offset > m_file.size()) fail("its levels of detail lie outside the file");
        std::span<const std::byte> rest = m_file.subspan(offset);
        for (uint32_t i = 0; i < count; ++i) {
            ByteReader header(array(rest, 0, 1, kLodBytes, "levels of detail"), m_name);
            const auto surfaceCount = header.read<uint32_t>();
            const auto surfacesOffset = header.read<uint32_t>();
            const auto end = header.read<uint32_t>();
            if (end < kLodBytes || end > rest.size()) fail("a level of detail ends outside the file");
            readSurfaces(rest.first(end), surfacesOffset, surfaceCount);
            rest = rest.subspan(end);
        }
    }

    void readSurfaces(std::span<const std::byte> lod, uint32_t offset, uint32_t count) {
        m_model.lods.emplace_back();
        if (count == 0) return;
        if (offset > lod.size()) fail("its surfaces lie outside the file");
        std::span<const std::byte> rest = lod.subspan(offset);
        for (uint32_t i = 0; i < count; ++i) {
            ByteReader header(array(rest, 0, 1, kSurfaceBytes, "surfaces"), m_name);
            header.skip(4); // identifier
            MdrSurface surface;
            surface.name = toLowerAscii(header.text(kNameBytes));
            surface.shader = header.text(kNameBytes);
            header.skip(8); // shader index, offset back to the file's header
            const auto vertexCount = header.read<uint32_t>();
            const auto verticesOffset = header.read<uint32_t>();
            const auto triangleCount = header.read<uint32_t>();
            const auto trianglesOffset = header.read<uint32_t>();
            header.skip(8); // bone references: weights name their bones directly
            const auto end = header.read<uint32_t>();
            if (end < kSurfaceBytes || end > rest.size()) fail("surface '" + surface.name + "' ends outside the file");
            const std::span<const std::byte> block = rest.first(end);
            readVertices(block, verticesOffset, vertexCount, surface);
            readTriangles(array(block, trianglesOffset, triangleCount, kTriangleBytes, "triangles"), surface);
            m_model.lods.back().push_back(std::move(surface));
            rest = rest.subspan(end);
        }
    }

    void readVertices(std::span<const std::byte> block, uint32_t offset, uint32_t count, MdrSurface& surface) const {
        ByteReader reader(block, m_name);
        array(block, offset, count, kVertexBytes, "vertices"); // at the least: each has its weights behind it
        if (count == 0) return;
        reader.skip(offset);
        surface.vertices.resize(count);
        for (MdrVertex& vertex : surface.vertices) {
            vertex.normal = finiteVec3(reader, "vertices");
            for (int i = 0; i < 2; ++i) {
                const float value = reader.f32();
                vertex.st[i] = std::isfinite(value) ? value : 0.0f;
            }
            vertex.firstWeight = static_cast<uint32_t>(surface.weights.size());
            vertex.weightCount = reader.read<uint32_t>();
            if (vertex.weightCount > reader.remaining() / kWeightBytes) fail("its weights lie outside the file");
            for (uint32_t i = 0; i < vertex.weightCount; ++i) {
                MdrWeight weight;
                weight.bone = reader.read<uint32_t>();
                weight.weight = finite(reader, "weights");
                weight.offset = finiteVec3(reader, "weights");
                if (weight.bone >= boneCount()) fail("a vertex of surface '" + surface.name + "' has no such bone");
                surface.weights.push_back(weight);
            }
        }
    }

    void readTriangles(std::span<const std::byte> bytes, MdrSurface& surface) const {
        ByteReader reader(bytes, m_name);
        surface.indices.resize(bytes.size() / sizeof(uint32_t));
        for (uint32_t& index : surface.indices) {
            index = reader.read<uint32_t>();
            if (index >= surface.vertices.size())
                fail("a triangle of surface '" + surface.name + "' has no such vertex");
        }
    }

    void readTags(std::span<const std::byte> bytes, uint32_t count) {
        ByteReader reader(bytes, m_name);
        m_model.tags.resize(count);
        for (MdrTag& tag : m_model.tags) {
            tag.bone = reader.read<uint32_t>();
            tag.name = reader.text(kTagNameBytes);
            if (tag.bone >= boneCount()) fail("tag '" + tag.name + "' has no such bone");
        }
    }

    size_t boneCount() const { return m_model.boneCount; }

    std::span<const std::byte> m_file;
    std::string m_name;
    Mdr m_model;
};

} // namespace

Mdr parseMdr(std::span<const std::byte> file, std::string_view name) { return MdrParser(file, name).parse(); }

} // namespace q3rt
