// Numbers over the finished picture (rt_printPerfStats 2; of an accumulated mean in a window always), in the font of
// the engine's console.

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

namespace {

/// 16 x 16 characters by their 8-bit codes.
constexpr const char* kFontShader = "gfx/2d/bigchars";
constexpr int kFontColumns = 16;

/// Lines of text that a picture's height holds, and the smallest legible character.
constexpr float kTextRows = 60, kLeastCharacterPixels = 6;

void appendLine(std::vector<FrameCommand>& out, const std::string& line, float x, float y, float size, int font,
                U8vec4 color) {
    constexpr float kCell = 1.0f / kFontColumns;
    for (const char letter : line) {
        const auto code = static_cast<uint8_t>(letter);
        const float s = kCell * static_cast<float>(code % kFontColumns);
        const float t = kCell * static_cast<float>(code / kFontColumns);
        if (letter != ' ') out.emplace_back(Picture{x, y, size, size, s, t, s + kCell, t + kCell, font, color});
        x += size;
    }
}

/// From the top left corner, white over a black shadow.
std::vector<FrameCommand> layoutText(const std::vector<std::string>& lines, int font, VkExtent2D target) {
    const float size = std::max(kLeastCharacterPixels, static_cast<float>(target.height) / kTextRows);
    const float shadow = std::max(1.0f, size / 12);
    std::vector<FrameCommand> out;
    float y = size;
    for (const std::string& line : lines) {
        appendLine(out, line, size + shadow, y + shadow, size, font, {0, 0, 0, 255});
        appendLine(out, line, size, y, size, font, U8vec4(255));
        y += 1.25f * size;
    }
    return out;
}

bool isTracing(std::string_view pass) {
    return pass == "look" || pass == "primary" || pass == "shadows" || pass == "direct" || pass == "plain";
}

} // namespace

void TraceRenderer::registerOverlayFont() { m_overlayFont = registerShader(kFontShader, false); }

std::vector<std::string> TraceRenderer::meanLines() const {
    if (!m_lastBuffers || !m_lastBuffers->sums) return {};
    std::vector<std::string> lines{formatText("%u frames", m_lastBuffers->sums->sampleNumber + 1)};
    const ReportNumbers& report = m_report->latest();
    if (!report.hasError) return lines;
    lines.push_back(formatText("SSIM to truth: %.4f", report.likeness));
    lines.push_back(formatText("standard error: %.5f", report.error));
    return lines;
}

std::string TraceRenderer::rayLine(double tracingMs) const {
    constexpr double kMillion = 1e6;
    const double millions = static_cast<double>(m_report->latest().rayCount) / kMillion;
    std::string line = formatText("rays: %.2f million", millions);
    if (tracingMs > 0) line += formatText(", %.1f million a second", millions / (tracingMs / 1000));
    return line;
}

std::vector<std::string> TraceRenderer::performanceLines() {
    std::vector<std::string> lines{""};
    double total = 0, tracing = 0;
    for (const TimerRow& pass : passTimes()) {
        total += pass.ms;
        if (isTracing(pass.name)) tracing += pass.ms;
        lines.push_back(formatText("%8.2f %s", pass.ms, pass.name.c_str()));
    }
    lines.front() = formatText("%8.2f ms in all, %s", total, backendName());
    lines.push_back(rayLine(tracing));
    const size_t lightCount =
        m_scene->hasWorld() ? m_scene->lights()->triangleCount() + m_scene->lights()->others().size() : 0;
    const std::string lights = m_settings.rt_numRandomDL == 0 ? "all" : formatText("%d", m_settings.rt_numRandomDL);
    lines.push_back(formatText("lights a pixel: %s of %zu", lights.c_str(), lightCount));
    uint32_t builds = 0, updates = 0;
    for (const ClassCount& count : m_classCounts) {
        builds += count.builds;
        updates += count.updates;
    }
    lines.push_back(formatText("structures: %u, built: %u, updated: %u, moving triangles: %u", m_instanceCount, builds,
                               updates, m_movingTriangleCount));
    const MemoryUse use = context().device().memory().measureUse();
    constexpr double kMiB = 1 << 20;
    lines.push_back(formatText("memory: %.0f of %.0f MiB", static_cast<double>(use.usedBytes) / kMiB,
                               static_cast<double>(use.reservedBytes) / kMiB));
    return lines;
}

void TraceRenderer::addOverlay(FrameGraph& graph, FrameTargets& targets, bool captured) {
    const bool performance = m_settings.rt_printPerfStats == kPerformanceOverlay;
    // A kept picture of a mean has no numbers on it.
    const bool mean = performance || (engine().wantsWindow() && !captured);
    std::vector<std::string> lines;
    if (mean && m_reportBuffer) lines = meanLines();
    if (performance)
        for (std::string& line : performanceLines())
            lines.push_back(std::move(line));
    if (lines.empty()) return;
    if (m_overlayFont == 0) {
        if (!world()) return; // it comes with the map
        logLineOnce(LogLevel::Warning, "%s: image not found; numbers are not shown on the picture", kFontShader);
        return;
    }
    const std::vector<FrameCommand> text = layoutText(lines, m_overlayFont, context().extent());
    raster().addUi(graph, targets, text, 0);
}

} // namespace q3rt
