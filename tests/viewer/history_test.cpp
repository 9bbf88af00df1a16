#include "viewer/History.h"

#include <gtest/gtest.h>

namespace lucent::viewer {
namespace {

TEST(History, ChangesOfOneGestureAreOneStep) {
    History history;
    history.record(1, {"a", "0", "1"});
    history.record(1, {"a", "1", "2"});
    history.record(1, {"b", "5", "6"});
    const auto undone = history.undo();
    ASSERT_EQ(undone.size(), 2u);
    EXPECT_EQ(undone[0].path, "b"); // last one first
    EXPECT_EQ(undone[1].before, "0");
    EXPECT_EQ(undone[1].after, "2");
    EXPECT_TRUE(history.undo().empty());
}

TEST(History, RedoGivesBackWhatUndoTookUntilSomethingNewIsRecorded) {
    History history;
    history.record(1, {"a", "0", "1"});
    history.record(2, {"a", "1", "2"});
    (void)history.undo();
    ASSERT_EQ(history.redo().size(), 1u);
    (void)history.undo();
    history.record(3, {"a", "1", "7"});
    EXPECT_TRUE(history.redo().empty());
    EXPECT_EQ(history.undo().at(0).after, "7");
    EXPECT_EQ(history.undo().at(0).after, "1");
}

TEST(History, ForgetsTheOldestOfMoreThanAHundredThousandSteps) {
    History history;
    for (std::uint64_t i = 1; i <= 100050; ++i)
        history.record(i, {"a", std::to_string(i - 1), std::to_string(i)});
    int steps = 0;
    std::string oldest;
    for (auto step = history.undo(); !step.empty(); step = history.undo()) {
        ++steps;
        oldest = step[0].before;
    }
    EXPECT_EQ(steps, 100000);
    EXPECT_EQ(oldest, "50"); // 100050 - 100000
}

} // namespace
} // namespace lucent::viewer
