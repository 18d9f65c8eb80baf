#pragma once
// A recording made by a test: the room with one square light.

#include <filesystem>

#include "host/still/still_scene.hpp"
#include "trace/recording_writer.hpp"

namespace q3rt::test {

/// `frames` world frames of an eye that turns a degree a frame in the room.
inline void recordRoom(const std::filesystem::path& path, int frames) {
    RecordingWriter writer(path);
    writer.setRenderer("made by a test");
    writer.add(event::BeginRegistration{64, 48, 4.0f / 3});
    writer.add(event::LoadWorld{"maps/room_square_light.bsp"});
    writer.add(event::EndRegistration{});
    for (int i = 0; i < frames; ++i) {
        writer.add(event::Clock{100 + 20 * i});
        writer.add(event::BeginFrame{0});
        writer.add(event::ClearScene{});
        writer.add(event::RenderScene{makeView({{0, 0, 64}, 0, static_cast<float>(i)}, 90, 64, 48, 100 + 20 * i)});
        writer.add(event::EndFrame{});
    }
    writer.finish();
}

} // namespace q3rt::test
