// The module renderer_vk: the rasteriser behind the engine's export table.

#include "engine/export_table.hpp"
#include "renderer_vk/vk_renderer.hpp"

namespace q3rt {

std::unique_ptr<Renderer> createRenderer(EngineServices& engine) { return std::make_unique<VkRenderer>(engine); }

} // namespace q3rt

Q3RT_EXPORT_MODULE
