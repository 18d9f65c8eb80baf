#include "renderer_rt/denoiser_svgf.hpp"

#include <algorithm>

#include "gpu/growing_buffer.hpp"
#include "renderer_rt/view_buffers.hpp"

namespace q3rt {

Svgf::Svgf(Device& device, const DenoisePipelines& pipelines, VkExtent2D extent)
    : m_work{.pipelines = pipelines, .extent = extent}
    , m_light(makeViewBuffer(device, extent, sizeof(vec4), "light"))
    , m_previousLight(makeViewBuffer(device, extent, sizeof(vec4), "previous light"))
    , m_moments(makeViewBuffer(device, extent, sizeof(vec2), "moments"))
    , m_previousMoments(makeViewBuffer(device, extent, sizeof(vec2), "previous moments"))
    , m_filtered{makeViewBuffer(device, extent, sizeof(vec4), "filtered 0"),
                 makeViewBuffer(device, extent, sizeof(vec4), "filtered 1")} {}

void Svgf::turn(ViewBuffers&) {
    std::swap(m_light, m_previousLight);
    std::swap(m_moments, m_previousMoments);
}

RtDenoise Svgf::describe(const ViewBuffers& view) const {
    const ViewMotion& motion = view.motion;
    RtDenoise table{};
    table.pixels = view.pixels.address();
    table.irradiance = view.irradiance.address();
    table.guides = view.guides->guides.address();
    table.previousGuides = view.guides->previousGuides.address();
    table.pasts = view.guides->pasts.address();
    table.light = m_light.address();
    table.previousLight = m_previousLight.address();
    table.moments = m_moments.address();
    table.previousMoments = m_previousMoments.address();
    for (size_t i = 0; i < 2; ++i)
        table.filtered[i] = m_filtered[i].address();
    table.camera = motion.current().camera;
    table.previousCamera = motion.previous().camera;
    const VkExtent2D size = view.extent, strata = strataOf(size);
    table.size = {size.width, size.height};
    table.strata = {strata.width, strata.height};
    table.frame = motion.current().sampleFrame;
    table.previousFrame = motion.previous().sampleFrame;
    table.pixelTangent = std::max(2.0f * glm::length(table.camera.left) / static_cast<float>(size.width),
                                  2.0f * glm::length(table.camera.up) / static_cast<float>(size.height));
    table.flags = motion.isContinuous() ? kDenoiseHistory : 0;
    return table;
}

void Svgf::keepTable(const RtDenoise& table, GrowingBuffer& stream) {
    m_work.table = stream.append(table).address;
    m_work.hasHistory = (table.flags & kDenoiseHistory) != 0;
    m_work.hasGradient = (table.flags & kDenoiseGradient) != 0;
}

void Svgf::prepare(ViewBuffers& view, GrowingBuffer& stream) { keepTable(describe(view), stream); }

void Svgf::import(FrameGraph& graph) {
    m_resources = {};
    m_resources.light = graph.importBuffer("light", m_light);
    m_resources.previousLight = graph.importBuffer("previous light", m_previousLight);
    m_resources.moments = graph.importBuffer("moments", m_moments);
    m_resources.previousMoments = graph.importBuffer("previous moments", m_previousMoments);
    for (size_t i = 0; i < 2; ++i)
        m_resources.filtered[i] = graph.importBuffer("filtered", m_filtered[i]);
}

void Svgf::addBeforeDirect(FrameGraph&, ViewResources&) {}

void Svgf::addAfterDirect(FrameGraph& graph, ViewResources& resources) {
    addDenoiseTemporal(graph, resources, m_resources, m_work);
    addDenoiseVariance(graph, resources, m_resources, m_work);
    addDenoiseFilter(graph, resources, m_resources, m_work);
    resources.lighting = m_resources.filtered[kFilterLevels & 1];
}

} // namespace q3rt
