#include "truth/Photons.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>

namespace lucent::truth {

namespace {
void addColor(Rays::Color& sum, const dvec3& color) {
    for (int channel = 0; channel < 3; ++channel)
        sum[std::size_t(channel)].add(color[channel]);
}
void addColor(Rays::Color& sum, const Rays::Color& other) {
    for (std::size_t channel = 0; channel < 3; ++channel)
        sum[channel].add(other[channel]);
}
} // namespace

void Rays::add(std::span<const std::pair<std::size_t, dvec3>> samples) {
    for (const auto& [pixel, value] : samples) {
        addColor(pixels[pixel].sum, value);
        addColor(pixels[pixel].squares, value * value);
    }
}

void Rays::add(const EnergyBook& book) {
    for (std::size_t i = 0; i < energy.size(); ++i)
        addColor(energy[i], book.*EnergyBook::kEntries[i].value);
}

void Rays::add(const Rays& other) {
    for (std::size_t i = 0; i < other.pixels.size(); ++i) {
        addColor(pixels[i].sum, other.pixels[i].sum);
        addColor(pixels[i].squares, other.pixels[i].squares);
    }
    for (std::size_t i = 0; i < energy.size(); ++i)
        addColor(energy[i], other.energy[i]);
    strongest = glm::max(strongest, other.strongest);
}

Rays followAll(const FollowRay& follow, ivec2 size, const Tile& part, std::int64_t all, const Work& work,
               const std::atomic<bool>& cancel) {
    constexpr std::int64_t kChunk = 4096;
    const std::int64_t photons = part.photons(all);
    Rays rays(std::size_t(size.x) * std::size_t(size.y));
    std::mutex mutex;
    std::atomic<std::int64_t> next = 0, done = 0;
    const auto followChunks = [&](const std::function<void()>& now) {
        Rays own; // but for the pixels
        Brought brought;
        for (std::int64_t from; (from = next.fetch_add(kChunk)) < photons && !cancel; now()) {
            const std::int64_t to = std::min(from + kChunk, photons);
            for (std::int64_t i = from; i < to; ++i) {
                follow(part.index + i * part.count, brought);
                own.add(std::exchange(brought.energy, {}));
            }
            const std::lock_guard lock(mutex);
            rays.add(brought.samples);
            brought.samples.clear();
            done += to - from;
        }
        own.strongest = brought.strongest;
        const std::lock_guard lock(mutex);
        rays.add(own);
    };
    const int threads =
        work.threads > 0 ? work.threads : int(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> others; // the calling thread is one of them
    for (int i = 1; i < threads; ++i)
        others.emplace_back([&] { followChunks([] {}); });
    followChunks([&] { work.progress(double(done) / double(photons)); });
    for (std::thread& other : others)
        other.join();
    return rays;
}

void addRays(Picture& picture, const Rays& rays, std::int64_t count) {
    const auto photons = double(count);
    for (std::size_t i = 0; i < rays.pixels.size(); ++i) {
        const double coverage = double(picture.values.pixels[4 * i + 3]);
        const double ofCovered = coverage > 0 ? 1 / coverage : 1;
        for (int channel = 0; channel < 3; ++channel) {
            const auto c = std::size_t(channel);
            const double mean = rays.pixels[i].sum[c].value() / photons;
            const double squares = rays.pixels[i].squares[c].value();
            const double bound = 3 / photons * rays.strongest[channel] * rays.worth[i][channel];
            const double spread =
                squares == 0 ? bound * bound
                             : std::max(0.0, squares / photons - mean * mean) / std::max(1.0, photons - 1);
            picture.values.pixels[4 * i + c] += float(ofCovered * mean);
            float& error = picture.errors.pixels[3 * i + c];
            error = float(std::sqrt(double(error) * double(error) + ofCovered * ofCovered * spread));
        }
    }
    EnergyBook& energy = picture.energy.emplace();
    for (std::size_t i = 0; i < rays.energy.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            (energy.*EnergyBook::kEntries[i].value)[channel] =
                rays.energy[i][std::size_t(channel)].value() / photons;
}

Picture withRays(Picture rows, Rays rays, const Tile& part, std::int64_t photons) {
    if (part.count == 1)
        addRays(rows, rays, photons);
    else
        rows.rays = std::make_shared<Rays>(std::move(rays));
    return rows;
}

} // namespace lucent::truth
