#pragma once
// Flares of a map's lights (spec of world 8.1): where one stands on the screen, how large and bright it is, and how far
// it has faded in or out. Whether something stands before it is asked of the GPU at the end of a view and known when
// that frame's slot comes round; until then the last answer holds.

#include <compare>
#include <optional>
#include <vector>

#include "renderer_vk/view_setup.hpp"

namespace q3rt {

/// A flare in one view of a frame: each fades by itself.
struct FlareKey {
    uint32_t surface = 0;
    uint32_t scene = 0; ///< number of the scene in its frame
    bool portal = false;
    auto operator<=>(const FlareKey&) const = default;
};

class FlareFades {
  public:
    FlareFades();
    void beginFrame(uint64_t frame);
    /// What frame `asked` found out.
    void answer(const FlareKey& key, uint64_t asked, bool seen);
    /// Of a flare that this frame's view holds: 0 gone, 1 full.
    float strength(const FlareKey& key, int timeMs, float fadesPerSecond);
    size_t size() const { return m_states.size(); }

  private:
    struct State {
        FlareKey key;
        uint64_t firstFrame = 0, lastFrame = 0; ///< without a gap
        bool answer = false, seen = false;
        int changedMs = 0;
    };
    std::vector<State>::iterator find(const FlareKey& key);
    std::vector<State> m_states; ///< by key; a list, which keeps its memory
    uint64_t m_frame = 0;
};

/// Its centre, pixels of the viewport from the lower left, and how far away it is along the view.
struct FlarePlace {
    int x = 0, y = 0;
    float depthQu = 0;
};
/// Nullopt if it is not on the screen.
std::optional<FlarePlace> placeFlare(const RasterView& view, const vec3& origin);

struct FlareLook {
    float halfSizePixels = 0;
    float intensity = 0; ///< of its colour
};
/// r_flareSize, r_flareCoeff; a larger coefficient lets far ones stay bright.
FlareLook flareLook(float depthQu, int viewWidth, float size, float coefficient);

} // namespace q3rt
