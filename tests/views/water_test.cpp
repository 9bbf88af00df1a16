// Water against the wave equation's closed forms and invariants.
#include "tests/support/Gl.h"
#include "tests/support/Vertices.h"
#include "truth/Basin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucent::views {
namespace {

scene::Scene sceneOf(const scene::Water& water) {
    scene::Scene scene;
    scene.objects.resize(1);
    scene.objects[0].name = "pool";
    scene.objects[0].shape = water;
    return scene;
}

// The travelling sine of truth/Optics.h.
struct Sine {
    dvec2 wave;
    double amplitude, damping, frequency;

    explicit Sine(const scene::Water& water) {
        const double k = 2 * std::numbers::pi / double(water.wavelength), fastest = double(water.speed) * k;
        wave = k * glm::normalize(dvec2(water.direction));
        amplitude = double(water.amplitude);
        damping = double(water.damping);
        frequency = std::sqrt(fastest * fastest - damping * damping / 4);
    }
    double operator()(dvec2 place, double time) const {
        return amplitude * std::exp(-damping * time / 2) * std::sin(glm::dot(wave, place) - frequency * time);
    }
};

struct WaterTest : support::GlTest {
    // State of the first object: x height, y rise; row 0 of the grid first.
    struct State {
        ivec2 size;
        std::vector<vec2> texels;
        vec2 at(int x, int z) const { return texels[std::size_t(z * size.x + x)]; }
        // Walls cut the cells of the outer texels in half.
        double weight(int x, int z) const {
            return (x == 0 || x == size.x - 1 ? 0.5 : 1) * (z == 0 || z == size.y - 1 ? 0.5 : 1);
        }
        double mean() const {
            double sum = 0, weights = 0;
            for (int z = 0; z < size.y; ++z)
                for (int x = 0; x < size.x; ++x) {
                    sum += weight(x, z) * double(at(x, z).x);
                    weights += weight(x, z);
                }
            return sum / weights;
        }
        // Kinetic and potential energy up to a factor: a sum over cells of h_t^2 + speed^2 |grad h|^2.
        double energy(const scene::Water& water) const {
            const vec2 cell = water.size / vec2(size - 1);
            double sum = 0;
            for (int z = 0; z + 1 < size.y; ++z)
                for (int x = 0; x + 1 < size.x; ++x) {
                    const vec2 slope = (vec2(at(x + 1, z).x, at(x, z + 1).x) - at(x, z).x) / cell;
                    sum +=
                        double(at(x, z).y * at(x, z).y + water.speed * water.speed * glm::dot(slope, slope));
                }
            return sum;
        }
    };

    State stateOf(const Waters& waters) {
        const Image image = context->device().read(waters.of(0)->state().handle());
        State state{image.size(), {}};
        for (int z = 0; z < image.height; ++z)
            for (int x = 0; x < image.width; ++x) {
                const float* texel = image.at(x, image.height - 1 - z);
                state.texels.push_back({texel[0], texel[1]});
            }
        return state;
    }
    static void goTo(Waters& waters, scene::Scene& scene, float time) {
        scene.view.time = time;
        for (;;) {
            const Result<bool> there = waters.advance(scene);
            ASSERT_TRUE(there.ok()) << there.error().message;
            if (*there) return;
        }
    }
};

TEST_F(WaterTest, VerticesAreATravellingSineFarFromTheWalls) {
    // What the walls mirror travels at 0.5 m/s: after 0.4 s the middle 0.5 m of 1 m x 1 m know nothing of
    // them. The scheme's waves are slower by (k cell)^2 (1 - r^2) / 24 with r = 0.53: over the 0.4 s 5
    // radians times 1.2e-3, 6e-3 of the amplitude; between steps heights go on straight, 5e-3 more.
    const scene::Water water{.amplitude = 0.01f, .direction = {3, 4}};
    scene::Scene scene = sceneOf(water);
    const Sine sine(water);
    Waters waters(*context);
    for (const float time : {0.0f, 0.1f, 0.4f, 0.404f}) {
        goTo(waters, scene, time);
        const support::Vertices found = support::verticesAt(*context, scene, time, &waters);
        EXPECT_EQ(found.passes, 1);
        double worst = 0, worstNormal = 0;
        int middle = 0;
        for (std::size_t i = 0; i < found.positions.size(); ++i) {
            const vec3 p = found.positions[i];
            if (std::abs(p.x) > 0.25f || std::abs(p.z) > 0.25f) continue;
            ++middle;
            const double height = sine({p.x, p.z}, time);
            worst = std::max(worst, std::abs(double(p.y) - height));
            const double d = 1e-5;
            const dvec3 normal =
                glm::normalize(dvec3(sine({p.x - d, p.z}, time) - sine({p.x + d, p.z}, time), 2 * d,
                                     sine({p.x, p.z - d}, time) - sine({p.x, p.z + d}, time)));
            worstNormal = std::max(worstNormal, glm::distance(normal, dvec3(found.normals[i])));
        }
        EXPECT_EQ(middle, 65 * 65);
        EXPECT_LE(worst, (time == 0 ? 1e-6 : 0.011) * double(water.amplitude)) << time;
        // Slopes are up to k a = 0.25; central differences lose (k cell)^2 / 6 = 6e-3 of them.
        EXPECT_LE(worstNormal, 0.25 * (6.5e-3 + (time == 0 ? 0 : 0.011))) << time;
    }
}

// The mesh of a preview has fewer squares than the water has heights.
TEST_F(WaterTest, FewerSquaresStandAtTheSameHeights) {
    scene::Scene scene = sceneOf({.size = {1, 0.5f}, .cells = 128, .amplitude = 0.01f, .direction = {3, 4}});
    Waters waters(*context);
    goTo(waters, scene, 0.4f);
    const support::Vertices all = support::verticesAt(*context, scene, 0.4f, &waters);
    scene.objects[0].mostCells = 32;
    const support::Vertices some = support::verticesAt(*context, scene, 0.4f, &waters);
    ASSERT_EQ(some.positions.size(), 33u * 17);
    for (int z = 0; z < 17; ++z)
        for (int x = 0; x < 33; ++x) {
            const auto few = std::size_t(z * 33 + x), many = std::size_t(4 * (z * 129 + x));
            EXPECT_EQ(some.positions[few], all.positions[many]);
            EXPECT_NEAR(glm::length(some.normals[few]), 1, 1e-5);
            EXPECT_GT(glm::dot(some.normals[few], all.normals[many]), 0.99f);
        }
    scene.objects[0].mostCells = 50; // no part of 128
    const support::Vertices others = support::verticesAt(*context, scene, 0.4f, &waters);
    ASSERT_EQ(others.positions.size(), 51u * 26);
    EXPECT_EQ(others.positions.front(), all.positions.front());
    EXPECT_EQ(others.positions.back(), all.positions.back());
}

TEST_F(WaterTest, HalfTheCellHalvesTheErrorTwice) {
    const auto worstWith = [&](int cells) {
        // Steps: 120 a second for both, far below what is stable, so that cells alone decide.
        const scene::Water water{
            .cells = cells, .speed = 0.05f, .damping = 0, .amplitude = 0.01f, .wavelength = 0.25f};
        scene::Scene scene = sceneOf(water);
        Waters waters(*context);
        goTo(waters, scene, 1);
        const Sine sine(water);
        const State state = stateOf(waters);
        double worst = 0;
        for (int x = cells / 4; x <= 3 * cells / 4; ++x)
            worst = std::max(
                worst, std::abs(double(state.at(x, cells / 2).x) - sine({double(x) / cells - 0.5, 0}, 1)));
        return worst;
    };
    EXPECT_NEAR(worstWith(32) / worstWith(64), 4, 0.4);
}

TEST_F(WaterTest, EnergyStaysWithoutDampingAndFallsAsItSaysWithIt) {
    // Waves lose e^(-damping t) of their energy. Heights and rises are half a step apart: their sum wavers by
    // a few percent.
    for (const float damping : {0.0f, 0.8f}) {
        scene::Water water{.cells = 64, .damping = damping};
        scene::Scene scene = sceneOf(water);
        Waters waters(*context);
        goTo(waters, scene, 0);
        waters.fall(0, {.place = {0.1f, -0.2f}, .radius = 0.1f, .depth = 0.02f});
        goTo(waters, scene, 0.5f);
        const double before = stateOf(waters).energy(water);
        goTo(waters, scene, 2.5f);
        const double after = stateOf(waters).energy(water);
        EXPECT_NEAR(after / before, std::exp(-2 * double(damping)), 0.03) << damping;
    }
}

TEST_F(WaterTest, TheMeanStaysWhereverDropsFall) {
    // In the middle, at a wall and in a corner; 30 s are 3600 steps.
    // Each step rounds a height of about 1e-3 m by 1e-10: if all of that went one way it were 4e-7.
    scene::Scene scene = sceneOf({.size = {1, 0.6f}, .cells = 32, .damping = 0});
    Waters waters(*context);
    goTo(waters, scene, 0);
    for (const vec2 place : {vec2(0, 0), vec2(0.5f, 0.1f), vec2(-0.48f, -0.3f)})
        waters.fall(0, {.place = place, .radius = 0.08f, .depth = 0.02f});
    EXPECT_NEAR(stateOf(waters).mean(), 0, 1e-8);
    goTo(waters, scene, 30);
    EXPECT_NEAR(stateOf(waters).mean(), 0, 4e-7);
}

TEST_F(WaterTest, ARingGrowsAtTheSpeedOfWavesInAllDirections) {
    // Fallen at the middle; the crest that leads passes 0.2 m and, dt later, 0.4 m: by then it has gone
    // 0.2 m. Its place along an axis and along the diagonal, from the largest height between cells.
    const scene::Water water{.size = {2, 2}, .cells = 256, .speed = 0.5f, .damping = 0};
    scene::Scene scene = sceneOf(water);
    Waters waters(*context);
    goTo(waters, scene, 0);
    waters.fall(0, {.radius = 0.06f, .depth = 0.02f});
    const auto crest = [&](ivec2 along) {
        const State state = stateOf(waters);
        int best = 1;
        const auto height = [&](int i) { return double(state.at(128 + i * along.x, 128 + i * along.y).x); };
        for (int i = 8; i < 120; ++i)
            if (height(i) > height(best)) best = i;
        const double bend = height(best - 1) - 2 * height(best) + height(best + 1);
        const double between = 0.5 * (height(best - 1) - height(best + 1)) / bend;
        return (best + between) * glm::length(dvec2(along)) * 2 / 256;
    };
    goTo(waters, scene, 0.6f);
    const double axis = crest({1, 0}), diagonal = crest({1, 1});
    goTo(waters, scene, 1.1f);
    // 0.5 s at 0.5 m/s: 0.25 m, half a cell of 4 mm allowed.
    EXPECT_NEAR(crest({1, 0}) - axis, 0.25, 0.004);
    EXPECT_NEAR(crest({1, 1}) - diagonal, 0.25, 0.004);
    EXPECT_NEAR(axis, diagonal, 0.002); // the ring is round
}

TEST_F(WaterTest, WhatIsSymmetricStaysSymmetric) {
    scene::Scene scene = sceneOf({.cells = 33});
    Waters waters(*context);
    goTo(waters, scene, 0);
    waters.fall(0, {.place = {0.2f, 0}});
    waters.fall(0, {.place = {-0.2f, 0}});
    goTo(waters, scene, 3);
    const State state = stateOf(waters);
    for (int z = 0; z < 34; ++z)
        for (int x = 0; x < 34; ++x) {
            EXPECT_NEAR(state.at(x, z).x, state.at(33 - x, z).x, 1e-6);
            EXPECT_NEAR(state.at(x, z).x, state.at(x, 33 - z).x, 1e-6);
        }
}

TEST_F(WaterTest, WallsMirrorWaves) {
    // A drop between two walls 0.4 m apart is an endless row of drops and mirrored drops without the walls.
    // So it is in a basin thrice as wide into which its two nearest images fall as well.
    scene::Scene narrow = sceneOf({.size = {0.4f, 1}, .cells = 80}),
                 wide = sceneOf({.size = {1.2f, 1}, .cells = 96});
    Waters inNarrow(*context), inWide(*context);
    goTo(inNarrow, narrow, 0);
    goTo(inWide, wide, 0);
    inNarrow.fall(0, {.place = {0.05f, 0}});
    for (const float x : {0.05f, 0.4f - 0.05f, -0.4f - 0.05f})
        inWide.fall(0, {.place = {x, 0}});
    goTo(inNarrow, narrow, 0.9f);
    goTo(inWide, wide, 0.9f);
    const State found = stateOf(inNarrow), expected = stateOf(inWide);
    ASSERT_EQ(found.size, ivec2(33, 81));
    ASSERT_EQ(expected.size, ivec2(97, 81));
    for (int z = 0; z < 81; ++z)
        for (int x = 0; x < 33; ++x)
            EXPECT_NEAR(found.at(x, z).x, expected.at(x + 32, z).x, 1e-6) << x << ", " << z;
}

TEST_F(WaterTest, TruthComputesTheSameHeights) {
    // Drops, walls and a time between steps. Floats round a height of up to 0.02 m by 1e-9 in each of 241
    // steps.
    const scene::Water water{
        .size = {0.8f, 0.5f}, .cells = 64, .amplitude = 0.005f, .direction = {1, 2}, .dropInterval = 0.3f};
    scene::Scene scene = sceneOf(water);
    Waters waters(*context);
    goTo(waters, scene, 2.013f);
    const support::Vertices found = support::verticesAt(*context, scene, 2.013f, &waters);
    const truth::Basin basin(water, double(2.013f));
    ASSERT_EQ(found.positions.size(), 65u * 41);
    double highest = 0;
    for (const vec3& p : found.positions) {
        EXPECT_NEAR(double(p.y), basin.at({p.x, p.z}).height, 1e-6);
        highest = std::max(highest, double(p.y));
    }
    EXPECT_GT(highest, 0.002);
}

// --- time

TEST_F(WaterTest, StatesAreTheSameOnEveryWayToATime) {
    const scene::Water water{.cells = 32, .amplitude = 0.01f, .dropInterval = 0.3f};
    scene::Scene scene = sceneOf(water);
    Waters atOnce(*context), inSteps(*context), back(*context);
    goTo(atOnce, scene, 5.05f); // more than one call computes
    for (float time = 0; time < 5; time += 0.21f)
        goTo(inSteps, scene, time);
    goTo(inSteps, scene, 5.05f);
    goTo(back, scene, 6);
    goTo(back, scene, 5.05f);
    const State expected = stateOf(atOnce);
    EXPECT_EQ(stateOf(inSteps).texels, expected.texels);
    EXPECT_EQ(stateOf(back).texels, expected.texels);
    EXPECT_GT(expected.energy(water), 0);
}

TEST_F(WaterTest, DropsOfThePointerFallAgainButNotThoseOfLaterTimes) {
    scene::Scene scene = sceneOf({.cells = 32});
    Waters waters(*context);
    goTo(waters, scene, 0.5f);
    waters.fall(0, {.place = {0.2f, 0.1f}});
    goTo(waters, scene, 1);
    const State before = stateOf(waters);
    waters.fall(0, {.place = {-0.3f, 0}});
    goTo(waters, scene, 2);
    goTo(waters, scene, 0.9f);
    goTo(waters, scene, 1);
    EXPECT_EQ(stateOf(waters).texels, before.texels);
    goTo(waters, scene, 0);
    goTo(waters, scene, 0.4f);
    EXPECT_EQ(stateOf(waters).mean(), 0); // still calm
}

TEST_F(WaterTest, ACallComputesAtMostSoManySteps) {
    scene::Scene scene = sceneOf({.cells = 16, .amplitude = 0.01f});
    scene.view.time = 5; // 600 steps
    Waters waters(*context);
    EXPECT_FALSE(*waters.advance(scene));
    EXPECT_FALSE(*waters.advance(scene));
    EXPECT_TRUE(*waters.advance(scene));
    const std::uint64_t changes = waters.changes();
    EXPECT_TRUE(*waters.advance(scene)); // time stands
    EXPECT_EQ(waters.changes(), changes);
}

TEST_F(WaterTest, ATimeFarAheadIsRefusedAndTimeThatRunsIsNot) {
    scene::Water water;
    water.cells = 4;
    scene::Scene scene = sceneOf(water);
    Waters waters(*context);
    scene.view.time = 1e6f; // 120 million steps of 16 cells
    ASSERT_TRUE(waters.advance(scene));
    std::get<scene::Water>(scene.objects[0].shape).cells = 128;
    const Result<bool> far = waters.advance(scene);
    ASSERT_FALSE(far);
    EXPECT_EQ(far.error().message,
              "view.time: is 1000000, to which the waves of objects.pool take 1.96608e+12 steps of "
              "cells; must take at most 1e+10");
    scene.view.time = 1;
    EXPECT_TRUE(waters.advance(scene));
}

TEST_F(WaterTest, FastWavesOnFineGridsStayFinite) {
    // 3 m/s over cells of 1/512 m: 1536 cells a second, which steps of 1/120 s cannot hold.
    scene::Scene scene = sceneOf({.size = {0.25f, 0.01f}, .cells = 128, .speed = 3, .amplitude = 0.01f});
    Waters waters(*context);
    goTo(waters, scene, 1);
    for (const vec2& texel : stateOf(waters).texels)
        EXPECT_LE(std::abs(texel.x), waterReach(std::get<scene::Water>(scene.objects[0].shape)));
}

TEST_F(WaterTest, AnotherShapeBeginsAnewAndWhatIsGoneGivesItsMemoryBack) {
    scene::Scene scene = sceneOf({.cells = 16, .amplitude = 0.01f});
    Waters waters(*context);
    goTo(waters, scene, 1);
    std::get<scene::Water>(scene.objects[0].shape).cells = 32;
    goTo(waters, scene, 0);
    EXPECT_EQ(waters.bytes(), 2u * 33 * 33 * 8);
    scene.objects[0].shape = scene::Plane{};
    goTo(waters, scene, 0);
    EXPECT_EQ(waters.of(0), nullptr);
    EXPECT_EQ(waters.bytes(), 0u);
}

TEST_F(WaterTest, WithoutSheetsWaterLiesStill) {
    const scene::Scene scene = sceneOf({.size = {2, 1}, .cells = 8, .amplitude = 0.1f});
    const support::Vertices found = support::verticesAt(*context, scene, 1);
    EXPECT_EQ(found.passes, 0);
    ASSERT_EQ(found.positions.size(), 9u * 5);
    EXPECT_EQ(found.positions.front(), vec3(-1, 0, -0.5f));
    EXPECT_EQ(found.positions.back(), vec3(1, 0, 0.5f));
    const auto mesh = meshOf(scene.objects[0]);
    EXPECT_EQ(mesh->indices.size(), 6u * 8 * 4);
    for (const vec3& normal : scene::areaWeightedNormals(mesh->positions, mesh->indices))
        EXPECT_EQ(normal, vec3(0, 1, 0));
}

} // namespace
} // namespace lucent::views
