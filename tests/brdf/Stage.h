#pragma once
/// What the tests of opaque surfaces share: matt things, the technique with all that it asks for, and truth.

#include "techniques/brdf/Brdf.h"
#include "tests/support/Matt.h"
#include "tests/support/Seen.h"
#include "truth/Glass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::brdf::stage {

inline constexpr scene::Aov kIrradiance = scene::Aov::Irradiance;

inline scene::Object matt(scene::Shape shape, vec3 centre = vec3(0)) {
    scene::Object object;
    object.name = "matt";
    object.shape = std::move(shape);
    object.material.diffuse = vec3(0.5f);
    object.transform.translate = centre;
    return object;
}

/// An orthographic eye above the origin: column grows with x, row with z.
inline scene::Scene seenFromAbove(std::vector<scene::Object> objects, float height) {
    scene::Scene scene;
    scene.objects = std::move(objects);
    scene.camera.eye = {0, 5, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    return scene;
}

inline std::shared_ptr<const Image> mapOf(ivec2 size, const std::function<vec3(vec3)>& radiance) {
    auto map = std::make_shared<Image>(size.x, size.y, 3);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float azimuth = kPi * (2 * (float(x) + 0.5f) / float(size.x) - 1);
            const float polar = kPi * (float(y) + 0.5f) / float(size.y);
            const vec3 color = radiance(
                {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)});
            std::copy_n(&color[0], 3, map->at(x, y));
        }
    return map;
}

inline void addSky(scene::Scene& scene, std::shared_ptr<const Image> map) {
    scene.environment.emplace();
    scene.environment->map = std::move(map);
}

/// Middle of a pixel of seenFromAbove(), in metres from the middle.
inline vec2 placeOf(const scene::Scene& scene, ivec2 pixel, ivec2 size) {
    return (vec2(pixel) + 0.5f - 0.5f * vec2(size)) * scene.camera.height / float(size.y);
}

struct Brdf : support::GlTest {
    Image shade(const scene::Scene& scene, ivec2 size, scene::Aov show = kIrradiance,
                const views::Sampling& sampling = {}, const Image* flux = nullptr) {
        graph::TexturePool pool(context->device());
        views::ImageCache images(*context);
        const graph::TextureDesc desc{.size = size, .format = graph::Format::RGBA32F};
        const graph::Texture surface(context->device(), desc, "surface"),
            target(context->device(), desc, "target"), caustics(context->device(), desc, "flux");
        context->device().upload(target.handle(), 0,
                                 std::vector<vec4>(std::size_t(size.x * size.y), vec4(-1)));
        if (flux) context->device().upload(caustics.handle(), 0, flux->pixels);
        graph::FrameGraph graph;
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), desc, texture.label());
        };
        const graph::TextureId surfaceId = import(surface), targetId = import(target);
        const graph::TextureId fluxId = flux ? import(caustics) : graph::TextureId();
        graph.keep(targetId);
        const support::Seen posed(graph, *context, images, scene, surfaceId, size);
        context->device().checkTargets(true);
        const views::Drawables mirrors = filtered(posed.solids, &views::Drawable::isMirror),
                               matt = filtered(posed.solids, std::not_fn(&views::Drawable::isMirror));
        graph::Texture table;
        support::recordMatt(graph, *context,
                            {.scene = scene,
                             .eye = posed.eye,
                             .size = size,
                             .surface = surfaceId,
                             .matt = matt,
                             .all = posed.all,
                             .show = show,
                             .flux = fluxId},
                            table, targetId, sampling);
        if (show == scene::Aov::Color) {
            EXPECT_TRUE(brdf::Brdf(*context)
                            .recordMirrors(graph, {.scene = scene,
                                                   .eye = posed.eye,
                                                   .size = size,
                                                   .mirrors = mirrors,
                                                   .surface = surfaceId,
                                                   .environment = posed.environment,
                                                   .target = targetId})
                            .ok());
        }
        return support::finish(graph, pool, *context, target);
    }
    float atMiddle(const scene::Scene& scene, const views::Sampling& sampling = {}) {
        return shade(scene, {33, 33}, kIrradiance, sampling).at(16, 16)[1];
    }
};

/// Truth at each pixel's middle: of a surface whose diffuse is 1/2 its irradiance, and where it is.
struct Truth {
    Image light, places;
    double noise = 0; // mean squared standard error of the light
    Truth(const scene::Scene& scene, ivec2 size, int samples = 1)
        : light(size.x, size.y, 3), places(size.x, size.y, 3) {
        const auto color =
            truth::GlassEstimator::create(scene, size, scene::Aov::Color, {.samples = samples});
        const auto place = truth::GlassEstimator::create(scene, size, scene::Aov::Position, {});
        const double scale = std::numbers::pi / 0.5;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const truth::Pixel found = color->solve({x, y});
                const dvec3 where = place->solve({x, y}).value;
                for (int channel = 0; channel < 3; ++channel) {
                    light.at(x, y)[channel] = float(scale * found.value[channel]);
                    places.at(x, y)[channel] = float(where[channel]);
                }
                noise += scale * scale * found.variance[1] / (size.x * size.y);
            }
    }
};
} // namespace lucent::brdf::stage
