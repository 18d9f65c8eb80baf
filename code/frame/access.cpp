#include "frame/access.hpp"

#include <span>

#include "base/error.hpp"

namespace q3rt {
namespace {

struct BitName {
    VkFlags64 bits;
    const char* name;
};

constexpr BitName kStageNames[] = {
    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "vertex-input"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "index-input"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "depth"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color-output"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    {VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR, "rays"},
    {VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR, "build"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "host"},
};

constexpr BitName kAccessNames[] = {
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "vertex-read"},
    {VK_ACCESS_2_INDEX_READ_BIT, "index-read"},
    {VK_ACCESS_2_SHADER_READ_BIT, "shader-read"},
    {VK_ACCESS_2_SHADER_WRITE_BIT, "shader-write"},
    {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled"},
    {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "storage-read"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "storage-write"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color-read"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color-write"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth-read"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth-write"},
    {VK_ACCESS_2_TRANSFER_READ_BIT, "copy-read"},
    {VK_ACCESS_2_TRANSFER_WRITE_BIT, "copy-write"},
    {VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR, "structure-read"},
    {VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, "structure-write"},
    {VK_ACCESS_2_MEMORY_READ_BIT, "read"},
    {VK_ACCESS_2_MEMORY_WRITE_BIT, "write"},
};

std::string nameBits(VkFlags64 bits, std::span<const BitName> names) {
    std::string text;
    for (const BitName& entry : names) {
        if ((bits & entry.bits) != entry.bits) continue;
        text += (text.empty() ? "" : "|") + std::string(entry.name);
        bits &= ~entry.bits;
    }
    if (bits) text += formatText("%s0x%llx", text.empty() ? "" : "|", static_cast<unsigned long long>(bits));
    return text.empty() ? "none" : text;
}

} // namespace

VkAccessFlags2 writesOf(VkAccessFlags2 access) {
    constexpr VkAccessFlags2 kWrites =
        VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT |
        VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
    return access & kWrites;
}

bool coversAccess(const ResourceState& seen, const Access& wanted) {
    VkPipelineStageFlags2 stages = seen.stages;
    if (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) stages = ~VkPipelineStageFlags2{0};
    VkAccessFlags2 access = seen.access;
    if (access & VK_ACCESS_2_SHADER_READ_BIT)
        access |= VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    if (access & VK_ACCESS_2_MEMORY_READ_BIT) access |= ~writesOf(~VkAccessFlags2{0});
    return (wanted.stages & ~stages) == 0 && (wanted.access & ~access) == 0;
}

std::string stageText(VkPipelineStageFlags2 stages) { return nameBits(stages, kStageNames); }

std::string accessText(VkAccessFlags2 access) { return nameBits(access, kAccessNames); }

std::string layoutText(VkImageLayout layout) {
    switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
        return "undefined";
    case VK_IMAGE_LAYOUT_GENERAL:
        return "general";
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
        return "color";
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
        return "depth";
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
        return "sampled";
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
        return "copy-source";
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
        return "copy-target";
    case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR:
        return "present";
    default:
        return formatText("layout %d", static_cast<int>(layout));
    }
}

} // namespace q3rt
