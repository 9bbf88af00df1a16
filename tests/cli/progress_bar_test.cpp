#include "cli/ProgressBar.h"

#include <gtest/gtest.h>

namespace lucent::cli {
namespace {

TEST(ProgressLine, SaysTheShareAndWhatIsLeftAtTheSameSpeed) {
    // A quarter took 30 s, so three quarters take 90.
    EXPECT_EQ(progressLine(0.25, 30), "[#####...............] 25 %, 1 min 30 s left");
    EXPECT_EQ(progressLine(0.5, 12), "[##########..........] 50 %, 12 s left");
    EXPECT_EQ(progressLine(1, 12), "[####################] 100 %, 0 s left");
}

TEST(ProgressLine, KeepsSilentAboutTheTimeBeforeItCanKnow) {
    EXPECT_EQ(progressLine(0, 5), "[....................] 0 %");
    EXPECT_EQ(progressLine(0.1, 0.5), "[##..................] 10 %");
}

} // namespace
} // namespace lucent::cli
