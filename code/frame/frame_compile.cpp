// The compile step: which passes run, from where to where resources live, which barriers stand before each pass.
// Passes keep the order in which they were added; no GPU is needed for any of it.

#include <algorithm>

#include "base/error.hpp"
#include "frame/frame_graph.hpp"

namespace q3rt {

void FrameGraph::compile() {
    if (m_compiled) return;
    cullPasses();
    findLifetimes();
    placeBarriers();
    m_compiled = true;
}

void FrameGraph::cullPasses() {
    // Backwards: a pass is needed if it is kept, writes something that outlives the frame, or writes what a later
    // needed pass uses. A write keeps what was there, so it needs the earlier writers too.
    std::pmr::vector<bool> needed(m_resources.size(), false, m_memory);
    for (size_t i = 0; i < m_resources.size(); ++i)
        needed[i] = m_resources[i].imported;
    for (size_t i = m_passes.size(); i-- > 0;) {
        GraphPass& pass = m_passes[i];
        const bool wanted = pass.kept || std::any_of(pass.uses.begin(), pass.uses.end(), [&](const GraphUse& use) {
                                return use.write && needed[use.resource];
                            });
        pass.culled = !wanted;
        if (!wanted) continue;
        for (const GraphUse& use : pass.uses)
            needed[use.resource] = true;
    }
}

void FrameGraph::findLifetimes() {
    for (uint32_t i = 0; i < m_passes.size(); ++i) {
        if (m_passes[i].culled) continue;
        for (const GraphUse& use : m_passes[i].uses) {
            GraphResource& resource = m_resources[use.resource];
            if (resource.firstPass == kNoResource) resource.firstPass = i;
            resource.lastPass = i;
            resource.imageUsage |= use.how.imageUsage;
            resource.bufferUsage |= use.how.bufferUsage;
        }
    }
}

namespace {

/// All uses of one resource in one pass as one access.
Access mergeUses(const GraphPass& pass, uint32_t resource) {
    Access merged;
    for (const GraphUse& use : pass.uses) {
        if (use.resource != resource) continue;
        merged.stages |= use.how.stages;
        merged.access |= use.how.access;
        merged.layout = use.how.layout;
    }
    return merged;
}

/// What has happened to a resource up to the pass at hand. A change of layout counts as a write that is available and
/// visible to the reads it was made for.
struct Tracked {
    explicit Tracked(std::pmr::memory_resource* memory)
        : visible(memory) {}
    VkPipelineStageFlags2 writeStages = 0;
    VkAccessFlags2 writeAccess = 0;          // still to be made available; 0 once a barrier has done so
    VkPipelineStageFlags2 readStages = 0;    // reads since the write
    std::pmr::vector<ResourceState> visible; // who sees the write already
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool used = false;
};

/// Starts from what the last frame left behind.
Tracked startFrom(const ResourceState& initial, std::pmr::memory_resource* memory) {
    Tracked tracked(memory);
    tracked.layout = initial.layout;
    tracked.writeStages = initial.stages;
    tracked.writeAccess = writesOf(initial.access);
    if (isWrite(initial.access) || initial.stages == 0) return tracked;
    tracked.readStages = initial.stages;
    tracked.visible.push_back(initial);
    return tracked;
}

/// What the next frame has to know, in one state: reads, if all see the write alike; else the write with all stages.
ResourceState finish(const Tracked& tracked) {
    if (tracked.visible.size() == 1) return {tracked.readStages, tracked.visible[0].access, tracked.layout};
    return {tracked.writeStages | tracked.readStages, tracked.writeAccess, tracked.layout};
}

/// Moves `now` past a use; true if a barrier has to stand before it, from `from`.
bool advance(Tracked& now, const Access& next, bool image, ResourceState& from) {
    const bool writes = isWrite(next.access);
    const bool relayout = image && now.layout != next.layout;
    const bool seen = std::any_of(now.visible.begin(), now.visible.end(),
                                  [&](const ResourceState& state) { return coversAccess(state, next); });
    const bool untouched = now.writeStages == 0 && now.readStages == 0;
    const bool barrier = relayout || (!untouched && (writes || !seen));
    // A write waits for the reads before it (order is enough); a read only for the write before it.
    from = {now.writeStages, now.writeAccess, now.layout};
    if (writes || relayout) from.stages |= now.readStages;

    if (writes || relayout) {
        now.writeStages = next.stages;
        now.writeAccess = writesOf(next.access);
        now.readStages = 0;
        now.visible.clear();
    }
    if (!writes) {
        now.readStages |= next.stages;
        if (!seen || relayout) now.visible.push_back({next.stages, next.access, next.layout});
    }
    now.layout = image ? next.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    return barrier;
}

} // namespace

void FrameGraph::placeBarriers() {
    std::pmr::vector<Tracked> tracked(m_memory);
    for (const GraphResource& resource : m_resources)
        tracked.push_back(startFrom(resource.initial, m_memory));

    for (GraphPass& pass : m_passes) {
        if (pass.culled) continue;
        std::pmr::vector<uint32_t> done(m_memory);
        for (const GraphUse& use : pass.uses) {
            if (std::find(done.begin(), done.end(), use.resource) != done.end()) continue;
            done.push_back(use.resource);
            const GraphResource& resource = m_resources[use.resource];
            Tracked& now = tracked[use.resource];
            const Access next = mergeUses(pass, use.resource);
            const bool discard = !resource.imported && !now.used;
            now.used = true;
            ResourceState from;
            const bool barrier = advance(now, next, resource.image, from);
            if (barrier || discard)
                pass.barriers.push_back({use.resource, from, {next.stages, next.access, now.layout}, discard});
        }
    }
    for (size_t i = 0; i < m_resources.size(); ++i)
        if (tracked[i].used) m_resources[i].final = finish(tracked[i]);
}

std::string FrameGraph::print() const {
    std::string text;
    for (size_t i = 0; i < m_passes.size(); ++i) {
        const GraphPass& pass = m_passes[i];
        text += formatText("%zu %s%s\n", i, pass.name.data(), pass.culled ? " (dropped)" : "");
        for (const GraphBarrier& barrier : pass.barriers) {
            const GraphResource& resource = m_resources[barrier.resource];
            text += formatText("    %s: %s %s", resource.name.data(), stageText(barrier.from.stages).c_str(),
                               accessText(barrier.from.access).c_str());
            if (resource.image) text += " " + layoutText(barrier.from.layout);
            text +=
                formatText(" -> %s %s", stageText(barrier.to.stages).c_str(), accessText(barrier.to.access).c_str());
            if (resource.image) text += " " + layoutText(barrier.to.layout);
            text += barrier.discard ? " (new)\n" : "\n";
        }
    }
    for (const GraphResource& resource : m_resources) {
        text += resource.name;
        if (resource.image)
            text += formatText(" %ux%u format %d", resource.info.extent.width, resource.info.extent.height,
                               static_cast<int>(resource.info.format));
        else
            text += formatText(" %llu bytes", static_cast<unsigned long long>(resource.bytes));
        text += resource.imported ? " imported" : "";
        text += resource.firstPass == kNoResource
                    ? ": unused\n"
                    : formatText(": passes %u to %u\n", resource.firstPass, resource.lastPass);
    }
    return text;
}

} // namespace q3rt
