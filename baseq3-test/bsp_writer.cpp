// Layout: 8 bytes of identifier and version, 17 lumps of {offset, length}, then the lumps, each on a 4-byte boundary.

#include "baseq3-test/bsp_writer.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

namespace q3rt {

namespace {

constexpr size_t kLumpCount = 17, kHeaderBytes = 8 + kLumpCount * 8;
constexpr size_t kNameBytes = 64;

/// Little-endian fields, appended.
class Lump {
  public:
    void add(int value) {
        for (int shift = 0; shift < 32; shift += 8)
            bytes.push_back(static_cast<std::byte>(static_cast<uint32_t>(value) >> shift & 255u));
    }
    void add(uint32_t value) { add(static_cast<int>(value)); }
    void add(float value) { add(std::bit_cast<int>(value)); }
    void add(const vec2& v) { add(v.x), add(v.y); }
    void add(const vec3& v) { add(v.x), add(v.y), add(v.z); }
    void add(const ivec3& v) { add(v.x), add(v.y), add(v.z); }
    void add(const U8vec4& v) {
        for (int i = 0; i < 4; ++i)
            bytes.push_back(static_cast<std::byte>(v[i]));
    }
    void add(const std::vector<int>& values) {
        for (const int value : values)
            add(value);
    }
    void add(const std::vector<uint8_t>& values) {
        for (const uint8_t value : values)
            bytes.push_back(static_cast<std::byte>(value));
    }
    /// Zero-padded; longer names are cut as the format does.
    void addName(std::string_view name) {
        for (size_t i = 0; i < kNameBytes; ++i)
            bytes.push_back(static_cast<std::byte>(i < name.size() && i + 1 < kNameBytes ? name[i] : '\0'));
    }

    std::vector<std::byte> bytes;
};

template <class T, class Function>
Lump makeLump(const std::vector<T>& records, const Function& addRecord) {
    Lump lump;
    for (const T& record : records)
        addRecord(lump, record);
    return lump;
}

void addSurface(Lump& lump, const BspSurface& s) {
    lump.add(s.shader), lump.add(s.fog), lump.add(static_cast<int>(s.type));
    lump.add(s.firstVertex), lump.add(s.vertexCount), lump.add(s.firstIndex), lump.add(s.indexCount);
    lump.add(s.lightmap);
    // The place in the page, which no reader uses.
    lump.add(std::vector<int>(4));
    lump.add(s.lightmapOrigin);
    for (const vec3& vector : s.lightmapVectors)
        lump.add(vector);
    lump.add(s.patchWidth), lump.add(s.patchHeight);
}

std::vector<Lump> makeLumps(const Bsp& bsp) {
    std::vector<Lump> lumps(kLumpCount);
    for (const char c : bsp.entities)
        lumps[0].bytes.push_back(static_cast<std::byte>(c));
    lumps[0].bytes.push_back(std::byte{0});
    lumps[1] = makeLump(bsp.shaders, [](Lump& lump, const BspShader& s) {
        lump.addName(s.name), lump.add(s.surfaceFlags), lump.add(s.contentFlags);
    });
    lumps[2] = makeLump(bsp.planes, [](Lump& lump, const Plane& p) { lump.add(p.normal), lump.add(p.distance); });
    lumps[3] = makeLump(bsp.nodes, [](Lump& lump, const BspNode& n) {
        lump.add(n.plane), lump.add(n.children[0]), lump.add(n.children[1]), lump.add(n.mins), lump.add(n.maxs);
    });
    lumps[4] = makeLump(bsp.leafs, [](Lump& lump, const BspLeaf& l) {
        lump.add(l.cluster), lump.add(l.area), lump.add(l.mins), lump.add(l.maxs);
        lump.add(l.firstLeafSurface), lump.add(l.leafSurfaceCount), lump.add(l.firstLeafBrush),
            lump.add(l.leafBrushCount);
    });
    lumps[5].add(bsp.leafSurfaces);
    lumps[6].add(bsp.leafBrushes);
    lumps[7] = makeLump(bsp.models, [](Lump& lump, const BspModel& m) {
        lump.add(m.mins), lump.add(m.maxs);
        lump.add(m.firstSurface), lump.add(m.surfaceCount), lump.add(m.firstBrush), lump.add(m.brushCount);
    });
    lumps[8] = makeLump(bsp.brushes, [](Lump& lump, const BspBrush& b) {
        lump.add(b.firstSide), lump.add(b.sideCount), lump.add(b.shader);
    });
    lumps[9] =
        makeLump(bsp.brushSides, [](Lump& lump, const BspBrushSide& s) { lump.add(s.plane), lump.add(s.shader); });
    lumps[10] = makeLump(bsp.vertices, [](Lump& lump, const BspDrawVertex& v) {
        lump.add(v.position), lump.add(v.st), lump.add(v.lightmapSt), lump.add(v.normal), lump.add(v.color);
    });
    lumps[11].add(bsp.indices);
    lumps[12] = makeLump(bsp.fogs, [](Lump& lump, const BspFog& f) {
        lump.addName(f.shader), lump.add(f.brush), lump.add(f.visibleSide);
    });
    lumps[13] = makeLump(bsp.surfaces, addSurface);
    lumps[14].add(bsp.lightmaps);
    lumps[15].add(bsp.lightGrid);
    if (bsp.clusterCount > 0) {
        lumps[16].add(bsp.clusterCount), lumps[16].add(bsp.clusterRowBytes);
        lumps[16].add(bsp.visibility);
    }
    return lumps;
}

} // namespace

std::vector<std::byte> writeBsp(const Bsp& bsp) {
    Lump file;
    for (const char c : std::string_view("IBSP"))
        file.bytes.push_back(static_cast<std::byte>(c));
    file.add(46);
    const std::vector<Lump> lumps = makeLumps(bsp);
    const auto aligned = [](size_t size) { return (size + 3) / 4 * 4; };
    size_t offset = kHeaderBytes;
    for (const Lump& lump : lumps) {
        file.add(static_cast<int>(offset)), file.add(static_cast<int>(lump.bytes.size()));
        offset += aligned(lump.bytes.size());
    }
    for (const Lump& lump : lumps) {
        file.bytes.insert(file.bytes.end(), lump.bytes.begin(), lump.bytes.end());
        file.bytes.resize(aligned(file.bytes.size()));
    }
    return file.bytes;
}

} // namespace q3rt
