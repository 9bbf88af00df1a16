#include "truth/Layered.h"

#include "diffusion/Stack.h"
#include "tests/truth/bodies.h"
#include "truth/Dipole.h"
#include "truth/Walk.h"

#include <cstdio>
#include <deque>

namespace lucent::truth {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Picture walks(const scene::Scene& scene, const WalkOptions& options, ivec2 size = {4, 4}) {
    const std::atomic<bool> never = false;
    Result<Picture> picture = traceWalks(scene, size, options, {}, {.threads = 2}, never);
    EXPECT_TRUE(picture) << picture.error().message;
    return std::move(*picture);
}

/// Green marble on red and blue skin, of one index of refraction.
scene::Scene marbleOnSkin() {
    scene::Scene scene = test::marbleHalfSpace();
    scene::Translucent& material = scene.objects[0].material.translucent();
    material.scattering = vec3(880);
    material.absorption = vec3(170);
    material.ior = 1.3f;
    scene::MediumLayer layer;
    layer.thickness = 5e-4f;
    layer.scattering = vec3(2620);
    layer.absorption = vec3(4.1f);
    layer.ior = 1.3f;
    material.layers = {layer};
    return scene;
}

TEST(Layered, AgreesWithTheTableOfThePicture) {
    // One model, two ways to solve it: here by elimination and along the real axis, there by running through
    // the layers and along a ray. Both read cubics between distances 6 and 7.5 % apart.
    const diffusion::Medium media[] = {
        {880, 170, 1.3, {{2620, 4.1, 1.5, 5e-4}}},
        {3000, 7.1, 1.5, {{3000, 7.1, 1.5, 5e-4}, {1000, 300, 1.3, 2e-4}}},
        {500, 0, 1.3, {{2000, 0, 1.4, 1e-3}, {4000, 0, 1.2, 5e-4}, {1000, 0, 1.5, 1e-3}}},
        {282, 0.6, 1.3, {{8730, 2436, 1.47, 3.9e-5}}}, // so thin that phi does not reach its 0 outside
    };
    const double thicknesses[] = {0, 0, 2e-3, 4e-4};
    for (std::size_t i = 0; i < std::size(media); ++i) {
        std::vector<Layer> layers;
        for (const diffusion::Slab& slab : media[i].above)
            layers.push_back({{slab.scattering, 0, slab.absorption, slab.ior}, slab.thickness});
        layers.push_back({{media[i].scattering, 0, media[i].absorption, media[i].ior},
                          thicknesses[i] > 0 ? thicknesses[i] : kInfinity});
        const LayeredResponse response(layers, 0.02);
        const diffusion::Stack stack(media[i], thicknesses[i]);
        EXPECT_NEAR(response.depths().x, stack.depth(), 1e-12);
        for (const double r : {0.0, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 8e-3})
            EXPECT_NEAR(response.at(r) / stack.at(r), 1, 3e-5) << i << " " << r;
    }
}

TEST(Layered, DipoleOfAHalfSpaceGivesBackTheShareOfTheStack) {
    scene::Scene scene = marbleOnSkin();
    const auto dipole =
        DipoleEstimator::create(scene, {8, 8}, {.profile = Diffusion::Multipole, .samples = 4096});
    ASSERT_TRUE(dipole) << dipole.error().message;
    const Hit hit = test::intersect(dipole->bodies(), {0, 0.01, 0}, {0, -1, 0});
    const Estimate estimate = dipole->radiosity(dipole->bodies().all()[0], hit, 0);
    const diffusion::Stack stack({880, 170, 1.3, {{2620, 4.1, 1.3, 5e-4}}}, 0);
    const double entering = 1 - test::fresnel(0, 1 / 1.3);
    EXPECT_LT(estimate.standardError().x, 2e-3);
    EXPECT_NEAR(estimate.mean().x, entering * stack.total(), 4 * estimate.standardError().x + 1e-4);
}

TEST(Layered, WalksKnowTheLayerByItsDepth) {
    // Layers of the sphere's own medium change nothing but the numbers drawn.
    scene::Scene sphere = test::marbleSphere();
    scene::Translucent& material = sphere.objects[0].material.translucent();
    scene::MediumLayer same;
    same.thickness = 1e-3f;
    same.scattering = material.scattering;
    same.absorption = material.absorption;
    material.layers = {same, same};
    const EnergyBook whole = *walks(sphere, {.photons = 45000}).energy;
    const double known[] = {0.853, 0.813, 0.769};
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(whole.escaped[c] / whole.incident[c], known[c], 0.006);

    // By the walks of tests/diffusion, 0.4114 of what enters a half space of skin under 0.5 mm of marble.
    const EnergyBook book = *walks(marbleOnSkin(), {.photons = 60000}).energy;
    const dvec3 share = book.escaped / (book.incident - book.reflected);
    const diffusion::Stack stack({880, 170, 1.3, {{2620, 4.1, 1.3, 5e-4}}}, 0);
    std::printf("marble 0.5 mm on skin: model %.4f, walks %.4f\n", stack.total(), share.x);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(share[c], 0.4114, 0.012); // 13000 rays of each colour whose shares spread by 0.35
    // The model gives back 8 % less: tests/diffusion has its bounds.
    EXPECT_NEAR(stack.total() / share.x, 0.92, 0.04);
}

TEST(Layered, WalksAreCountedByHowOftenLightWasScattered) {
    // Index 1, even scattering, light straight from above: scattered once, (a / 2) (1 - ln 2) comes back.
    scene::Scene scene = test::marbleHalfSpace();
    scene::Translucent& material = scene.objects[0].material.translucent();
    material.ior = 1;
    material.scattering = vec3(0.9e5f);
    material.absorption = vec3(0.1e5f);
    scene.camera.eye = {0, 1, 0};
    scene.camera.up = {0, 0, 1};
    scene.camera.height = 0.6f;
    const auto seen = [&](std::optional<int> scatterings) {
        return double(
            walks(scene, {.aov = scene::Aov::Radiosity, .photons = 60000, .scatterings = scatterings}, {1, 1})
                .values.pixels[0]);
    };
    EXPECT_NEAR(seen(1), 0.45 * (1 - std::log(2.0)), 0.01); // of 20000 rays a share that spreads by 0.3
    EXPECT_EQ(seen(0), 0);
    EXPECT_GT(seen({}), 2 * seen(1));
}

} // namespace
} // namespace lucent::truth
