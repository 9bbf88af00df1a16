// Where shadows are looked for from a light.
#include "light/ShadowMap.h"

#include <gtest/gtest.h>

namespace lucent::views {
namespace {

const Bounds kBox{vec3(-1, 0, -1), vec3(1, 2, 1)};
const Bounds kFloor{vec3(-1000, 0, -1000), vec3(1000, 0, 1000)};

// Largest coordinate of a box's corners in clip space, 1 at the view's border.
float reachOf(const Eye& eye, const Bounds& bounds) {
    float most = 0;
    for (int i = 0; i < 8; ++i) {
        const vec4 clip = eye.clipFromWorld * vec4(i & 1 ? bounds.high.x : bounds.low.x,
                                                   i & 2 ? bounds.high.y : bounds.low.y,
                                                   i & 4 ? bounds.high.z : bounds.low.z, 1);
        const vec3 at = glm::abs(vec3(clip)) / clip.w;
        most = std::max({most, at.x, at.y, at.z});
    }
    return most;
}

TEST(ShadowViews, ParallelLightLooksAtWhatCastsAndReceivesOnly) {
    for (const vec3 toLight : {vec3(0, 1, 0), vec3(0.6f, 0.8f, 0), vec3(0, 0.6f, -0.8f)}) {
        const ShadowViews views = shadowViews({.place = vec4(toLight, 0)}, kBox, kFloor, 512);
        ASSERT_EQ(views.faces.size(), 1u);
        EXPECT_EQ(views.imageSize(), ivec2(512));
        EXPECT_LT(reachOf(views.faces[0], kBox), 1);
        // Half the box's diagonal, sqrt(3), and not the floor's 1414 m.
        EXPECT_LT(views.faces[0].halfExtent.x, 1.75f);
        EXPECT_LT(views.faces[0].halfExtent.y, 1.75f);
    }
    // Straight down 1 m to each side, a thousandth, and two texels.
    const ShadowViews down = shadowViews({.place = {0, 1, 0, 0}}, kBox, kFloor, 512);
    EXPECT_NEAR(down.faces[0].halfExtent.x, 1.002 * 512 / 508, 1e-4);
}

TEST(ShadowViews, APointBeforeTheSceneNeedsOneViewAndOneAmidItSix) {
    const ShadowViews before = shadowViews({.place = {5, 5, 5, 1}}, kBox, kBox, 512);
    ASSERT_EQ(before.faces.size(), 1u);
    EXPECT_LT(reachOf(before.faces[0], kBox), 1);
    const ShadowViews amid = shadowViews({.place = {0.5f, 1, 0, 1}}, kBox, kBox, 512);
    ASSERT_EQ(amid.faces.size(), 6u);
    EXPECT_EQ(amid.imageSize(), ivec2(3 * 512, 2 * 512));
    for (const Eye& eye : amid.faces) // 45 degrees and two texels beyond
        EXPECT_NEAR(eye.halfExtent.x, 512.0 / 508, 1e-6);
    // Six ways, each once.
    vec3 sum(0), squares(0);
    for (const Eye& eye : amid.faces) {
        sum += eye.forward;
        squares += eye.forward * eye.forward;
    }
    EXPECT_EQ(sum, vec3(0));
    EXPECT_EQ(squares, vec3(2));
}

TEST(ShadowViews, APointNearAFloorDoesNotLookAwayFromIt) {
    const ShadowViews views = shadowViews({.place = {0, 1, 0, 1}}, kBox, kFloor, 512);
    ASSERT_EQ(views.faces.size(), 5u);
    for (const Eye& eye : views.faces)
        EXPECT_LE(eye.forward.y, 0);
}

TEST(ShadowViews, ASpotLooksNoFartherAroundThanItShines) {
    const ShadowSource narrow{{0, 1.5f, 0, 1}, {0, -1, 0}, 0.25f};
    const ShadowViews views = shadowViews(narrow, kBox, kBox, 512);
    ASSERT_EQ(views.faces.size(), 1u);
    EXPECT_EQ(views.faces[0].forward, vec3(0, -1, 0));
    EXPECT_NEAR(views.faces[0].halfExtent.x, 0.25 * 512 / 508, 2e-4);
}

TEST(ShadowViews, WithoutCastersOrReceiversThereAreNone) {
    EXPECT_TRUE(shadowViews({.place = {5, 5, 5, 1}}, Bounds{}, kBox, 512).faces.empty());
    EXPECT_TRUE(shadowViews({.place = {0, 1, 0, 0}}, kBox, Bounds{}, 512).faces.empty());
    // What casts lies behind what receives.
    const Bounds below{vec3(-1, -3, -1), vec3(1, -2, 1)};
    EXPECT_TRUE(shadowViews({.place = {0, 1, 0, 0}}, below, kBox, 512).faces.empty());
}

} // namespace
} // namespace lucent::views
