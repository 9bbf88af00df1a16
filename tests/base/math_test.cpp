// Numbers that go to the GPU.
#include "base/Math.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lucent {
namespace {

// Nearer than its neighbours, and of two at the same distance the even one.
TEST(Math, AHalfIsTheNearest) {
    for (int code = 0; code < 0x7bff; ++code) {
        const float low = glm::unpackHalf1x16(std::uint16_t(code)),
                    high = glm::unpackHalf1x16(std::uint16_t(code + 1));
        const float middle = (low + high) / 2; // exact
        EXPECT_EQ(halfFrom(low), code);
        EXPECT_EQ(halfFrom(std::nextafter(middle, low)), code);
        EXPECT_EQ(halfFrom(std::nextafter(middle, high)), code + 1);
        EXPECT_EQ(halfFrom(middle), code % 2 ? code + 1 : code);
    }
    EXPECT_EQ(halfFrom(1e30f), 0x7bff);
    EXPECT_EQ(halfFrom(std::numeric_limits<float>::infinity()), 0x7bff);
}

} // namespace
} // namespace lucent
