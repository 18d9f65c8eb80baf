#pragma once
// Host memory for what a driver records into the command buffers of one pool. A software driver asks for a piece for
// each command and gives all back when the pool is reset: pieces of equal size lie ready here, while the heap joins
// and splits them anew each frame.

#include <memory_resource>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class CommandMemory {
  public:
    CommandMemory();
    CommandMemory(const CommandMemory&) = delete;
    CommandMemory& operator=(const CommandMemory&) = delete;
    /// For one command pool, which lives shorter: whoever uses the pool keeps others out of it, and so out of this.
    const VkAllocationCallbacks* callbacks() const { return &m_callbacks; }

  private:
    void* allocate(size_t size, size_t alignment) noexcept;
    void* reallocate(void* piece, size_t size, size_t alignment) noexcept;
    void free(void* piece) noexcept;
    std::pmr::memory_resource& resourceFor(size_t bytes);

    static constexpr size_t kBusyFrameBytes = size_t{1} << 20; ///< several times what a usual frame records
    std::pmr::monotonic_buffer_resource m_blocks{kBusyFrameBytes};
    static constexpr size_t kLargestPooledBytes = size_t{1} << 16;
    std::pmr::unsynchronized_pool_resource m_pool{{.max_blocks_per_chunk = 0, // the library's own
                                                   .largest_required_pool_block = kLargestPooledBytes},
                                                  &m_blocks};
    VkAllocationCallbacks m_callbacks{};
};

} // namespace q3rt
