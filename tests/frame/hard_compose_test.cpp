// Everything in everything, where it is hard: things that touch, contain each other, or move through each
// other.
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "tests/support/Misplaced.h"
#include "truth/Glass.h"
#include "truth/LightTracer.h"
#include "truth/Picture.h"

#include <algorithm>
#include <atomic>

namespace lucent::frame {
namespace {

scene::Object objectOf(const char* name, scene::Shape shape, vec3 place) {
    scene::Object object;
    object.name = name;
    object.shape = std::move(shape);
    object.material.diffuse = {0.7f, 0.5f, 0.3f};
    object.transform.translate = place;
    return object;
}

struct HardComposed : support::GlTest {
    scene::Scene scene;
    HardComposed() {
        scene.size = {64, 64};
        scene.camera.eye = {0, 4, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 1.6f;
        technique::addSettings(scene);
        scene.objects.push_back(objectOf("floor", scene::Plane{{6, 6}}, vec3(0)));
        scene.lights = {scene::DistantLight{.direction = {-0.5f, -1, -0.2f}, .irradiance = 3}};
    }
    /// A relief 1 m wide that lies at a height.
    scene::Object relief(float height,
                         std::shared_ptr<const Image> heights = support::waves({64, 64})) const {
        scene::HeightField field;
        field.width = 1;
        field.heightScale = 0.06f;
        field.heights = std::move(heights);
        scene::Object object = objectOf("relief", field, {0, height, 0});
        object.transform.rotate = {-90, 0, 0};
        object.material.relief().depth = 0.03f;
        return object;
    }
    Image picture() {
        Renderer renderer(*context);
        const Status finished = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(finished.ok()) << finished.error().message;
        Image image = *renderer.read(scene, scene::Aov::Color);
        EXPECT_EQ(findNonFinite(image), ivec2(-1)) << "NaN or Inf left a pass";
        return image;
    }
    /// Half the summed absolute difference over the light there is, between the picture and what is exact.
    double misplaced() {
        const std::atomic<bool> goOn = false;
        const auto exact =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = 256});
        return support::misplaced(picture(), truth::render(*exact, scene.size, {}, {}, goOn)->values);
    }
    /// Over squares of 4 x 4 pixels: within them caustics may lie where they like.
    static Image meansOf(const Image& image) {
        Image means(image.width / 4, image.height / 4, 4);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 4; ++c)
                    means.at(x / 4, y / 4)[c] += image.at(x, y)[c] / 16;
        return means;
    }
};

// Targets are those of lucent bench compose: 1 % of direct and shadowed light, 2 % of what glass shows.

TEST_F(HardComposed, AReliefInsideGlassIsLitAndSeenThroughIt) {
    scene.objects[0] = relief(0.1f);
    scene.objects.push_back(objectOf("block", scene::Box{{1.2f, 0.6f, 1.2f}}, {0, 0.25f, 0}));
    scene.objects.back().material.kind = scene::Clear{.absorption = {0.2f, 0.6f, 1}};
    const std::atomic<bool> goOn = false;
    const auto exact =
        truth::traceLight(scene, scene.size, {.aov = scene::Aov::Color, .photons = 2'000'000}, {}, {}, goOn);
    EXPECT_LT(support::misplaced(meansOf(picture()), meansOf(exact->values)), 0.02);
}

TEST_F(HardComposed, ABoxThatStandsOnAReliefTouchesItsShadow) {
    const auto flat = support::heights({64, 64}, [](int, int) { return 0.5f; });
    scene.objects.push_back(relief(0, flat));
    scene.objects.push_back(objectOf("box", scene::Box{vec3(0.3f)}, {0.1f, 0.03f + 0.15f, 0}));
    EXPECT_LT(misplaced(), 0.01);
}

TEST_F(HardComposed, ALampBetweenAReliefAndABoxLightsBoth) {
    scene.objects.push_back(relief(0));
    scene.objects.push_back(objectOf("box", scene::Box{{0.3f, 0.1f, 0.3f}}, {0.4f, 0.8f, 0.3f}));
    scene.lights = {scene::PointLight{
        .position = {0.1f, 0.4f, 0}, .intensity = 0.3f, .falloff = scene::LightFalloff::InverseSquare}};
    EXPECT_LT(misplaced(), 0.01);
}

TEST_F(HardComposed, ACausticRunsAcrossTheSeamOfAReliefAndAFloor) {
    // A level relief without depth fills the right half of what is seen; the floor lies as high beside it.
    scene.objects.push_back(objectOf("ball", scene::Sphere{0.3f}, {0, 0.6f, 0}));
    scene.objects.back().material.kind = scene::Clear{};
    scene.objects.back().visible = false;
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 3}};
    const Image onFloor = picture();
    const auto flat = support::heights({64, 64}, [](int, int) { return 0.0f; });
    scene.objects.push_back(relief(1e-4f, flat));
    scene.objects.back().transform.translate.x = 0.5f;
    scene.objects.back().material.relief().depth = 1e-6f;
    EXPECT_LT(support::misplaced(picture(), onFloor), 0.01);
}

TEST_F(HardComposed, EveryMaterialAtOnceInAnyOrderIsOnePicture) {
    scene.objects.push_back(relief(0.001f));
    const scene::MaterialKinds kinds[] = {
        scene::Matt{}, scene::Mirror{vec3(0.8f)}, scene::Clear{},
        scene::Translucent{.scattering = vec3(260), .absorption = vec3(0.5f)}};
    for (std::size_t i = 0; i < std::size(kinds); ++i) {
        const std::string name = "ball" + std::to_string(i);
        scene.objects.push_back(
            objectOf(name.c_str(), scene::Sphere{0.15f}, {0.4f * float(i) - 0.6f, 0.3f, 0.1f * float(i)}));
        scene.objects.back().material.kind = kinds[i];
    }
    const Image first = picture();
    std::reverse(scene.objects.begin(), scene.objects.end());
    // Splats and caustic maps add up in another order, rounded to half floats.
    EXPECT_LT(support::misplaced(picture(), first), 1e-3);
}

TEST_F(HardComposed, SixtyFourLampsAreOneOfTheirSum) {
    scene.objects.push_back(relief(0));
    scene.objects.push_back(objectOf("box", scene::Box{vec3(0.25f)}, {0.35f, 0.4f, 0.1f}));
    const Image one = picture();
    std::get<scene::DistantLight>(scene.lights[0]).irradiance /= 64;
    scene.lights.resize(64, scene.lights[0]);
    const Image all = picture();
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        EXPECT_NEAR(all.pixels[i], one.pixels[i], 1e-5 * std::max(1.0, double(one.pixels[i])));
}

TEST_F(HardComposed, ALampThatIsDraggedThroughAFloorGoesOutBelowIt) {
    for (const float height : {0.1f, 0.01f, 1e-4f, 0.0f, -1e-4f, -0.01f, -0.1f}) {
        scene.lights = {scene::PointLight{.position = {0.013f, height, 0.017f},
                                          .intensity = 0.01f,
                                          .falloff = scene::LightFalloff::InverseSquare}};
        const Image image = picture();
        const double brightest = double(*std::max_element(image.pixels.begin(), image.pixels.end()));
        // Where the floor is nearest E = I / h²; L = 0.7 E / pi.
        if (height > 0) {
            EXPECT_LE(brightest, 1.01 * std::max(1.0, 0.7 * 0.01 / (double(height) * height) / kPi))
                << height;
        } else {
            for (std::size_t i = 0; i < image.pixels.size(); i += 4)
                EXPECT_EQ(image.pixels[i], 0) << height;
        }
    }
}

} // namespace
} // namespace lucent::frame
