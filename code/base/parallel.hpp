#pragma once
// A loop on all cores. What an iteration does may depend on its index only, so results never depend on the machine.

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace q3rt {

inline size_t coreCount() { return std::max<size_t>(1, std::thread::hardware_concurrency()); }

/// Calls work(i) for each i in [0, count), in any order, from several threads. The first exception comes back.
template <typename Work>
void parallelFor(size_t count, Work&& work) {
    constexpr size_t kChunksPerThread = 16; // cores that other programs slow down leave their share to the rest
    const size_t threadCount = std::min(coreCount(), count);
    const size_t chunk = std::max<size_t>(1, count / std::max<size_t>(1, threadCount * kChunksPerThread));
    std::atomic<size_t> next{0};
    std::exception_ptr failure;
    std::mutex failureLock;
    const auto run = [&] {
        try {
            for (size_t first = next.fetch_add(chunk); first < count; first = next.fetch_add(chunk))
                for (size_t i = first; i < std::min(count, first + chunk); ++i)
                    work(i);
        } catch (...) {
            const std::lock_guard<std::mutex> hold(failureLock);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    std::vector<std::thread> threads;
    for (size_t t = 1; t < threadCount; ++t)
        threads.emplace_back(run);
    run();
    for (std::thread& thread : threads)
        thread.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace q3rt
