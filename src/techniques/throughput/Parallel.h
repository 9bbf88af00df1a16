#pragma once
/// Long work in small independent pieces, with progress.

#include "base/Result.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace lucent::throughput {

/// How the work is done; no result depends on it.
struct Work {
    int threads = 0; ///< 0: as many as the machine has
    /// Called now and then, always from the calling thread, with the finished share in [0,1]. @return false:
    /// the work stops
    std::function<bool(double)> goOn = [](double) { return true; };
};

/// A part [from, to] of the work as work of its own.
inline Work partOf(const Work& work, double from, double to) {
    return {work.threads, [=](double share) { return work.goOn(from + share * (to - from)); }};
}

/// Calls `piece` with each of [0, count), on several threads.
///
/// @return  Error where the work was stopped: some pieces are not done
template <class Piece>
Status forEach(std::size_t count, const Work& work, const Piece& piece) {
#ifdef __EMSCRIPTEN__
    const std::size_t threads = 1; // the page's module is built without them
#else
    const std::size_t threads =
        std::size_t(work.threads > 0 ? work.threads : std::max(1, int(std::thread::hardware_concurrency())));
#endif
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stops{false};
    const std::size_t batch = std::clamp<std::size_t>(count / 256, 1, 64);
    const auto takeBatch = [&] {
        const std::size_t first = next.fetch_add(batch);
        if (first >= count || stops) return false;
        for (std::size_t i = first; i < std::min(first + batch, count); ++i)
            piece(i);
        return true;
    };
    std::vector<std::thread> others; // the calling thread is one of them
    for (std::size_t i = 1; i < std::min(threads, count); ++i)
        others.emplace_back([&] {
            while (takeBatch()) {
            }
        });
    do {
        if (!work.goOn(double(std::min(next.load(), count)) / double(std::max<std::size_t>(count, 1))))
            stops = true;
    } while (takeBatch());
    for (std::thread& other : others)
        other.join();
    if (stops) return Error{"the bake was stopped; nothing is kept of it"};
    return Done{};
}

} // namespace lucent::throughput
