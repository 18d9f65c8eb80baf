// The module renderer_rt: the ray tracer behind the engine's export table.

#include "engine/export_table.hpp"
#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

std::unique_ptr<Renderer> createRenderer(EngineServices& engine) { return std::make_unique<TraceRenderer>(engine); }

} // namespace q3rt

Q3RT_EXPORT_MODULE
