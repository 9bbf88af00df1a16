#pragma once
/// Pictures by rays of light: what each ray brings is added to the pixels that show where it arrives.

#include "base/Math.h"
#include "truth/Exact.h"
#include "truth/Picture.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace lucent::truth {

/// In place of a pixel's number, for random numbers of rays: one that no pixel has.
inline constexpr std::uint64_t kPhotonStream = ~std::uint64_t(0);

/// What one ray has brought.
struct Brought {
    std::vector<std::pair<std::size_t, dvec3>> samples; ///< of pixels, row by row
    dvec3 strongest{0};                                 ///< W of a ray, of each colour
    EnergyBook energy;

    /// All that one ray brings to a pixel: what comes at once is one sample.
    void add(std::size_t pixel, const dvec3& value) { samples.emplace_back(pixel, value); }
};

/// What some of the rays of a picture have brought: the same sums in whatever order and parts they came.
struct Rays {
    using Color = std::array<Exact, 3>;
    struct Sample {
        Color sum, squares;
    };
    std::vector<Sample> pixels; ///< row by row
    std::array<Color, EnergyBook::kEntries.size()> energy;
    dvec3 strongest{0};       ///< W of a ray, of each colour
    std::vector<dvec3> worth; ///< what a watt would add to each pixel; no sum, and the same in all parts

    explicit Rays(std::size_t count = 0) : pixels(count) {}
    void add(std::span<const std::pair<std::size_t, dvec3>> samples);
    void add(const EnergyBook& book);
    void add(const Rays& other);
};

/// Follows one ray, by its number; called by several threads at once.
using FollowRay = std::function<void(std::int64_t number, Brought& brought)>;

/// Follows the rays of a part of a picture.
///
/// @param all  rays of the whole picture
/// @return     what was brought until `cancel` was set
Rays followAll(const FollowRay& follow, ivec2 size, const Tile& part, std::int64_t all, const Work& work,
               const std::atomic<bool>& cancel);

/// Adds the mean of all `photons` rays and its error to a picture without them. A pixel that no ray met may
/// still be lit: there the error is what it receives with a probability of 95 % at most, 3 / n times what the
/// strongest ray would bring (the rule of three: (1 - 3 / n)^n = 0.05).
void addRays(Picture& picture, const Rays& rays, std::int64_t photons);

/// The rows of a part with what its rays brought: added where they are all of them, else kept for merge().
Picture withRays(Picture rows, Rays rays, const Tile& part, std::int64_t photons);

} // namespace lucent::truth
