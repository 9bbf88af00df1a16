#include "base/File.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace lucent {
namespace {

// An empty folder for one test.
std::string freshFolder() {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const std::string folder = testing::TempDir() + "lucent_" + name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

TEST(File, WrittenBytesAreReadBackAndNoOtherFileIsLeft) {
    const std::string folder = freshFolder(), path = folder + "/a.bin";
    Bytes bytes(200000, std::byte(7)); // more than one block
    bytes.back() = std::byte(9);
    ASSERT_TRUE(writeFile(path, bytes));
    EXPECT_EQ(*readFile(path), bytes);
    ASSERT_TRUE(writeFile(path, {}));
    EXPECT_TRUE(readFile(path)->empty());
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(File, MessagesNameThePathAndTheReason) {
    const std::string folder = freshFolder();
    EXPECT_EQ(readFile(folder + "/none").error().message,
              folder + "/none: cannot be read (No such file or directory)");
    EXPECT_EQ(readFile(folder).error().message, folder + ": cannot be read (Is a directory)");
    EXPECT_EQ(writeFile(folder + "/no/a", {}).error().message,
              folder + "/no/a: cannot be written (No such file or directory)");
}

TEST(File, FailedWriteLeavesTheOldFileAndNothingElse) {
    const std::string folder = freshFolder(), path = folder + "/a";
    std::filesystem::create_directories(path + "/full"); // a folder cannot be replaced by a file
    EXPECT_FALSE(writeFile(path, test::bytesOf("x")));
    EXPECT_TRUE(std::filesystem::is_directory(path + "/full"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(File, PathsAreSeenFromTheFolderOfAnotherFile) {
    EXPECT_EQ(resolvePath("scenes/coin.json", "coin.png"), "scenes/coin.png");
    EXPECT_EQ(resolvePath("coin.json", "maps/coin.png"), "maps/coin.png");
    EXPECT_EQ(resolvePath("a/b/c.json", "../d.png"), "a/b/../d.png");
    EXPECT_EQ(resolvePath("a/b.json", "/c.png"), "/c.png");
    EXPECT_EQ(resolvePath("a/b.json", "https://host/c.png"), "https://host/c.png");
}

} // namespace
} // namespace lucent
