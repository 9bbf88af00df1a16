#pragma once
/// What the tests of caustics share: floors, the technique with all that it asks for, and sums over pictures.

#include "techniques/caustics/Caustics.h"
#include "tests/support/Gl.h"
#include "tests/support/Matt.h"
#include "tests/truth/scenes.h"
#include "truth/Glass.h"
#include "truth/LightTracer.h"
#include "views/FieldTextures.h"
#include "views/Surface.h"
#include "views/Water.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace lucent::caustics::stage {

using test::glass;
using test::matt;
using test::mirror;
using test::sceneOf;

inline constexpr double kTau = 2 * std::numbers::pi;

/// A floor through the origin, seen straight down, `height` metres from top to bottom: column grows with x,
/// row with z.
inline scene::Scene floorUnder(scene::Object object, float height) {
    object.visible = false;
    scene::Scene scene = sceneOf({matt(scene::Plane{{40, 40}}), std::move(object)});
    scene.camera.eye = {0, 20, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    return scene;
}

/// Puts an environment in the place of its lamps.
inline void shineFrom(scene::Scene& scene, ivec2 size, const std::function<float(ivec2)>& radiance) {
    auto map = std::make_shared<Image>(size.x, size.y, 3);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            std::fill_n(map->at(x, y), 3, radiance({x, y}));
    scene.lights.clear();
    scene.environment.emplace();
    scene.environment->map = std::move(map);
}

struct Caustics : support::GlTest {
    // A scene with all that the technique asks for.
    struct Stage {
        graph::TexturePool pool;
        views::ImageCache images;
        views::Waters waters;
        views::Eye eye;
        views::Drawables drawn{};
        Plan plan{};

        Stage(gl::Context& context, const scene::Scene& scene, ivec2 size, const Settings& settings)
            : pool(context.device()), images(context), waters(context),
              eye(views::makeEye(scene, float(size.x) / float(size.y))) {
            Result<bool> there = false;
            while (there && !*there)
                there = waters.advance(scene);
            EXPECT_TRUE(there.ok());
            drawn = *views::drawablesOf(scene, images, &waters);
            const caustics::Caustics technique(context);
            views::Readings readings;
            const Status planned =
                technique.plan(plan, readings, pool, scene,
                               caustics::Caustics::receiving(&eye, drawn, settings), drawn, settings);
            EXPECT_TRUE(planned.ok()) << planned.error().message;
        }
    };
    // The technique, with the pictures that lamps project.
    caustics::Caustics techniqueOn(Stage& stage) {
        return caustics::Caustics(
            *context, [&stage](const views::LampPoint& lamp) { return stage.images.image(lamp.picture); });
    }
    Plan planOf(const scene::Scene& scene) { return Stage(*context, scene, ivec2(1), {}).plan; }
    Energy energyOf(const scene::Scene& scene, ivec2 size, const Settings& settings = {}) {
        Stage stage(*context, scene, size, settings);
        context->device().checkTargets(false); // they have passed in lightOf()
        const auto energy = techniqueOn(stage).measure(stage.pool, scene, stage.eye, stage.drawn, stage.plan);
        EXPECT_TRUE(energy.ok()) << energy.error().message;
        return *energy;
    }
    Image lightOf(const scene::Scene& scene, ivec2 size, const Settings& settings = {},
                  bool alsoDirect = false) {
        Stage stage(*context, scene, size, settings);
        context->device().checkTargets(true);
        const views::Eye& eye = stage.eye;
        const graph::TextureDesc desc{.size = size, .format = graph::Format::RGBA32F};
        const graph::Texture target(context->device(), desc, "target");
        graph::FrameGraph graph;
        const auto posed = views::recordPose(graph, *context, stage.drawn, scene.view.time);
        const graph::TextureId surface = graph.create("surface", desc);
        const views::Drawables solids = opaque(*posed), seen = visible(solids);
        EXPECT_TRUE(views::recordSurface(graph, *context, eye, seen, surface, size).ok());
        const auto light = techniqueOn(stage).record(
            graph, {scene, eye, refractive(*posed), solids, surface, size}, stage.plan.lights);
        EXPECT_TRUE(light.ok()) << light.error().message;
        const graph::TextureId targetId = graph.import(target.handle(), desc, target.label());
        graph.keep(targetId);
        scene::Scene lit = scene;
        if (!alsoDirect) lit.lights.clear();
        graph::Texture table;
        support::recordMatt(graph, *context,
                            {.scene = lit,
                             .eye = eye,
                             .size = size,
                             .surface = surface,
                             .matt = seen,
                             .all = *posed,
                             .show = scene::Aov::Irradiance,
                             .flux = light->irradiance},
                            table, targetId, {.lamp = 16, .directions = 0});
        const Status compiled = graph.compile();
        EXPECT_TRUE(compiled.ok()) << compiled.error().message;
        graph.execute(stage.pool);
        return context->device().read(target.handle());
    }
    struct Shown {
        Image light;
        Energy energy;
    };
    Shown show(const scene::Scene& scene, ivec2 size, const Settings& settings = {},
               bool alsoDirect = false) {
        return {lightOf(scene, size, settings, alsoDirect), energyOf(scene, size, settings)};
    }
};

/// Half the summed absolute difference of means over 5 x 5 pixels, over the true sum.
inline double misplaced(const Image& found, const Image& wanted, int cell = 5) {
    double apart = 0, all = 0;
    for (int y = 0; y + cell <= wanted.height; y += cell)
        for (int x = 0; x + cell <= wanted.width; x += cell) {
            double a = 0, b = 0;
            for (int i = 0; i < cell * cell; ++i) {
                a += double(found.at(x + i % cell, y + i / cell)[1]);
                b += double(wanted.at(x + i % cell, y + i / cell)[1]);
            }
            apart += std::abs(a - b);
            all += b;
        }
    return 0.5 * apart / all;
}

inline double sumOf(const Image& image) {
    double sum = 0;
    for (std::size_t i = 1; i < image.pixels.size(); i += 4)
        sum += double(image.pixels[i]);
    return sum;
}

inline double total(const dvec3& flux) { return flux.r + flux.g + flux.b; }

inline void expectClosed(const Energy& energy) {
    const double others = total(energy.received) + total(energy.absorbed) + total(energy.reflected) +
                          total(energy.missed) + total(energy.lost);
    EXPECT_NEAR(others / total(energy.incident), 1, 0.005);
    EXPECT_LE(total(energy.received), 1.001 * total(energy.incident)); // triangles cover whole texels
}

/// Light on a floor by way of glass and mirrors, from truth: all that arrives less what comes straight.
inline Image truthOf(const scene::Scene& scene, ivec2 size, std::int64_t photons) {
    const std::atomic<bool> goOn = false;
    Image light = truth::traceLight(scene, size, {.photons = photons, .samples = 16}, {}, {}, goOn)->values;
    const auto direct = truth::GlassEstimator::create(scene, size, scene::Aov::Color, {.samples = 16});
    const double scale = std::numbers::pi / double(scene.objects[0].material.diffuse.g);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            light.at(x, y)[1] -= float(scale * direct->solve({x, y}).value.g);
    return light;
}
} // namespace lucent::caustics::stage
