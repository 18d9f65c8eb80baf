#pragma once
// What stands between traced light and the light that is shown. A denoiser sees the direct light alone: albedo is
// multiplied in, ambient and glow are added after it. One object a view: it owns what it remembers of that view.
// docs/denoising.md says what each does.

#include <memory>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Buffer;
class DenoisePipelines;
class Device;
class FrameGraph;
class GrowingBuffer;
struct ViewBuffers;
struct ViewResources;

/// rt_denoiser.
enum class DenoiserKind { None, Asvgf, Svgf };

class Denoiser {
  public:
    virtual ~Denoiser() = default;
    virtual DenoiserKind kind() const = 0;
    /// A new frame of the view: what the last one left becomes history.
    virtual void turn(ViewBuffers& view) = 0;
    /// The view's motion is known: makes the shaders' tables for the frame.
    virtual void prepare(ViewBuffers& view, GrowingBuffer& stream) = 0;
    /// Makes the denoiser's buffers known to the frame's graph, before the passes below.
    virtual void import(FrameGraph& graph) = 0;
    /// Passes between "primary" and "direct". May replace what the direct stage lights.
    virtual void addBeforeDirect(FrameGraph& graph, ViewResources& resources) = 0;
    /// Passes after "direct": resources.lighting becomes what the picture shows, resources.gradients what has changed.
    virtual void addAfterDirect(FrameGraph& graph, ViewResources& resources) = 0;
    /// Where resources.lighting will lie.
    virtual const Buffer& lighting() const = 0;
    /// vec2[], a stratum: change of light, and what it is relative to. Null: not known.
    virtual const Buffer* gradients() const { return nullptr; }
};

/// Null for None. `pipelines` outlives the result.
std::unique_ptr<Denoiser> makeDenoiser(DenoiserKind kind, Device& device, const DenoisePipelines& pipelines,
                                       VkExtent2D extent);

} // namespace q3rt
