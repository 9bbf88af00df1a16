// The matrix of everything on everything: cells that were wrong while reliefs and all else had lights of
// their own.
#include "measure/Compose.h"

#include "scene/Mesh.h"
#include "tests/support/Gl.h"

#include <gtest/gtest.h>

namespace lucent::measure {
namespace {

struct Compose : support::GlTest {};

TEST_F(Compose, ABoxAReliefAndAFloorShadeEachOtherWithinTheTarget) {
    for (const auto& [lamp, between, receiver] : {std::array{"distant", "matt box", "relief 3 %"},
                                                  {"spot", "relief 2.5 %", "relief 0"},
                                                  {"area", "matt box", "matt mesh"},
                                                  {"spot", "pierced mesh", "matt mesh"},
                                                  {"projector", "matt box", "matt plane"}}) {
        const ComposeCell cell = measureCompose(*context, lamp, between, receiver);
        EXPECT_TRUE(cell.isMet()) << cell.name() << ": " << cell.misplaced << ", flux " << cell.flux;
        EXPECT_LT(cell.byNoise, cell.target / 4) << cell.name();
    }
}

TEST(ComposeScene, ThePiercedMeshHasHoles) { // without them picture and truth would agree as well
    const scene::Scene scene = composeScene("spot", "pierced mesh", "matt plane");
    const scene::Textures* textures = scene::texturesOf(scene.objects.back());
    ASSERT_TRUE(textures);
    EXPECT_TRUE(textures->hasHoles());
}

TEST_F(Compose, WhatTheCameraDoesNotSeeStandsInTheWayOfScatteringAndOfCaustics) {
    for (const auto& [between, receiver] : {std::array{"relief 2.5 %", "marble slab"},
                                            {"relief 2.5 %", "floor through glass"},
                                            {"pierced mesh", "floor through glass"},
                                            {"marble ball", "floor through glass"}}) {
        const ComposeCell cell = measureCompose(*context, "distant", between, receiver);
        EXPECT_TRUE(cell.isMet()) << cell.name() << ": " << cell.misplaced << ", flux " << cell.flux;
    }
}

TEST_F(Compose, AFlatMirrorShowsTheFloorWithWhatFallsOnIt) {
    for (const auto& [lamp, between] : {std::array{"point", "matt box"}, {"distant", "glass ball"}}) {
        const ComposeCell cell = measureCompose(*context, lamp, between, "floor in a mirror");
        EXPECT_TRUE(cell.isMet()) << cell.name() << ": " << cell.misplaced << ", flux " << cell.flux;
    }
}

TEST_F(Compose, CausticsFallOnWhatScattersAndComeFromEnvironmentsToo) {
    for (const auto& [lamp, between, receiver] : {std::array{"spot", "glass ball", "marble slab"},
                                                  {"projector", "glass ball", "precomputed slab"},
                                                  {"environment", "glass ball", "matt plane"}}) {
        const ComposeCell cell = measureCompose(*context, lamp, between, receiver);
        EXPECT_TRUE(cell.isMet()) << cell.name() << ": " << cell.misplaced << ", flux " << cell.flux;
    }
}

TEST(ComposeReport, ACellWithoutAFigureSaysWhy) {
    const ComposeCell cell{.lamp = "spot", .between = "fog", .receiver = "floor", .message = "no such thing"};
    const std::string json = composeJson({&cell, 1});
    EXPECT_NE(json.find("no such thing"), std::string::npos);
    EXPECT_EQ(json.find("misplaced"), std::string::npos);
}

} // namespace
} // namespace lucent::measure
