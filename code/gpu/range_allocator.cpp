#include "gpu/range_allocator.hpp"

#include <iterator>

namespace q3rt {
namespace {

uint64_t alignUp(uint64_t value, uint64_t alignment) { return (value + alignment - 1) & ~(alignment - 1); }

} // namespace

RangeAllocator::RangeAllocator(uint64_t size)
    : m_size(size) {
    if (size > 0) m_holes.emplace(0, size);
}

std::optional<uint64_t> RangeAllocator::allocate(uint64_t size, uint64_t alignment) {
    // Best fit: the hole that leaves the least, so that large holes survive for large requests.
    auto best = m_holes.end();
    uint64_t bestLeft = ~uint64_t{0};
    for (auto hole = m_holes.begin(); hole != m_holes.end(); ++hole) {
        const uint64_t start = alignUp(hole->first, alignment);
        const uint64_t end = hole->first + hole->second;
        if (start > end || end - start < size) continue;
        const uint64_t left = hole->second - size;
        if (left < bestLeft) {
            best = hole;
            bestLeft = left;
        }
    }
    if (best == m_holes.end()) return std::nullopt;

    const uint64_t holeStart = best->first;
    const uint64_t holeEnd = holeStart + best->second;
    const uint64_t start = alignUp(holeStart, alignment);
    m_holes.erase(best);
    // The gap before an aligned start stays a hole of its own, so free() needs no more than offset and size.
    if (start > holeStart) m_holes.emplace(holeStart, start - holeStart);
    if (holeEnd > start + size) m_holes.emplace(start + size, holeEnd - start - size);
    m_used += size;
    return start;
}

void RangeAllocator::free(uint64_t offset, uint64_t size) {
    if (size == 0) return;
    m_used -= size;
    auto next = m_holes.lower_bound(offset);
    if (next != m_holes.end() && next->first == offset + size) {
        size += next->second;
        next = m_holes.erase(next);
    }
    if (next != m_holes.begin()) {
        const auto previous = std::prev(next);
        if (previous->first + previous->second == offset) {
            previous->second += size;
            return;
        }
    }
    m_holes.emplace(offset, size);
}

} // namespace q3rt
