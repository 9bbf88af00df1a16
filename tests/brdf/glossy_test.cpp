// Pictures of glossy surfaces against exact solutions.
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "scene/ReflectanceTable.h"
#include "technique/Technique.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"
#include "truth/Gloss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lucent::brdf {
namespace {

struct Glossy : support::GlTest {
    scene::Scene scene;

    Glossy() {
        scene.size = {42, 30};
        scene.camera.type = scene::Camera::Type::Perspective;
        scene.camera.eye = {0, 0.7f, 2.2f};
        technique::addSettings(scene);
    }
    scene::Object& add(const char* name, scene::Shape shape, scene::MaterialKinds kind,
                       vec3 place = vec3(0)) {
        scene::Object object;
        object.name = name;
        object.shape = std::move(shape);
        object.material.diffuse = {0.5f, 0.4f, 0.3f};
        object.material.kind = std::move(kind);
        object.transform.translate = place;
        scene.objects.push_back(std::move(object));
        return scene.objects.back();
    }
    // Bright above on one side, and dim elsewhere.
    void addSky() {
        auto map = std::make_shared<Image>(64, 32, 3);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x) {
                const float bright =
                    0.3f + 2 * std::exp(-0.02f * float((x - 40) * (x - 40) + 2 * (y - 9) * (y - 9)));
                const vec3 color(bright, 0.9f * bright, 0.3f + 0.5f * bright);
                std::copy_n(&color[0], 3, map->at(x, y));
            }
        scene.environment.emplace().map = std::move(map);
    }
    Image picture() {
        frame::Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        Result<Image> image = renderer.read(scene, scene.view.show);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
    /// Summed differences over the sum of what is exact, of pixels that show objects, 3x3 pixels at a time.
    double misplaced(int samples) {
        const Image found = picture();
        const auto exact =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = samples});
        const auto places =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Position, {.samples = 1});
        double apart = 0, sum = 0;
        for (int y = 0; y + 3 <= scene.size.y; y += 3)
            for (int x = 0; x + 3 <= scene.size.x; x += 3) {
                dvec3 cell(0), light(0);
                for (int i = 0; i < 9; ++i) {
                    const ivec2 at(x + i % 3, y + i / 3);
                    if (places->solve(at).coverage == 0) continue;
                    const dvec3 value = exact->solve(at).value;
                    const float* pixel = found.at(at.x, at.y);
                    cell += dvec3(pixel[0], pixel[1], pixel[2]) - value;
                    light += value;
                }
                for (int c = 0; c < 3; ++c) {
                    apart += std::abs(cell[c]);
                    sum += light[c];
                }
            }
        return apart / sum;
    }
};

const scene::MaterialKinds kKinds[] = {
    scene::Glossy{.roughness = 0.4f},
    scene::Glossy{.metallic = 1, .roughness = 0.6f},
    scene::Phong{.exponent = 30},
    scene::Phong{.exponent = 30, .asPrinted = true},
    scene::Blinn{.exponent = 100},
    scene::CookTorrance{.roughness = 0.5f},
    scene::CookTorrance{.roughness = 0.5f, .asPrinted = true},
    scene::OrenNayar{.roughness = 0.8f},
};

TEST_F(Glossy, LampsAreSeenInEachModelAsTheTruthSays) {
    add("floor", scene::Plane{{4, 4}}, scene::Matt{});
    scene.lights = {scene::PointLight{.position = {0.3f, 0.8f, -0.9f}, .intensity = 3},
                    scene::DistantLight{.direction = {-1, -0.7f, -0.2f}, .irradiance = 2}};
    for (const scene::MaterialKinds& kind : kKinds) {
        scene.objects[0].material.kind = kind;
        EXPECT_LT(misplaced(1), 1e-4) << kind.index(); // powers of rounded cosines
    }
}

TEST_F(Glossy, ASmoothSurfaceMirrorsWhatIsAround) {
    add("floor", scene::Plane{{4, 4}}, scene::Glossy{.metallic = 1, .roughness = 0});
    addSky();
    EXPECT_LT(misplaced(4), 2e-3);
    // As a mirror does, but for Fresnel's reflection, which of a metal of that colour is at least as much.
    const Image glossy = picture();
    scene.objects[0].material.kind = scene::Mirror{scene.objects[0].material.diffuse};
    const Image mirror = picture();
    for (std::size_t i = 0; i < mirror.pixels.size(); ++i)
        if (i % 4 != 3) {
            EXPECT_GE(glossy.pixels[i], 0.999f * mirror.pixels[i]);
        }
}

TEST_F(Glossy, TheEnvironmentLightsEachModelAsTheTruthSays) {
    add("ball", scene::Sphere{0.8f}, scene::Matt{});
    addSky();
    ASSERT_TRUE(scene::setParam(scene, "technique.brdf.lobeDirections", "64").ok());
    for (const scene::MaterialKinds& kind : kKinds) {
        scene.objects[0].material.kind = kind;
        // Measured: 0.3 to 0.6 %, and with 16 directions 0.3 to 2.4 %. Noise of the truth 0.3 %.
        EXPECT_LT(misplaced(1024), 0.01) << kind.index();
    }
}

TEST_F(Glossy, OtherObjectsAreSeenInIt) {
    add("floor", scene::Plane{{4, 4}}, scene::Glossy{.roughness = 0.25f, .ior = 2.5f}).material.diffuse =
        vec3(0.05f);
    add("box", scene::Box{vec3(0.5f)}, scene::Matt{}, {0.4f, 0.5f, -0.5f}).material.diffuse = {0.9f, 0.1f,
                                                                                               0.1f};
    addSky();
    scene.size = {63, 45}; // of the views of the surroundings as well
    scene.lights = {scene::PointLight{.position = {-1, 1.6f, 0.9f}, .intensity = 4}};
    ASSERT_TRUE(scene::setParam(scene, "technique.brdf.lobeDirections", "64").ok());
    const double found = misplaced(1024);
    EXPECT_LT(found, 0.02);
    // Without views of the surroundings it is not.
    ASSERT_TRUE(scene::setParam(scene, "technique.brdf.surroundings", "environment").ok());
    EXPECT_GT(misplaced(1024), 2 * found);
}

TEST_F(Glossy, ObjectsStandInTheWayOfLightOnRoughSurfaces) {
    add("floor", scene::Plane{{4, 4}}, scene::Glossy{.metallic = 1, .roughness = 0.7f});
    add("box", scene::Box{vec3(0.5f)}, scene::Matt{}, {0.3f, 0.25f, -0.4f});
    addSky();
    scene.lights = {scene::DistantLight{.direction = {-0.6f, -1, -0.4f}, .irradiance = 1}};
    const double found = misplaced(1024);
    EXPECT_LT(found, 0.02);
}

TEST_F(Glossy, MoreSamplesOfALampMakeItsHighlightExact) {
    add("floor", scene::Plane{{4, 4}}, scene::Matt{}).material.diffuse = vec3(0.8f);
    const scene::Light kLamps[] = {
        scene::AreaLight{
            .corner = {-0.4f, 0.6f, -1.6f}, .edgeU = {0.8f, 0, 0}, .edgeV = {0, 0.8f, 0}, .radiance = 5},
        scene::PointLight{.position = {0.2f, 1, -1.4f}, .intensity = 5, .radius = 0.4f},
        scene::DistantLight{.direction = {0.1f, -0.6f, 1}, .irradiance = 3, .angle = 20}};
    for (const float roughness : {0.15f, 0.3f})
        for (const scene::Light& lamp : kLamps) {
            scene.objects[0].material.kind = scene::Glossy{.metallic = 1, .roughness = roughness};
            scene.lights = {lamp};
            views::samplingOf(scene).lamp = 16;
            const double few = misplaced(512);
            views::samplingOf(scene).lamp = 256;
            const double many = misplaced(512);
            EXPECT_LT(many, 0.4 * few) << roughness << " lamp " << lamp.index();
            EXPECT_LT(many, roughness < 0.2f ? 0.08 : 0.03) << roughness << " lamp " << lamp.index();
        }
}

TEST_F(Glossy, ATableShowsTheModelThatItIsOf) {
    add("ball", scene::Sphere{0.8f}, scene::CookTorrance{.roughness = 0.7f, .ior = 2});
    scene.lights = {scene::PointLight{.position = {-1, 1.6f, 2}, .intensity = 4}};
    const auto brdf = [material = scene.objects[0].material](const dvec3& toLight, const dvec3& toEye) {
        return vec3(truth::Gloss(material, dvec3(0, 0, 1), toEye).share(toLight) / toLight.z);
    };
    const Image model = picture();
    double sum = 0;
    for (std::size_t i = 1; i < model.pixels.size(); i += 4)
        sum += double(model.pixels[i]);
    struct {
        scene::TableForm form;
        double most;
    } const kForms[] = {{scene::TableForm::Merl, 0.001},
                        {scene::TableForm::EqualArea, 0.002},
                        {scene::TableForm::Projected, 0.002}};
    for (const auto& [form, most] : kForms) {
        auto table = std::make_shared<Image>(scene::tabulate(brdf, form, 32, 32));
        scene.objects[0].material.kind = scene::MeasuredBrdf{
            .form = form, .blocks = form == scene::TableForm::Merl ? 0 : 32, .table = table};
        // The shader's look at the table is that of the truth,
        EXPECT_LT(misplaced(1), 1e-3) << int(form);
        // and the table that of the model, but for what lies between its texels.
        const Image found = picture();
        double apart = 0;
        for (std::size_t i = 1; i < model.pixels.size(); i += 4)
            apart += std::abs(double(found.pixels[i] - model.pixels[i]));
        // Measured: 0.01 %, 0.06 %, 0.05 %.
        EXPECT_LT(apart / sum, most) << int(form);
    }
}

TEST_F(Glossy, LampsTwiceAsBrightGiveTwiceThePicture) {
    add("ball", scene::Sphere{0.8f}, scene::Glossy{.roughness = 0.3f});
    scene.lights = {scene::PointLight{.position = {-1, 1.6f, 0.9f}, .intensity = 4}};
    const Image once = picture();
    std::get<scene::PointLight>(scene.lights[0]).intensity = 8;
    const Image twice = picture();
    for (std::size_t i = 0; i < once.pixels.size(); ++i)
        if (i % 4 != 3) {
            EXPECT_FLOAT_EQ(twice.pixels[i], 2 * once.pixels[i]);
        }
}

} // namespace
} // namespace lucent::brdf
