#pragma once
// What a recording holds: every call of the engine into a renderer with its data and result, and what the renderer saw
// through its imports. One struct a call; `fields` lists the members once, for writing and for reading.
// Handles are the recording's own numbers, counted from 1 per kind (model, skin, shader) in the order of registration.
// The position of a type in TraceEvent is its code in the file: append only, or raise kTraceVersion.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "abi/ref_types.h"
#include "trace/trace_queries.hpp"

namespace q3rt {

namespace event {

// --- engine to renderer ---
struct Shutdown {
    int32_t destroyWindow = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(destroyWindow);
    }
};
/// Sizes are what the recorded renderer reported, in pixels.
struct BeginRegistration {
    int32_t width = 0, height = 0;
    float aspect = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(width);
        a(height);
        a(aspect);
    }
};
enum class HandleKind : uint8_t { Model, Skin, Shader, ShaderNoMip };
struct Register {
    HandleKind kind = HandleKind::Model;
    std::string name;
    int32_t handle = 0; ///< 0: the renderer had nothing of that name
    template <class Archive>
    void fields(Archive& a) {
        a(kind);
        a(name);
        a(handle);
    }
};
struct LoadWorld {
    std::string name;
    template <class Archive>
    void fields(Archive& a) {
        a(name);
    }
};
struct EndRegistration {
    template <class Archive>
    void fields(Archive&) {}
};
struct ClearScene {
    template <class Archive>
    void fields(Archive&) {}
};
struct AddEntity {
    refEntity_t entity{};
    template <class Archive>
    void fields(Archive& a) {
        a(entity);
    }
};
struct AddPolys {
    int32_t shader = 0;
    int32_t vertexCount = 0; ///< of one polygon; vertices.size() is a multiple of it
    std::vector<polyVert_t> vertices;
    template <class Archive>
    void fields(Archive& a) {
        a(shader);
        a(vertexCount);
        a(vertices);
    }
};
struct AddLight {
    float origin[3] = {};
    float radius = 0;
    float color[3] = {};
    uint8_t additive = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(origin);
        a(radius);
        a(color);
        a(additive);
    }
};
struct RenderScene {
    refdef_t view{};
    template <class Archive>
    void fields(Archive& a) {
        a(view);
    }
};
struct SetColor {
    uint8_t given = 0; ///< 0: the engine passed no colour, which means white
    float rgba[4] = {};
    template <class Archive>
    void fields(Archive& a) {
        a(given);
        a(rgba);
    }
};
struct DrawPicture {
    float x = 0, y = 0, width = 0, height = 0, s1 = 0, t1 = 0, s2 = 0, t2 = 0;
    int32_t shader = 0;
    template <class Archive>
    void fields(Archive& a) {
        for (float* value : {&x, &y, &width, &height, &s1, &t1, &s2, &t2})
            a(*value);
        a(shader);
    }
};
/// DrawStretchRaw, and UploadCinematic where `drawn` is 0. Pixels are RGBA; absent when the engine said "not dirty".
struct Cinematic {
    uint8_t drawn = 0;
    int32_t x = 0, y = 0, width = 0, height = 0, columns = 0, rows = 0, client = 0, dirty = 0;
    int32_t handle = -1; ///< of the import CIN_UploadCinematic that it answered, or -1
    std::vector<uint8_t> rgba;
    template <class Archive>
    void fields(Archive& a) {
        a(drawn);
        for (int32_t* value : {&x, &y, &width, &height, &columns, &rows, &client, &dirty, &handle})
            a(*value);
        a(rgba);
    }
};
struct BeginFrame {
    int32_t stereo = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(stereo);
    }
};
struct EndFrame {
    template <class Archive>
    void fields(Archive&) {}
};
} // namespace event

using TraceEvent =
    std::variant<event::Shutdown, event::BeginRegistration, event::Register, event::LoadWorld, event::EndRegistration,
                 event::ClearScene, event::AddEntity, event::AddPolys, event::AddLight, event::RenderScene,
                 event::SetColor, event::DrawPicture, event::Cinematic, event::BeginFrame, event::EndFrame,
                 event::MarkFragments, event::LerpTag, event::ModelBounds, event::LightForPoint, event::RegisterFont,
                 event::RemapShader, event::EntityToken, event::InPvs, event::Clock, event::CvarValue,
                 event::CinematicPlay, event::CinematicRun>;

/// Appends the event's code and fields (little endian, no padding).
void encodeEvent(TraceEvent& event, std::vector<std::byte>& out);
/// Reads the event at `offset` and moves it on. Throws ContentError ("<name>: ...") where the bytes are no event.
TraceEvent decodeEvent(const std::vector<std::byte>& bytes, size_t& offset, const std::string& name);

/// True if the event changes more than the frame that it stands in: it must be replayed even if the frame isn't drawn.
bool changesState(const TraceEvent& event);

} // namespace q3rt
