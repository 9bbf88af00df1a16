// Opaque surfaces and mirrors in closed forms.
#include "techniques/brdf/Brdf.h"

#include "light/Samples.h"
#include "tests/brdf/Stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lucent::brdf {
namespace {

using namespace stage;
using stage::Brdf; // the fixture, not the technique

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
    EXPECT_NEAR(atMiddle(scene, {.lamp = 4}) / expected, 1, 0.02);
    EXPECT_NEAR(atMiddle(scene) / expected, 1, 0.01);
    EXPECT_NEAR(atMiddle(scene, {.lamp = 64}) / expected, 1, 0.01);
    EXPECT_NEAR(atMiddle(scene, {.lamp = 256}) / expected, 1, 0.001);
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

// Four by two pixels, red in the upper left corner and green in the upper right one, elsewhere blue.
std::shared_ptr<const Image> flag() {
    auto picture = std::make_shared<Image>(4, 2, 3);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x)
            picture->at(x, y)[y == 1 ? 2 : x < 2 ? 0 : 1] = 1;
    return picture;
}

TEST_F(Brdf, AProjectorsPictureLiesAsWideAndAsTurnedAsItSays) {
    scene::Scene scene = seenFromAbove({matt(scene::Plane{{4, 4}})}, 2);
    const ivec2 size{64, 64};
    // One metre above: the picture is 1 m wide and half as high. Straight down, -z is up as in the view.
    scene::SpotLight lamp{.position = {0, 1, 0}, .direction = {0, -1, 0}, .innerAngle = 40, .outerAngle = 50};
    lamp.fov = glm::degrees(2 * std::atan(0.5f));
    lamp.image = flag();
    const auto colorAt = [&](float roll, vec2 place) {
        lamp.roll = roll;
        scene.lights = {lamp};
        const Image image = shade(scene, size);
        const ivec2 pixel = ivec2((place / 2.0f + 0.5f) * vec2(size));
        const double square = double(glm::dot(placeOf(scene, pixel, size), placeOf(scene, pixel, size))) + 1;
        const float* value = image.at(pixel.x, pixel.y);
        return dvec3(value[0], value[1], value[2]) * (square * std::sqrt(square)); // I cos / d²
    };
    const auto expectColor = [&](float roll, vec2 place, const dvec3& color) {
        // Texels of 0.25 m, bilinear: in the middle of what is of one colour nothing mixes.
        EXPECT_LT(glm::length(colorAt(roll, place) - color), 1e-5)
            << roll << " " << place.x << " " << place.y;
    };
    // Right and down in the view.
    expectColor(0, {-0.4f, -0.2f}, {1, 0, 0});
    expectColor(0, {0.4f, -0.2f}, {0, 1, 0});
    expectColor(0, {0.4f, 0.2f}, {0, 0, 1});
    for (const vec2 outside : {vec2(0.55f, 0), vec2(-0.55f, 0), vec2(0, 0.3f), vec2(0, -0.3f)})
        expectColor(0, outside, dvec3(0));
    // A quarter turn counter-clockwise seen from the lamp, which looks as the view does.
    expectColor(90, {-0.2f, 0.4f}, {1, 0, 0});
    expectColor(90, {-0.2f, -0.4f}, {0, 1, 0});
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
                // 256 directions stand for all.
                EXPECT_NEAR(image.at(x, y)[channel], scene.objects[0].material.diffuse[channel], 5e-3);
}

TEST_F(Brdf, ASlabShutsTheSkyOut) {
    // Under a slab of half side a at height h above the origin a uniform sky of radiance 1 is left outside of
    // it: pi (1 - F) with the form factor F of a square overhead, four corners of sides x = a / h.
    scene::Scene scene =
        seenFromAbove({matt(scene::Plane{{40, 40}}), matt(scene::Box{{4, 0.2f, 4}}, {0, 1.1f, 0})}, 0.5f);
    scene.objects[1].visible = false;
    addSky(scene, mapOf({64, 32}, [](vec3) { return vec3(1); }));
    const double x = 2, root = std::sqrt(1 + x * x);
    const double form = 4 * x / (std::numbers::pi * root) * std::atan(x / root);
    // 256 directions: their cells are 13 degrees wide, of which the slab's border cuts some.
    EXPECT_NEAR(atMiddle(scene) / std::numbers::pi, 1 - form, 0.03);
}

TEST_F(Brdf, AMirrorShowsTheSurroundingInTheMirroredDirection) {
    scene::Scene scene;
    scene.objects = {matt(scene::Plane{{4, 4}})};
    scene.objects[0].material.kind = scene::Mirror{{1, 0.5f, 0.25f}};
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
                            (1 + onMap[channel]) * scene.objects[0].material.mirror().reflectance[channel],
                            2e-3);
        }
    EXPECT_EQ(shade(scene, size).at(3, 3)[1], -1); // no matt surface that receives anything
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
    scene.objects[0].material.kind = scene::Clear{};
    scene.objects[1].name = "ball";
    EXPECT_EQ(brdf::Brdf::need(scene), "object \"ball\" is an opaque surface");
    scene.objects[1].material.kind = scene::Mirror{};
    EXPECT_EQ(brdf::Brdf::need(scene), "object \"ball\" is a mirror");
    scene.objects[1].visible = false;
    EXPECT_FALSE(brdf::Brdf::need(scene));
}
} // namespace
} // namespace lucent::brdf
