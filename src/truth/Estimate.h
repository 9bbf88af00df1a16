#pragma once
/// Means of independent samples, and how far such a mean may be off.

#include "base/Math.h"

#include <cstdint>

namespace lucent::truth {

/// Mean and spread of samples of a colour, gathered in one pass without a difference of large sums (Welford
/// 1962); two halves may be gathered apart and put together (Chan, Golub, LeVeque 1979).
class Estimate {
public:
    void add(const dvec3& sample) {
        const dvec3 before = sample - mean_;
        mean_ += before / double(++count_);
        squares_ += before * (sample - mean_);
    }
    void add(const Estimate& other) {
        if (other.count_ == 0) return;
        const auto all = double(count_ + other.count_);
        const dvec3 apart = other.mean_ - mean_;
        mean_ += apart * (double(other.count_) / all);
        squares_ += other.squares_ + apart * apart * (double(count_) * double(other.count_) / all);
        count_ += other.count_;
    }

    std::int64_t count() const { return count_; }
    dvec3 mean() const { return mean_; }
    /// Unbiased variance of one sample; 0 before the second.
    dvec3 variance() const { return count_ > 1 ? squares_ / double(count_ - 1) : dvec3(0); }
    /// Variance of the mean: the square of its standard error.
    dvec3 varianceOfMean() const { return count_ > 0 ? variance() / double(count_) : dvec3(0); }
    dvec3 standardError() const { return glm::sqrt(varianceOfMean()); }

private:
    std::int64_t count_ = 0;
    dvec3 mean_{0}, squares_{0};
};

} // namespace lucent::truth
