#pragma once
// Memory for what lives one frame: taken piece by piece, given back all at once. The block grows until it holds a whole
// frame, and from then on no frame asks the heap.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <vector>

namespace q3rt {

class FrameArena final : public std::pmr::memory_resource {
  public:
    /// Everything taken since the last call is invalid from now on.
    void reset() {
        m_used = 0;
        if (m_blocks.size() < 2) return;
        size_t total = 0;
        for (const Block& block : m_blocks)
            total += block.size;
        m_blocks.clear();
        addBlock(total);
    }
    size_t blockCount() const { return m_blocks.size(); }

  private:
    struct Block {
        std::unique_ptr<std::byte[]> bytes;
        size_t size;
    };
    static constexpr size_t kFirstBlockBytes = size_t{16} << 10;

    void addBlock(size_t size) {
        m_blocks.push_back({std::make_unique_for_overwrite<std::byte[]>(size), size});
        m_used = 0;
    }
    void* takeFromLast(size_t bytes, size_t alignment) {
        if (m_blocks.empty()) return nullptr;
        const Block& last = m_blocks.back();
        size_t space = last.size - m_used;
        void* place = last.bytes.get() + m_used;
        if (!std::align(alignment, bytes, place, space)) return nullptr;
        m_used = last.size - space + bytes;
        return place;
    }
    void* do_allocate(size_t bytes, size_t alignment) override {
        if (void* place = takeFromLast(bytes, alignment)) return place;
        const size_t last = m_blocks.empty() ? kFirstBlockBytes / 2 : m_blocks.back().size;
        addBlock(std::max(last * 2, bytes + alignment));
        return takeFromLast(bytes, alignment);
    }
    void do_deallocate(void*, size_t, size_t) override {}
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

    std::vector<Block> m_blocks; ///< the last one is being filled
    size_t m_used = 0;           ///< of the last one
};

} // namespace q3rt
