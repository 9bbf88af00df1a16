#include "truth/Estimate.h"
#include "truth/Exact.h"
#include "truth/Random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

namespace lucent::truth {
namespace {

TEST(Random, IsTheSameForTheSamePlaceAndAnotherForAnyOther) {
    std::set<double> seen;
    for (std::uint64_t seed = 0; seed < 8; ++seed)
        for (std::uint64_t pixel = 0; pixel < 16; ++pixel)
            for (std::uint64_t sample = 0; sample < 16; ++sample) {
                Random random(seed, pixel, sample), again(seed, pixel, sample);
                const double first = random.next();
                EXPECT_EQ(first, again.next());
                seen.insert(first);
                seen.insert(random.next());
            }
    EXPECT_EQ(seen.size(), 2u * 8 * 16 * 16);
}

TEST(Random, IsEvenAndNeighboursAreIndependent) {
    // n numbers even in [0,1) have the mean 1/2 with a standard error of 1/sqrt(12 n), the square of each 1/3
    // with sqrt(4/45/n), the product of neighbours 1/4 with sqrt(7/144/n) at most doubled by their overlap.
    constexpr int kCount = 100'000;
    double sum = 0, squares = 0, products = 0, before = Random(7, 99'999, 0).next();
    for (int i = 0; i < kCount; ++i) {
        const double x = Random(7, std::uint64_t(i), 0).next();
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        sum += x;
        squares += x * x;
        products += x * before;
        before = x;
    }
    EXPECT_NEAR(sum / kCount, 0.5, 4 / std::sqrt(12.0 * kCount));
    EXPECT_NEAR(squares / kCount, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / kCount));
    EXPECT_NEAR(products / kCount, 0.25, 8 * std::sqrt(7.0 / 144 / kCount));
}

TEST(Estimate, GivesMeanAndSpreadOfFourNumbers) {
    // 1, 2, 3, 6: mean 3, squared distances 4 + 1 + 0 + 9 = 14, over n - 1 = 3.
    Estimate estimate;
    EXPECT_EQ(estimate.varianceOfMean().x, 0);
    for (const double value : {1.0, 2.0, 3.0, 6.0})
        estimate.add(dvec3(value, 10 * value, 1e9 + value));
    for (int channel = 0; channel < 3; ++channel) {
        const double scale = channel == 1 ? 10 : 1;
        EXPECT_NEAR(estimate.mean()[channel], (channel == 2 ? 1e9 : 0) + 3 * scale, 1e-6);
        EXPECT_NEAR(estimate.variance()[channel], 14.0 / 3 * scale * scale, 1e-6 * scale * scale);
        EXPECT_NEAR(estimate.standardError()[channel], std::sqrt(14.0 / 12) * scale, 1e-6 * scale);
    }
}

TEST(Estimate, TwoHalvesMakeTheWhole) {
    Estimate whole, first, second, empty;
    for (int i = 0; i < 100; ++i) {
        const dvec3 value(Random(1, std::uint64_t(i), 0).next(), i, i % 3);
        whole.add(value);
        (i < 37 ? first : second).add(value);
    }
    first.add(second);
    first.add(empty);
    EXPECT_EQ(first.count(), 100);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(first.mean()[channel], whole.mean()[channel], 1e-12);
        EXPECT_NEAR(first.variance()[channel], whole.variance()[channel], 1e-9);
    }
}

TEST(Exact, AnyOrderAndAnyPartsOfTermsHaveOneSum) {
    // Signs and powers of two mixed: as doubles their sum depends on the order in every digit.
    std::vector<double> terms;
    Random random(1, 2, 3);
    for (int i = 0; i < 4000; ++i)
        terms.push_back(std::ldexp(random.next() - 0.5, int(160 * random.next()) - 80));
    const auto sumOf = [](std::span<const double> list) {
        Exact sum;
        for (const double term : list)
            sum.add(term);
        return sum;
    };
    const double forward = sumOf(terms).value();
    Exact parts = sumOf(std::span(terms).first(1234));
    parts.add(sumOf(std::span(terms).subspan(1234)));
    EXPECT_EQ(parts.value(), forward);
    std::reverse(terms.begin(), terms.end());
    EXPECT_EQ(sumOf(terms).value(), forward);
    // What cancels leaves the rest, whole.
    for (const double term : std::vector(terms))
        terms.push_back(-term);
    terms.push_back(0x1.23456789abcdep-60);
    EXPECT_EQ(sumOf(terms).value(), 0x1.23456789abcdep-60);
}

TEST(Exact, CarriesAndBorrowsReachAllWords) {
    for (const int place : {-100, -64, -1, 0, 1, 63, 64, 100}) {
        Exact sum;
        sum.add(std::ldexp(1.0, place));
        sum.add(-std::ldexp(1.0, -128)); // all words below are ones now
        sum.add(std::ldexp(1.0, -128));
        EXPECT_EQ(sum.value(), std::ldexp(1.0, place));
        sum.add(-std::ldexp(3.0, place));
        EXPECT_EQ(sum.value(), -std::ldexp(2.0, place));
    }
    Exact fine;
    fine.add(std::ldexp(1.5, -128)); // its half is finer than the sum
    EXPECT_EQ(fine.value(), std::ldexp(1.0, -128));
    fine.add(1e-300);
    EXPECT_EQ(fine.value(), std::ldexp(1.0, -128));
}

} // namespace
} // namespace lucent::truth
