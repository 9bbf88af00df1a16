#include "truth/Photons.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>

namespace lucent::truth {

namespace {
/// Rays are worked off in this many rows, each added up in order and then to the others in order, whatever
/// the number of threads: sums of floating point numbers depend on their order.
constexpr int kLanes = 16;

/// The lanes' sum. Keeps those that are early until their turn, so that few pictures lie about at a time.
class Sum {
public:
    explicit Sum(ivec2 size) : total_(size) {}
    void add(int lane, Brought brought) {
        const std::lock_guard lock(mutex_);
        early_.emplace(lane, std::move(brought));
        for (; !early_.empty() && early_.begin()->first == next_; ++next_) {
            total_.add(early_.begin()->second);
            early_.erase(early_.begin());
        }
    }
    Brought take() { return std::move(total_); }

private:
    std::mutex mutex_;
    std::map<int, Brought> early_;
    int next_ = 0;
    Brought total_;
};

struct Job {
    const FollowRay& follow;
    ivec2 size;
    Tile part;
    std::int64_t photons; ///< of the part
    const std::atomic<bool>& cancel;
    std::atomic<std::int64_t> done = 0;
    std::atomic<int> nextLane = 0;
};

Brought followLane(Job& job, int lane, const std::function<void()>& now) {
    constexpr std::int64_t kChunk = 4096;
    Brought brought(job.size);
    for (std::int64_t from = lane * kChunk; from < job.photons && !job.cancel; from += kLanes * kChunk) {
        const std::int64_t to = std::min(from + kChunk, job.photons);
        for (std::int64_t i = from; i < to; ++i)
            job.follow(job.part.index + i * job.part.count, brought);
        job.done += to - from;
        now();
    }
    return brought;
}
} // namespace

void Brought::add(const Brought& other) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] += other.sums[i];
        squares[i] += other.squares[i];
    }
    strongest = glm::max(strongest, other.strongest);
    energy.add(other.energy, 1);
}

Brought followAll(const FollowRay& follow, ivec2 size, const Tile& part, std::int64_t photons,
                  const Work& work, const std::atomic<bool>& cancel) {
    Sum sum(size);
    Job job{follow, size, part, photons, cancel};
    const auto takeLanes = [&](const std::function<void()>& now) {
        for (int lane; (lane = job.nextLane++) < kLanes;)
            sum.add(lane, followLane(job, lane, now));
    };
    const int threads =
        work.threads > 0 ? work.threads : int(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> others; // the calling thread is one of them
    for (int i = 1; i < std::min(threads, kLanes); ++i)
        others.emplace_back([&] { takeLanes([] {}); });
    takeLanes([&] { work.progress(double(job.done) / double(photons)); });
    for (std::thread& other : others)
        other.join();
    return sum.take();
}

void addTo(Picture& picture, const Brought& brought, const std::vector<dvec3>& worth, double photons) {
    for (std::size_t i = 0; i < brought.sums.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = brought.sums[i][channel] / photons;
            const double bound = 3 / photons * brought.strongest[channel] * worth[i][channel];
            const double spread = brought.squares[i][channel] == 0
                                      ? bound * bound
                                      : std::max(0.0, brought.squares[i][channel] / photons - mean * mean) /
                                            std::max(1.0, photons - 1);
            picture.values.pixels[4 * i + std::size_t(channel)] += float(mean);
            float& error = picture.errors.pixels[3 * i + std::size_t(channel)];
            error = float(std::sqrt(double(error) * double(error) + spread));
        }
}

} // namespace lucent::truth
