#pragma once
// "taa": the composed picture averaged over jittered frames.

#include "renderer_rt/passes/passes.hpp"
#include "renderer_rt/view_buffers.hpp"

namespace q3rt {

/// resources.picture becomes the averaged picture.
void addTaa(FrameGraph& graph, ViewResources& resources, const ViewWork& work, TaaBuffers& buffers);

} // namespace q3rt
