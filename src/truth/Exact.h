#pragma once
/// Sums that are the same in whatever order their terms come, to the last bit.

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace lucent::truth {

/// A sum of doubles as a fixed-point number of 256 bits: whole multiples of 2^-128 below 2^127. Terms lose
/// what is finer than that and nothing else, so that the order of additions does not matter.
class Exact {
public:
    /// @param term  finite, at most 2^119; all of them together below 2^127
    void add(double term) {
        if (term == 0) return;
        int exponent = 0;
        const auto digits = std::uint64_t(std::ldexp(std::frexp(std::abs(term), &exponent), 53));
        assert(std::isfinite(term) && exponent <= 120);
        const int place = exponent - 53 + 128; // of the last digit
        Exact more;
        if (place >= 0) {
            const auto word = std::size_t(place / 64);
            const int shift = place % 64;
            more.words_[word] = digits << shift;
            if (shift > 11) more.words_[word + 1] = digits >> (64 - shift);
        } else if (place > -64) {
            more.words_[0] = digits >> -place;
        }
        if (term < 0) more.negate();
        add(more);
    }
    void add(const Exact& other) {
        bool carry = false;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const std::uint64_t sum = words_[i] + other.words_[i], whole = sum + carry;
            carry = sum < other.words_[i] || whole < sum;
            words_[i] = whole;
        }
    }
    double value() const {
        Exact size = *this;
        const bool negative = words_.back() >> 63;
        if (negative) size.negate();
        double sum = 0;
        for (std::size_t i = 0; i < words_.size(); ++i)
            sum += std::ldexp(double(size.words_[i]), 64 * int(i) - 128);
        return negative ? -sum : sum;
    }

private:
    void negate() {
        bool carry = true;
        for (std::uint64_t& word : words_) {
            word = ~word + carry;
            carry = carry && word == 0;
        }
    }
    std::array<std::uint64_t, 4> words_{}; ///< lowest first, two's complement
};

} // namespace lucent::truth
