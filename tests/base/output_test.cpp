#include "base/Output.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <set>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {
int renamesUntilFailure = -1; // below 0: none fails
}

// The library's renames come here, so that one of them can fail behind others that did not.
extern "C" int rename(const char* from, const char* to) noexcept {
    if (renamesUntilFailure-- == 0) {
        errno = EBUSY;
        return -1;
    }
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

namespace lucent {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;

class Outputs : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = testing::TempDir() + "lucent_" + name;
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    std::string text(const std::string& name) const {
        const Result<Bytes> bytes = readFile(path(name));
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "none";
    }
    std::set<std::string> names() const {
        std::set<std::string> names;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
            names.insert(entry.path().filename().string());
        return names;
    }
    Status write(const std::vector<Output>& outputs) const { return writeFiles(outputs); }

private:
    std::string folder_;
};

TEST_F(Outputs, AppearTogether) {
    ASSERT_TRUE(writeFile(path("a"), bytesOf("old")));
    ASSERT_TRUE(write({{path("a"), bytesOf("1")}, {path("b"), bytesOf("2")}}));
    EXPECT_EQ(text("a"), "1");
    EXPECT_EQ(text("b"), "2");
    EXPECT_EQ(names(), (std::set<std::string>{"a", "b"}));
}

TEST_F(Outputs, LeaveAllAsItWasWhenOneHasNoFolder) {
    ASSERT_TRUE(writeFile(path("a"), bytesOf("old")));
    const Status written = write({{path("a"), bytesOf("1")}, {path("no/b"), bytesOf("2")}});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, path("no/b") + ": cannot be written (No such file or directory)");
    EXPECT_EQ(text("a"), "old");
    EXPECT_EQ(names(), (std::set<std::string>{"a"}));
}

TEST_F(Outputs, LeaveAllAsItWasWhenOneDoesNotFit) {
    ASSERT_TRUE(writeFile(path("a"), bytesOf("old")));
    rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Status written = write({{path("a"), bytesOf("1")}, {path("b"), Bytes(2000)}});
    setrlimit(RLIMIT_FSIZE, &before);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, path("b") + ": cannot be written (File too large)");
    EXPECT_EQ(text("a"), "old");
    EXPECT_EQ(names(), (std::set<std::string>{"a"}));
}

TEST_F(Outputs, LeaveAllAsItWasWhenOneCannotTakeItsPlace) {
    ASSERT_TRUE(writeFile(path("b"), bytesOf("old")));
    renamesUntilFailure = 2; // a and b are in place
    const Status written =
        write({{path("a"), bytesOf("1")}, {path("b"), bytesOf("2")}, {path("c"), bytesOf("3")}});
    renamesUntilFailure = -1;
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, path("c") + ": cannot be written (Device or resource busy)");
    EXPECT_EQ(text("b"), "old");
    EXPECT_EQ(names(), (std::set<std::string>{"b"}));
}

TEST_F(Outputs, ReplaceRegularFilesOnly) {
    fs::create_directory(path("folder"));
    mkfifo(path("pipe").c_str(), 0600);
    const std::string must = "; must be a regular file, or a new one";
    EXPECT_EQ(writeFile(path("folder"), {}).error().message, path("folder") + ": is a folder" + must);
    EXPECT_EQ(writeFile(path("pipe"), {}).error().message, path("pipe") + ": is a pipe" + must);
    EXPECT_EQ(writeFile("/dev/null", {}).error().message, "/dev/null: is a device" + must);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    fs::create_symlink("/dev/null", path("link"));
    EXPECT_EQ(writeFile(path("link"), {}).error().message, path("link") + ": is a device" + must);
    EXPECT_EQ(names(), (std::set<std::string>{"folder", "link", "pipe"}));
}

TEST_F(Outputs, KeepPermissionsAndSymbolicLinks) {
    fs::create_directory(path("deep"));
    ASSERT_TRUE(writeFile(path("deep/a"), bytesOf("old")));
    fs::permissions(path("deep/a"), fs::perms(0640));
    fs::create_symlink("deep/a", path("to-file"));
    fs::create_symlink("to-file", path("to-link"));
    fs::create_symlink("deep/new", path("to-nothing"));
    ASSERT_TRUE(writeFile(path("to-link"), bytesOf("1")));
    ASSERT_TRUE(writeFile(path("to-nothing"), bytesOf("2")));
    EXPECT_EQ(fs::read_symlink(path("to-file")), "deep/a");
    EXPECT_EQ(fs::read_symlink(path("to-nothing")), "deep/new");
    EXPECT_EQ(text("deep/a"), "1");
    EXPECT_EQ(text("deep/new"), "2");
    EXPECT_EQ(fs::status(path("deep/a")).permissions(), fs::perms(0640));
}

TEST_F(Outputs, OfOnePathAreRefused) {
    ASSERT_TRUE(writeFile(path("a"), bytesOf("old")));
    fs::create_symlink("a", path("link"));
    fs::create_directory(path("deep"));
    for (const char* same : {"a", "link", "deep/../a"}) {
        const Status written = write({{path("a"), bytesOf("1")}, {path(same), bytesOf("2")}});
        ASSERT_FALSE(written) << same;
        EXPECT_EQ(written.error().message,
                  path(same) + ": is written twice, as " + path("a") + " too; must be two files");
    }
    EXPECT_EQ(text("a"), "old");
}

TEST_F(Outputs, LeaveNothingHalfWhenASignalEndsTheProgram) {
    const Bytes large(std::size_t(1) << 25, std::byte(1));
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const pid_t child = fork();
        if (child == 0)
            for (;;)
                if (!write({{path("a"), large}, {path("b"), large}})) _exit(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        kill(child, signal);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
        for (const std::string& name : names()) {
            EXPECT_TRUE(name == "a" || name == "b") << name;
            EXPECT_EQ(fs::file_size(path(name)), large.size());
        }
    }
}

} // namespace
} // namespace lucent
