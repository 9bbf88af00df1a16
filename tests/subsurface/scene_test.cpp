// Whole scenes in which light scatters: only the passes that they need, and scattering objects among others.
#include "diffusion/Profile.h"
#include "frame/Renderer.h"
#include "technique/Technique.h"
#include "techniques/subsurface/Subsurface.h"
#include "tests/support/Gl.h"
#include "truth/Dipole.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucent::frame {
namespace {

struct Scattering : support::GlTest {
    scene::Scene scene;

    Scattering() {
        scene.size = {48, 48};
        scene.camera.eye = {0, 0, 1};
        scene.camera.height = 0.05f;
        technique::addSettings(scene);
        scene.lights = {scene::DistantLight{.direction = {-0.3f, -1, -0.5f}}};
        add("ball", scene::Sphere{0.01f}).material.kind = scene::Translucent{.scattering = vec3(2000)};
        scene.objects[0].material.translucent().absorption = vec3(100);
    }
    scene::Object& add(const char* name, scene::Shape shape, vec3 centre = vec3(0)) {
        scene::Object object;
        object.name = name;
        object.shape = std::move(shape);
        object.transform.translate = centre;
        scene.objects.push_back(object);
        return scene.objects.back();
    }
    std::string explained() {
        Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, scene.size);
        EXPECT_TRUE(text.ok()) << text.error().message;
        return *text;
    }
    bool runs(const std::string& pass) { return explained().find("\n  " + pass + ":") != std::string::npos; }
    Image picture(scene::Aov aov = scene::Aov::Radiosity) {
        Renderer renderer(*context);
        scene.view.show = aov;
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        Result<Image> image = renderer.read(scene, aov);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
};

float sumOf(const Image& image) {
    float sum = 0;
    for (std::size_t i = 1; i < image.pixels.size(); i += 4)
        sum += image.pixels[i];
    return sum;
}

TEST_F(Scattering, ABallRunsNoPassOfOpaqueSurfaces) {
    EXPECT_TRUE(runs("subsurface.splat"));
    EXPECT_TRUE(runs("subsurface.shade"));
    EXPECT_TRUE(runs("subsurface.enter"));
    EXPECT_FALSE(runs("brdf.light"));
    EXPECT_FALSE(runs("subsurface.peel")); // no environment
    EXPECT_NE(explained().find("subsurface: light scatters inside object \"ball\""), std::string::npos);
}

TEST_F(Scattering, AFloorBesideItIsShadedAsEverAndABallThatIsHiddenStillCastsItsShadow) {
    scene::Object& floor = add("floor", scene::Plane{{0.04f, 0.04f}}, {0, -0.012f, 0});
    floor.transform.rotate = {60, 0, 0};
    EXPECT_TRUE(runs("brdf.light"));
    EXPECT_GT(sumOf(picture()), 0);
    scene.objects[0].visible = false;
    EXPECT_FALSE(runs("subsurface.shade"));
    EXPECT_EQ(sumOf(picture()), 0);
    const float shadowed = sumOf(picture(scene::Aov::Color));
    scene.objects.erase(scene.objects.begin());
    EXPECT_LT(shadowed, sumOf(picture(scene::Aov::Color)));
}

TEST_F(Scattering, WhatALampDoesNotSeeStaysDark) {
    // A spot that shines past the ball.
    scene.lights = {scene::SpotLight{.position = {0.1f, 0, 0}, .direction = {0, 1, 0}}};
    EXPECT_EQ(sumOf(picture()), 0);
    scene.lights = {scene::SpotLight{.position = {0.1f, 0, 0}, .direction = {-1, 0, 0}}};
    EXPECT_GT(sumOf(picture()), 0);
    // Something opaque before it.
    add("blind", scene::Box{{0.005f, 0.05f, 0.05f}}, {0.04f, 0, 0});
    EXPECT_EQ(sumOf(picture()), 0);
}

TEST_F(Scattering, LayersFollowEveryEdit) {
    static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data())->profile =
        diffusion::Shape::Multipole;
    scene.view.show = scene::Aov::Radiosity;
    Renderer renderer(*context); // one for all: it keeps tables
    std::uint64_t revision = 0;
    const auto light = [&] {
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size).ok());
        const Result<Image> image = renderer.read(scene, scene.view.show);
        EXPECT_TRUE(image.ok());
        return sumOf(*image);
    };
    const float plain = light();
    EXPECT_GT(plain, 0);
    scene::Translucent& material = scene.objects[0].material.translucent();
    material.layers = {{.thickness = 5e-4f, .scattering = vec3(2000), .absorption = vec3(100), .ior = 1.5f}};
    EXPECT_NEAR(light() / plain, 1,
                1e-3); // of the same medium; splats are 1e-2 apart, but at the same places
    material.layers[0].absorption = vec3(1000);
    const float filtered = light();
    EXPECT_LT(filtered, 0.8f * plain);
    material.layers[0].thickness = 0.005f;
    const float hidden = light();
    EXPECT_LT(hidden, 0.95f * filtered);
    material.layers.push_back({.thickness = 5e-4f, .scattering = vec3(4000)});
    const float below = light(); // where hardly any light arrives
    EXPECT_NEAR(below / hidden, 1, 0.01);
    material.layers[0].order = 2;
    EXPECT_GT(light(), 1.2f * below);
    material.layers[0].thickness = material.layers[1].thickness = 0;
    EXPECT_EQ(light(), plain);
}

TEST_F(Scattering, AWaveMovesItsLightAlong) {
    scene.objects[0].wave = {
        .amplitude = {0, 0.004f, 0}, .direction = {1, 0, 0}, .wavelength = 0.02f, .period = 1};
    const Image still = picture();
    scene.view.time = 0.25f;
    const Image moved = picture();
    EXPECT_GT(sumOf(still), 0);
    EXPECT_NE(still.pixels, moved.pixels);
    EXPECT_NEAR(sumOf(moved) / sumOf(still), 1, 0.5); // the same body in another shape
}

TEST_F(Scattering, TwoMaterialsAtOnceAreEachAsTheyAreAlone) {
    // Side by side along the light, which comes from above.
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    scene.objects[0].transform.translate = {-0.012f, 0, 0};
    scene::Object& other = add("other", scene::Box{vec3(0.016f)}, {0.012f, 0, 0});
    other.material.kind = scene::Translucent{.scattering = {500, 1500, 4000}, .absorption = {300, 50, 10}};
    const Image both = picture();
    scene.objects.pop_back();
    const Image ball = picture();
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 24; ++x)
            EXPECT_NEAR(both.at(x, y)[1], ball.at(x, y)[1], 1e-6);
    EXPECT_GT(sumOf(both), 1.1f * sumOf(ball));
}

TEST_F(Scattering, LambertLeavesTheWholeProfileWhereLightEnteredAndSplatsNothing) {
    scene::Object& box = scene.objects[0];
    box.shape = scene::Box{{0.02f, 0.02f, 0.004f}};
    box.material.translucent().scattering = {500, 1500, 4000};
    subsurface::Settings lambert;
    lambert.method = subsurface::Method::Lambert;
    *static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data()) = lambert;
    EXPECT_FALSE(runs("subsurface.splat"));
    EXPECT_TRUE(runs("subsurface.enter")); // as ever
    // The front faces +z; light of 1 W/m² travels along (-0.3, -1, -0.5).
    const double cosine = 0.5 / std::sqrt(0.09 + 1 + 0.25);
    EXPECT_NEAR(picture(scene::Aov::Irradiance).at(24, 24)[1], cosine, 1e-5);
    const Image image = picture();
    const auto media = diffusion::mediaOf(box.material);
    for (std::size_t c = 0; c < 3; ++c) {
        const double whole = diffusion::totalReflectance(media[c], diffusion::Shape::Dipole, 0);
        const double expected = cosine * diffusion::transmittedShare(cosine, 1.5) * whole;
        EXPECT_NEAR(double(image.at(24, 24)[c]), expected, 1e-5);
    }
    EXPECT_EQ(image.at(1, 1)[1], 0);
}

TEST_F(Scattering, LambertUnderAnEvenSkyIsTheMeanTransmittanceTimesTheWholeProfile) {
    scene.environment.emplace();
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 0.5f);
    scene.environment->map = map;
    scene.lights.clear();
    static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data())->method =
        subsurface::Method::Lambert;
    views::samplingOf(scene).directions = 4096;
    const double arriving = 0.5 * double(kPi);
    EXPECT_NEAR(double(picture(scene::Aov::Irradiance).at(24, 24)[1]), arriving, 1e-3 * arriving);
    const double whole = diffusion::totalReflectance(diffusion::mediaOf(scene.objects[0].material)[1],
                                                     diffusion::Shape::Dipole, 0);
    const double expected = arriving * diffusion::meanTransmittance(1.5) * whole;
    EXPECT_NEAR(double(picture().at(24, 24)[1]), expected, 1e-3 * expected);
}

TEST_F(Scattering, WithNoLightAtAllLambertIsBlack) {
    scene.lights.clear();
    static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data())->method =
        subsurface::Method::Lambert;
    EXPECT_EQ(sumOf(picture()), 0);
}

TEST_F(Scattering, HighlightsAreThoseOfTheTruth) {
    scene.camera.height = 0.03f;
    scene.lights.push_back(scene::PointLight{.position = {0.01f, 0.02f, 0.03f}, .intensity = 1e-3f});
    const auto solved = [&](float roughness) {
        scene.objects[0].material.translucent().roughness = roughness;
        auto dipole = truth::DipoleEstimator::create(scene, scene.size, {.samples = 48});
        EXPECT_TRUE(dipole.ok());
        std::vector<double> values;
        for (int y = 0; y < scene.size.y; ++y)
            for (int x = 0; x < scene.size.x; ++x)
                values.push_back(dipole->solve({x, y}).value.g);
        return values;
    };
    const std::vector<double> exact = solved(0.3f),
                              exactMatt = solved(0); // their dipoles are the same to the bit
    const auto drawn = [&](float roughness) {
        scene.objects[0].material.translucent().roughness = roughness;
        return picture(scene::Aov::Color);
    };
    const Image shown = drawn(0.3f), shownMatt = drawn(0);
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double wanted = exact[i] - exactMatt[i];
        const double found = double(shown.pixels[4 * i + 1]) - double(shownMatt.pixels[4 * i + 1]);
        largest = std::max(largest, wanted);
        // The ball of triangles has outlines of its own, and a shadow map's edge lies where hardly any light
        // falls.
        if (wanted > 0 && found > 0) error = std::max(error, std::abs(found - wanted));
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(error, 0.01 * largest); // normals between triangles' corners, 16 bits of an octahedral map
}

TEST_F(Scattering, AnEnvironmentPeelsItsSurfacesAlongThreeAxes) {
    scene.environment.emplace();
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 0.5f);
    scene.environment->map = map;
    scene.lights.clear();
    const std::string text = explained();
    int layers = 0;
    for (std::size_t at = text.find("\n  subsurface.peel:"); at != std::string::npos;
         at = text.find("\n  subsurface.peel:", at + 1))
        ++layers;
    EXPECT_EQ(layers, 6); // the front and the back of a ball, three times
    const Image image = picture(scene::Aov::Color);
    EXPECT_GT(image.at(24, 24)[1], 0.1f);
    EXPECT_NEAR(image.at(1, 1)[1], 0.5f, 1e-3); // behind it the environment itself
}

// A wide blind right before the front shuts out all of the sky that it would receive; what the back receives
// is on its way through 4 mm of marble.
TEST_F(Scattering, WhatStandsInTheWayOfAnEnvironmentShutsItOut) {
    scene.environment.emplace();
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 0.5f);
    scene.environment->map = map;
    scene.lights.clear();
    scene.objects[0].shape = scene::Box{{0.02f, 0.02f, 0.004f}};
    const auto middle = [&](scene::Aov aov) { return double(picture(aov).at(24, 24)[1]); };
    const double arriving = middle(scene::Aov::Irradiance), leaving = middle(scene::Aov::Radiosity);
    EXPECT_NEAR(arriving, 0.5 * double(kPi), 0.005 * double(kPi)); // 256 directions
    add("blind", scene::Box{{0.2f, 0.2f, 0.001f}}, {0, 0, 0.01f});
    scene.objects.back().visible = false;
    // h² / (h² + a²) of the sky stays, h = 7.5 mm before a half width a = 0.1 m: 0.6 %.
    EXPECT_LT(middle(scene::Aov::Irradiance), 0.02 * arriving);
    for (const auto method :
         {subsurface::Method::Multires, subsurface::Method::Splat, subsurface::Method::Diffusion}) {
        static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data())->method = method;
        EXPECT_LT(middle(scene::Aov::Radiosity), 0.1 * leaving) << int(method);
    }
}

// What a glass ball throws onto a slab enters as what falls straight in: its irradiance is that of a matt
// slab, and as much of it leaves as of the light beside it.
TEST_F(Scattering, CausticsEnterWhatScatters) {
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    scene.objects[0].shape = scene::Box{{0.04f, 0.04f, 0.004f}};
    const auto sums = [&] {
        return dvec2(sumOf(picture(scene::Aov::Irradiance)), sumOf(picture(scene::Aov::Radiosity)));
    };
    using subsurface::Method;
    for (const auto method : {Method::Multires, Method::Splat, Method::Diffusion}) {
        static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data())->method = method;
        const dvec2 without = sums();
        scene::Object& ball = add("ball of glass", scene::Sphere{0.006f}, {0, 0, 0.014f});
        ball.visible = false;
        ball.material.kind = scene::Clear{};
        const dvec2 within = sums();
        // The ball takes away what it mirrors, 0.08 of its 0.11 of the light.
        EXPECT_LT(within.x, 0.999 * without.x) << int(method);
        EXPECT_NEAR(within.y / without.y, within.x / without.x, 0.02) << int(method);
        const scene::Material marble = scene.objects[0].material;
        const Image onMarble = picture(scene::Aov::Irradiance);
        scene.objects[0].material.kind = scene::Matt{};
        const Image onMatt = picture(scene::Aov::Irradiance);
        for (std::size_t i = 1; i < onMatt.pixels.size(); i += 4)
            ASSERT_NEAR(onMarble.pixels[i], onMatt.pixels[i], 1e-3 + 1e-3 * double(onMatt.pixels[i])) << i;
        scene.objects[0].material = marble;
        scene.objects.pop_back();
    }
}

TEST_F(Scattering, LayersUnderAnEnvironmentAreCountedOnceHoweverTheObjectMovesAndTurns) {
    scene.environment.emplace();
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 0.5f);
    scene.environment->map = map;
    scene.lights.clear();
    scene.objects[0].shape = scene::Box{{0.02f, 0.01f, 0.004f}};
    scene.view.show = scene::Aov::Radiosity;
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto draws = [&] {
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size).ok());
        return renderer.stats().draws;
    };
    const int counted = draws();
    scene.objects[0].transform.rotate = {20, 30, 40};
    scene.objects[0].transform.translate = {0.003f, 0, 0};
    EXPECT_EQ(draws(), counted - 6); // a picture along each of three axes, and its maxima
    const Result<Image> kept = renderer.read(scene, scene::Aov::Radiosity);
    ASSERT_TRUE(kept.ok());
    EXPECT_EQ(kept->pixels, picture().pixels);
    scene.objects[0].shape = scene::Box{{0.02f, 0.01f, 0.005f}};
    EXPECT_EQ(draws(), counted);
}

// Radiosity of a box that turns, picture after picture.
struct Turning : Scattering {
    Turning() {
        scene.view.show = scene::Aov::Radiosity;
        scene.lights = {scene::DistantLight{.direction = {-1, -0.5f, -0.5f}}};
        scene.camera.height = 0.03f;
        scene.objects[0].shape = scene::Box{{0.02f, 0.008f, 0.008f}};
    }
    subsurface::Settings& settings() {
        return *static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data());
    }
    void splatFew(bool temporal) {
        settings() = {.method = subsurface::Method::Splat,
                      .splats = subsurface::Splats::Paper,
                      .mostSplats = 24,
                      .temporal = temporal};
    }
    Image next(Renderer& renderer) {
        EXPECT_TRUE(renderer.finish(scene, ++revision_, scene.size).ok());
        Result<Image> image = renderer.read(scene, scene::Aov::Radiosity);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
    std::vector<Image> turned() {
        Renderer renderer(*context);
        std::vector<Image> images;
        for (int frame = 0; frame < 6; ++frame) {
            scene.objects[0].transform.rotate.y = 20 + float(frame);
            images.push_back(next(renderer));
        }
        return images;
    }

private:
    std::uint64_t revision_ = 0;
};

// RMS of what changes from picture to picture, less what changes in exact ones.
double flicker(const std::vector<Image>& images, const std::vector<Image>& exact) {
    double squares = 0;
    for (std::size_t i = 1; i < images.size(); ++i)
        for (std::size_t p = 0; p < images[i].pixels.size(); ++p) {
            const float change = images[i].pixels[p] - images[i - 1].pixels[p],
                        wanted = exact[i].pixels[p] - exact[i - 1].pixels[p];
            squares += std::pow(double(change - wanted), 2);
        }
    return std::sqrt(squares);
}

TEST_F(Turning, FewSplatsFlickerLessMixedWithThePictureBefore) {
    const std::vector<Image> exact = turned();
    splatFew(false);
    const double before = flicker(turned(), exact);
    splatFew(true);
    EXPECT_LT(flicker(turned(), exact), 0.5 * before);
}

TEST_F(Turning, APictureThatFollowsNoneOrItsLikeIsAsItIsWithoutTheOneBefore) {
    splatFew(true);
    Renderer renderer(*context);
    const Image first = next(renderer);
    scene.objects[0].transform.rotate.y = 1;
    const Image moved = next(renderer), again = next(renderer);
    scene.objects[0].material.translucent().scattering = vec3(1500);
    const Image other = next(renderer);
    scene.lights = {scene::DistantLight{.direction = {1, -0.5f, -0.5f}}};
    const Image jumped = next(renderer);
    splatFew(false);
    EXPECT_EQ(jumped.pixels, picture().pixels);
    scene.lights = {scene::DistantLight{.direction = {-1, -0.5f, -0.5f}}};
    EXPECT_EQ(other.pixels, picture().pixels);
    scene.objects[0].material.translucent().scattering = vec3(2000);
    const Image alone = picture();
    EXPECT_NE(moved.pixels, alone.pixels);
    EXPECT_EQ(again.pixels, alone.pixels);
    scene.objects[0].transform.rotate.y = 0;
    EXPECT_EQ(first.pixels, picture().pixels);
}

TEST_F(Turning, LightThatChangesEvenlyDoesNotLagBehind) {
    // A half space under a lamp that comes up: all of its radiosity follows at once, though it never was
    // there.
    scene.objects[0].shape = scene::Box{{0.1f, 0.1f, 0.02f}};
    scene.camera.height = 0.01f;
    splatFew(true);
    Renderer renderer(*context);
    Image last;
    for (int frame = 0; frame < 6; ++frame) {
        const float angle = 0.1f * float(frame);
        scene.lights = {scene::DistantLight{.direction = {-std::cos(angle), 0, -std::sin(angle) - 0.1f}}};
        last = next(renderer);
    }
    splatFew(false);
    EXPECT_NEAR(sumOf(last) / sumOf(picture()), 1, 0.01);
}

TEST(Settings, WhatMixesPicturesActsWherePointsAreSummed) {
    using subsurface::Method;
    for (const Method method : {Method::Multires, Method::Splat, Method::Diffusion, Method::Lambert})
        EXPECT_EQ(subsurface::acts({.method = method}, "temporal"),
                  method == Method::Multires || method == Method::Splat);
    EXPECT_TRUE(subsurface::acts({.method = Method::Diffusion}, "cells"));
}

TEST_F(Scattering, DiffusionIsSolvedAnewOnlyWhereSomethingElseThanTheCameraHasChanged) {
    auto* settings = static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data());
    settings->method = subsurface::Method::Diffusion;
    settings->cells = 16;
    scene.view.show = scene::Aov::Radiosity;
    add("blind", scene::Box{{0.004f, 0.001f, 0.004f}}, {0, 0.015f, 0});
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto passes = [&] {
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size).ok());
        return renderer.stats().passes;
    };
    const int solved = passes();
    scene.camera.eye = {0.5f, 0.3f, 0.8f};
    EXPECT_LT(passes(), 10);
    const Result<Image> kept = renderer.read(scene, scene::Aov::Radiosity);
    ASSERT_TRUE(kept.ok());
    EXPECT_GT(sumOf(*kept), 0);
    EXPECT_EQ(kept->pixels, picture().pixels); // as one solved anew has it, bit for bit

    const std::function<void()> changes[] = {
        [&] {
            scene.lights = {scene::DistantLight{.direction = {0.3f, -1, -0.5f}}};
        },
        [&] { scene.objects[0].material.translucent().scattering = vec3(1500); },
        [&] {
            scene.objects[0].transform.translate = {0.001f, 0, 0};
        },
        [&] {
            scene.objects[1].transform.translate = {0.002f, 0.015f, 0};
        }, // its shadow
        [&] { settings->cells = 18; },
    };
    for (const auto& change : changes) {
        change();
        EXPECT_GT(passes(), solved / 2);
        EXPECT_LT(passes(), 10);
        const Result<Image> image = renderer.read(scene, scene::Aov::Radiosity);
        EXPECT_TRUE(image.ok() && image->pixels == picture().pixels);
    }
}

} // namespace
} // namespace lucent::frame
