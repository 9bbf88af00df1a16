#pragma once
/// What the tests of subsurface scattering share: bodies of marble, and the technique with all that it asks
/// for.

#include "techniques/subsurface/Subsurface.h"
#include "tests/support/Seen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lucent::subsurface::stage {

inline constexpr double kPi64 = std::numbers::pi;

/// Coefficients of Jensen et al. 2001, 1/m.
inline scene::Material marble() {
    scene::Material material;
    material.kind = scene::Translucent{.scattering = {2190, 2620, 3000}, .absorption = {2.1f, 4.1f, 7.1f}};
    return material;
}

inline scene::Object bodyOf(scene::Shape shape, const scene::Material& material, vec3 centre = vec3(0)) {
    scene::Object object;
    object.name = "body";
    object.shape = std::move(shape);
    object.material = material;
    object.transform.translate = centre;
    return object;
}

/// An orthographic eye at +z that looks at the origin: column grows with x, row with -y.
inline scene::Scene seen(std::vector<scene::Object> objects, float height) {
    scene::Scene scene;
    scene.objects = std::move(objects);
    scene.camera.eye = {0, 0, 1};
    scene.camera.height = height;
    return scene;
}

/// Share of light that enters a surface of index 1.5.
inline double entering(double cosine, double ior = 1.5) {
    if (cosine <= 0) return 0;
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / ior / ior);
    const double across = (cosine - ior * inside) / (cosine + ior * inside);
    const double along = (ior * cosine - inside) / (ior * cosine + inside);
    return 1 - 0.5 * (across * across + along * along);
}

struct SubsurfaceTest : support::GlTest {
    Image draw(const scene::Scene& scene, ivec2 size, const Settings& settings = {}, bool radiosity = true) {
        graph::TexturePool pool(context->device());
        views::ImageCache images(*context);
        const graph::TextureDesc desc{.size = size, .format = graph::Format::RGBA32F};
        const graph::Texture surface(context->device(), desc, "surface"),
            target(context->device(), desc, "target");
        context->device().upload(target.handle(), 0,
                                 std::vector<vec4>(std::size_t(size.x * size.y), vec4(-1)));
        graph::FrameGraph graph;
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), desc, texture.label());
        };
        const graph::TextureId surfaceId = import(surface), targetId = import(target);
        graph.keep(targetId);
        const support::Seen posed(graph, *context, images, scene, surfaceId, size);
        context->device().checkTargets(true);
        Subsurface subsurface(*context);
        const auto bodies = [](const views::Drawables& list) {
            return meshesOf(filtered(list, [](const views::Drawable& one) { return scatters(*one.object); }));
        };
        views::Readings readings;
        const auto plan = subsurface.plan(readings, pool, scene, bodies(posed.drawn), settings);
        EXPECT_TRUE(plan.ok()) << plan.error().message;
        const std::vector<views::LampPoint> samples = views::lightSamples(scene, views::samplingOf(scene));
        const Image table = views::sampleTable(samples);
        const graph::TextureDesc tableDesc{.size = table.size(), .format = graph::Format::RGBA32F};
        const graph::Texture tableTexture(context->device(), tableDesc, "samples");
        context->device().upload(tableTexture.handle(), 0, table.pixels);
        const graph::TextureId tableId = graph.import(tableTexture.handle(), tableDesc, "samples");
        const int count = int(samples.size()), most = views::mostSamplesAtOnce(*context, size);
        for (int first = 0; first == 0 || first < count; first += most) {
            const int end = std::min(count, first + most);
            const auto occlusion = views::recordOcclusion(
                graph, *context,
                {.eye = posed.eye,
                 .size = size,
                 .surface = surfaceId,
                 .drawables = posed.all,
                 .shadowSize = views::samplingOf(scene).shadowSize,
                 .beside = boundsOfAll(posed.solids)},
                std::span(samples).subspan(std::size_t(first), std::size_t(end - first)));
            EXPECT_TRUE(occlusion.ok()) << occlusion.error().message;
            const Status lit = subsurface.light(
                graph,
                {.scene = scene,
                 .eye = posed.eye,
                 .size = size,
                 .solids = bodies(posed.all),
                 .casters = posed.all,
                 .surface = surfaceId,
                 .samples = samples,
                 .table = tableId,
                 .first = first,
                 .end = end,
                 .placed = int(std::count_if(samples.begin(), samples.end(),
                                             [](const auto& sample) { return !sample.isEnvironment; })),
                 .occlusion = *occlusion,
                 .radiosity = radiosity},
                *plan, settings);
            EXPECT_TRUE(lit.ok()) << lit.error().message;
        }
        const Inputs in{
            .scene = scene,
            .eye = posed.eye,
            .solids = bodies(posed.all),
            .casters = posed.all,
            .surface = surfaceId,
            .environment = posed.environment,
            .target = targetId,
            .radiosity = radiosity,
            .size = size,
            .pictureOf = [&](const views::LampPoint& lamp) { return images.image(lamp.picture); }};
        const Status recorded = subsurface.record(graph, in, *plan, settings);
        EXPECT_TRUE(recorded.ok()) << recorded.error().message;
        return support::finish(graph, pool, *context, target);
    }
};

inline Settings with(Method method, DipoleGeometry geometry = DipoleGeometry::Planar, float epsilon = 0.01f) {
    Settings settings;
    settings.method = method;
    settings.dipoleGeometry = geometry;
    settings.epsilon = epsilon;
    return settings;
}

inline scene::Scene sphereFromTheSide(double radius, const scene::Material& material) {
    scene::Scene scene = seen({bodyOf(scene::Sphere{float(radius)}, material)}, float(2.2 * radius));
    scene.lights = {scene::DistantLight{.direction = {-1, 0, 0}}};
    return scene;
}

/// Green light over that of a reference, in the picture's middle.
inline float atMiddle(const Image& image) { return image.at(image.width / 2, image.height / 2)[1]; }

/// A plane in the picture's plane, lit head-on.
inline scene::Scene sheet(const scene::Material& material, float width, float height) {
    scene::Object plane = bodyOf(scene::Plane{{width, width}}, material);
    plane.transform.rotate = {90, 0, 0};
    scene::Scene scene = seen({plane}, height);
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    return scene;
}

/// Absorbs so much that light reaches a few millimetres only: a small plane is a half space.
inline scene::Material dense() {
    scene::Material material = marble();
    material.translucent().absorption = {200, 200, 200};
    return material;
}
} // namespace lucent::subsurface::stage
