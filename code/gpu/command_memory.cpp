#include "gpu/command_memory.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>

namespace q3rt {

namespace {

/// Lies before each piece.
struct Header {
    size_t wholeSize, offset, alignment; ///< of the block, bytes; where the piece begins in it
};

Header& headerOf(void* piece) { return static_cast<Header*>(piece)[-1]; }

} // namespace

CommandMemory::CommandMemory() {
    m_callbacks.pUserData = this;
    m_callbacks.pfnAllocation = [](void* user, size_t size, size_t alignment, VkSystemAllocationScope) {
        return static_cast<CommandMemory*>(user)->allocate(size, alignment);
    };
    m_callbacks.pfnReallocation = [](void* user, void* piece, size_t size, size_t alignment, VkSystemAllocationScope) {
        return static_cast<CommandMemory*>(user)->reallocate(piece, size, alignment);
    };
    m_callbacks.pfnFree = [](void* user, void* piece) { static_cast<CommandMemory*>(user)->free(piece); };
}

/// What the pool does not keep it would take from `m_blocks`, which never gets anything back.
std::pmr::memory_resource& CommandMemory::resourceFor(size_t bytes) {
    return bytes > kLargestPooledBytes ? *std::pmr::new_delete_resource() : m_pool;
}

void* CommandMemory::allocate(size_t size, size_t alignment) noexcept {
    size = std::max<size_t>(size, 1); // drivers take none for a failure, also of nothing
    Header header;
    header.alignment = std::max(alignment, alignof(Header));
    header.offset = (sizeof(Header) + header.alignment - 1) / header.alignment * header.alignment;
    header.wholeSize = header.offset + size;
    try {
        void* const block = resourceFor(header.wholeSize).allocate(header.wholeSize, header.alignment);
        void* const piece = static_cast<std::byte*>(block) + header.offset;
        headerOf(piece) = header;
        return piece;
    } catch (const std::bad_alloc&) {
        return nullptr; // the driver's call fails and says so
    }
}

void* CommandMemory::reallocate(void* piece, size_t size, size_t alignment) noexcept {
    if (size == 0) {
        free(piece);
        return nullptr;
    }
    void* const larger = allocate(size, alignment);
    if (larger && piece) std::memcpy(larger, piece, std::min(size, headerOf(piece).wholeSize - headerOf(piece).offset));
    if (larger) free(piece);
    return larger;
}

void CommandMemory::free(void* piece) noexcept {
    if (!piece) return;
    const Header header = headerOf(piece);
    void* const block = static_cast<std::byte*>(piece) - header.offset;
    resourceFor(header.wholeSize).deallocate(block, header.wholeSize, header.alignment);
}

} // namespace q3rt
