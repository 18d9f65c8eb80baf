#pragma once
// Surfaces of models with a single frame: each in a structure of its own, made when it is first seen, kept as long as
// the models, instanced by every entity that shows it.

#include <map>
#include <memory>

#include "gpu/acceleration_structure.hpp"
#include "renderer_rt/backend.hpp"
#include "renderer_rt/scene_trees.hpp"
#include "scene/model.hpp"

namespace q3rt {

struct ModelPart {
    Buffer memory;
    VkDeviceAddress surfaceOfTriangle = 0;
    TriangleGeometry geometry;
    AccelerationStructure structure; ///< back ends of the driver
    TreeAddress tree;                ///< back end `compute`
};

class ModelGeometry {
  public:
    ModelGeometry(Device& device, Backend backend)
        : m_device(device)
        , m_backend(backend) {}
    /// `indices` absolute in `vertices`, which are used at the first call for this surface only. The address stays.
    ModelPart& find(const ModelSurface* source, SurfaceClass surfaceClass, std::span<const Vertex> vertices,
                    std::span<const uint32_t> indices);
    /// Those made since the last call: their structures want a build in this frame.
    std::vector<ModelPart*> takeNew();

  private:
    void fill(ModelPart& part, SurfaceClass surfaceClass, std::span<const Vertex> vertices,
              std::span<const uint32_t> indices);

    Device& m_device;
    Backend m_backend;
    std::map<std::pair<const ModelSurface*, SurfaceClass>, std::unique_ptr<ModelPart>> m_parts;
    std::vector<ModelPart*> m_new;
};

} // namespace q3rt
