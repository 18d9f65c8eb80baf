#pragma once
// How a view and what it shows have moved since the frame before: cameras, entities and instances found again, and
// whether there is a frame before at all. Pure CPU.

#include <optional>
#include <vector>

#include "renderer_rt/view_places.hpp"
#include "shaders/shared/rt_motion.h"

namespace q3rt {

/// One frame of a view.
struct ViewInstant {
    RtCamera camera{};
    int timeMs = 0;
    uint32_t sampleFrame = 0;   ///< of random numbers
    uint32_t pictureNumber = 0; ///< counts drawn frames
    float inverseError = 0;     ///< of the back end's rays, see lib/offset.glsl
    std::vector<uint32_t> settingsKey;
    std::vector<EntityPlace> entities;
    std::vector<InstancePlace> instances;
    std::vector<vec3> corners;                 ///< of all changing shapes, model space
    std::vector<VkDeviceAddress> indexAddress; ///< by instance: of its triangles, for this frame
};

RtCamera cameraOf(const RtFrame& frame);

/// For each of `now` its number among `before`: the nearest that is the same kind of thing, both ways. Things are
/// looked for where their motion has carried them; what has just appeared has none.
std::vector<std::optional<size_t>> matchEntities(const std::vector<EntityPlace>& now,
                                                 const std::vector<EntityPlace>& before, int elapsedMs);

class ViewMotion {
  public:
    /// `now` becomes the current frame, the current one the previous one.
    void advance(ViewInstant now);
    /// Is there a previous frame that this one continues? Not after a jump of the eye or of the clock.
    bool isContinuous() const { return m_continuous; }
    const ViewInstant& current() const { return m_current; }
    const ViewInstant& previous() const { return m_previous; }
    /// By instance of the previous frame. `corners`: where those of the current one lie.
    std::vector<RtMotion> toCurrent(VkDeviceAddress corners) const;
    /// By instance of the current frame. `corners`: where those of the previous one lie.
    std::vector<RtMotion> toPrevious(VkDeviceAddress corners) const;

  private:
    void matchInstances();

    ViewInstant m_current, m_previous;
    std::vector<std::optional<size_t>> m_previousOf; ///< by instance of the current frame
    bool m_started = false, m_continuous = false;
};

} // namespace q3rt
