#include "md3_builder.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace q3rt::test {
namespace {

class Writer {
  public:
    std::vector<std::byte> bytes;

    void raw(const void* data, size_t size) {
        const size_t at = bytes.size();
        bytes.resize(at + size);
        std::memcpy(bytes.data() + at, data, size);
    }
    void integer(size_t value) {
        const auto word = static_cast<uint32_t>(value);
        raw(&word, sizeof word);
    }
    void number(float value) { raw(&value, sizeof value); }
    void vector(const vec3& v) {
        for (int i = 0; i < 3; ++i) {
            number(v[i]);
        }
    }
    void text(const std::string& value, size_t size) {
        std::vector<char> field(size, 0);
        std::memcpy(field.data(), value.data(), std::min(value.size(), size - 1));
        raw(field.data(), size);
    }
};

constexpr size_t kHeader = 108, kFrame = 56, kTag = 112, kShader = 68, kTriangle = 12, kSt = 8, kVertex = 8;

void writeSurface(Writer& out, const std::vector<Md3TestFrame>& frames, const std::string& shader) {
    const size_t triangles = kHeader + kShader, st = triangles + kTriangle, vertices = st + 3 * kSt;
    out.raw("IDP3", 4);
    out.text("body", 64);
    for (const size_t field : {size_t{0}, frames.size(), size_t{1}, size_t{3}, size_t{1}, triangles, kHeader, st,
                               vertices, vertices + frames.size() * 3 * kVertex}) {
        out.integer(field);
    }
    out.text(shader, 64);
    out.integer(0);
    for (const size_t index : {size_t{0}, size_t{1}, size_t{2}}) {
        out.integer(index);
    }
    const vec2 corners[3] = {{0, 0}, {0, 8}, {8, 0}};
    for (const vec2& corner : corners) {
        out.number(corner.x / 8);
        out.number(corner.y / 8);
    }
    for (const Md3TestFrame& frame : frames) {
        for (const vec2& corner : corners) {
            const int16_t position[3] = {static_cast<int16_t>(corner.x * 64), static_cast<int16_t>(corner.y * 64),
                                         static_cast<int16_t>(frame.height * 64)};
            out.raw(position, sizeof position);
            const uint16_t up = 0; // latitude and longitude 0: +z
            out.raw(&up, sizeof up);
        }
    }
}

} // namespace

std::vector<std::byte> buildMd3(const std::vector<Md3TestFrame>& frames, const std::string& shader) {
    Writer out;
    const size_t tagCount = frames[0].tags.size();
    const size_t tags = kHeader + frames.size() * kFrame, surfaces = tags + frames.size() * tagCount * kTag;
    const size_t surfaceBytes = kHeader + kShader + kTriangle + 3 * kSt + frames.size() * 3 * kVertex;
    out.raw("IDP3", 4);
    out.integer(15);
    out.text("test", 64);
    for (const size_t field :
         {size_t{0}, frames.size(), tagCount, size_t{1}, size_t{0}, kHeader, tags, surfaces, surfaces + surfaceBytes}) {
        out.integer(field);
    }
    for (const Md3TestFrame& frame : frames) {
        out.vector(frame.mins);
        out.vector(frame.maxs);
        out.vector(vec3(0));
        out.number(frame.radius);
        out.text("frame", 16);
    }
    for (const Md3TestFrame& frame : frames) {
        for (const auto& [name, orientation] : frame.tags) {
            out.text(name, 64);
            out.vector(orientation.origin);
            for (const vec3& axis : orientation.axis) {
                out.vector(axis);
            }
        }
    }
    writeSurface(out, frames, shader);
    return out.bytes;
}

} // namespace q3rt::test
