#include "renderer_rt/denoiser_asvgf.hpp"

#include "gpu/growing_buffer.hpp"
#include "renderer_rt/view_buffers.hpp"

namespace q3rt {

Asvgf::Asvgf(Device& device, const DenoisePipelines& pipelines, VkExtent2D extent)
    : Svgf(device, pipelines, extent)
    , m_previousPixels(makeViewBuffer(device, extent, sizeof(RtPixel), "previous pixels"))
    , m_previousIrradiance(makeViewBuffer(device, extent, sizeof(vec4), "previous irradiance"))
    , m_winners(makeViewBuffer(device, strataOf(extent), sizeof(uint32_t), "winners"))
    , m_gradients{makeViewBuffer(device, strataOf(extent), sizeof(vec4), "gradients 0"),
                  makeViewBuffer(device, strataOf(extent), sizeof(vec4), "gradients 1")} {}

void Asvgf::turn(ViewBuffers& view) {
    Svgf::turn(view);
    std::swap(view.pixels, m_previousPixels);
    std::swap(view.irradiance, m_previousIrradiance);
}

RtDenoise Asvgf::describe(const ViewBuffers& view) const {
    RtDenoise table = Svgf::describe(view);
    table.previousPixels = m_previousPixels.address();
    table.previousIrradiance = m_previousIrradiance.address();
    table.winners = m_winners.address();
    for (size_t i = 0; i < 2; ++i)
        table.gradients[i] = m_gradients[i].address();
    if (table.flags & kDenoiseHistory) table.flags |= kDenoiseGradient;
    return table;
}

void Asvgf::prepare(ViewBuffers& view, GrowingBuffer& stream) {
    RtDenoise table = describe(view);
    const VkDeviceAddress corners = stream.append(std::span<const vec3>(view.motion.current().corners)).address;
    table.motionToCurrent = stream.append(std::span<const RtMotion>(view.motion.toCurrent(corners))).address;
    keepTable(table, stream);
}

void Asvgf::import(FrameGraph& graph) {
    Svgf::import(graph);
    m_resources.previousPixels = graph.importBuffer("previous pixels", m_previousPixels);
    m_resources.previousIrradiance = graph.importBuffer("previous irradiance", m_previousIrradiance);
    m_resources.winners = graph.importBuffer("winners", m_winners);
    for (size_t i = 0; i < 2; ++i)
        m_resources.gradients[i] = graph.importBuffer("gradients", m_gradients[i]);
}

void Asvgf::addBeforeDirect(FrameGraph& graph, ViewResources& resources) {
    if (!m_work.hasHistory) return;
    addDenoiseProject(graph, resources, m_resources, m_work);
    addDenoiseCarry(graph, resources, m_resources, m_work);
}

void Asvgf::addAfterDirect(FrameGraph& graph, ViewResources& resources) {
    if (m_work.hasHistory) {
        addDenoiseGradient(graph, resources, m_resources, m_work);
        addDenoiseGradientFilter(graph, resources, m_resources, m_work);
        resources.gradients = m_resources.gradients[kGradientLevels & 1];
    }
    Svgf::addAfterDirect(graph, resources);
}

std::unique_ptr<Denoiser> makeDenoiser(DenoiserKind kind, Device& device, const DenoisePipelines& pipelines,
                                       VkExtent2D extent) {
    switch (kind) {
    case DenoiserKind::Asvgf:
        return std::make_unique<Asvgf>(device, pipelines, extent);
    case DenoiserKind::Svgf:
        return std::make_unique<Svgf>(device, pipelines, extent);
    case DenoiserKind::None:
        break;
    }
    return nullptr;
}

} // namespace q3rt
