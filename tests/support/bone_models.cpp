#include "bone_models.hpp"

#include <cmath>
#include <numbers>

#include "math/affine.hpp"
#include "support/tiny_files.hpp"

namespace q3rt::test {

namespace {

constexpr float kElbow = kBarLengthQu / 2;

struct BarVertex {
    vec3 position, normal;
    vec2 st;
    float tipWeight;
};

/// Three rings of four corners.
std::vector<BarVertex> barVertices(float thickness) {
    std::vector<BarVertex> vertices;
    for (int ring = 0; ring < 3; ++ring)
        for (int corner = 0; corner < 4; ++corner) {
            const vec3 out(0, corner == 1 || corner == 2 ? 1 : -1, corner >= 2 ? 1 : -1);
            const vec3 at = out * (thickness / 2) + vec3(kElbow * static_cast<float>(ring), 0, 0);
            const vec2 st(static_cast<float>(ring) / 2, static_cast<float>(corner) / 3);
            vertices.push_back({at, glm::normalize(out), st, static_cast<float>(ring) / 2});
        }
    return vertices;
}

/// Clockwise as seen from outside.
std::vector<int> barIndices() {
    std::vector<int> indices;
    for (int ring = 0; ring < 2; ++ring)
        for (int corner = 0; corner < 4; ++corner) {
            const int a = ring * 4 + corner, b = ring * 4 + (corner + 1) % 4;
            for (const int index : {a, a + 4, b, b, a + 4, b + 4})
                indices.push_back(index);
        }
    return indices;
}

float bendRadians(int frame) { return static_cast<float>(frame) * kBarBendDegrees * std::numbers::pi_v<float> / 180; }

/// The tip's place at a frame: turned about the y axis at the elbow, upward.
Affine tipBone(int frame) {
    const float c = std::cos(bendRadians(frame)), s = std::sin(bendRadians(frame));
    return {{vec4(c, 0, -s, kElbow), vec4(0, 1, 0, 0), vec4(s, 0, c, 0)}};
}

void putVec3(ByteWriter& out, const vec3& v) { out.floats({v.x, v.y, v.z}); }

void putCompressed(ByteWriter& out, const Affine& bone) {
    for (const vec4& row : bone.row)
        out.put(static_cast<uint16_t>(std::lround(row.w * 64 + 32768)));
    for (const vec4& row : bone.row)
        for (int c = 0; c < 3; ++c)
            out.put(static_cast<uint16_t>(std::lround(row[c] * 32766 + 32768)));
}

ByteWriter mdrFrames(const BarOptions& options) {
    ByteWriter out;
    for (int frame = 0; frame < options.frames; ++frame) {
        putVec3(out, vec3(-options.thickness));
        putVec3(out, vec3(kBarLengthQu + options.thickness));
        out.floats({kElbow, 0, 0, kBarLengthQu});
        if (!options.compressed) out.text("bend", 16);
        for (const Affine& bone : {Affine{}, tipBone(frame)}) {
            if (options.compressed) {
                putCompressed(out, bone);
                continue;
            }
            for (const vec4& row : bone.row)
                out.floats({row.x, row.y, row.z, row.w});
        }
    }
    return out;
}

ByteWriter mdrVertices(float thickness) {
    ByteWriter out;
    for (const BarVertex& vertex : barVertices(thickness)) {
        putVec3(out, vertex.normal);
        out.floats({vertex.st.x, vertex.st.y});
        const bool both = vertex.tipWeight > 0 && vertex.tipWeight < 1;
        out.put(both ? 2 : 1);
        if (vertex.tipWeight < 1) {
            out.put(0).put(1 - vertex.tipWeight);
            putVec3(out, vertex.position);
        }
        if (vertex.tipWeight > 0) {
            out.put(1).put(vertex.tipWeight);
            putVec3(out, vertex.position - vec3(kElbow, 0, 0));
        }
    }
    return out;
}

ByteWriter mdrLod(const BarOptions& options, float thickness) {
    constexpr int kLodHeader = 12, kSurfaceHeader = 168;
    const ByteWriter vertices = mdrVertices(thickness);
    const std::vector<int> indices = barIndices();
    const auto vertexBytes = static_cast<int>(vertices.bytes().size()),
               indexBytes = static_cast<int>(indices.size()) * 4;
    ByteWriter out;
    out.ints({1, kLodHeader, kLodHeader + kSurfaceHeader + vertexBytes + indexBytes});
    out.text("", 4).text(options.surface, 64).text(options.shader, 64).ints({0, 0, 12, kSurfaceHeader});
    out.ints({static_cast<int>(indices.size() / 3), kSurfaceHeader + vertexBytes, 0, 0});
    out.put(kSurfaceHeader + vertexBytes + indexBytes).append(vertices.bytes());
    for (const int index : indices)
        out.put(index);
    return out;
}

// --- IQM: tables behind the header, offsets written as they come ---

struct IqmWriter {
    static constexpr int kHeader = 124;
    ByteWriter body;
    int at() const { return kHeader + static_cast<int>(body.bytes().size()); }
};

struct IqmTables {
    int text = 0, meshes = 0, arrays = 0, arrayCount = 0, triangles = 0, joints = 0, poses = 0, frames = 0, bounds = 0;
};

constexpr const char kIqmText[] = "\0root\0tip\0";
constexpr int kTextRoot = 1, kTextTip = 6, kTextSurface = 10;

void writeIqmArrays(const BarOptions& options, IqmWriter& out, IqmTables& tables) {
    const std::vector<BarVertex> vertices = barVertices(options.thickness);
    ByteWriter list;
    constexpr int kUByte = 1, kFloat = 7;
    const auto begin = [&](int kind, int format, int size) {
        list.ints({kind, 0, format, size, out.at()});
        ++tables.arrayCount;
    };
    begin(0, kFloat, 3);
    for (const BarVertex& vertex : vertices)
        putVec3(out.body, vertex.position);
    begin(1, kFloat, 2);
    for (const BarVertex& vertex : vertices)
        out.body.floats({vertex.st.x, vertex.st.y});
    begin(2, kFloat, 3);
    for (const BarVertex& vertex : vertices)
        putVec3(out.body, vertex.normal);
    if (options.skeleton) {
        begin(4, kUByte, 4);
        for (const BarVertex& vertex : vertices)
            out.body.put(vertex.tipWeight == 1 ? uint8_t{1} : uint8_t{0}).put(uint8_t{1}).put(uint16_t{0});
        begin(5, options.floatWeights ? kFloat : kUByte, 4);
        for (const BarVertex& vertex : vertices) {
            const bool both = vertex.tipWeight > 0 && vertex.tipWeight < 1;
            if (options.floatWeights)
                out.body.floats({both ? 0.5f : 1.0f, both ? 0.5f : 0.0f, 0, 0});
            else
                out.body.put(both ? uint8_t{128} : uint8_t{255}).put(both ? uint8_t{127} : uint8_t{0}).put(uint16_t{0});
        }
    }
    if (options.colors) {
        begin(6, kUByte, 4);
        for (const BarVertex& vertex : vertices) {
            const auto tip = static_cast<uint8_t>(vertex.tipWeight * 255);
            out.body.put(static_cast<uint8_t>(255 - tip)).put(uint8_t{0}).put(tip).put(uint8_t{255});
        }
    }
    tables.arrays = out.at();
    out.body.append(list.bytes());
}

void writeIqmSkeleton(const BarOptions& options, IqmWriter& out, IqmTables& tables) {
    tables.joints = out.at();
    out.body.ints({kTextRoot, -1}).floats({0, 0, 0, 0, 0, 0, 1, 1, 1, 1});
    out.body.ints({kTextTip, 0}).floats({kElbow, 0, 0, 0, 0, 0, 1, 1, 1, 1});
    tables.poses = out.at();
    // The tip's quaternion is stored: y and w, channels 4 and 6, in steps over -1 to 1.
    constexpr float kStep = 2.0f / 65535;
    out.body.ints({-1, 0}).floats({0, 0, 0, 0, 0, 0, 1, 1, 1, 1}).floats({0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    out.body.ints({0, 1 << 4 | 1 << 6});
    out.body.floats({kElbow, 0, 0, 0, -1, 0, -1, 1, 1, 1}).floats({0, 0, 0, 0, kStep, 0, kStep, 0, 0, 0});
    tables.frames = out.at();
    for (int frame = 0; frame < options.frames; ++frame)
        for (const float value : {-std::sin(bendRadians(frame) / 2), std::cos(bendRadians(frame) / 2)})
            out.body.put(static_cast<uint16_t>(std::lround((value + 1) / kStep)));
    if (!options.bounds) return;
    tables.bounds = out.at();
    for (int frame = 0; frame < options.frames; ++frame) {
        putVec3(out.body, vec3(-options.thickness));
        putVec3(out.body, vec3(kBarLengthQu + options.thickness));
        out.body.floats({kBarLengthQu, kBarLengthQu});
    }
}

} // namespace

std::vector<std::byte> makeBarMdr(const BarOptions& options) {
    constexpr int kHeader = 104, kTagBytes = 36;
    const ByteWriter frames = mdrFrames(options);
    ByteWriter lods;
    for (int lod = 0; lod < options.lods; ++lod)
        lods.append(mdrLod(options, options.thickness / static_cast<float>(1 << lod)).bytes());
    const int lodsAt = kHeader + static_cast<int>(frames.bytes().size());
    const int tagsAt = lodsAt + static_cast<int>(lods.bytes().size());
    ByteWriter out;
    out.text("RDM5", 4).put(2).text("bar", 64).ints({options.frames, 2, options.compressed ? -kHeader : kHeader});
    out.ints({options.lods, lodsAt, 2, tagsAt, tagsAt + 2 * kTagBytes});
    out.append(frames.bytes()).append(lods.bytes());
    for (int bone = 0; bone < 2; ++bone)
        out.put(bone).text(kBarBones[bone], 32);
    return out.bytes();
}

std::vector<std::byte> makeBarIqm(const BarOptions& options) {
    IqmWriter out;
    IqmTables tables;
    std::string text(kIqmText, sizeof kIqmText - 1);
    text += options.surface;
    text += '\0';
    const auto shaderAt = static_cast<int>(text.size());
    text += options.shader;
    text += '\0';
    text.resize((text.size() + 3) & ~size_t{3});
    tables.text = out.at();
    out.body.text(text, text.size());
    writeIqmArrays(options, out, tables);
    const std::vector<int> indices = barIndices();
    const auto triangleCount = static_cast<int>(indices.size() / 3);
    tables.meshes = out.at();
    out.body.ints({kTextSurface, shaderAt, 0, 12, 0, triangleCount});
    tables.triangles = out.at();
    for (const int index : indices)
        out.body.put(index);
    if (options.skeleton) writeIqmSkeleton(options, out, tables);
    const int joints = options.skeleton ? 2 : 0, frames = options.skeleton ? options.frames : 0;
    ByteWriter file;
    file.text("INTERQUAKEMODEL", 16)
        .ints({2, out.at(), 0, static_cast<int>(text.size()), tables.text, 1, tables.meshes});
    file.ints({tables.arrayCount, 12, tables.arrays, triangleCount, tables.triangles, 0, joints, tables.joints});
    file.ints({joints, tables.poses, 0, 0, frames, frames > 0 ? 2 : 0, tables.frames, tables.bounds, 0, 0, 0, 0});
    return file.append(out.body.bytes()).bytes();
}

} // namespace q3rt::test
