#pragma once
/// Pictures through glass with nothing around the technique: what is opaque shows its place in the world.

#include "techniques/refract/Refract.h"
#include "tests/support/Gl.h"
#include "tests/truth/scenes.h"
#include "truth/Glass.h"
#include "views/FieldTextures.h"
#include "views/Surface.h"

#include <algorithm>
#include <cstdio>

namespace lucent::refract {

inline constexpr scene::Aov kDirection = scene::Aov::Direction;

/// A perspective camera on the z axis that looks at the origin.
inline scene::Scene seenFrom(float z, std::vector<scene::Object> objects, float fov = 45) {
    scene::Scene scene = test::sceneOf(std::move(objects));
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0, z};
    scene.camera.fov = fov;
    return scene;
}

/// An orthographic camera at z = 5 that looks at the origin.
inline scene::Scene seenStraight(float height, std::vector<scene::Object> objects) {
    scene::Scene scene = test::sceneOf(std::move(objects));
    scene.camera.type = scene::Camera::Type::Orthographic;
    scene.camera.eye = {0, 0, 5};
    scene.camera.height = height;
    return scene;
}

inline vec3 rgb(const Image& image, ivec2 pixel) {
    const float* p = image.at(pixel.x, pixel.y);
    return {p[0], p[1], p[2]};
}

/// How far directions lie apart, in degrees.
struct Errors {
    int compared = 0; ///< pixels
    int lost = 0;     ///< given up by the layers only
    double median = 0, p95 = 0, most = 0;
    double wrong = 0; ///< share of the pixels that are more than two degrees off, or lost
};

struct Refraction : support::GlTest {
    float nearest = 1e-3f; ///< of views::makeEye()

    void SetUp() override {
        GlTest::SetUp();
        if (context) context->device().checkTargets(true); // NaN and infinity are errors
    }

    /// @param layers  how many are drawn; 0: as many as there are
    Image trace(const scene::Scene& scene, ivec2 size, scene::Aov show = kDirection, int layers = 0,
                const Settings& settings = {}) {
        const graph::TextureDesc desc{.size = size, .format = graph::Format::RGBA32F};
        const graph::Texture surface(context->device(), desc, "surface"),
            places(context->device(), desc, "places"), target(context->device(), desc, "target");
        context->device().upload(places.handle(), 0,
                                 std::vector<vec4>(std::size_t(size.x * size.y), vec4(0)));
        const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y), nearest);
        graph::TexturePool pool(context->device());
        views::ImageCache images(*context);
        const auto drawn = views::drawablesOf(scene, images);
        EXPECT_TRUE(drawn.ok());
        views::Readings readings;
        if (layers == 0)
            layers = *views::countLayers(readings, "", pool, *context, eye, refractive(visible(*drawn)),
                                         scene.view.time, size);

        graph::FrameGraph graph;
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), desc, texture.label());
        };
        const graph::TextureId surfaceId = import(surface), targetId = import(target);
        graph.keep(targetId);
        const auto posed = views::recordPose(graph, *context, visible(*drawn), scene.view.time);
        const views::Drawables glass = refractive(*posed), solids = opaque(*posed);
        graph::TextureId shown, solid;
        if (!solids.empty()) {
            EXPECT_TRUE(views::recordSurface(graph, *context, eye, solids, surfaceId, size).ok());
            shown = import(places);
            solid = graph.create("solid", desc);
            EXPECT_TRUE(views::recordGeometry(graph, *context, eye, solids, surfaceId, shown,
                                              scene::Aov::Position, size)
                            .ok());
            EXPECT_TRUE(views::recordSolid(graph, *context, eye, solids, surfaceId, solid, size).ok());
        }
        const int peeled = settings.layers == LayerMethod::Peel ? layers : 1;
        const auto recorded = views::recordLayers(graph, *context, eye, glass, size, peeled, solid);
        EXPECT_TRUE(recorded.ok());
        auto environment = graph::TextureHandle::None;
        if (scene.environment) environment = *images.image(scene.environment->map);
        const Inputs in{.eye = eye,
                        .glass = glass,
                        .layers = *recorded,
                        .opaque = shown,
                        .solid = solid,
                        .environment = environment,
                        .light = scene.environment ? &*scene.environment : nullptr,
                        .target = targetId,
                        .show = show,
                        .count = layers};
        const Status done = Refract(*context).record(graph, in, size, settings);
        EXPECT_TRUE(done.ok()) << (done ? "" : done.error().message);
        const Status compiled = graph.compile();
        EXPECT_TRUE(compiled.ok());
        graph.execute(pool);
        return context->device().read(target.handle());
    }
};

/// The same picture ray-traced.
inline Image truthOf(const scene::Scene& scene, ivec2 size, scene::Aov show = kDirection) {
    const auto estimator = truth::GlassEstimator::create(scene, size, show, {.samples = 1});
    EXPECT_TRUE(estimator.ok());
    const auto picture = truth::render(*estimator, size, {}, {}, false);
    EXPECT_TRUE(picture.ok());
    return picture->values;
}

/// Pixels that see glass, at least `border` pixels from where the number of surfaces behind each other
/// changes.
inline std::vector<ivec2> withinOutlines(const scene::Scene& scene, ivec2 size, int border) {
    const Image layers = truthOf(scene, size, scene::Aov::Layers);
    std::vector<ivec2> pixels;
    for (int y = border; y < size.y - border; ++y)
        for (int x = border; x < size.x - border; ++x) {
            const float count = layers.at(x, y)[0];
            bool even = count > 0;
            for (int dy = -border; dy <= border; ++dy)
                for (int dx = -border; dx <= border; ++dx)
                    even = even && layers.at(x + dx, y + dy)[0] == count;
            if (even) pixels.emplace_back(x, y);
        }
    return pixels;
}

inline Errors compare(const Image& found, const Image& expected, const std::vector<ivec2>& pixels) {
    Errors errors;
    std::vector<double> angles;
    for (const ivec2 pixel : pixels) {
        if (expected.at(pixel.x, pixel.y)[3] == 0) continue;
        ++errors.compared;
        if (found.at(pixel.x, pixel.y)[3] == 0) {
            ++errors.lost;
            continue;
        }
        angles.push_back(test::degrees(test::angleBetween(rgb(found, pixel), rgb(expected, pixel))));
    }
    if (angles.empty()) return errors;
    std::sort(angles.begin(), angles.end());
    errors.median = angles[angles.size() / 2];
    errors.p95 = angles[angles.size() * 95 / 100];
    errors.most = angles.back();
    const auto right = std::upper_bound(angles.begin(), angles.end(), 2.0) - angles.begin();
    errors.wrong = 1 - double(right) / errors.compared;
    return errors;
}

/// Prints the figures, so that a failure shows by how much.
inline std::ostream& operator<<(std::ostream& out, const Errors& e) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d pixels, %d lost, median %.4f, 95%% %.3f, most %.2f degrees, %.4f wrong", e.compared,
                  e.lost, e.median, e.p95, e.most, e.wrong);
    return out << text;
}

} // namespace lucent::refract
