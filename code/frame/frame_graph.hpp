#pragma once
// A frame as declared passes. Built anew each frame: add passes in drawing order, compile (pure CPU, printable), run.
//
//   ImageId hdr = trace(graph, ...);                        // each pass is one function of this shape
//   ImageId out = addTonemap(graph, hdr, settings);
//
// `declare` runs at once and may only read / write / create; `record` runs in FrameExecutor::run, captures by value and
// may only emit commands. Every write makes a new version of the handle; reading an old version after a write is an
// error. A pass nobody needs (its results unread, nothing imported written, not kept) is dropped.

#include <deque>
#include <functional>
#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "frame/access.hpp"

namespace q3rt {

class GpuImage;
class Buffer;
class FrameGraph;
class PassContext;

inline constexpr uint32_t kNoResource = ~0u;

struct ImageId {
    uint32_t index = kNoResource;
    uint32_t version = 0;
    explicit operator bool() const { return index != kNoResource; }
};
struct BufferId {
    uint32_t index = kNoResource;
    uint32_t version = 0;
    explicit operator bool() const { return index != kNoResource; }
};

struct GraphImageInfo {
    VkExtent2D extent{};
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    uint32_t mipCount = 1;
    uint32_t layerCount = 1;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool operator==(const GraphImageInfo& other) const {
        return extent.width == other.extent.width && extent.height == other.extent.height && format == other.format &&
               mipCount == other.mipCount && layerCount == other.layerCount && samples == other.samples;
    }
};

/// Handed to `declare`.
class PassBuilder {
  public:
    void read(ImageId image, const Access& how);
    void read(BufferId buffer, const Access& how);
    /// Changes the contents; what was there stays where the pass doesn't write.
    [[nodiscard]] ImageId write(ImageId image, const Access& how);
    [[nodiscard]] BufferId write(BufferId buffer, const Access& how);
    /// A transient image of this frame, first written here. Contents before are undefined: clear or cover it.
    [[nodiscard]] ImageId create(const char* name, const GraphImageInfo& info, const Access& how);
    [[nodiscard]] BufferId create(const char* name, VkDeviceSize bytes, const Access& how);
    /// The pass has an effect that the graph can't see (a readback, a present): never dropped.
    void keep();

  private:
    friend class FrameGraph;
    PassBuilder(FrameGraph& graph, uint32_t pass)
        : m_graph(graph)
        , m_pass(pass) {}
    FrameGraph& m_graph;
    uint32_t m_pass;
};

/// One resource of a frame.
struct GraphResource {
    std::string_view name; // a zero follows
    bool image = true;
    GraphImageInfo info;    // images
    VkDeviceSize bytes = 0; // buffers
    uint32_t version = 0;   // newest
    GpuImage* importedImage = nullptr;
    Buffer* importedBuffer = nullptr;
    VkImage foreignImage = VK_NULL_HANDLE; // a swapchain image
    VkImageView foreignView = VK_NULL_HANDLE;
    bool imported = false;
    ResourceState* persistent = nullptr; // where `final` is kept for the next frame
    ResourceState initial;
    // Filled by compile():
    VkImageUsageFlags imageUsage = 0;
    VkBufferUsageFlags bufferUsage = 0;
    uint32_t firstPass = kNoResource; // of the compiled order
    uint32_t lastPass = kNoResource;
    ResourceState final;
};

struct GraphUse {
    uint32_t resource;
    uint32_t version; // read, or produced
    Access how;
    bool write;
    bool fresh; // created here
};

struct GraphBarrier {
    uint32_t resource;
    ResourceState from;
    ResourceState to;
    /// First use of a transient: old contents are dropped; `from` is filled in from the cached image when run.
    bool discard = false;
};

struct GraphPass {
    explicit GraphPass(std::pmr::memory_resource* memory)
        : uses(memory)
        , barriers(memory) {}
    std::string_view name; // a zero follows
    std::pmr::vector<GraphUse> uses;
    bool kept = false;
    bool culled = false;
    std::function<void(PassContext&)> record;
    std::pmr::vector<GraphBarrier> barriers; // before the pass; filled by compile()
};

class FrameGraph {
  public:
    /// `memory` outlives the graph; an arena spares the heap.
    explicit FrameGraph(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
        : m_memory(memory)
        , m_passes(memory)
        , m_resources(memory)
        , m_kept(memory)
        , m_names(memory) {}

    /// `name` is the debug label, the timer row and the dump file's name. `declare(PassBuilder&)` may return a handle
    /// or a structure of handles (default-constructible): then `record(PassContext&, const Data&)` gets it, and so does
    /// the caller. Otherwise `record(PassContext&)`.
    template <typename Declare, typename Record>
    auto addPass(const char* name, Declare&& declare, Record&& record) {
        using Data = std::invoke_result_t<Declare&, PassBuilder&>;
        PassBuilder builder = beginPass(name);
        GraphPass& pass = m_passes.back();
        // What the standard function holds is small enough for it to need no memory of its own.
        auto* kept = keep(std::forward<Record>(record));
        if constexpr (std::is_void_v<Data>) {
            pass.record = [kept](PassContext& context) { (*kept)(context); };
            declare(builder);
        } else {
            auto* data = keep(Data{});
            pass.record = [kept, data](PassContext& context) { (*kept)(context, *data); };
            *data = declare(builder);
            return *data;
        }
    }

    /// An image that lives beyond the frame (history, targets); its state is kept in GpuImage::state.
    ImageId importImage(const char* name, GpuImage& image);
    BufferId importBuffer(const char* name, Buffer& buffer);
    /// The swapchain's image: undefined at first.
    ImageId importForeign(const char* name, VkImage image, VkImageView view, const GraphImageInfo& info);
    /// Something without a handle of ours, such as all acceleration structures together; `state` must outlive the run
    /// and be kept for the next frame.
    BufferId importToken(const char* name, ResourceState& state);
    /// For tests of the compile step: there is no image or buffer behind it.
    ImageId importImage(const char* name, const GraphImageInfo& info, const ResourceState& initial);
    BufferId importBuffer(const char* name, const ResourceState& initial);

    const GraphImageInfo& info(ImageId image) const;
    VkExtent2D extent(ImageId image) const { return info(image).extent; }

    /// Order, culling, barriers, lifetimes. Throws UsageError naming pass and resource on a wrong declaration.
    void compile();
    bool compiled() const { return m_compiled; }
    /// The compiled frame: a line a pass, a line a barrier, lifetimes at the end.
    std::string print() const;

    const std::pmr::vector<GraphPass>& passes() const { return m_passes; } // in order; `culled` ones don't run
    const std::pmr::vector<GraphResource>& resources() const { return m_resources; }

  private:
    friend class PassBuilder;
    friend class FrameExecutor;
    PassBuilder beginPass(const char* name);
    /// Puts it into the graph's memory, until the graph goes.
    template <typename Value>
    auto* keep(Value&& value) {
        using Kept = std::decay_t<Value>;
        auto held =
            std::allocate_shared<Kept>(std::pmr::polymorphic_allocator<Kept>(m_memory), std::forward<Value>(value));
        Kept* place = held.get();
        m_kept.push_back(std::move(held));
        return place;
    }
    std::string_view keepName(const char* name);
    uint32_t use(uint32_t pass, uint32_t resource, uint32_t version, const Access& how, bool write);
    uint32_t addResource(GraphResource resource);
    void cullPasses();
    void findLifetimes();
    void placeBarriers();

    std::pmr::memory_resource* m_memory;
    std::pmr::vector<GraphPass> m_passes;
    std::pmr::vector<GraphResource> m_resources;
    std::pmr::vector<std::shared_ptr<void>> m_kept;
    std::pmr::deque<std::pmr::string> m_names; // which never move
    bool m_compiled = false;
};

} // namespace q3rt
