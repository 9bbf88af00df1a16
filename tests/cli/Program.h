#pragma once
/// Runs the built program in a folder of its own.

#include "base/File.h"
#include "base/Image.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace lucent::test {

struct Outcome {
    int code;
    std::string out, err;
};

class ProgramTest : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("lucent-") + info->name() + "-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

    void write(const std::string& name, const std::string& text) const {
        const auto* first = reinterpret_cast<const std::byte*>(text.data());
        ASSERT_TRUE(writeFile(path(name), std::span(first, text.size())).ok());
    }
    void write(const std::string& name, const Image& image) const {
        const auto bytes = encodeImage(image, name);
        ASSERT_TRUE(bytes.ok());
        ASSERT_TRUE(writeFile(path(name), *bytes).ok());
    }
    std::string text(const std::string& name) const {
        const auto bytes = readFile(path(name));
        return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
    }

    /// Files in the folder, so that nothing written can be told.
    std::size_t fileCount() const {
        const std::filesystem::directory_iterator files(folder_);
        return std::size_t(std::distance(begin(files), end(files)));
    }

    /// A scene over `heights` (a file name), with `material` and `rest` put in as JSON members.
    void writeScene(const std::string& heights, const std::string& material = R"("depth": 0.1)",
                    const std::string& rest = R"("title": "test")") const {
        write("scene.json", "{ \"lucent\": 1, \"size\": [16, 16], " + rest +
                                ",\n"
                                "  \"lights\": [ { \"type\": \"point\", \"position\": [0.3, 0.4, 0.6] } ],\n"
                                "  \"objects\": [ { \"name\": \"field\",\n"
                                "    \"shape\": { \"type\": \"heightfield\", \"heights\": " +
                                heights + " },\n    \"material\": { " + material + " } } ] }\n");
    }
    /// A bump of 8 x 8 texels.
    void writeBump(const std::string& name) const {
        Image heights(8, 8, 1);
        *heights.at(3, 4) = 1;
        write(name, heights);
    }

    /// Runs "lucent ARGUMENTS" in the folder.
    Outcome run(const std::string& arguments) const {
        return outcomeOf(std::system(commandFor(arguments).c_str()));
    }

    /// The same, stopped by SIGINT once it catches that and `isTime`, or after half a minute. Its code is -1
    /// where it did not end by itself.
    Outcome runStopped(
        const std::string& arguments, const std::function<bool()>& isTime = [] { return true; }) const {
        const std::string command = commandFor(arguments);
        const pid_t program = fork();
        if (program == 0) {
            alarm(60); // outlives exec: a program that does not stop is stopped all the same
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(127);
        }
        for (int i = 0; i < 300 && !(catchesInterrupts(program) && isTime()); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        kill(program, SIGINT);
        int status = 0;
        waitpid(program, &status, 0);
        return outcomeOf(status);
    }

    /// The command must end with code 1 and exactly this message, and leave no new file.
    void expectRefusal(const std::string& arguments, const std::string& message) const {
        const std::size_t before = fileCount();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 1) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_EQ(outcome.err, "lucent: " + message + "\n") << arguments;
        EXPECT_EQ(fileCount(), before) << arguments;
    }

    /// What a text in JSON says; a failure and null when it is none.
    static nlohmann::json parsed(const std::string& text) {
        nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
        EXPECT_FALSE(json.is_discarded()) << text;
        return json.is_discarded() ? nlohmann::json() : json;
    }

private:
    std::string commandFor(const std::string& arguments) const {
        return "cd '" + folder_.string() + "' && exec '" LUCENT_PROGRAM "' " + arguments + " >'" +
               path(".out") + "' 2>'" + path(".err") + "'";
    }
    Outcome outcomeOf(int status) const {
        Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(".out"), text(".err")};
        std::filesystem::remove(path(".out"));
        std::filesystem::remove(path(".err"));
        return outcome;
    }
    // As the kernel tells of a process: proc(5), SigCgt.
    static bool catchesInterrupts(pid_t program) {
        std::ifstream status("/proc/" + std::to_string(program) + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("SigCgt:"))
                return std::strtoull(line.c_str() + 7, nullptr, 16) >> (SIGINT - 1) & 1;
        return false;
    }

    std::filesystem::path folder_;
};

} // namespace lucent::test
