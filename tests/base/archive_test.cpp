// Zip archives: true ones, and those that somebody made to do harm.
#include "base/Archive.h"
#include "tests/support/Zip.h"

#include <gtest/gtest.h>

namespace lucent {
namespace {

using test::ZipFile;
using test::zipOf;

Bytes bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return Bytes(bytes.begin(), bytes.end());
}

std::string textOf(const Bytes& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Archive opened(const std::vector<ZipFile>& files) {
    Result<Archive> archive = Archive::open("a.zip", bytesOf(zipOf(files)));
    EXPECT_TRUE(archive.ok()) << archive.error().message;
    return std::move(*archive);
}

std::string refusal(const std::string& bytes) {
    const Result<Archive> archive = Archive::open("a.zip", bytesOf(bytes));
    return archive.ok() ? "" : archive.error().message;
}

std::string refusal(const std::vector<ZipFile>& files) { return refusal(zipOf(files)); }

TEST(Archive, GivesWhatWasPutIn) {
    const std::string long_(100000, 'x');
    const Archive archive = opened({{.name = "scene.json", .content = "{}"},
                                    {.name = "maps/", .content = ""},
                                    {.name = "maps/a.pfm", .content = long_, .deflated = true},
                                    {.name = "none", .content = ""}});
    EXPECT_EQ(textOf(*archive.read("scene.json")), "{}");
    EXPECT_EQ(textOf(*archive.read("maps/a.pfm")), long_);
    EXPECT_EQ(textOf(*archive.read("none")), "");
    EXPECT_EQ(archive.read("maps/").error().message, "a.zip/maps/: is not in the archive; must be");
    EXPECT_EQ(archive.read("b").error().message, "a.zip/b: is not in the archive; must be");
}

TEST(Archive, FindsTheScene) {
    EXPECT_EQ(
        *opened({{.name = "other.json", .content = ""}, {.name = "scene.json", .content = ""}}).sceneFile(),
        "scene.json");
    EXPECT_EQ(
        *opened({{.name = "coin.json", .content = ""}, {.name = "a/b.json", .content = ""}}).sceneFile(),
        "coin.json");
    EXPECT_EQ(opened({{.name = "a/scene.json", .content = ""}}).sceneFile().error().message,
              "a.zip: has no scene; must have scene.json, or one .json file");
    EXPECT_EQ(opened({{.name = "a.json", .content = ""}, {.name = "b.json", .content = ""}})
                  .sceneFile()
                  .error()
                  .message,
              "a.zip: has \"a.json\" and \"b.json\"; must have scene.json, or one .json file");
}

TEST(Archive, IsNoOtherFile) {
    EXPECT_EQ(refusal("no archive at all"),
              "a.zip: cannot be read (Not a zip archive); must be a zip archive");
    EXPECT_EQ(Archive::open("a.zip", {})->sceneFile().error().message,
              "a.zip: has no scene; must have scene.json, or one .json file");
    const std::string whole = zipOf({{.name = "scene.json", .content = "{}"}});
    EXPECT_NE(refusal(whole.substr(0, whole.size() / 2)), "");
    for (std::size_t cut = 1; cut < whole.size(); ++cut) // wherever it was cut
        EXPECT_NE(refusal(whole.substr(0, whole.size() - cut)), "") << cut;
}

TEST(Archive, HoldsNoNameThatLeadsOutside) {
    for (const char* name : {"../a", "/a", "a/../../b", "a/..", "..", "./a", "a//b", "a/../"})
        EXPECT_EQ(refusal({{.name = name, .content = ""}}),
                  std::string("a.zip: has a file \"") + name + "\", which leads outside; must lie in it");
}

TEST(Archive, HoldsOneFileOfAName) {
    EXPECT_EQ(refusal({{.name = "a", .content = "1"}, {.name = "a", .content = "2"}}),
              "a.zip: has two files \"a\"; must have one of a name");
}

TEST(Archive, HoldsNoMoreThanThePageDoes) {
    const ZipFile half{.name = "a", .content = "", .size = 1u << 29};
    ZipFile other = half, more = half;
    other.name = "b";
    more = {.name = "c", .content = "", .size = 1};
    EXPECT_EQ(refusal({half, other}), "");
    EXPECT_EQ(refusal({half, other, more}),
              "a.zip: unpacks to more than 1 GiB with \"c\"; must be at most that");
    EXPECT_EQ(refusal({{.name = "a", .content = "", .size = 0xfffffffe}}),
              "a.zip: unpacks to more than 1 GiB with \"a\"; must be at most that");
    std::vector<ZipFile> many;
    for (int i = 0; i <= Archive::kMostFiles; ++i)
        many.push_back({.name = std::to_string(i), .content = ""});
    EXPECT_EQ(refusal(many), "a.zip: has 1001 files; must have at most 1000");
}

// 1 MiB that unpacks from 1 KiB, as the list of the archive does not say.
TEST(Archive, UnpacksNoMoreThanItSays) {
    const std::string zeros(1 << 20, '\0');
    const Archive archive = opened({{.name = "less", .content = zeros, .size = 10, .deflated = true},
                                    {.name = "more", .content = "abc", .size = 1u << 29, .deflated = true}});
    const auto message = [&](const char* name) {
        const Result<Bytes> bytes = archive.read(name);
        return bytes.ok() ? "" : bytes.error().message;
    };
    EXPECT_EQ(message("less"),
              "a.zip/less: unpacks to more than the 10 bytes that the archive says; must be as many");
    EXPECT_EQ(message("more"), "a.zip/more: unpacks to fewer than the 536870912 bytes that the archive says; "
                               "must be as many");
}

TEST(Archive, TellsWhatIsDamagedOrEncrypted) {
    const Archive archive = opened({{.name = "wrong", .content = "abc", .crc = 1},
                                    {.name = "secret", .content = "abcdefghijklmnop", .flags = 1}});
    EXPECT_EQ(archive.read("wrong").error().message,
              "a.zip/wrong: cannot be read (CRC error); must be undamaged");
    EXPECT_EQ(archive.read("secret").error().message,
              "a.zip/secret: cannot be read (No password provided); must be a plain file");
}

} // namespace
} // namespace lucent
