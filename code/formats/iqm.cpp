#include "formats/iqm.hpp"

#include <bit>
#include <cmath>

#include "formats/byte_reader.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

constexpr char kMagic[16] = "INTERQUAKEMODEL";
constexpr uint32_t kIqmVersion = 2;
constexpr size_t kHeaderBytes = 124, kMeshBytes = 24, kArrayBytes = 20, kTriangleBytes = 12, kJointBytes = 48,
                 kPoseBytes = 88, kBoundsBytes = 32;

/// Kinds of vertex arrays and of their numbers, as stored.
enum class ArrayKind : uint32_t { Position, Texcoord, Normal, Tangent, BlendIndexes, BlendWeights, Color };
enum class NumberKind : uint32_t { Byte, UByte, Short, UShort, Int, UInt, Half, Float, Double };

/// A table of the file: how many records, where.
struct Table {
    uint32_t count = 0, offset = 0;
};

struct Header {
    Table text, meshes, vertexArrays, triangles, joints, poses, frames;
    uint32_t vertexCount = 0, channelCount = 0, boundsOffset = 0;
};

/// A quaternion of length 0 is no turn at all. In double: squares of large floats are still numbers.
vec4 normalizeQuaternion(const vec4& q) {
    const glm::dvec4 wide(q);
    const double length = glm::length(wide);
    return length > 0 ? vec4(wide / length) : vec4(0, 0, 0, -1);
}

class IqmParser {
  public:
    IqmParser(std::span<const std::byte> file, std::string_view name)
        : m_file(file)
        , m_name(name) {}

    Iqm parse() {
        readHeader();
        readJoints();
        readPoses();
        readFrames();
        readVertexArrays();
        readMeshes();
        readBounds();
        return std::move(m_model);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw ContentError(m_name + ": " + what + "; the model is damaged, get it again");
    }

    std::span<const std::byte> array(uint64_t offset, uint64_t count, size_t recordBytes, const char* what) const {
        if (count == 0) return {};
        if (offset > m_file.size() || count > (m_file.size() - offset) / recordBytes)
            fail(std::string("its ") + what + " lie outside the file");
        return m_file.subspan(static_cast<size_t>(offset), static_cast<size_t>(count) * recordBytes);
    }
    std::span<const std::byte> array(const Table& table, size_t recordBytes, const char* what) const {
        return array(table.offset, table.count, recordBytes, what);
    }

    float finite(ByteReader& reader, const char* what) const {
        const float value = reader.f32();
        if (!std::isfinite(value)) fail(std::string("its ") + what + " hold a number that is not finite");
        return value;
    }
    template <int N>
    glm::vec<N, float> finiteVector(ByteReader& reader, const char* what) const {
        glm::vec<N, float> v;
        for (int i = 0; i < N; ++i)
            v[i] = finite(reader, what);
        return v;
    }

    std::string textAt(uint32_t offset) const {
        const std::span<const std::byte> all = array(m_header.text, 1, "names");
        if (offset >= all.size()) return {};
        const char* start = reinterpret_cast<const char*>(all.data()) + offset;
        return std::string(start, strnlen(start, all.size() - offset));
    }

    void readHeader() {
        ByteReader reader(m_file, m_name);
        if (m_file.size() < kHeaderBytes || std::memcmp(reader.take(sizeof kMagic).data(), kMagic, sizeof kMagic) != 0)
            fail("is no IQM model");
        const auto next = [&] { return reader.read<uint32_t>(); };
        if (const uint32_t version = next(); version != kIqmVersion)
            fail(formatText("is an IQM model of version %u, only version %u can be used", version, kIqmVersion));
        if (next() > m_file.size()) fail("ends too early");
        reader.skip(4); // flags
        const auto nextTable = [&](Table& table) {
            table.count = next();
            table.offset = next();
        };
        Header& h = m_header;
        nextTable(h.text);
        nextTable(h.meshes);
        h.vertexArrays.count = next();
        h.vertexCount = next();
        h.vertexArrays.offset = next();
        nextTable(h.triangles);
        reader.skip(4); // adjacency
        nextTable(h.joints);
        nextTable(h.poses);
        reader.skip(8); // names of animations
        h.frames.count = next();
        h.channelCount = next();
        h.frames.offset = next();
        h.boundsOffset = next();
    }

    void readJoints() {
        ByteReader reader(array(m_header.joints, kJointBytes, "joints"), m_name);
        m_model.joints.resize(m_header.joints.count);
        for (size_t i = 0; i < m_model.joints.size(); ++i) {
            IqmJoint& joint = m_model.joints[i];
            joint.name = textAt(reader.read<uint32_t>());
            joint.parent = readParent(reader, i);
            joint.bind.translate = finiteVector<3>(reader, "joints");
            joint.bind.rotate = normalizeQuaternion(finiteVector<4>(reader, "joints"));
            joint.bind.scale = finiteVector<3>(reader, "joints");
        }
    }

    /// Parents come first, so that one pass over the joints places them all.
    int readParent(ByteReader& reader, size_t child) const {
        const int parent = reader.i32();
        if (parent < -1 || parent >= static_cast<int>(child)) fail("a joint does not come after its parent");
        return parent;
    }

    void readPoses() {
        if (m_header.poses.count != 0 && m_header.poses.count != m_header.joints.count)
            fail("it has another number of poses than of joints");
        ByteReader reader(array(m_header.poses, kPoseBytes, "poses"), m_name);
        m_model.poses.resize(m_header.poses.count);
        uint32_t channel = 0;
        for (IqmPose& pose : m_model.poses) {
            reader.skip(4); // its parent: the joint's
            pose.mask = reader.read<uint32_t>() & 0x3FFu;
            for (float& value : pose.offset)
                value = finite(reader, "poses");
            for (size_t k = 0; k < pose.scale.size(); ++k) {
                constexpr float kLargestStored = 65535;
                pose.scale[k] = finite(reader, "poses");
                if (!std::isfinite(pose.offset[k] + kLargestStored * pose.scale[k])) fail("a pose is out of range");
            }
            pose.firstChannel = channel;
            channel += static_cast<uint32_t>(std::popcount(pose.mask));
        }
        if (channel > m_header.channelCount) fail("its frames lack channels that its poses want");
    }

    void readFrames() {
        m_model.frameCount = m_header.frames.count;
        m_model.channelCount = m_header.channelCount;
        const uint64_t total = uint64_t{m_header.frames.count} * m_header.channelCount;
        ByteReader reader(array(m_header.frames.offset, total, sizeof(uint16_t), "frames"), m_name);
        m_model.channels.resize(static_cast<size_t>(total));
        for (uint16_t& value : m_model.channels)
            value = reader.read<uint16_t>();
    }

    void readVertexArrays() {
        ByteReader reader(array(m_header.vertexArrays, kArrayBytes, "vertex arrays"), m_name);
        for (uint32_t i = 0; i < m_header.vertexArrays.count; ++i) {
            const auto kind = static_cast<ArrayKind>(reader.read<uint32_t>());
            reader.skip(4); // flags
            const auto number = static_cast<NumberKind>(reader.read<uint32_t>());
            const auto size = reader.read<uint32_t>();
            readVertexArray(kind, number, size, reader.read<uint32_t>());
        }
        const size_t count = m_header.vertexCount;
        const bool complete =
            m_model.positions.size() == count && m_model.normals.size() == count && m_model.st.size() == count;
        if (m_header.meshes.count > 0 && !complete) fail("it lacks positions, normals or texture coordinates");
        const bool blended = m_model.blendIndexes.size() == count && m_model.blendWeights.size() == count;
        if (m_header.meshes.count > 0 && !m_model.joints.empty() && !blended) fail("it has joints but no weights");
    }

    void readVertexArray(ArrayKind kind, NumberKind number, uint32_t size, uint32_t offset) {
        const auto require = [&](bool good, const char* what) {
            if (!good) fail(std::string("its ") + what + " are stored in a way that is not known");
        };
        const bool bytes = number == NumberKind::UByte && size == 4, floats = number == NumberKind::Float;
        switch (kind) {
        case ArrayKind::Position:
            require(floats && size == 3, "positions");
            return readFloats<3>(offset, "positions", m_model.positions);
        case ArrayKind::Normal:
            require(floats && size == 3, "normals");
            return readFloats<3>(offset, "normals", m_model.normals);
        case ArrayKind::Texcoord:
            require(floats && size == 2, "texture coordinates");
            return readFloats<2>(offset, "texture coordinates", m_model.st);
        case ArrayKind::BlendIndexes:
            require(bytes, "joint numbers");
            readBytes(offset, "joint numbers", m_model.blendIndexes);
            return requireJoints();
        case ArrayKind::BlendWeights:
            require(bytes || (floats && size == 4), "weights");
            if (floats) return readFloats<4>(offset, "weights", m_model.blendWeights);
            return readByteWeights(offset);
        case ArrayKind::Color:
            require(bytes, "colours");
            return readBytes(offset, "colours", m_model.colors);
        case ArrayKind::Tangent: // nothing that is drawn needs it
            break;
        }
    }

    template <int N>
    void readFloats(uint32_t offset, const char* what, std::vector<glm::vec<N, float>>& out) const {
        ByteReader reader(array(offset, m_header.vertexCount, N * sizeof(float), what), m_name);
        out.resize(m_header.vertexCount);
        for (auto& value : out)
            value = finiteVector<N>(reader, what);
    }
    void readBytes(uint32_t offset, const char* what, std::vector<std::array<uint8_t, 4>>& out) const {
        ByteReader reader(array(offset, m_header.vertexCount, 4, what), m_name);
        out.resize(m_header.vertexCount);
        for (auto& value : out)
            for (uint8_t& byte : value)
                byte = reader.u8();
    }
    void readByteWeights(uint32_t offset) {
        std::vector<std::array<uint8_t, 4>> bytes;
        readBytes(offset, "weights", bytes);
        m_model.blendWeights.clear();
        for (const auto& value : bytes)
            m_model.blendWeights.push_back(vec4(value[0], value[1], value[2], value[3]) / 255.0f);
    }
    void requireJoints() const {
        if (m_model.joints.empty()) return;
        for (const auto& four : m_model.blendIndexes)
            for (const uint8_t joint : four)
                if (joint >= m_model.joints.size()) fail("a vertex has no such joint");
    }

    void readMeshes() {
        ByteReader reader(array(m_header.meshes, kMeshBytes, "meshes"), m_name);
        const std::span<const std::byte> triangles = array(m_header.triangles, kTriangleBytes, "triangles");
        uint64_t triangleSum = 0, vertexSum = 0;
        for (uint32_t i = 0; i < m_header.meshes.count; ++i) {
            IqmMesh mesh;
            mesh.name = toLowerAscii(textAt(reader.read<uint32_t>()));
            mesh.material = textAt(reader.read<uint32_t>());
            mesh.firstVertex = reader.read<uint32_t>();
            mesh.vertexCount = reader.read<uint32_t>();
            const auto firstTriangle = reader.read<uint32_t>();
            const auto triangleCount = reader.read<uint32_t>();
            if (uint64_t{mesh.firstVertex} + mesh.vertexCount > m_header.vertexCount ||
                uint64_t{firstTriangle} + triangleCount > m_header.triangles.count)
                fail("mesh '" + mesh.name + "' is larger than the model");
            // Meshes share nothing: many that name the same vertices would blow a small file up.
            triangleSum += triangleCount;
            vertexSum += mesh.vertexCount;
            if (triangleSum > m_header.triangles.count || vertexSum > m_header.vertexCount)
                fail("its meshes together are larger than the model");
            readTriangles(triangles.subspan(firstTriangle * kTriangleBytes, triangleCount * kTriangleBytes), mesh);
            m_model.meshes.push_back(std::move(mesh));
        }
    }

    void readTriangles(std::span<const std::byte> bytes, IqmMesh& mesh) const {
        ByteReader reader(bytes, m_name);
        mesh.indices.resize(bytes.size() / sizeof(uint32_t));
        for (uint32_t& index : mesh.indices) {
            index = reader.read<uint32_t>() - mesh.firstVertex;
            if (index >= mesh.vertexCount) fail("a triangle of mesh '" + mesh.name + "' has no such vertex");
        }
    }

    void readBounds() {
        if (m_header.boundsOffset == 0) return;
        ByteReader reader(array(m_header.boundsOffset, m_header.frames.count, kBoundsBytes, "bounds"), m_name);
        m_model.bounds.resize(m_header.frames.count);
        for (Bounds& box : m_model.bounds) {
            box.mins = finiteVector<3>(reader, "bounds");
            box.maxs = finiteVector<3>(reader, "bounds");
            reader.skip(8); // radii
        }
    }

    std::span<const std::byte> m_file;
    std::string m_name;
    Header m_header;
    Iqm m_model;
};

} // namespace

IqmTransform Iqm::poseAt(size_t frame, size_t joint) const {
    const IqmPose& pose = poses[joint];
    const uint16_t* stored = channels.data() + frame * channelCount + pose.firstChannel;
    std::array<float, 10> value = pose.offset;
    for (size_t k = 0; k < value.size(); ++k)
        if (pose.mask & (1u << k)) value[k] += static_cast<float>(*stored++) * pose.scale[k];
    return {vec3(value[0], value[1], value[2]), normalizeQuaternion(vec4(value[3], value[4], value[5], value[6])),
            vec3(value[7], value[8], value[9])};
}

Iqm parseIqm(std::span<const std::byte> file, std::string_view name) { return IqmParser(file, name).parse(); }

} // namespace q3rt
