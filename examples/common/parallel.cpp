// Work on all cores.
#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

void parallel_for(uint32_t count, const std::function<void(uint32_t)> &work)
{
    std::atomic<uint64_t> next{0}; // 64 bits: every thread counts once beyond the end
    std::mutex mutex;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (uint64_t i = next++; i < count; i = next++)
                work(static_cast<uint32_t>(i));
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            failure = std::current_exception();
            next = count;
        }
    };
    std::vector<std::thread> threads;
    const uint32_t wanted = std::min(count, std::max(1u, std::thread::hardware_concurrency()));
    try {
        for (uint32_t i = 1; i < wanted; i++)
            threads.emplace_back(run);
    } catch (const std::system_error &) {
        // A limit on threads: those there are do the work.
    }
    run();
    for (std::thread &thread : threads)
        thread.join();
    if (failure)
        std::rethrow_exception(failure);
}
