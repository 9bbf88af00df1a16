// The embedded shader sources and their table of lines.
#include "shaders/Shaders.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace lucent::shaders {
namespace {

TEST(Shaders, EveryStageHasALineTableAsLongAsItsSource) {
    int stages = 0;
    for (const Stage* stage = begin(); stage != end(); ++stage, ++stages) {
        const std::string source = stage->source;
        EXPECT_EQ(std::count(source.begin(), source.end(), '\n'), stage->lineCount) << stage->path;
        EXPECT_EQ(source.find("#include"), std::string::npos) << stage->path;
        EXPECT_EQ(source.find("//"), std::string::npos) << stage->path;
    }
    EXPECT_GE(stages, 5);
}

TEST(Shaders, LinesPointIntoTheFilesTheyCameFrom) {
    const Stage* stage = find("relief/light.frag");
    ASSERT_NE(stage, nullptr);
    bool fromLib = false, fromItself = false;
    for (int i = 0; i < stage->lineCount; ++i) {
        fromLib |= !std::strcmp(stage->lines[i].file, "lib/shading.glsl");
        fromItself |= !std::strcmp(stage->lines[i].file, "relief/light.frag");
    }
    EXPECT_TRUE(fromLib && fromItself);
}

TEST(Shaders, UnknownStagesAreNotFound) { EXPECT_EQ(find("relief/nothing.frag"), nullptr); }

} // namespace
} // namespace lucent::shaders
