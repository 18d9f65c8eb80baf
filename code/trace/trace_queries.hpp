#pragma once
// The events of a recording that ask something of the renderer, and what the renderer saw through its imports. See
// trace/trace_event.hpp.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "abi/ref_types.h"

namespace q3rt::event {

struct Point {
    float xyz[3] = {};
};
struct MarkFragments {
    std::vector<Point> polygon;
    float projection[3] = {};
    int32_t maxPoints = 0, maxFragments = 0;
    std::vector<Point> points; ///< the result
    std::vector<markFragment_t> fragments;
    template <class Archive>
    void fields(Archive& a) {
        a(polygon);
        a(projection);
        a(maxPoints);
        a(maxFragments);
        a(points);
        a(fragments);
    }
};
struct LerpTag {
    int32_t model = 0, startFrame = 0, endFrame = 0;
    float fraction = 0;
    std::string tag;
    int32_t found = 0;
    orientation_t result{};
    template <class Archive>
    void fields(Archive& a) {
        a(model);
        a(startFrame);
        a(endFrame);
        a(fraction);
        a(tag);
        a(found);
        a(result);
    }
};
struct ModelBounds {
    int32_t model = 0;
    float mins[3] = {}, maxs[3] = {};
    template <class Archive>
    void fields(Archive& a) {
        a(model);
        a(mins);
        a(maxs);
    }
};
struct LightForPoint {
    float point[3] = {};
    int32_t found = 0;
    float ambient[3] = {}, directed[3] = {}, direction[3] = {};
    template <class Archive>
    void fields(Archive& a) {
        a(point);
        a(found);
        a(ambient);
        a(directed);
        a(direction);
    }
};
/// Glyph handles are shader numbers of the recording.
struct RegisterFont {
    std::string name;
    int32_t pointSize = 0;
    std::shared_ptr<fontInfo_t> font = std::make_shared<fontInfo_t>(); ///< apart: it makes 20 KB of every event
    template <class Archive>
    void fields(Archive& a) {
        a(name);
        a(pointSize);
        a(*font);
    }
};
struct RemapShader {
    std::string from, to, timeOffset;
    uint8_t hasOffset = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(from);
        a(to);
        a(timeOffset);
        a(hasOffset);
    }
};
struct EntityToken {
    int32_t found = 0;
    std::string token;
    template <class Archive>
    void fields(Archive& a) {
        a(found);
        a(token);
    }
};
struct InPvs {
    float from[3] = {}, to[3] = {};
    int32_t visible = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(from);
        a(to);
        a(visible);
    }
};

// --- what the renderer saw through its imports ---
/// The engine's clock from here on; it stands still within a frame.
struct Clock {
    int32_t ms = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(ms);
    }
};
struct CvarValue {
    std::string name, value;
    uint8_t isDefault = 0; ///< the renderer's own default, not a choice of the player
    template <class Archive>
    void fields(Archive& a) {
        a(name);
        a(value);
        a(isDefault);
    }
};
struct CinematicPlay {
    std::string name;
    int32_t handle = -1;
    template <class Archive>
    void fields(Archive& a) {
        a(name);
        a(handle);
    }
};
struct CinematicRun {
    int32_t handle = -1, status = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(handle);
        a(status);
    }
};

} // namespace q3rt::event
