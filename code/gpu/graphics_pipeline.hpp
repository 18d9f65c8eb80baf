#pragma once
// A raster pipeline for dynamic rendering. Viewport and scissor are always dynamic; other state is fixed unless listed
// in `dynamicStates`.

#include <optional>

#include "gpu/pipeline.hpp"

namespace q3rt {

class GpuImage;

/// Blending of one colour attachment; off by default.
struct BlendInfo {
    bool enable = false;
    VkBlendFactor source = VK_BLEND_FACTOR_ONE;
    VkBlendFactor destination = VK_BLEND_FACTOR_ZERO;
    VkBlendOp op = VK_BLEND_OP_ADD;
    VkColorComponentFlags writeMask = 0xf;
};

struct GraphicsPipelineInfo {
    std::string name = "graphics";
    ShaderStage vertex;
    ShaderStage fragment; // no code: depth only
    PipelineInterface interface;

    std::vector<VkVertexInputBindingDescription> vertexBindings;
    std::vector<VkVertexInputAttributeDescription> vertexAttributes;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;

    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    VkCullModeFlags cullMode = VK_CULL_MODE_NONE;
    VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    bool depthClamp = false;
    bool depthBias = false;
    float depthBiasConstant = 0;
    float depthBiasSlope = 0;

    bool depthTest = false;
    bool depthWrite = false;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    std::optional<VkStencilOpState> stencil; // of both sides; none: no test. Needs a depth format with stencil.
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;

    std::vector<VkFormat> colorFormats{VK_FORMAT_R8G8B8A8_UNORM};
    std::vector<BlendInfo> blends{BlendInfo{}}; // one an attachment; a shorter list repeats its last
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;

    std::vector<VkDynamicState> dynamicStates;
};

class GraphicsPipeline : public Pipeline {
  public:
    GraphicsPipeline() = default;
    GraphicsPipeline(Device& device, const GraphicsPipelineInfo& info);
    /// lavapipe compiles at the first draw: one triangle under an empty scissor moves that to loading. Inside
    /// beginRendering(), with everything bound as for a real draw (vertex buffers of at least three vertices). Leaves
    /// the scissor empty.
    void warmUp(VkCommandBuffer commands) const;
};

/// An attachment of beginRendering(). The image must be in the attachment layout (the frame graph sees to it).
struct Attachment {
    VkImageView view = VK_NULL_HANDLE;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkClearValue clear{};
    VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE;
    bool stencil = false;                 // a depth attachment whose format has stencil too
    VkImageView resolve = VK_NULL_HANDLE; // of a colour with several samples: takes their mean at the end
};

/// Begins dynamic rendering over `extent` with a full viewport (depth 0..1, y down as Vulkan has it) and scissor.
/// End with vkCmdEndRenderingKHR. A depth attachment without view: none.
void beginRendering(VkCommandBuffer commands, VkExtent2D extent, const Attachment& color, const Attachment& depth = {});

} // namespace q3rt
