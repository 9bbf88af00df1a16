// The embedded shader sources and their table of lines.
#include "shaders/Shaders.h"

#include <gtest/gtest.h>

#include <cstring>
#include <regex>
#include <string>
#include <vector>

namespace lucent::shaders {
namespace {

TEST(Shaders, StagesHoldCodeOnly) {
    int stages = 0;
    for (const Stage* stage = begin(); stage != end(); ++stage, ++stages) {
        ASSERT_GT(stage->pieceCount, 0) << stage->path;
        for (int i = 0; i < stage->pieceCount; ++i) {
            const std::string source = stage->pieces[i]->source;
            EXPECT_EQ(source.back(), '\n') << stage->path;
            EXPECT_NE(source.front(), '\n') << stage->path;
            EXPECT_EQ(source.find("#include"), std::string::npos) << stage->path;
            EXPECT_EQ(source.find("//"), std::string::npos) << stage->path;
        }
    }
    EXPECT_GE(stages, 5);
}

// The pieces of a stage that come from one file.
std::vector<const Piece*> piecesOf(const char* path, const char* file) {
    std::vector<const Piece*> list;
    const Stage* stage = find(path);
    for (int i = 0; stage && i < stage->pieceCount; ++i)
        if (!std::strcmp(stage->pieces[i]->file, file)) list.push_back(stage->pieces[i]);
    return list;
}

TEST(Shaders, AFileStandsOnceInAStageAndIsSharedByStages) {
    const auto inLight = piecesOf("relief/light.frag", "views/field.glsl");
    ASSERT_EQ(inLight.size(), 1u); // it includes nothing
    EXPECT_EQ(piecesOf("views/surface.frag", "views/field.glsl"), inLight);
    EXPECT_FALSE(piecesOf("relief/light.frag", "relief/light.frag").empty());
}

// WebGL refuses an output with a variable index, which native drivers let pass: no output is indexed at all.
TEST(Shaders, NoOutputIsIndexed) {
    for (const Stage* stage = begin(); stage != end(); ++stage) {
        std::string source;
        for (int i = 0; i < stage->pieceCount; ++i)
            source += stage->pieces[i]->source;
        static const std::regex indexed(R"(\bo[A-Z]\w*\s*\[)");
        std::smatch found;
        EXPECT_FALSE(std::regex_search(source, found, indexed)) << stage->path << ": " << found.str();
    }
}

TEST(Shaders, UnknownStagesAreNotFound) { EXPECT_EQ(find("relief/nothing.frag"), nullptr); }

} // namespace
} // namespace lucent::shaders
