// Opaque surfaces and mirrors: closed forms first, then ray-traced truth.
#include "brdf/Brdf.h"

#include "brdf/SkyIrradiance.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"
#include "views/Lamps.h"
#include "views/ShadowMap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lucent::brdf {
namespace {

constexpr scene::Aov kIrradiance = scene::Aov::Irradiance;

scene::Object matt(scene::Shape shape, vec3 centre = vec3(0)) {
    scene::Object object;
    object.name = "matt";
    object.shape = std::move(shape);
    object.material.diffuse = vec3(0.5f);
    object.transform.translate = centre;
    return object;
}

// An orthographic eye above the origin: column grows with x, row with z.
scene::Scene seenFromAbove(std::vector<scene::Object> objects, float height) {
    scene::Scene scene;
    scene.objects = std::move(objects);
    scene.camera.eye = {0, 5, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    return scene;
}

std::shared_ptr<const Image> mapOf(ivec2 size, const std::function<vec3(vec3)>& radiance) {
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

void addSky(scene::Scene& scene, std::shared_ptr<const Image> map) {
    scene.environment.emplace();
    scene.environment->map = std::move(map);
}

// Middle of a pixel of seenFromAbove(), in metres from the middle.
vec2 placeOf(const scene::Scene& scene, ivec2 pixel, ivec2 size) {
    return (vec2(pixel) + 0.5f - 0.5f * vec2(size)) * scene.camera.height / float(size.y);
}

struct Brdf : support::GlTest {
    Image shade(const scene::Scene& scene, ivec2 size, scene::Aov show = kIrradiance,
                const Settings& settings = {}, const Image* flux = nullptr) {
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
        const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
        const auto drawn = views::drawnMeshes(scene, images, true);
        std::vector<views::DrawnMesh> all = drawn->solid;
        all.insert(all.end(), drawn->glass.begin(), drawn->glass.end());
        const auto posed = views::recordPose(graph, *context, all, scene.view.time);
        std::vector<views::PosedMesh> solids = *posed;
        std::erase_if(solids, [](const views::PosedMesh& mesh) {
            return !mesh.drawn.object->visible || mesh.drawn.object->material.isRefractive();
        });
        const graph::TextureId surfaceId = import(surface), targetId = import(target);
        const graph::TextureId fluxId = flux ? import(caustics) : graph::TextureId();
        graph.keep(targetId);
        EXPECT_TRUE(views::recordSurface(graph, *context, eye, {}, solids, surfaceId, size).ok());
        auto environment = graph::TextureHandle::None;
        if (scene.environment) environment = *images.image(scene.environment->map);
        context->device().checkTargets(true);
        const Inputs in{scene, eye, solids, *posed, surfaceId, fluxId, environment, targetId, show, size};
        const Status recorded = brdf::Brdf(*context).record(graph, in, settings);
        EXPECT_TRUE(recorded.ok());
        const Status compiled = graph.compile();
        EXPECT_TRUE(compiled.ok()) << compiled.error().message;
        graph.execute(pool);
        return context->device().read(target.handle());
    }
    float atMiddle(const scene::Scene& scene, const Settings& settings = {}) {
        return shade(scene, {33, 33}, kIrradiance, settings).at(16, 16)[1];
    }
};

// Truth at each pixel's middle: of a surface whose diffuse is 1/2 its irradiance, and where it is.
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

// --- light on a plane

TEST_F(Brdf, EachKindOfLampGivesItsIrradiance) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{9, 9}})}, 1);
    // At the origin, from (3, 4, 0): five metres away, cosine 4/5. The colour's green is 1/2.
    const vec3 place(3, 4, 0), color(1, 0.5f, 0);
    scene::PointLight point{
        .position = place, .color = color, .intensity = 10, .falloff = scene::LightFalloff::InverseSquare};
    scene.lights = {point};
    EXPECT_NEAR(atMiddle(scene), 0.5 * 10 * 0.8 / 25, 1e-6);
    point.falloff = scene::LightFalloff::None;
    scene.lights = {point};
    EXPECT_NEAR(atMiddle(scene), 0.5 * 10 * 0.8, 1e-5);
    scene.lights = {scene::DistantLight{.direction = -place, .color = color, .irradiance = 2}};
    EXPECT_NEAR(atMiddle(scene), 0.5 * 2 * 0.8, 1e-6);
    scene.lights = {
        scene::SpotLight{.position = place, .direction = -place, .color = color, .intensity = 10}};
    EXPECT_NEAR(atMiddle(scene), 0.5 * 10 * 0.8 / 25, 1e-6);
    // Lamps add up.
    scene.lights.push_back(scene::DistantLight{.direction = -place, .irradiance = 2});
    EXPECT_NEAR(atMiddle(scene), 0.5 * 10 * 0.8 / 25 + 2 * 0.8, 2e-6);
    // From below nothing reaches the side that is seen.
    scene.lights = {scene::DistantLight{.direction = place}};
    EXPECT_EQ(atMiddle(scene), 0);
}

TEST_F(Brdf, AnAreaLightsAPlaneByItsFormFactor) {
    // A square of side 2 one metre above: four corners of sides 1 at a distance of 1. The form factor of each
    // is (X / sqrt(1 + X²) atan(Y / sqrt(1 + X²)) + Y / sqrt(1 + Y²) atan(X / sqrt(1 + Y²))) / 2 pi, X = Y
    // = 1.
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{9, 9}})}, 1);
    const scene::AreaLight area{.corner = {-1, 1, -1}, .edgeU = {2, 0, 0}, .edgeV = {0, 0, 2}, .radiance = 3};
    const double corner = std::atan(1 / std::sqrt(2)) / (std::sqrt(2) * std::numbers::pi);
    const double expected = 3 * std::numbers::pi * 4 * corner;
    scene.lights = {area};
    // Measured: 1.8 %, 0.15 %, -0.8 %, -0.03 %.
    EXPECT_NEAR(atMiddle(scene, {.lightSamples = 4}) / expected, 1, 0.02);
    EXPECT_NEAR(atMiddle(scene) / expected, 1, 0.01);
    EXPECT_NEAR(atMiddle(scene, {.lightSamples = 64}) / expected, 1, 0.01);
    EXPECT_NEAR(atMiddle(scene, {.lightSamples = 256}) / expected, 1, 0.001);
    // The other side is dark.
    scene.lights = {
        scene::AreaLight{.corner = area.corner, .edgeU = area.edgeV, .edgeV = area.edgeU, .radiance = 3}};
    EXPECT_EQ(atMiddle(scene), 0);
}

TEST_F(Brdf, PointLightFallsWithTheSquareOfTheDistance) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{4, 4}})}, 3);
    const ivec2 size{65, 65};
    for (const float height : {0.05f, 0.5f, 2.0f}) {
        scene.lights = {scene::PointLight{
            .position = {0, height, 0}, .intensity = 2, .falloff = scene::LightFalloff::InverseSquare}};
        const Image image = shade(scene, size);
        double worst = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vec2 at = placeOf(scene, {x, y}, size);
                const double square = double(glm::dot(at, at)) + double(height) * height;
                const double expected = 2 * height / (square * std::sqrt(square)); // I cos / d²
                worst = std::max(worst, std::abs(image.at(x, y)[1] / expected - 1));
            }
        EXPECT_LT(worst, 2e-6) << height; // rounding
    }
}

TEST_F(Brdf, ASpotFadesBetweenItsAngles) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{4, 4}})}, 2);
    const ivec2 size{65, 65};
    scene.lights = {scene::SpotLight{
        .position = {0, 1, 0}, .direction = {0, -1, 0}, .intensity = 1, .innerAngle = 15, .outerAngle = 30}};
    const Image image = shade(scene, size);
    const double inner = std::cos(glm::radians(15.0)), outer = std::cos(glm::radians(30.0));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const vec2 at = placeOf(scene, {x, y}, size);
            const double square = double(glm::dot(at, at)) + 1, cosine = 1 / std::sqrt(square);
            const double share = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
            EXPECT_NEAR(image.at(x, y)[1], share * share * cosine / square, 2e-6) << x << " " << y;
        }
}

TEST_F(Brdf, GrazingLightLeavesNoSpecklesOnAPlane) {
    // A box far to the side makes sure that there is a shadow map. Five degrees above the plane.
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{8, 8}}), matt(scene::Box{vec3(0.1f)}, {0, 0.05f, 3.5f})}, 6);
    const float angle = glm::radians(5.0f);
    for (const float around : {0.0f, 0.3f, 1.0f}) {
        const vec3 toLight(std::cos(angle) * std::cos(around), std::sin(angle),
                           std::cos(angle) * std::sin(around));
        scene.lights = {scene::DistantLight{.direction = -toLight}};
        const Image sun = shade(scene, {128, 128});
        scene.lights = {scene::PointLight{.position = 20.0f * toLight}};
        const Image lamp = shade(scene, {128, 128});
        scene.lights = {scene::PointLight{.position = {0.1f, 0.03f, 0}}}; // amid the scene: six views
        const Image low = shade(scene, {128, 128});
        float worst = 0, worstLamp = 0, worstLow = 0;
        for (int y = 0; y < 100; ++y) // the box's shadow lies in the rows behind
            for (int x = 0; x < 128; ++x) {
                const vec2 at = placeOf(scene, {x, y}, {128, 128});
                const vec3 way = 20.0f * toLight - vec3(at.x, 0, at.y),
                           near = vec3(0.1f, 0.03f, 0) - vec3(at.x, 0, at.y);
                worst = std::max(worst, std::abs(sun.at(x, y)[1] / toLight.y - 1));
                worstLamp = std::max(worstLamp, std::abs(lamp.at(x, y)[1] * glm::length(way) / way.y - 1));
                worstLow = std::max(worstLow, std::abs(low.at(x, y)[1] * glm::length(near) / near.y - 1));
            }
        EXPECT_LT(worst, 1e-6); // rounding
        EXPECT_LT(worstLamp, 1e-6);
        EXPECT_LT(worstLow, 1e-6);
    }
}

// --- shadows

// Pixels that differ from truth by more than 2 % of its brightest, though no neighbour lies on the other side
// of a shadow's edge, or 5 cm higher or lower: where a wall stands on a floor a texel sees both.
int wrongPixels(const Image& found, const Truth& truth) {
    const auto lit = [&](ivec2 p) { return truth.light.at(p.x, p.y)[1] > 0; };
    const auto height = [&](ivec2 p) { return truth.places.at(p.x, p.y)[1]; };
    const auto nearEdge = [&](ivec2 p) {
        for (int i = 0; i < 9; ++i) {
            const ivec2 q = glm::clamp(p + ivec2(i % 3, i / 3) - 1, ivec2(0), truth.light.size() - 1);
            if (lit(q) != lit(p) || std::abs(height(q) - height(p)) > 0.05f) return true;
        }
        return false;
    };
    float brightest = 0;
    for (std::size_t i = 1; i < truth.light.pixels.size(); i += 3)
        brightest = std::max(brightest, truth.light.pixels[i]);
    int wrong = 0;
    for (int y = 0; y < found.height; ++y)
        for (int x = 0; x < found.width; ++x)
            if (std::abs(found.at(x, y)[1] - truth.light.at(x, y)[1]) > 0.02f * brightest &&
                !nearEdge({x, y}))
                ++wrong;
    return wrong;
}

TEST_F(Brdf, TheShadowOfABoxEndsWithinATexel) {
    // Light at 45 degrees over a box 0.4 m high that ends at x = 0.2: its shadow ends at x = 0.6 on the
    // floor.
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{4, 4}}), matt(scene::Box{vec3(0.4f)}, {0, 0.2f, 0})}, 1.6f);
    const ivec2 size{256, 256};
    for (const int texels : {64, 256, 1024}) {
        for (const bool distant : {true, false}) {
            if (distant)
                scene.lights = {scene::DistantLight{.direction = {1, -1, 0}}};
            else // the line through the box's upper edge at 45 degrees
                scene.lights = {scene::PointLight{.position = {-2.4f, 3, 0}}};
            const Image image = shade(scene, size, kIrradiance, {.shadowSize = texels});
            // Seen are 1.6 m, which lie in at most 1.6 sqrt(2) m of the light's view, plus its margins, and
            // stretch by sqrt(2) on the floor; of the point light's pyramid a little more.
            const double texel = 1.6 * 1.45 * std::sqrt(2) * (distant ? 1 : 1.4) / (texels - 4);
            const int row = 128;
            int column = 162; // right of the box
            EXPECT_EQ(image.at(column, row)[1], 0);
            while (image.at(column, row)[1] < 0.3f)
                ++column;
            const double edge = placeOf(scene, {column, row}, size).x - 0.5 * 1.6 / 256;
            EXPECT_NEAR(edge, 0.6, texel + 1.6 / 256);
        }
    }
}

TEST_F(Brdf, NoLightLeaksUnderABoxThatStandsOnTheFloor) {
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{4, 4}}), matt(scene::Box{vec3(0.4f)}, {0, 0.2f, 0})}, 0.6f);
    const ivec2 size{240, 240}; // 2.5 mm
    for (const float degrees : {5.0f, 20.0f, 45.0f, 70.0f}) {
        const float angle = glm::radians(degrees);
        scene.lights = {scene::DistantLight{.direction = {std::cos(angle), -std::sin(angle), 0.01f}}};
        const Image image = shade(scene, size);
        // In the light's view 0.6 m are at most 0.9 m: a texel is 0.9 mm, and on the floor 1 / sin as long.
        const double texel = 0.9e-3 / std::sin(angle);
        int dark = 0;
        float leak = 0;
        for (int y = 0; y < 240; ++y)
            for (int x = 0; x < 240; ++x) {
                const vec2 at = placeOf(scene, {x, y}, size);
                // Behind the box, away from the shadow's sides, which run 0.01 aslant.
                if (at.x < 0.2 + texel || at.x > 0.3 - 0.01 || at.x > 0.2 + 0.4 / std::tan(angle) - 0.01 ||
                    std::abs(at.y) > 0.19)
                    continue;
                leak = std::max(leak, image.at(x, y)[1]);
                ++dark;
            }
        EXPECT_EQ(leak, 0) << degrees;
        EXPECT_GT(dark, 1000);
    }
}

TEST_F(Brdf, ShadowsOfManyThingsAreThoseOfTruth) {
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{4, 4}}), matt(scene::Box{{0.5f, 0.3f, 0.2f}}, {0.1f, 0.15f, 0.3f}),
                       matt(scene::Sphere{0.2f}, {-0.4f, 0.4f, -0.3f}),
                       matt(scene::Torus{0.3f, 0.08f}, {0.5f, 0.3f, -0.4f})},
                      2);
    scene.objects[1].transform.rotate = {0, 30, 0};
    scene.objects[3].transform.rotate = {60, 0, 20};
    const ivec2 size{160, 160};
    const std::pair<const char*, scene::Light> lights[] = {
        {"sun", scene::DistantLight{.direction = {1, -1.2f, 0.4f}}},
        {"far", scene::PointLight{.position = {-1, 4, -2}}},
        {"amid", scene::PointLight{.position = {0, 0.5f, 0}, .falloff = scene::LightFalloff::InverseSquare}},
        {"spot", scene::SpotLight{.position = {0.2f, 1.2f, 0.1f},
                                  .direction = {-0.2f, -1, -0.1f},
                                  .innerAngle = 20,
                                  .outerAngle = 35}},
        {"wide spot", scene::SpotLight{.position = {0.2f, 0.8f, 0.1f},
                                       .direction = {-0.2f, -1, -0.1f},
                                       .innerAngle = 70,
                                       .outerAngle = 85}}};
    for (const auto& [name, light] : lights) {
        scene.lights = {light};
        // A pixel is 12.5 mm, a texel 3 mm or, in the six views of the wide spot and the light amid, 5 mm.
        EXPECT_EQ(wrongPixels(shade(scene, size), Truth(scene, size)), 0) << name;
    }
}

TEST_F(Brdf, AShadowOnAFloorOfKilometresIsSharpWhereItIsSeen) {
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{5000, 5000}}), matt(scene::Box{vec3(0.4f)}, {0, 0.2f, 0})}, 1.6f);
    scene.lights = {scene::DistantLight{.direction = {1, -1, 0}}};
    const ivec2 size{256, 256};
    const Image image = shade(scene, size);
    const double pixel = 1.6 / 256;
    for (int x = 162; x < 256; ++x) {
        const double at = placeOf(scene, {x, 128}, size).x;
        if (std::abs(at - 0.6) < pixel) continue;
        EXPECT_NEAR(image.at(x, 128)[1], at < 0.6 ? 0 : std::sqrt(0.5), 1e-4) << at;
    }
}

TEST_F(Brdf, ABallsTerminatorIsSmooth) {
    scene::Scene scene = seenFromAbove({matt(scene::Sphere{1})}, 2.2f);
    const ivec2 size{200, 200};
    for (const vec3 direction : {vec3(1, 0, 0), vec3(1, -0.5f, 0.3f), vec3(1, 0.7f, 0)}) {
        scene.lights = {scene::DistantLight{.direction = direction}};
        const Image image = shade(scene, size);
        double worst = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vec2 at = placeOf(scene, {x, y}, size);
                const double square = double(glm::dot(at, at));
                if (square > 0.99 * 0.99) continue;
                const dvec3 normal(at.x, std::sqrt(1 - square), at.y);
                const double expected = std::max(0.0, -glm::dot(normal, glm::normalize(dvec3(direction))));
                worst = std::max(worst, std::abs(image.at(x, y)[1] - expected));
            }
        EXPECT_LT(worst, 1e-3); // measured 6e-4: normals are interpolated between 256 vertices around
    }
}

TEST_F(Brdf, HiddenAndClearObjectsCastShadows) {
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{4, 4}}), matt(scene::Box{vec3(0.2f)}, {0, 0.5f, 0})}, 1);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    scene.objects[1].visible = false;
    EXPECT_EQ(atMiddle(scene), 0);
    scene.objects[1].material.transmission = 1;
    EXPECT_EQ(atMiddle(scene), 0);
    scene.objects.pop_back();
    EXPECT_NEAR(atMiddle(scene), 1, 1e-6);
}

TEST_F(Brdf, LightFromWithinAPlaneLeavesItDark) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{1, 1}})}, 1);
    const scene::Light lights[] = {
        scene::DistantLight{.direction = {1, 0, 0}},
        scene::PointLight{.position = {0, 0, 0}, .falloff = scene::LightFalloff::InverseSquare},
        scene::PointLight{.position = {0.3f, 0, 5}},
        scene::SpotLight{.position = {0, 0, 0}, .direction = {1, 0, 0}, .innerAngle = 0, .outerAngle = 0}};
    for (const scene::Light& light : lights) {
        scene.lights = {light};
        const Image image = shade(scene, {33, 33}); // the fixture fails on what is not finite
        for (int i = 0; i < 33 * 33; ++i)
            EXPECT_EQ(image.pixels[std::size_t(i) * 4 + 1], 0);
    }
}

// --- lamps with a size

// RMSE over the mean; truth's own noise is taken off.
double relativeRmse(const Image& found, const Truth& truth) {
    double squares = 0, sum = 0;
    for (int y = 0; y < found.height; ++y)
        for (int x = 0; x < found.width; ++x) {
            const double error = double(found.at(x, y)[1]) - double(truth.light.at(x, y)[1]);
            squares += error * error;
            sum += truth.light.at(x, y)[1];
        }
    const double pixels = double(found.width) * found.height;
    return std::sqrt(std::max(0.0, squares / pixels - truth.noise)) / (sum / pixels);
}

TEST_F(Brdf, SoftShadowsComeNearerToTruthWithMorePoints) {
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{4, 4}}), matt(scene::Box{{0.4f, 0.3f, 0.4f}}, {0.2f, 0.4f, 0})}, 2);
    const ivec2 size{32, 32};
    // Largest errors with 4, 16 and 64 points: measured on llvmpipe, and a fifth more.
    const struct {
        const char* name;
        scene::Light light;
        double limits[3];
    } cases[] = {
        {"area",
         scene::AreaLight{
             .corner = {-0.4f, 1.5f, -0.4f}, .edgeU = {0.8f, 0, 0}, .edgeV = {0, 0, 0.8f}, .radiance = 2},
         {0.070, 0.021, 0.006}},
        {"sun", scene::DistantLight{.direction = {1, -2, 0.4f}, .angle = 12}, {0.026, 0.0075, 0.0035}},
        {"lamp",
         scene::PointLight{.position = {-0.5f, 2, 0},
                           .intensity = 3,
                           .falloff = scene::LightFalloff::InverseSquare,
                           .radius = 0.3f},
         {0.045, 0.014, 0.005}}};
    for (const auto& [name, light, limits] : cases) {
        scene.lights = {light};
        const Truth truth(scene, size, 2000);
        int samples = 4;
        for (const double limit : limits) {
            const double error =
                relativeRmse(shade(scene, size, kIrradiance, {.lightSamples = samples}), truth);
            EXPECT_LT(error, limit) << name << ", " << samples << " points";
            samples *= 4;
        }
    }
}

TEST(Lamps, ALampsPointsAreAnEvenDiscFromEverySide) {
    scene::Scene scene;
    scene.lights = {scene::PointLight{.position = {1, 2, 3}, .radius = 0.5f}};
    const std::vector<views::LampPoint> points = views::lampPoints(scene, 1000);
    for (const vec3 side : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0.6f, 0, 0.8f)}) {
        // Of an even disc a quarter lies within half the radius, and the mean square of the radius is 1/2.
        double square = 0;
        int inner = 0;
        for (const views::LampPoint& point : points) {
            const vec3 way = (vec3(point.place) - vec3(1, 2, 3)) / 0.5f;
            const double aside = glm::length(glm::cross(way, side));
            EXPECT_LE(aside, 1.0001);
            square += aside * aside;
            inner += aside < 0.5;
        }
        EXPECT_NEAR(square / 1000, 0.5, 0.01);
        EXPECT_NEAR(inner / 1000.0, 0.25, 0.02);
    }
}

// --- environment and mirrors

TEST_F(Brdf, AWhiteSurroundingMakesEverySurfaceItsAlbedo) {
    scene::Scene scene = seenFromAbove({matt(scene::Sphere{1})}, 2.2f);
    scene.objects[0].material.diffuse = {0.8f, 0.5f, 0.2f};
    addSky(scene, mapOf({64, 32}, [](vec3) { return vec3(1); }));
    scene.environment->rotation = {20, 40, 60};
    const Image image = shade(scene, {32, 32}, scene::Aov::Color);
    for (int y = 8; y < 24; ++y)
        for (int x = 8; x < 24; ++x)
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(image.at(x, y)[channel], scene.objects[0].material.diffuse[channel], 2e-4);
}

TEST(SkyIrradiance, OfALinearSurroundingIsExact) {
    // L = 1/2 + d/2 has no harmonics above order 1: E = pi (1/2 + n / 3).
    scene::Environment environment;
    environment.map = mapOf({256, 128}, [](vec3 d) { return 0.5f + 0.5f * d; });
    environment.intensity = 2;
    const std::array<vec3, 9> sky = skyIrradiance(environment);
    EXPECT_NEAR(glm::distance(sky[0], vec3(2 * kPi / 2)), 0, 1e-3);
    EXPECT_NEAR(glm::distance(sky[1], vec3(0, 2 * kPi / 3, 0)), 0, 2e-3);
    EXPECT_NEAR(glm::distance(sky[2], vec3(0, 0, 2 * kPi / 3)), 0, 2e-3);
    EXPECT_NEAR(glm::distance(sky[3], vec3(2 * kPi / 3, 0, 0)), 0, 2e-3);
    for (std::size_t i = 4; i < 9; ++i)
        EXPECT_NEAR(glm::length(sky[i]), 0, 2e-3) << i;
}

float irradianceAt(const std::array<vec3, 9>& sky, vec3 n) {
    return sky[0].g + n.y * sky[1].g + n.z * sky[2].g + n.x * sky[3].g + n.x * n.y * sky[4].g +
           n.y * n.z * sky[5].g + (3 * n.z * n.z - 1) * sky[6].g + n.x * n.z * sky[7].g +
           (n.x * n.x - n.y * n.y) * sky[8].g;
}

TEST(SkyIrradiance, OfAHalfSphereIsExactWhereverItLies) {
    // L = 1 above the horizon: E = pi (1 + cos) / 2, which has no harmonics above order 1.
    scene::Environment environment;
    environment.map = mapOf({128, 64}, [](vec3 d) { return vec3(d.y > 0 ? 1 : 0); });
    environment.rotation = {0, 0, -90}; // +y goes to +x
    const std::array<vec3, 9> sky = skyIrradiance(environment);
    EXPECT_NEAR(irradianceAt(sky, {1, 0, 0}), kPi, 3e-3);
    EXPECT_NEAR(irradianceAt(sky, {0, 1, 0}), kPi / 2, 3e-3);
    EXPECT_NEAR(irradianceAt(sky, {-1, 0, 0}), 0, 3e-3);
    EXPECT_NEAR(irradianceAt(sky, {0.6f, 0, 0.8f}), kPi * (0.5 + 0.3), 3e-3);
}

TEST(SkyIrradiance, OfASmallLightIsTheSeriesOfOrderTwo) {
    // A light in one direction: E = 1/4 + cos/2 + 5/32 (3 cos² - 1) of what a facing surface gets.
    scene::Environment environment;
    environment.map = mapOf({256, 128}, [](vec3 d) { return vec3(d.x > 0.9995f ? 1000 : 0); });
    const std::array<vec3, 9> sky = skyIrradiance(environment);
    const double facing = irradianceAt(sky, {1, 0, 0}) / (0.25 + 0.5 + 10.0 / 32);
    for (const vec3 n :
         {vec3(0, 1, 0), vec3(0, 0, -1), vec3(-1, 0, 0), vec3(-0.6f, 0.8f, 0), vec3(0.48f, 0.6f, 0.64f)}) {
        const double series = 0.25 + n.x / 2.0 + 5.0 / 32 * (3.0 * n.x * n.x - 1);
        EXPECT_NEAR(irradianceAt(sky, n) / facing, series, 5e-3); // the light is 1.8 degrees wide
    }
}

TEST_F(Brdf, AMirrorShowsTheSurroundingInTheMirroredDirection) {
    scene::Scene scene;
    scene.objects = {matt(scene::Plane{{4, 4}})};
    scene.objects[0].material.reflectance = {1, 0.5f, 0.25f};
    scene.objects[0].material.base = vec3(9); // of no meaning for mirrors
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0.3f, 2, 1}, .fov = 30};
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    addSky(scene, mapOf({1024, 512}, [](vec3 d) { return 0.5f + 0.5f * d; }));
    scene.environment->rotation = {0, 90, 0}; // the map's +x is the world's -z
    scene.environment->intensity = 2;
    const ivec2 size{24, 16};
    const Image image = shade(scene, size, scene::Aov::Color);
    const views::Eye eye = views::makeEye(scene, 1.5f);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const vec2 at = (2.0f * (vec2(x, size.y - 1 - y) + 0.5f) / vec2(size) - 1.0f) * eye.halfExtent;
            vec3 way = glm::normalize(eye.forward + at.x * eye.right + at.y * eye.up);
            way.y = -way.y;
            const vec3 onMap(-way.z, way.y, way.x);
            // Half floats: 1e-3 of 2; the map's pixels are 0.006 wide, whose chord is 5e-6 off.
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(image.at(x, y)[channel],
                            (1 + onMap[channel]) * scene.objects[0].material.reflectance[channel], 2e-3);
        }
    EXPECT_EQ(shade(scene, size).at(3, 3)[1], 0); // no matt surface receives anything
    EXPECT_EQ(shade(scene, size).at(3, 3)[3], 1);
}

// --- what is drawn where

TEST_F(Brdf, AddsItsOwnLightAndThatOfCausticsAndLeavesOtherPixels) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{1, 1}})}, 2);
    scene.objects[0].material.base = {0.1f, 0.2f, 0.3f};
    Image flux(16, 16, 4);
    for (float& value : flux.pixels)
        value = 3;
    const Image image = shade(scene, {16, 16}, scene::Aov::Color, {}, &flux);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(image.at(8, 8)[channel],
                    scene.objects[0].material.base[channel] + 0.5 * 3 / std::numbers::pi, 1e-6);
    EXPECT_EQ(image.at(8, 8)[3], 1);
    EXPECT_EQ(image.at(0, 0)[0], -1); // as the target was
    EXPECT_EQ(shade(scene, {16, 16}, kIrradiance, {}, &flux).at(8, 8)[0], 3);
}

TEST_F(Brdf, ShadesHundredsOfObjectsEachInItsColour) {
    std::vector<scene::Object> tiles;
    for (int i = 0; i < 300; ++i) {
        tiles.push_back(matt(scene::Plane{{1, 1}}, {float(i % 20) - 9.5f, 0, float(i / 20) - 7}));
        tiles.back().material.base = vec3(float(i));
    }
    scene::Scene scene = seenFromAbove(std::move(tiles), 15);
    const Image image = shade(scene, {20, 15}, scene::Aov::Color);
    for (int i = 0; i < 300; ++i)
        EXPECT_EQ(image.at(i % 20, i / 20)[0], float(i));
}

TEST_F(Brdf, ATooLargeShadowMapIsRefused) {
    const int size = context->caps().maxTextureSize / 2;
    graph::FrameGraph graph;
    const views::Bounds box{vec3(-1), vec3(1)};
    const views::ShadowViews views = views::shadowViews({.place = {0, 0, 0, 1}}, box, box, size);
    ASSERT_EQ(views.faces.size(), 6u);
    const Result<graph::TextureId> shadow = views::recordShadow(graph, *context, views, {}, box);
    ASSERT_FALSE(shadow.ok());
    EXPECT_EQ(shadow.error().message, "views: a shadow map of " + std::to_string(3 * size) + " x " +
                                          std::to_string(2 * size) + " texels; must be at most " +
                                          std::to_string(2 * size) + " a side on this GPU");
}

TEST(Need, NamesTheFirstObjectThatIsSeenAndNeitherClearNorAField) {
    scene::Scene scene;
    EXPECT_FALSE(brdf::Brdf::need(scene));
    scene.objects = {matt(scene::Sphere{}), matt(scene::Sphere{})};
    scene.objects[0].material.transmission = 1;
    scene.objects[1].name = "ball";
    EXPECT_EQ(brdf::Brdf::need(scene), "object \"ball\" is an opaque surface");
    scene.objects[1].material.reflectance = vec3(1);
    EXPECT_EQ(brdf::Brdf::need(scene), "object \"ball\" is a mirror");
    scene.objects[1].visible = false;
    EXPECT_FALSE(brdf::Brdf::need(scene));
}

} // namespace
} // namespace lucent::brdf
