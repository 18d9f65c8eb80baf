#pragma once
// How a view and what it shows have moved since the frame before: cameras, entities found again, and whether there is
// a frame before at all. Pure CPU.

#include <vector>

#include "scene/entity_geometry.hpp"
#include "shaders/shared/rt_motion.h"

namespace q3rt {

/// One entity of a view, with what tells it from others. The engine numbers entities for itself only.
struct EntityPlace {
    bool moves = true;    ///< false: the world
    bool rigid = false;   ///< its surfaces are the same in every frame with this identity
    int inlineModel = -1; ///< such models are in a view once
    int model = 0, frame = 0, oldFrame = 0;
    float backLerp = 0;
    uint32_t flags = 0;
    mat4 worldFromModel{1.0f};
};

/// One frame of a view.
struct ViewInstant {
    RtCamera camera{};
    int timeMs = 0;
    uint32_t sampleFrame = 0;   ///< of random numbers
    uint32_t pictureNumber = 0; ///< counts drawn frames
    std::vector<uint32_t> settingsKey;
    std::vector<EntityPlace> entities;
};

RtCamera cameraOf(const RtFrame& frame);
std::vector<EntityPlace> findPlaces(const FrameCommands& frame, const SceneView& scene, const ViewGeometry& geometry);

class ViewMotion {
  public:
    /// `now` becomes the current frame, the current one the previous one.
    void advance(ViewInstant now);
    /// Is there a previous frame that this one continues? Not after a jump of the eye or of the clock.
    bool isContinuous() const { return m_continuous; }
    const ViewInstant& current() const { return m_current; }
    const ViewInstant& previous() const { return m_previous; }
    /// By entity of the previous frame.
    const std::vector<RtMotion>& toCurrent() const { return m_toCurrent; }
    /// By entity of the current frame.
    const std::vector<RtMotion>& toPrevious() const { return m_toPrevious; }

  private:
    void matchEntities();

    ViewInstant m_current, m_previous;
    std::vector<RtMotion> m_toCurrent, m_toPrevious;
    bool m_started = false, m_continuous = false;
};

} // namespace q3rt
