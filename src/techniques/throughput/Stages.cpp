#include "techniques/throughput/Stages.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

namespace lucent::throughput {

namespace {

std::size_t threadsFor(int wanted) {
#ifdef __EMSCRIPTEN__
    (void)wanted;
    return 1; // the page's module is built without them
#else
    return std::size_t(wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency())));
#endif
}

} // namespace

Stages::Stages(int threads) : threads_(threadsFor(threads)) {}

void Stages::add(Stage stage) { stages_.insert(place_, std::move(stage)); }

void Stages::then(std::function<Status()> work) {
    Stage stage;
    stage.whole = std::move(work);
    add(std::move(stage));
}

void Stages::forEach(double share, std::size_t count, std::function<void(std::size_t)> piece) {
    Stage stage;
    stage.share = share;
    stage.count = count;
    stage.piece = std::move(piece);
    add(std::move(stage));
}

void Stages::inOrder(double share, std::size_t count, std::function<void(std::size_t)> piece) {
    forEach(share, count, std::move(piece));
    std::prev(place_)->isParallel = false;
}

void Stages::work(Stage& stage, Clock::time_point end) const {
    const std::size_t threads = stage.isParallel ? std::min(threads_, stage.count) : 1;
    // Few enough that a slice ends in time, and so many that threads do not wait for each other.
    const std::size_t batch = std::clamp<std::size_t>(stage.count / 4096, 1, 16);
    std::atomic<std::size_t> next{stage.done};
    const auto takeBatches = [&] {
        do {
            const std::size_t first = next.fetch_add(batch);
            for (std::size_t i = first; i < std::min(first + batch, stage.count); ++i)
                stage.piece(i);
        } while (next < stage.count && Clock::now() < end);
    };
    std::vector<std::thread> others; // the calling thread is one of them
    for (std::size_t i = 1; i < threads; ++i)
        others.emplace_back(takeBatches);
    takeBatches();
    for (std::thread& other : others)
        other.join();
    stage.done = std::min(next.load(), stage.count);
}

Result<bool> Stages::advance(double ms) {
    using namespace std::chrono;
    constexpr double kForever = 1e9; // ms: more, and clocks run over
    const auto end =
        Clock::now() + duration_cast<Clock::duration>(duration<double, std::milli>(std::min(ms, kForever)));
    do {
        if (stages_.empty()) return true;
        Stage& stage = stages_.front();
        if (stage.done < stage.count) work(stage, end);
        if (stage.done < stage.count) continue;
        const Stage ended = std::move(stage);
        stages_.pop_front();
        done_ += ended.share;
        if (!ended.whole) continue;
        place_ = stages_.begin();
        const Status done = ended.whole();
        place_ = stages_.end();
        if (!done) {
            stages_.clear();
            return done.error();
        }
    } while (Clock::now() < end);
    return stages_.empty();
}

Status Stages::finish() {
    for (;;) {
        const Result<bool> done = advance(1e9);
        if (!done) return done.error();
        if (*done) return Done{};
    }
}

double Stages::share() const {
    if (stages_.empty()) return 1;
    const Stage& stage = stages_.front();
    const double part = stage.count > 0 ? double(stage.done) / double(stage.count) : 0;
    return std::min(1.0, done_ + part * stage.share);
}

} // namespace lucent::throughput
