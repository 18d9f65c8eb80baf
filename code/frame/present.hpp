#pragma once
// The last passes of a frame that goes to a window.

#include "frame/frame_graph.hpp"

namespace q3rt {

class Swapchain;

/// Scales `picture` (an 8-bit RGB image) to the window's image and leaves that ready for presentation. The swapchain's
/// image must have been acquired for this frame.
void addPresent(FrameGraph& graph, ImageId picture, const Swapchain& swapchain);

} // namespace q3rt
