#include "renderer_vk/flares.hpp"

#include <algorithm>
#include <cmath>

#include "scene/busy_frame.hpp"

namespace q3rt {

namespace {

constexpr int kLongAgoMs = 2000; // a flare that comes into view is not fading out any more
constexpr float kNearGain = 8;   // near flares are larger: viewport widths x qu
constexpr float kSizeUnit = 640; // r_flareSize is in pixels of such a viewport
constexpr float kDefaultCoefficient = 150;

} // namespace

FlareFades::FlareFades() { m_states.reserve(busyFrame::kSmall); }

void FlareFades::beginFrame(uint64_t frame) {
    m_frame = frame;
    std::erase_if(m_states, [&](const State& state) { return state.lastFrame + 1 < frame; });
}

/// The first that is not before `key`.
std::vector<FlareFades::State>::iterator FlareFades::find(const FlareKey& key) {
    return std::ranges::lower_bound(m_states, key, {}, &State::key);
}

void FlareFades::answer(const FlareKey& key, uint64_t asked, bool seen) {
    const auto found = find(key);
    if (found != m_states.end() && found->key == key && asked >= found->firstFrame) found->answer = seen;
}

float FlareFades::strength(const FlareKey& key, int timeMs, float fadesPerSecond) {
    auto found = find(key);
    if (found == m_states.end() || found->key != key)
        found = m_states.insert(found, {key, m_frame, m_frame, false, false, timeMs - kLongAgoMs});
    State& state = *found;
    state.lastFrame = m_frame;
    if (state.answer != state.seen) {
        state.seen = state.answer;
        state.changedMs = timeMs - 1;
    }
    const float fade = static_cast<float>(timeMs - state.changedMs) * 0.001f * fadesPerSecond;
    return std::clamp(state.seen ? fade : 1.0f - fade, 0.0f, 1.0f);
}

std::optional<FlarePlace> placeFlare(const RasterView& view, const vec3& origin) {
    const vec4 clip = view.clipFromWorld * vec4(origin, 1.0f);
    for (const float value : {clip.x, clip.y, clip.z * 2.0f - clip.w})
        if (!(std::abs(value) < clip.w)) return std::nullopt;
    const auto pixelOf = [](float ndc, int size) {
        return static_cast<int>((ndc * 0.5f + 0.5f) * static_cast<float>(size) + 0.5f);
    };
    return FlarePlace{pixelOf(clip.x / clip.w, view.scene->width), pixelOf(-clip.y / clip.w, view.scene->height),
                      clip.w};
}

FlareLook flareLook(float depthQu, int viewWidth, float size, float coefficient) {
    const float distance = std::max(depthQu, 1.0f);
    float whole = std::trunc(coefficient);
    if (whole == 0) whole = kDefaultCoefficient;
    FlareLook look;
    look.halfSizePixels = static_cast<float>(viewWidth) * (size / kSizeUnit + kNearGain / distance);
    const float spread = distance + look.halfSizePixels * std::sqrt(whole);
    look.intensity = whole * look.halfSizePixels * look.halfSizePixels / (spread * spread);
    return look;
}

} // namespace q3rt
