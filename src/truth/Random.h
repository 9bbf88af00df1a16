#pragma once
/// Random numbers without a state to carry: each is a function of seed, pixel, sample and its own place in
/// line. Threads, tiles and the order of work therefore never change a picture.

#include "base/Math.h"

#include <cstdint>

namespace lucent::truth {

/// The numbers of one sample of one pixel.
class Random {
public:
    Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
        : state_(mixed(mixed(mixed(seed) + pixel) + sample)) {}

    /// Even in [0,1), 53 bits.
    double next() {
        state_ += kStep;
        return double(scrambled(state_) >> 11) * 0x1p-53;
    }
    dvec2 nextPair() {
        const double first = next();
        return {first, next()};
    }

private:
    // SplitMix64 (Steele, Lea, Flood 2014): equal steps by the golden ratio's bits, each scrambled.
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
    static std::uint64_t scrambled(std::uint64_t bits) {
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        return bits ^ (bits >> 31);
    }
    static std::uint64_t mixed(std::uint64_t bits) { return scrambled(bits + kStep); }

    std::uint64_t state_;
};

} // namespace lucent::truth
