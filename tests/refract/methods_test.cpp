// The thesis's layers and rays beside ours: what each can do, and by how much it is off.
#include "frame/Renderer.h"
#include "technique/Technique.h"
#include "tests/refract/Trace.h"

#include <cmath>

namespace lucent::refract {
namespace {

using test::degrees;
using test::glass;

constexpr ivec2 kSize{128, 128};

struct Method {
    const char* name;
    Settings settings;
};

Settings bisection(LayerMethod layers, Normals normals, Slices slices = Slices::Few,
                   Extent bounds = Extent::Local, Peeling peeling = Peeling::Pass) {
    return {.layers = layers,
            .slices = slices,
            .bounds = bounds,
            .peeling = peeling,
            .trace = Trace::Bisection,
            .normals = normals};
}

const Settings kStored = bisection(LayerMethod::Peel, Normals::Stored);
const Settings kVoxels = bisection(LayerMethod::Voxels, Normals::Delta1);

const Method kMethods[] = {
    {"peel, pyramid", {}},
    {"peel, stored", kStored},
    {"peel, neighbours", bisection(LayerMethod::Peel, Normals::Neighbours)},
    {"peel, delta1", bisection(LayerMethod::Peel, Normals::Delta1)},
    {"peel, delta2", bisection(LayerMethod::Peel, Normals::Delta2)},
    {"front and back, delta1", bisection(LayerMethod::FrontBack, Normals::Delta1)},
    {"voxels 256, delta1", kVoxels},
    {"voxels 256, delta2", bisection(LayerMethod::Voxels, Normals::Delta2)},
    {"voxels 256, neighbours", bisection(LayerMethod::Voxels, Normals::Neighbours)},
    {"voxels 512, delta1", bisection(LayerMethod::Voxels, Normals::Delta1, Slices::Many)},
    {"voxels 256 between all, delta1",
     bisection(LayerMethod::Voxels, Normals::Delta1, Slices::Few, Extent::Global)},
};

using Methods = Refraction;

TEST_F(Methods, ASlabBendsNothingByAnyMethod) {
    scene::Scene scene = seenStraight(1.5f, {glass(scene::Box{{1, 1, 0.3f}}, 1.5f)});
    scene.objects[0].transform.rotate = {0, 40, 0};
    for (const Method& method : kMethods) {
        const Image found = trace(scene, kSize, kDirection, 0, method.settings);
        // Depths of a plane are linear, so differences give its normal but for rounding: about 5e-6 in depths
        // near 5 m over two pixels of p = 1.17 cm, 0.012 degrees. The first and the last surface are exact
        // between a pixel's own bounds. Between those of all, 0.87 m apart, slices are s = 3.4 mm: a
        // difference over two pixels is up to s / 2 p = 0.146 off along x and along y, and 1.5 cos 25.4 / cos
        // 40 - 1 = 0.77 of it goes on.
        const double bound =
            method.settings.bounds == Extent::Global ? degrees(0.146 * std::sqrt(2.0) * 0.77) : 0.02;
        for (int y = 40; y < 88; ++y)
            for (int x = 50; x < 70; ++x)
                EXPECT_LT(degrees(test::angleBetween(rgb(found, {x, y}), dvec3(0, 0, -1))), bound)
                    << method.name << " " << x << " " << y;
    }
}

TEST_F(Methods, FiveHalvingsOfASphereStayWithinTheirBound) {
    // Parallel rays at h <= 0.5 from the axis of a ball of 1 m: they enter at asin h = 30 degrees and run at
    // 30 - 19.5 = 10.5 degrees to the view. A layer ends at 1 m behind the middle, so the way is at most 1.9
    // m, a halving five times leaves 1.9 / 32 = 0.06 m of it, which is 0.011 m aside; the pixel's middle is
    // up to half a pixel's diagonal, 2.5 m / 128 / sqrt 2 = 0.014 m, beside. A normal of the far side turns
    // by 0.025 / cos 30 = 0.029, and what leaves by (1.5 cos 19.5 / cos 30 - 1) = 0.63 of it: 1.05 degrees.
    const scene::Scene scene = seenStraight(2.5f, {glass(scene::Sphere{1}, 1.5f)});
    std::vector<ivec2> pixels;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x)
            if (2.5f / 128 * glm::distance(vec2(x, y) + 0.5f, vec2(64)) < 0.5f) pixels.emplace_back(x, y);
    const Image exact = truthOf(scene, kSize);
    const Errors stored = compare(trace(scene, kSize, kDirection, 0, kStored), exact, pixels);
    std::cout << "stored normals: " << stored << "\n";
    EXPECT_LE(stored.most, 1.05);
    EXPECT_EQ(stored.lost, 0);
    // The ball has facets of 360 / 128 degrees: a difference of depths may find a facet's normal, 1.4 degrees
    // off, of which 0.63 goes on.
    const Errors delta = compare(trace(scene, kSize, kDirection, 0, kVoxels), exact, pixels);
    std::cout << "voxels: " << delta << "\n";
    EXPECT_LE(delta.most, 1.05 + 0.63 * 1.4 * std::sqrt(2.0));
    EXPECT_EQ(delta.lost, 0);
}

TEST_F(Methods, APrismDeviatesLeastByBisectionToo) {
    // Both sides are planes and nothing but their normals matters: sin((A + D) / 2) = n sin(A / 2).
    scene::Scene scene = seenStraight(1, {});
    scene::Mesh mesh; // a wedge of 60 degrees along y, its edge at the origin, its bisector along x
    const double half = glm::radians(30.0);
    const vec3 corners[] = {{0, 0, 0},
                            {float(std::cos(half)), 0, float(std::sin(half))},
                            {float(std::cos(half)), 0, -float(std::sin(half))}};
    for (int i = 0; i < 3; ++i) {
        const vec3 a = corners[i], b = corners[(i + 1) % 3];
        const vec3 outward = glm::normalize(glm::cross(b - a, vec3(0, 1, 0)));
        const auto first = std::uint32_t(mesh.positions.size());
        for (const vec3& place : {a, b})
            for (const float y : {-0.5f, 0.5f}) {
                mesh.positions.push_back(place + vec3(0, y, 0));
                mesh.normals.push_back(outward);
            }
        mesh.indices.insert(mesh.indices.end(),
                            {first, first + 2, first + 1, first + 1, first + 2, first + 3});
    }
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
    const double least = degrees(2 * std::asin(1.5 * std::sin(half))) - 60;
    scene.objects.push_back(glass(shape, 1.5f, {-0.3f, 0, 0}));
    scene.objects[0].transform.rotate = {0, -float(least / 2), 0};
    for (const Method& method : {kMethods[0], kMethods[1], kMethods[3], kMethods[5], kMethods[6]}) {
        const Image found = trace(scene, {64, 64}, kDirection, 0, method.settings);
        // Depths are good to about 5e-6 over two pixels of 1.6 cm: 0.01 degrees.
        EXPECT_NEAR(degrees(test::angleBetween(rgb(found, {32, 32}), dvec3(0, 0, -1))), least, 0.03)
            << method.name;
    }
}

TEST_F(Methods, OnTheFlyAndInAPassTheSameBitsAreRead) {
    const scene::Scene scene =
        seenFrom(3, {glass(scene::Torus{0.8f, 0.35f}, 1.5f), glass(scene::Sphere{0.3f}, 1.5f)});
    for (const Slices slices : {Slices::Few, Slices::Many})
        for (const scene::Aov show : {kDirection, scene::Aov::Layers}) {
            const auto settings = [&](Peeling peeling) {
                return bisection(LayerMethod::Voxels, Normals::Delta1, slices, Extent::Local, peeling);
            };
            EXPECT_EQ(trace(scene, kSize, show, 0, settings(Peeling::OnTheFly)).pixels,
                      trace(scene, kSize, show, 0, settings(Peeling::Pass)).pixels);
        }
}

TEST_F(Methods, VoxelsCountTheLayersThatPeelingCounts) {
    const scene::Scene scene = seenFrom(3, {glass(scene::Torus{0.8f, 0.35f}, 1.5f, {0, 0.2f, 0})});
    EXPECT_EQ(trace(scene, kSize, scene::Aov::Layers, 0, kVoxels).pixels,
              trace(scene, kSize, scene::Aov::Layers).pixels);
}

TEST_F(Methods, FrontAndBackAreTheWayThroughOneBall) {
    const scene::Scene scene = seenFrom(3, {glass(scene::Sphere{1}, 1.5f)});
    const Settings settings = bisection(LayerMethod::FrontBack, Normals::Delta1);
    const Errors errors =
        compare(trace(scene, kSize, kDirection, 0, settings), trace(scene, kSize, kDirection, 0, kVoxels),
                withinOutlines(scene, kSize, 1));
    EXPECT_LE(errors.most, 0.05) << errors; // the last slice is the last surface but for rounding
    EXPECT_GT(errors.compared, 1000);
}

TEST_F(Methods, LostRaysAreThoseWithoutADirection) {
    scene::Scene scene = seenFrom(3, {glass(scene::Torus{0.8f, 0.35f}, 1.5f)});
    scene.objects[0].transform.rotate = {50, 0, 20};
    for (const Settings& settings : {Settings{}, kStored, kVoxels})
        for (const int layers : {0, 2}) {
            const Image lost = trace(scene, kSize, scene::Aov::Lost, layers, settings);
            const Image direction = trace(scene, kSize, kDirection, layers, settings);
            int count = 0;
            for (std::size_t i = 0; i < lost.pixels.size(); i += 4) {
                EXPECT_EQ(lost.pixels[i], direction.pixels[i + 3] == 0 ? 1.0f : 0.0f);
                EXPECT_EQ(lost.pixels[i + 3], 1);
                count += lost.pixels[i] == 1;
            }
            // Total reflection ends the rays of bisection. Pyramids lose a few at outlines: measured 60
            // (llvmpipe).
            if (settings.trace == Trace::Bisection) {
                EXPECT_GT(count, 50);
            } else if (layers == 0) {
                EXPECT_LT(count, 120);
            }
        }
}

TEST_F(Methods, TheOpticalLengthAbsorbsByTheIndexOfRefraction) {
    // Straight through 0.3 m of n = 1.5: exp(-sigma 0.3) by the way, exp(-sigma 0.45) by the thesis's length.
    scene::Scene scene = seenStraight(0.5f, {glass(scene::Box{{1, 1, 0.3f}}, 1.5f)});
    scene.objects[0].material.clear().fresnel = false;
    scene.objects[0].material.clear().absorption = {0.5f, 2, 0};
    test::addSky(scene, vec3(1));
    for (Settings settings : {Settings{}, kStored, kVoxels})
        for (const PathLength length : {PathLength::Geometric, PathLength::Optical}) {
            settings.pathLength = length;
            const double way = length == PathLength::Optical ? 0.45 : 0.3;
            const dvec3 expected = glm::exp(-dvec3(0.5, 2, 0) * way);
            const Image found = trace(scene, {32, 32}, scene::Aov::Color, 0, settings);
            EXPECT_LT(glm::distance(dvec3(rgb(found, {16, 16})), expected), 5e-6);
        }
}

TEST_F(Methods, ChoicesThatDoNotGoTogetherAreRefused) {
    const auto message = [](const Settings& settings) { return check(settings).error().message; };
    EXPECT_EQ(message({.layers = LayerMethod::Voxels, .normals = Normals::Delta1}),
              "technique.refract.trace is pyramid with layers voxels, which know neither objects nor sides; "
              "must be "
              "bisection");
    EXPECT_EQ(
        message({.layers = LayerMethod::FrontBack, .trace = Trace::Bisection}),
        "technique.refract.normals is stored with layers front-back, which store none; must be neighbours, "
        "delta1 or delta2");
    EXPECT_EQ(message({.normals = Normals::Delta2}),
              "technique.refract.normals is delta2 with trace pyramid; must be stored");
    for (const Method& method : kMethods)
        EXPECT_TRUE(check(method.settings)) << method.name;
}

TEST_F(Methods, ASceneChoosesAMethodAndHearsOfItsLimits) {
    scene::Scene scene = seenFrom(3, {glass(scene::Sphere{1}, 1.5f), glass(scene::Sphere{0.999f}, 1.2f)});
    test::addSky(scene, vec3(1));
    technique::addSettings(scene);
    for (const auto& [key, value] : {std::pair("layers", "voxels"), std::pair("trace", "bisection")})
        EXPECT_TRUE(setParam(scene, std::string("technique.refract.") + key, value).ok());
    frame::Renderer renderer(*context);
    const Status refused = renderer.finish(scene, 1, kSize);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message,
              "technique.refract.normals is stored with layers voxels, which store none; "
              "must be neighbours, delta1 or delta2");
    EXPECT_TRUE(setParam(scene, "technique.refract.normals", "delta1").ok());
    testing::internal::CaptureStderr();
    EXPECT_TRUE(renderer.finish(scene, 2, kSize).ok());
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("refract: refractive surfaces lie closer than a slice of depth: "), std::string::npos)
        << said;
    EXPECT_NE(said.find("refract: layers voxels tell objects not apart"), std::string::npos) << said;
    const auto explained = renderer.explain(scene, kSize);
    ASSERT_TRUE(explained.ok());
    for (const char* pass : {"views.voxelBounds: ", "views.voxels: ", "views.voxelPeel: ", "views.deepest: "})
        EXPECT_NE(explained->find(pass), std::string::npos) << pass;
}

// Figures, with what each method promises at least: a picture of one ball.
TEST_F(Methods, AreAsFarOffAsTheirFiguresSay) {
    scene::Object ring = glass(scene::Torus{0.8f, 0.35f}, 1.5f);
    ring.transform.rotate = {50, 0, 20};
    const std::pair<const char*, scene::Scene> scenes[] = {
        {"sphere", seenFrom(3, {glass(scene::Sphere{1}, 1.5f)})}, {"torus", seenFrom(3, {ring})}};
    for (const auto& [name, scene] : scenes) {
        const ivec2 size{192, 192};
        const Image exact = truthOf(scene, size);
        const std::vector<ivec2> pixels = withinOutlines(scene, size, 2);
        for (const Method& method : kMethods) {
            const Errors errors = compare(trace(scene, size, kDirection, 0, method.settings), exact, pixels);
            std::cout << name << ", " << method.name << ": " << errors << "\n";
            EXPECT_GT(errors.compared, 1000);
            // Twice what was measured with llvmpipe: 0.37 to 1.03, between the bounds of all 4.2 and 5.1. The
            // thesis's differences (delta1, delta2) take a row's places for equally high, which they are not
            // in perspective.
            EXPECT_LE(errors.median, method.settings.bounds == Extent::Global ? 10 : 2) << method.name;
        }
    }
}

} // namespace
} // namespace lucent::refract
