// All of OpenArena's data through the parsers, compared with an independent census (tests/fixtures).

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "formats/image.hpp"
#include "formats/md3.hpp"
#include "formats/shader_script.hpp"
#include "formats/skin.hpp"
#include "formats/text_case.hpp"
#include "support/game_data.hpp"

namespace q3rt {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> readFixture(const std::string& name) {
    std::ifstream file(std::string(Q3RT_SOURCE_DIR) + "/tests/fixtures/" + name);
    const auto split = [](const std::string& line) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');)
            cells.push_back(cell);
        return cells;
    };
    std::string line;
    std::getline(file, line);
    const auto header = split(line);
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        const auto cells = split(line);
        Row row;
        for (size_t i = 0; i < header.size() && i < cells.size(); ++i)
            row[header[i]] = cells[i];
        rows.push_back(std::move(row));
    }
    return rows;
}

long count(const Row& row, const std::string& column) { return std::stol(row.at(column)); }

std::string_view asText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads and parses each map of the census and hands it over, with its file.
template <typename Visit>
void forEachMap(Pk3FileSource& files, Visit visit) {
    size_t maps = 0;
    for (const Row& row : readFixture("map_census.csv")) {
        const std::string name = "maps/" + row.at("map") + ".bsp";
        SCOPED_TRACE(name);
        const auto file = files.read(name);
        ASSERT_TRUE(file);
        visit(row, parseBsp(*file, name), *file);
        ++maps;
    }
    EXPECT_EQ(maps, 85u);
}

long zeroAreaTriangles(const Bsp& bsp) {
    long found = 0;
    for (const BspSurface& surface : bsp.surfaces) {
        if (surface.type != BspSurfaceType::Planar && surface.type != BspSurfaceType::TriangleSoup) continue;
        for (int i = 0; i < surface.indexCount; i += 3) {
            dvec3 corner[3];
            for (int k = 0; k < 3; ++k) {
                const int index = bsp.indices[static_cast<size_t>(surface.firstIndex + i + k)];
                corner[k] = bsp.vertices[static_cast<size_t>(surface.firstVertex + index)].position;
            }
            // Area in square units up to which the census called a triangle empty.
            constexpr double kNothing = 1e-3;
            if (glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) / 2 <= kNothing) ++found;
        }
    }
    return found;
}

TEST(GameData, AllMapsHaveTheFacesOfTheCensus) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    forEachMap(*files, [](const Row& row, const Bsp& bsp, const auto&) {
        std::array<long, 5> faces{};
        for (const BspSurface& surface : bsp.surfaces)
            ++faces.at(static_cast<size_t>(surface.type));
        EXPECT_EQ(faces[1], count(row, "planar"));
        EXPECT_EQ(faces[2], count(row, "patch"));
        EXPECT_EQ(faces[3], count(row, "mesh"));
        EXPECT_EQ(faces[4], count(row, "flare"));
        EXPECT_EQ(static_cast<long>(bsp.vertices.size()), count(row, "verts"));
        EXPECT_EQ(static_cast<long>(bsp.indices.size()), count(row, "indexes"));
        EXPECT_EQ(static_cast<long>(bsp.models.size()) - 1, count(row, "brush_models"));
        EXPECT_EQ(static_cast<long>(bsp.leafs.size()), count(row, "leafs"));
        EXPECT_EQ(static_cast<long>(bsp.nodes.size()), count(row, "nodes"));
        EXPECT_EQ(bsp.clusterCount, count(row, "clusters"));
        EXPECT_EQ(static_cast<long>(bsp.lightmapPageCount()), count(row, "lightmaps"));
        EXPECT_EQ(static_cast<long>(bsp.lightGrid.size()), count(row, "lightgrid_bytes"));
        EXPECT_EQ(static_cast<long>(bsp.fogs.size()), count(row, "fogs"));
        EXPECT_EQ(static_cast<long>(bsp.shaders.size()), count(row, "shaders_lump"));
        EXPECT_EQ(static_cast<long>(parseEntities(bsp.entities).size()), count(row, "entities"));
    });
}

TEST(GameData, MeanVisibilityIsThatOfTheCensus) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    forEachMap(*files, [](const Row& row, const Bsp& bsp, const auto&) {
        if (bsp.clusterCount > 1000) return; // quadratic; the smaller maps say enough
        long visible = 0;
        for (int from = 0; from < bsp.clusterCount; ++from) {
            for (int to = 0; to < bsp.clusterCount; ++to)
                visible += bsp.clusterVisible(from, to);
        }
        const double share = static_cast<double>(visible) / bsp.clusterCount / bsp.clusterCount;
        EXPECT_NEAR(share, std::stod(row.at("pvs_mean_frac")), 5.1e-5); // the census has 4 decimals
    });
}

TEST(GameData, T1NodrawPatches) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    long all = 0;
    forEachMap(*files, [&](const Row& row, const Bsp& bsp, const auto&) {
        long nodraw = 0;
        for (const BspSurface& surface : bsp.surfaces) {
            if (!(bsp.shaders[static_cast<size_t>(surface.shader)].surfaceFlags & kBspSurfaceNodraw)) continue;
            EXPECT_EQ(surface.type, BspSurfaceType::Patch);
            ++nodraw;
        }
        EXPECT_EQ(nodraw, count(row, "nodraw_patches"));
        all += nodraw;
    });
    EXPECT_EQ(all, 3065);
}

TEST(GameData, T2LightmapCoordinatesAreFinite) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    long mapsWithNan = 0;
    forEachMap(*files, [&](const Row&, const Bsp& bsp, const std::vector<std::byte>& file) {
        uint32_t vertexLump = 0;
        std::memcpy(&vertexLump, file.data() + 8 + 8 * 10, sizeof(vertexLump));
        bool nanStored = false;
        for (size_t i = 0; i < bsp.vertices.size(); ++i) {
            float stored[2];
            std::memcpy(stored, file.data() + vertexLump + i * 44 + 20, sizeof(stored));
            nanStored = nanStored || std::isnan(stored[0]) || std::isnan(stored[1]);
            const vec2 st = bsp.vertices[i].lightmapSt;
            ASSERT_TRUE(std::isfinite(st.x) && std::isfinite(st.y)) << "vertex " << i;
        }
        mapsWithNan += nanStored;
    });
    EXPECT_EQ(mapsWithNan, 18);
}

TEST(GameData, T3HugeTextureCoordinatesAreKept) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const auto file = files->read("maps/oa_thor.bsp");
    ASSERT_TRUE(file);
    float largest = 0;
    for (const BspDrawVertex& vertex : parseBsp(*file, "oa_thor").vertices)
        largest = std::max({largest, std::abs(vertex.st.x), std::abs(vertex.st.y)});
    EXPECT_GT(largest, 2.8e9f);
    EXPECT_LT(largest, 3.0e9f);
}

TEST(GameData, T5ZeroAreaTriangles) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    long all = 0, maps = 0;
    forEachMap(*files, [&](const Row& row, const Bsp& bsp, const auto&) {
        const long found = zeroAreaTriangles(bsp);
        EXPECT_EQ(found, count(row, "degenerate_tris"));
        all += found;
        maps += found > 0;
    });
    EXPECT_EQ(all, 1171);
    EXPECT_EQ(maps, 60);
}

ScriptLibrary loadScripts(Pk3FileSource& files) {
    ScriptLibrary library;
    for (const std::string& name : files.list("scripts", ".shader"))
        library.addFile(asText(*files.read("scripts/" + name)), "scripts/" + name, {});
    return library;
}

bool imageExists(Pk3FileSource& files, const std::string& name) {
    for (const char* extension : {".tga", ".jpg", ".jpeg", ".png", ".pcx", ".bmp"}) {
        if (files.findOrigin(name + extension)) return true;
    }
    return false;
}

TEST(GameData, T6MissingWorldTextures) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const ScriptLibrary library = loadScripts(*files);
    std::map<std::string, bool> known;
    long faces = 0;
    std::set<std::string> maps;
    forEachMap(*files, [&](const Row& row, const Bsp& bsp, const auto&) {
        for (const BspSurface& surface : bsp.surfaces) {
            const BspShader& shader = bsp.shaders[static_cast<size_t>(surface.shader)];
            if (surface.type == BspSurfaceType::Flare || shader.surfaceFlags & kBspSurfaceNodraw) continue;
            auto [entry, isNew] = known.try_emplace(shader.name);
            if (isNew) entry->second = library.find(shader.name) || imageExists(*files, shader.name);
            if (entry->second) continue;
            ++faces;
            maps.insert(row.at("map"));
        }
    });
    EXPECT_EQ(faces, 38);
    EXPECT_EQ(maps, (std::set<std::string>{"cbctf1", "oa_spirit3", "oacmpdm2", "oacmpdm5", "oacmpdm6", "ps37ctf"}));
}

TEST(GameData, T7RemapKeysOfTerrainMaps) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    for (const char* name : {"maps/islandctf.bsp", "maps/islanddm.bsp"}) {
        const auto file = files->read(name);
        ASSERT_TRUE(file);
        const auto entities = parseEntities(parseBsp(*file, name).entities);
        ASSERT_FALSE(entities.empty());
        long keys = 0;
        for (const auto& [key, value] : entities[0].pairs) {
            if (!key.starts_with("vertexremapshader")) continue;
            EXPECT_NE(value.find("METASHADER_NAME"), std::string::npos) << value;
            ++keys;
        }
        EXPECT_EQ(keys, 15) << name;
    }
}

TEST(GameData, T8LightmappedSurfacesWhoseScriptUsesNoLightmap) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const ScriptLibrary library = loadScripts(*files);
    const auto usesLightmap = [](const ScriptDefinition& definition) {
        for (const ScriptStage& stage : definition.stages) {
            for (const ScriptLine& line : stage.lines) {
                if (line.keyword == "map" && equalsIgnoringCase(line.arguments.at(0), "$lightmap")) return true;
            }
        }
        return false;
    };
    std::set<std::string> shaders;
    forEachMap(*files, [&](const Row&, const Bsp& bsp, const auto&) {
        for (const BspSurface& surface : bsp.surfaces) {
            const BspShader& shader = bsp.shaders[static_cast<size_t>(surface.shader)];
            if (surface.lightmap < 0) continue;
            const ScriptDefinition* definition = library.find(shader.name);
            if (definition && !usesLightmap(*definition)) shaders.insert(toLowerAscii(shader.name));
        }
    });
    EXPECT_EQ(shaders.size(), 60u);
}

TEST(GameData, AllMapsOfAllArchivesParse) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    std::set<uint32_t> distinct;
    for (const Pk3* archive : files->archives()) {
        for (size_t i = 0; i < archive->entries().size(); ++i) {
            const Pk3Entry& entry = archive->entries()[i];
            if (!toLowerAscii(entry.name).ends_with(".bsp") || !distinct.insert(entry.crc32).second) continue;
            EXPECT_NO_THROW(parseBsp(archive->read(i), entry.name)) << archive->path() << " " << entry.name;
        }
    }
    EXPECT_EQ(distinct.size(), 113u);
}

TEST(GameData, EveryScriptKeywordAsOftenAsTheCensusSays) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    std::map<std::string, long> all, winning;
    const auto addTo = [](std::map<std::string, long>& counts, const ScriptDefinition& definition) {
        for (const ScriptLine& line : definition.lines)
            ++counts["top " + line.keyword];
        for (const ScriptStage& stage : definition.stages) {
            for (const ScriptLine& line : stage.lines)
                ++counts["stage " + line.keyword];
        }
    };
    const auto names = files->list("scripts", ".shader");
    EXPECT_EQ(names.size(), 120u);
    size_t definitions = 0;
    for (const std::string& name : names) {
        const auto report = [](std::string_view file, int line, std::string_view what) {
            ADD_FAILURE() << file << ":" << line << ": " << what;
        };
        for (const auto& definition : parseShaderScript(asText(*files->read("scripts/" + name)), name, report)) {
            addTo(all, definition);
            ++definitions;
        }
    }
    const ScriptLibrary library = loadScripts(*files);
    long failed = 0;
    for (const ScriptDefinition* definition : library.all()) {
        addTo(winning, *definition);
        failed += definition->failed;
    }
    EXPECT_EQ(definitions, 2491u);
    EXPECT_EQ(library.size(), 2228u);
    EXPECT_EQ(failed, 28); // no stage, neither sky nor fog
    const auto rows = readFixture("shader_keywords.csv");
    EXPECT_EQ(rows.size(), 59u);
    for (const Row& row : rows) {
        const std::string key = row.at("level") + " " + row.at("keyword");
        EXPECT_EQ(all[key], count(row, "occurrences_all")) << key;
        EXPECT_EQ(winning[key], count(row, "occurrences_winning")) << key;
    }
    EXPECT_EQ(all.size(), rows.size());
}

TEST(GameData, TheLowestArchiveWinsADuplicateShader) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const ScriptLibrary library = loadScripts(*files);
    const auto surfaceLight = [&](const char* name) -> std::string {
        const ScriptDefinition* definition = library.find(name);
        if (!definition) return "(none)";
        for (const ScriptLine& line : definition->lines) {
            if (line.keyword == "q3map_surfacelight") return line.arguments.at(0);
        }
        return "(no light)";
    };
    EXPECT_EQ(surfaceLight("textures/base_light/ceil1_34"), "300");
    const ScriptDefinition* tinyLight = library.find("textures/evil8_lights/e8tinylight");
    ASSERT_TRUE(tinyLight);
    EXPECT_EQ(tinyLight->file, "scripts/evil8.shader");
    const auto origin = files->findOrigin(tinyLight->file);
    ASSERT_TRUE(origin);
    EXPECT_EQ(origin->container.filename(), "pak0.pk3");
}

/// Does the engine take `name` from this archive?
bool isWinningCopy(Pk3FileSource& files, const std::string& name, const Pk3& archive) {
    const auto origin = files.findOrigin(name);
    return origin && origin->container == archive.path();
}

TEST(GameData, AllModelsAndSkinsParse) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    size_t models = 0, empty = 0, mostFrames = 0, mostVertices = 0, mostTriangles = 0, skins = 0;
    for (const Pk3* archive : files->archives()) {
        for (size_t i = 0; i < archive->entries().size(); ++i) {
            const std::string name = toLowerAscii(archive->entries()[i].name);
            if (!isWinningCopy(*files, name, *archive)) continue;
            if (name.ends_with(".skin")) {
                parseSkin(asText(archive->read(i)));
                ++skins;
            }
            if (!name.ends_with(".md3")) continue;
            const Md3 model = parseMd3(archive->read(i), name);
            ++models;
            empty += model.surfaces.empty();
            mostFrames = std::max(mostFrames, model.frames.size());
            for (const Md3Surface& surface : model.surfaces) {
                mostVertices = std::max(mostVertices, surface.vertexCount);
                mostTriangles = std::max(mostTriangles, surface.indices.size() / 3);
            }
        }
    }
    EXPECT_EQ(models, 293u);
    EXPECT_EQ(empty, 10u);
    EXPECT_EQ(mostFrames, 325u);
    EXPECT_EQ(mostVertices, 1599u);
    EXPECT_EQ(mostTriangles, 2422u);
    EXPECT_EQ(skins, 276u);
}

TEST(GameData, AllImagesDecode) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    std::map<std::string, size_t> decoded, refused;
    for (const Pk3* archive : files->archives()) {
        for (size_t i = 0; i < archive->entries().size(); ++i) {
            const std::string name = toLowerAscii(archive->entries()[i].name);
            const size_t dot = std::min(name.rfind('.'), name.size());
            const std::string extension = name.substr(dot);
            if (extension != ".tga" && extension != ".jpg" && extension != ".png" && extension != ".pcx") continue;
            if (!isWinningCopy(*files, name, *archive)) continue;
            try {
                const Image image = decodeImage(archive->read(i), name);
                EXPECT_EQ(image.rgba.size(), static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 4);
                ++decoded[extension];
            } catch (const ContentError&) {
                ++refused[extension];
            }
        }
    }
    EXPECT_EQ(decoded[".tga"], 1584u);
    EXPECT_EQ(decoded[".jpg"], 1613u);
    EXPECT_EQ(decoded[".png"], 7u);
    // Both are true-colour PCX, which the engine's loader refuses as well.
    EXPECT_EQ(refused, (std::map<std::string, size_t>{{".pcx", 2}}));
}

} // namespace
} // namespace q3rt
