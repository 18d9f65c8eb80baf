#include "formats/bsp.hpp"

#include <cmath>

#include "formats/bsp_checks.hpp"
#include "formats/byte_reader.hpp"

namespace q3rt {
namespace {

constexpr int kBspVersion = 46;
constexpr size_t kBspNameBytes = 64;
constexpr size_t kLightmapBytes = size_t{3} * kLightmapSize * kLightmapSize;

enum Lump {
    kEntities,
    kShaders,
    kPlanes,
    kNodes,
    kLeafs,
    kLeafSurfaces,
    kLeafBrushes,
    kModels,
    kBrushes,
    kBrushSides,
    kDrawVertices,
    kDrawIndexes,
    kFogs,
    kSurfaces,
    kLightmaps,
    kLightGrid,
    kVisibility,
    kLumpCount,
};

struct LumpRule {
    const char* name;
    size_t recordBytes; ///< its length must be a multiple of this
};

constexpr LumpRule kLumpRules[kLumpCount] = {
    {"ENTITIES", 1},    {"SHADERS", 72},   {"PLANES", 16},   {"NODES", 36},     {"LEAFS", 48},     {"LEAFSURFACES", 4},
    {"LEAFBRUSHES", 4}, {"MODELS", 40},    {"BRUSHES", 12},  {"BRUSHSIDES", 8}, {"DRAWVERTS", 44}, {"DRAWINDEXES", 4},
    {"FOGS", 72},       {"SURFACES", 104}, {"LIGHTMAPS", 1}, {"LIGHTGRID", 1},  {"VISIBILITY", 1},
};

class BspParser {
  public:
    BspParser(std::span<const std::byte> file, std::string_view name)
        : m_file(file)
        , m_name(name) {
        readHeader();
    }

    Bsp parse() {
        Bsp bsp;
        readTexts(bsp);
        readTree(bsp);
        readBrushes(bsp);
        readVertices(bsp);
        readSurfaces(bsp);
        const auto lightmaps = m_lumps[kLightmaps];
        copyBytes(lightmaps.first(lightmaps.size() / kLightmapBytes * kLightmapBytes), bsp.lightmaps);
        copyBytes(m_lumps[kLightGrid], bsp.lightGrid);
        readVisibility(bsp);
        return bsp;
    }

  private:
    [[noreturn]] void fail(Lump lump, const std::string& what) const {
        throw ContentError(m_name + ": " + kLumpRules[lump].name + " lump: " + what +
                           "; the map is damaged, get it again");
    }

    void readHeader() {
        ByteReader header(m_file, m_name);
        const auto identifier = header.take(4);
        if (std::memcmp(identifier.data(), "IBSP", 4) != 0) throw ContentError(m_name + ": is no IBSP map");
        const int version = header.i32();
        if (version != kBspVersion)
            throw ContentError(formatText("%s: is an IBSP map of version %d; only version %d (Quake III) can be used",
                                          m_name.c_str(), version, kBspVersion));
        for (int i = 0; i < kLumpCount; ++i) {
            const auto lump = static_cast<Lump>(i);
            const auto offset = header.read<uint32_t>();
            const auto length = header.read<uint32_t>();
            if (length == 0) continue;
            if (offset > m_file.size() || length > m_file.size() - offset) fail(lump, "lies outside the file");
            if (length % kLumpRules[i].recordBytes != 0)
                fail(lump, formatText("%u bytes are no whole number of records", length));
            m_lumps[i] = m_file.subspan(offset, length);
        }
    }

    /// Calls `readRecord` for each record of a lump and collects what it returns.
    template <typename Record, typename Read>
    void readRecords(Lump lump, std::vector<Record>& records, Read readRecord) {
        const size_t count = m_lumps[lump].size() / kLumpRules[lump].recordBytes;
        records.reserve(count);
        ByteReader reader(m_lumps[lump], m_name);
        for (size_t i = 0; i < count; ++i)
            records.push_back(readRecord(reader, i));
    }

    static void copyBytes(std::span<const std::byte> bytes, std::vector<uint8_t>& copy) {
        const auto* first = reinterpret_cast<const uint8_t*>(bytes.data());
        copy.assign(first, first + bytes.size());
    }

    static ivec3 readInts(ByteReader& reader) {
        ivec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = reader.i32();
        return v;
    }

    /// A number that shading can live without: 0 where the file has none.
    static float readFinite(ByteReader& reader) {
        const float value = reader.f32();
        return std::isfinite(value) ? value : 0.0f;
    }
    static vec2 readFiniteVec2(ByteReader& reader) {
        const float x = readFinite(reader);
        return {x, readFinite(reader)};
    }
    static vec3 readFiniteVec3(ByteReader& reader) {
        const vec2 xy = readFiniteVec2(reader);
        return {xy, readFinite(reader)};
    }

    /// A number that geometry stands on.
    float readNeeded(ByteReader& reader, Lump lump, size_t record) const {
        const float value = reader.f32();
        if (!std::isfinite(value)) fail(lump, formatText("record %zu holds a number that is not finite", record));
        return value;
    }
    vec3 readNeededVec3(ByteReader& reader, Lump lump, size_t record) const {
        vec3 v;
        for (int i = 0; i < 3; ++i)
            v[i] = readNeeded(reader, lump, record);
        return v;
    }

    void readTexts(Bsp& bsp) {
        const auto lump = m_lumps[kEntities];
        const std::string_view text(reinterpret_cast<const char*>(lump.data()), lump.size());
        bsp.entities = text.substr(0, text.find('\0'));
        readRecords(kShaders, bsp.shaders, [](ByteReader& reader, size_t) {
            BspShader shader;
            shader.name = reader.text(kBspNameBytes);
            shader.surfaceFlags = reader.read<uint32_t>();
            shader.contentFlags = reader.read<uint32_t>();
            return shader;
        });
        readRecords(kFogs, bsp.fogs, [](ByteReader& reader, size_t) {
            BspFog fog;
            fog.shader = reader.text(kBspNameBytes);
            fog.brush = reader.i32();
            fog.visibleSide = reader.i32();
            return fog;
        });
    }

    void readTree(Bsp& bsp) {
        readRecords(kPlanes, bsp.planes, [this](ByteReader& reader, size_t i) {
            Plane plane;
            plane.normal = readNeededVec3(reader, kPlanes, i);
            plane.distance = readNeeded(reader, kPlanes, i);
            return plane;
        });
        readRecords(kNodes, bsp.nodes, [](ByteReader& reader, size_t) {
            BspNode node;
            node.plane = reader.i32();
            node.children[0] = reader.i32();
            node.children[1] = reader.i32();
            node.mins = readInts(reader);
            node.maxs = readInts(reader);
            return node;
        });
        readRecords(kLeafs, bsp.leafs, [](ByteReader& reader, size_t) {
            BspLeaf leaf;
            leaf.cluster = reader.i32();
            leaf.area = reader.i32();
            leaf.mins = readInts(reader);
            leaf.maxs = readInts(reader);
            leaf.firstLeafSurface = reader.i32();
            leaf.leafSurfaceCount = reader.i32();
            leaf.firstLeafBrush = reader.i32();
            leaf.leafBrushCount = reader.i32();
            return leaf;
        });
        const auto readInt = [](ByteReader& reader, size_t) { return reader.i32(); };
        readRecords(kLeafSurfaces, bsp.leafSurfaces, readInt);
        readRecords(kLeafBrushes, bsp.leafBrushes, readInt);
    }

    void readBrushes(Bsp& bsp) {
        readRecords(kModels, bsp.models, [this](ByteReader& reader, size_t i) {
            BspModel model;
            model.mins = readNeededVec3(reader, kModels, i);
            model.maxs = readNeededVec3(reader, kModels, i);
            model.firstSurface = reader.i32();
            model.surfaceCount = reader.i32();
            model.firstBrush = reader.i32();
            model.brushCount = reader.i32();
            return model;
        });
        readRecords(kBrushes, bsp.brushes, [](ByteReader& reader, size_t) {
            BspBrush brush;
            brush.firstSide = reader.i32();
            brush.sideCount = reader.i32();
            brush.shader = reader.i32();
            return brush;
        });
        readRecords(kBrushSides, bsp.brushSides, [](ByteReader& reader, size_t) {
            BspBrushSide side;
            side.plane = reader.i32();
            side.shader = reader.i32();
            return side;
        });
    }

    void readVertices(Bsp& bsp) {
        readRecords(kDrawVertices, bsp.vertices, [this](ByteReader& reader, size_t i) {
            BspDrawVertex vertex;
            vertex.position = readNeededVec3(reader, kDrawVertices, i);
            vertex.st = readFiniteVec2(reader);
            vertex.lightmapSt = readFiniteVec2(reader);
            vertex.normal = readFiniteVec3(reader);
            for (int channel = 0; channel < 4; ++channel)
                vertex.color[channel] = reader.u8();
            return vertex;
        });
        readRecords(kDrawIndexes, bsp.indices, [](ByteReader& reader, size_t) { return reader.i32(); });
    }

    void readSurfaces(Bsp& bsp) {
        readRecords(kSurfaces, bsp.surfaces, [this, &bsp](ByteReader& reader, size_t i) {
            BspSurface surface;
            surface.shader = reader.i32();
            surface.fog = reader.i32();
            const int type = reader.i32();
            if (type < static_cast<int>(BspSurfaceType::Planar) || type > static_cast<int>(BspSurfaceType::Flare))
                fail(kSurfaces, formatText("record %zu has the unknown type %d", i, type));
            surface.type = static_cast<BspSurfaceType>(type);
            surface.firstVertex = reader.i32();
            surface.vertexCount = reader.i32();
            surface.firstIndex = reader.i32();
            surface.indexCount = reader.i32();
            surface.lightmap = reader.i32();
            reader.skip(16); // place and size inside the page: the texture coordinates say it already
            surface.lightmapOrigin = readFiniteVec3(reader);
            for (vec3& vector : surface.lightmapVectors)
                vector = readFiniteVec3(reader);
            surface.patchWidth = reader.i32();
            surface.patchHeight = reader.i32();
            // Some compilers left a fog number on flares of maps without fog; a flare has no use for it.
            const bool noSuchFog = surface.fog < 0 || static_cast<size_t>(surface.fog) >= bsp.fogs.size();
            if (surface.type == BspSurfaceType::Flare && noSuchFog) surface.fog = -1;
            return surface;
        });
    }

    void readVisibility(Bsp& bsp) {
        if (m_lumps[kVisibility].empty()) return;
        ByteReader reader(m_lumps[kVisibility], m_name);
        if (reader.remaining() < 8) fail(kVisibility, "is shorter than its header");
        bsp.clusterCount = reader.i32();
        bsp.clusterRowBytes = reader.i32();
        if (bsp.clusterCount < 0 || bsp.clusterRowBytes < 0) fail(kVisibility, "its counts are negative");
        const uint64_t length = uint64_t(bsp.clusterCount) * uint64_t(bsp.clusterRowBytes);
        if (uint64_t(bsp.clusterRowBytes) * 8 < uint64_t(bsp.clusterCount)) fail(kVisibility, "its rows are too short");
        if (length > reader.remaining()) fail(kVisibility, "is shorter than its rows");
        copyBytes(reader.take(static_cast<size_t>(length)), bsp.visibility);
    }

    std::span<const std::byte> m_file;
    std::string m_name;
    std::span<const std::byte> m_lumps[kLumpCount];
};

} // namespace

bool Bsp::clusterVisible(int from, int to) const {
    if (from < 0 || to < 0 || from >= clusterCount || to >= clusterCount) return true;
    const size_t row = static_cast<size_t>(from) * static_cast<size_t>(clusterRowBytes);
    return (visibility[row + static_cast<size_t>(to >> 3)] >> (to & 7) & 1) != 0;
}

Bsp parseBsp(std::span<const std::byte> file, std::string_view name) {
    Bsp bsp = BspParser(file, name).parse();
    checkBspReferences(bsp, name);
    return bsp;
}

} // namespace q3rt
