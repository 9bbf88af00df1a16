// Where shadows are looked for from a light.
#include "light/ShadowMap.h"

#include <gtest/gtest.h>

#include <random>

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

// Whether the way from a place to a light meets a box.
bool meets(const vec3& from, const vec4& light, const Bounds& box) {
    const vec3 way = light.w == 0 ? vec3(light) : vec3(light) - from;
    float near = 0, far = light.w == 0 ? 1e9f : 1;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (box.low[axis] - from[axis]) / way[axis],
                    b = (box.high[axis] - from[axis]) / way[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

TEST(MayShade, WhateverStandsInTheWayMay) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> side(-1, 1), size(0.05f, 0.6f);
    const auto box = [&] {
        const vec3 low(side(random), side(random), side(random));
        return Bounds{low, low + vec3(size(random), size(random), size(random))};
    };
    int without = 0, withoutWay = 0;
    for (int i = 0; i < 2000; ++i) {
        const Bounds caster = box(), receivers = box();
        const vec3 place(side(random), side(random), side(random));
        const vec4 light = i % 2 ? vec4(2.0f * place, 1) : vec4(glm::normalize(place), 0);
        bool found = false;
        for (int j = 0; j < 200 && !found; ++j) {
            const vec3 share = 0.5f + 0.5f * vec3(side(random), side(random), side(random));
            found = meets(glm::mix(receivers.low, receivers.high, share), light, caster);
        }
        const bool may = mayShade(light, caster, receivers);
        EXPECT_TRUE(may || !found);
        without += !may;
        withoutWay += !found;
    }
    EXPECT_GT(without, 0.9 * withoutWay); // the others touch it at a corner
}

TEST(MayShade, NothingBesideOrBehindMay) {
    const vec4 above(0, 4, 0, 1), up(0, 1, 0, 0);
    const Bounds beside{vec3(3, -1, -1), vec3(4, 3, 1)}, below{vec3(-1, -3, -1), vec3(1, -2, 1)},
        higher{vec3(-1, 5, -1), vec3(1, 6, 1)};
    for (const vec4& light : {above, up}) {
        EXPECT_TRUE(mayShade(light, kBox, kFloor));
        EXPECT_FALSE(mayShade(light, beside, kBox));
        EXPECT_FALSE(mayShade(light, below, kBox));
        EXPECT_FALSE(mayShade(light, Bounds{}, kBox));
        EXPECT_FALSE(mayShade(light, kBox, Bounds{}));
    }
    EXPECT_FALSE(mayShade(above, higher, kBox)); // behind the lamp
    EXPECT_TRUE(mayShade(up, higher, kBox));
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
