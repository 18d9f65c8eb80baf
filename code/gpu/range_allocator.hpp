#pragma once
// Sub-allocation of one range of bytes: free list with coalescing, best fit. Pure CPU.

#include <cstdint>
#include <map>
#include <optional>

namespace q3rt {

class RangeAllocator {
  public:
    explicit RangeAllocator(uint64_t size);
    /// Offset of `size` bytes aligned to `alignment` (a power of two), or nullopt if no hole is large enough.
    std::optional<uint64_t> allocate(uint64_t size, uint64_t alignment);
    /// Gives back exactly what allocate() returned for the same size.
    void free(uint64_t offset, uint64_t size);
    uint64_t size() const { return m_size; }
    uint64_t used() const { return m_used; }
    bool empty() const { return m_used == 0; }
    /// 1 when nothing is allocated or fragmentation is nil.
    size_t holeCount() const { return m_holes.size(); }

  private:
    uint64_t m_size;
    uint64_t m_used = 0;
    std::map<uint64_t, uint64_t> m_holes; // offset -> size; neighbours never touch
};

} // namespace q3rt
