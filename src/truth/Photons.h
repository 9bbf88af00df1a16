#pragma once
/// Pictures by rays of light: what each ray brings is added to the pixels that show where it arrives.

#include "base/Math.h"
#include "truth/Picture.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

namespace lucent::truth {

/// In place of a pixel's number, for random numbers of rays: one that no pixel has.
inline constexpr std::uint64_t kPhotonStream = ~std::uint64_t(0);

/// What some of the rays have brought: sums, and sums of squares.
struct Brought {
    std::vector<dvec3> sums, squares; ///< of the pixels, row by row
    dvec3 strongest{0};               ///< W of a ray, of each colour
    EnergyBook energy;

    explicit Brought(ivec2 size)
        : sums(std::size_t(size.x) * std::size_t(size.y), dvec3(0)), squares(sums.size(), dvec3(0)) {}
    /// All that one ray brings to a pixel: what comes at once is one sample.
    void add(std::size_t pixel, const dvec3& value) {
        sums[pixel] += value;
        squares[pixel] += value * value;
    }
    void add(const Brought& other);
};

/// Follows one ray, by its number; called by several threads at once.
using FollowRay = std::function<void(std::int64_t number, Brought& brought)>;

/// Follows the rays of a part of a picture. Sums are the same whatever the number of threads.
///
/// @param photons  of the part
/// @return         what was brought until `cancel` was set
Brought followAll(const FollowRay& follow, ivec2 size, const Tile& part, std::int64_t photons,
                  const Work& work, const std::atomic<bool>& cancel);

/// Adds the mean of `photons` rays and its error to a picture. A pixel that no ray met may still be lit:
/// there the error is what it receives with a probability of 95 % at most, 3 / n times what the strongest ray
/// would bring (the rule of three: (1 - 3 / n)^n = 0.05).
///
/// @param worth  for each pixel what a watt would add
void addTo(Picture& picture, const Brought& brought, const std::vector<dvec3>& worth, double photons);

} // namespace lucent::truth
