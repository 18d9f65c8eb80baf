#include "support/tiny_files.hpp"

namespace q3rt::test {

void ByteWriter::addBytes(const void* bytes, size_t count) {
    const auto* first = static_cast<const std::byte*>(bytes);
    m_bytes.insert(m_bytes.end(), first, first + count);
}
namespace {

std::vector<std::byte> toBytes(const std::vector<uint8_t>& values) {
    std::vector<std::byte> bytes;
    for (const uint8_t value : values)
        bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

void putVertex(ByteWriter& writer, float x, float y) {
    writer.floats({x, y, 0, x / 64, y / 64, 0.25f, 0.75f, 0, 0, 1}).put(uint32_t{0xFF804020});
}

void putSurface(ByteWriter& writer, int type, int firstVertex, int vertexCount, int indexCount, int patchSide) {
    writer.ints({0, -1, type, firstVertex, vertexCount, 0, indexCount, 0, 0, 0, 0, 0});
    writer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).ints({patchSide, patchSide});
}

} // namespace

TinyBsp::TinyBsp() {
    const std::string entities = "{ \"classname\" \"worldspawn\" }\n";
    lumps[0] = ByteWriter().text(entities, entities.size()).bytes();
    lumps[1] = ByteWriter().text("textures/a/b", 64).ints({0, 1}).bytes();
    lumps[2] = ByteWriter().floats({0, 0, 1, 0, 0, 0, -1, 0}).bytes();
    lumps[3] = ByteWriter().ints({0, -1, -2, -64, -64, -64, 64, 64, 64}).bytes();
    ByteWriter leafs;
    for (int cluster = 0; cluster < 2; ++cluster)
        leafs.ints({cluster, 0, -64, -64, -64, 64, 64, 64, 0, 2, 0, 1});
    lumps[4] = leafs.bytes();
    lumps[5] = ByteWriter().ints({0, 1}).bytes();
    lumps[6] = ByteWriter().ints({0}).bytes();
    lumps[7] = ByteWriter().floats({-64, -64, -64, 64, 64, 64}).ints({0, 2, 0, 1}).bytes();
    lumps[8] = ByteWriter().ints({0, 6, 0}).bytes();
    ByteWriter sides;
    for (int side = 0; side < 6; ++side)
        sides.ints({side % 2, 0});
    lumps[9] = sides.bytes();
    ByteWriter vertices;
    putVertex(vertices, 0, 0);
    putVertex(vertices, 64, 0);
    putVertex(vertices, 64, 64);
    putVertex(vertices, 0, 64);
    for (int i = 0; i < 9; ++i)
        putVertex(vertices, static_cast<float>(i % 3), static_cast<float>(i / 3));
    lumps[10] = vertices.bytes();
    lumps[11] = ByteWriter().ints({0, 2, 1, 0, 3, 2}).bytes();
    lumps[12] = ByteWriter().text("textures/fog/f", 64).ints({0, 5}).bytes();
    ByteWriter surfaces;
    putSurface(surfaces, 1, 0, 4, 6, 0);
    putSurface(surfaces, 2, 4, 9, 0, 3);
    lumps[13] = surfaces.bytes();
    lumps[14].resize(3 * 128 * 128, std::byte{100});
    lumps[15].resize(8, std::byte{50});
    lumps[16] = ByteWriter().ints({2, 1}).put(uint8_t{1}).put(uint8_t{3}).bytes();
}

std::vector<std::byte> TinyBsp::build() const {
    ByteWriter header, body;
    header.text("IBSP", 4).put(version);
    for (const auto& lump : lumps) {
        header.put(static_cast<uint32_t>(8 + 17 * 8 + body.bytes().size())).put(static_cast<uint32_t>(lump.size()));
        body.append(lump);
    }
    return header.append(body.bytes()).bytes();
}

std::vector<std::byte> makeTinyMd3(const std::string& surfaceName, const std::string& shader) {
    ByteWriter frames, tags, surface;
    for (int frame = 0; frame < 2; ++frame)
        frames.floats({-1, -1, -1, 1, 1, 1, 0, 0, 0, 2}).text("frame", 16);
    for (int frame = 0; frame < 2; ++frame)
        tags.text("tag_torso", 64).floats({static_cast<float>(frame), 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    const int shaders = 108, triangles = shaders + 68, st = triangles + 12, vertices = st + 24, end = vertices + 48;
    surface.text("IDP3", 4).text(surfaceName, 64).ints({0, 2, 1, 3, 1, triangles, shaders, st, vertices, end});
    surface.text(shader, 64).ints({0}).ints({0, 1, 2}).floats({0, 0, 1, 0, 0, 1});
    for (int16_t vertex = 0; vertex < 6; ++vertex)
        surface.put(static_cast<int16_t>(64 * vertex))
            .put(int16_t{-64})
            .put(int16_t{32})
            .put(static_cast<uint16_t>(vertex * 37));
    const int framesAt = 108, tagsAt = framesAt + 2 * 56, surfacesAt = tagsAt + 2 * 112;
    ByteWriter file;
    file.text("IDP3", 4)
        .ints({15})
        .text("tiny", 64)
        .ints({0, 2, 1, 1, 0, framesAt, tagsAt, surfacesAt, surfacesAt + end});
    return file.append(frames.bytes()).append(tags.bytes()).append(surface.bytes()).bytes();
}

std::vector<std::byte> makeTga(int type, int width, int height, int bitsPerPixel, const std::vector<uint8_t>& payload,
                               int descriptor) {
    ByteWriter file;
    file.put(uint8_t{0}).put(uint8_t{0}).put(static_cast<uint8_t>(type)).text("", 9);
    file.put(static_cast<uint16_t>(width)).put(static_cast<uint16_t>(height));
    file.put(static_cast<uint8_t>(bitsPerPixel)).put(static_cast<uint8_t>(descriptor));
    return file.append(toBytes(payload)).bytes();
}

std::vector<std::byte> makePcx(int width, int height, const std::vector<uint8_t>& payload) {
    ByteWriter file;
    file.put(uint8_t{10}).put(uint8_t{5}).put(uint8_t{1}).put(uint8_t{8}).put(uint32_t{0});
    file.put(static_cast<uint16_t>(width - 1)).put(static_cast<uint16_t>(height - 1)).text("", 4 + 48 + 1);
    file.put(uint8_t{1}).put(static_cast<uint16_t>(width)).text("", 60);
    file.append(toBytes(payload)).put(uint8_t{12});
    for (int i = 0; i < 256; ++i)
        file.put(static_cast<uint8_t>(i)).put(static_cast<uint8_t>(255 - i)).put(uint8_t{7});
    return file.bytes();
}

std::vector<std::byte> makeBmp(int width, int height, int bitsPerPixel, const std::vector<uint8_t>& payload) {
    ByteWriter file;
    const int paletteBytes = bitsPerPixel == 8 ? 1024 : 0;
    file.text("BM", 2).ints({0, 0, 54 + paletteBytes, 40, width, height}).put(uint16_t{1});
    file.put(static_cast<uint16_t>(bitsPerPixel)).ints({0, 0, 0, 0, 0, 0});
    return file.append(toBytes(payload)).bytes();
}

std::vector<std::byte> makeFont() {
    ByteWriter file;
    for (int i = 0; i < 256; ++i)
        file.ints({i, 1, 2, 3, 4, 5, 6}).floats({0.1f, 0.2f, 0.3f, 0.4f}).ints({9}).text("g" + std::to_string(i), 32);
    return file.floats({1.5f}).text("fonts/fontImage_16.dat", 64).bytes();
}

} // namespace q3rt::test
