// Refraction where it is hard: each case with a number, and no direction that is none.
#include "tests/refract/Trace.h"
#include "views/Glass.h"

namespace lucent::refract {
namespace {

using test::glass;

constexpr ivec2 kSize{128, 128};

struct HardRefraction : Refraction {
    /// Pixels that were given up. Everywhere else there is a direction.
    int lostOf(const Image& image) {
        int lost = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.at(x, y)[3] == 0)
                    ++lost;
                else
                    EXPECT_NEAR(glm::length(rgb(image, {x, y})), 1, 1e-5) << x << " " << y;
            }
        return lost;
    }
    /// Against ray tracing in all pixels that see glass, outlines too.
    Errors against(const scene::Scene& scene, int border = 0) {
        const Image found = trace(scene, kSize);
        lostOf(found);
        const Errors errors = compare(found, truthOf(scene, kSize), withinOutlines(scene, kSize, border));
        std::cout << testing::UnitTest::GetInstance()->current_test_info()->name() << ": " << errors << "\n";
        return errors;
    }
};

scene::Object meshed(scene::Mesh mesh, float ior) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
    return glass(shape, ior);
}

TEST_F(HardRefraction, OutlinesStayBounded) {
    const Errors errors = against(seenFrom(3, {glass(scene::Sphere{1}, 1.5f)}));
    EXPECT_LE(errors.wrong, 0.01);
    EXPECT_EQ(errors.lost, 0);
}

TEST_F(HardRefraction, FortySurfacesAreCapped) {
    std::vector<scene::Object> balls;
    for (int i = 0; i < 20; ++i)
        balls.push_back(meshed(scene::meshOf(scene::Sphere{1 - 0.02f * float(i)}, 48), i % 2 ? 1.3f : 1.4f));
    const scene::Scene scene = seenFrom(3, balls);
    const Image layers = trace(scene, kSize, scene::Aov::Layers);
    EXPECT_EQ(layers.at(64, 64)[0], float(views::kMostLayers));
    EXPECT_LT(lostOf(trace(scene, kSize)), 128 * 128 / 4);
}

TEST_F(HardRefraction, FewerLayersThanSurfacesStillGiveADirection) {
    const scene::Scene scene = seenFrom(3, {glass(scene::Torus{0.8f, 0.35f}, 1.5f)});
    for (int layers = 1; layers <= 4; ++layers)
        lostOf(trace(scene, kSize, kDirection, layers));
}

TEST_F(HardRefraction, AnOpenSheetIsEnteredAndNeverLeft) {
    scene::Scene scene = seenStraight(1, {glass(scene::Plane{{1.4f, 1.4f}}, 1.5f)});
    scene.objects[0].transform.rotate = {90, 30, 0};
    const Image found = trace(scene, kSize);
    // Into glass at 30 degrees to the normal, asin(sin 30 / 1.5) behind it. Rays that leave the picture are
    // marked: within the depth of the scene, 1.3 m, they move 0.24 m or 31 pixels.
    const double expected = 30 - test::degrees(std::asin(std::sin(glm::radians(30.0)) / 1.5));
    for (int y = 0; y < 128; y += 9)
        for (int x = 36; x < 92; x += 5) {
            EXPECT_EQ(found.at(x, y)[3], 1) << x << " " << y;
            EXPECT_NEAR(test::degrees(test::angleBetween(rgb(found, {x, y}), dvec3(0, 0, -1))), expected,
                        1e-3);
        }
}

TEST_F(HardRefraction, ACupWithoutALidIsEnteredOftenerThanItIsLeft) {
    // A box without its upper side, seen from above: rays leave through sides they are inside of, and those
    // that go in by the hole are in nothing when they come to a side from within. Odd numbers of layers.
    scene::Mesh mesh = scene::meshOf(scene::Box{{1.2f, 1, 1.2f}});
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto isUp = [&](std::size_t k) { return mesh.normals[mesh.indices[i + k]].y > 0.9f; };
        if (!isUp(0)) kept.insert(kept.end(), &mesh.indices[i], &mesh.indices[i] + 3);
    }
    ASSERT_EQ(kept.size(), 30u);
    mesh.indices = kept;
    scene::Scene scene = seenFrom(3, {meshed(mesh, 1.5f)});
    scene.camera.eye = {0.7f, 2, 2.2f};
    const Errors errors = against(scene, 2);
    EXPECT_GT(errors.compared, 2000);
    EXPECT_LE(errors.median, 1e-3);
    EXPECT_LE(errors.p95, 0.1);
    EXPECT_LE(errors.wrong, 0.01);
}

TEST_F(HardRefraction, FacesInOnePlaneAreCrossedByTheMediumBehindThem) {
    // Ice that fills the upper half of water, four sides and the top in the same planes, and a block that
    // stands beside it: faces of two and of three objects in one place.
    const scene::Object water = glass(scene::Box{{1, 1, 1}}, 1.33f);
    const scene::Object ice = glass(scene::Box{{1, 0.5f, 1}}, 1.31f, {0, 0.25f, 0});
    const scene::Object beside = glass(scene::Box{{0.5f, 0.5f, 1}}, 1.6f, {0.75f, 0.25f, 0});
    scene::Scene scene = seenFrom(3, {water, ice, beside});
    scene.camera.eye = {0.6f, 0.8f, 3};
    const Errors errors = against(scene, 2);
    EXPECT_GT(errors.compared, 1500);
    EXPECT_LE(errors.median, 1e-3);
    EXPECT_LE(errors.p95, 0.1);
    EXPECT_LE(errors.wrong, 0.01);
}

TEST_F(HardRefraction, FlippedTrianglesAreCrossedAsTheyAre) {
    scene::Mesh mesh = scene::meshOf(scene::Sphere{1}, 64);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        std::swap(mesh.indices[i], mesh.indices[i + 1]);
    for (vec3& normal : mesh.normals)
        normal = -normal;
    // Leaving what the ray is not in changes nothing; it enters at the far side and stays inside.
    const Errors errors = against(seenFrom(3, {meshed(mesh, 1.5f)}), 2);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.p95, 2);
}

TEST_F(HardRefraction, TrianglesWithoutAreaChangeNothing) {
    scene::Mesh mesh = scene::meshOf(scene::Sphere{1}, 64);
    const Image plain = trace(seenFrom(3, {meshed(mesh, 1.5f)}), kSize);
    for (std::uint32_t i = 0; i + 2 < 300; i += 3)
        mesh.indices.insert(mesh.indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i]});
    EXPECT_EQ(trace(seenFrom(3, {meshed(mesh, 1.5f)}), kSize).pixels, plain.pixels);
}

TEST_F(HardRefraction, LightThatCannotLeaveIsMarked) {
    // From the middle of a cube towards a corner: all rays meet each side at more than 54.7 - 14.1 degrees,
    // and the critical angle of 2.4 is 24.6. The sides mirror them until they are given up or go where the
    // view does not see. Rays that go astray at an edge get out: measured 32 of 16384.
    scene::Scene scene = seenFrom(0, {glass(scene::Box{{1, 1, 1}}, 2.4f)}, 20);
    scene.camera.target = {1, 1, 1};
    EXPECT_GE(lostOf(trace(scene, kSize)), 0.996 * kSize.x * kSize.y);
    // With 1.2 the critical angle is 56.4, and the middle of the picture looks out.
    scene.objects[0].material.clear().ior = 1.2f;
    EXPECT_EQ(trace(scene, kSize).at(70, 60)[3], 1);
}

TEST_F(HardRefraction, TheEyeMayTouchTheGlass) {
    // 5 mm in front of a ball of 1 m; the near plane is a thousandth of the far one, 2.8 mm.
    const Errors errors = against(seenFrom(1.005f, {glass(scene::Sphere{1}, 1.5f)}), 2);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.wrong, 0.05);
}

TEST_F(HardRefraction, GlassAMillimetreFromTheEyeIsNotCut) {
    // Half of the near plane's distance for everything opaque, 1e-3 of 2 m; layers have one of their own.
    nearest = 1e-6f;
    const Errors errors = against(seenFrom(1.001f, {glass(scene::Sphere{1}, 1.5f)}), 2);
    EXPECT_GT(errors.compared, 5000);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.wrong, 0.05);
}

TEST_F(HardRefraction, AShellThinnerThanARoundingOfDepthsKeepsBothItsSurfaces) {
    // Ten micrometres of glass around air: a millionth of the way that light takes. What lies behind it is
    // seen where it is, but for rays that graze it.
    const scene::Object ball = glass(scene::Sphere{1}, 1.5f), hollow = glass(scene::Sphere{0.99999f}, 1);
    const Errors errors = against(seenFrom(3, {ball, hollow}), 2);
    EXPECT_GT(errors.compared, 5000);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.p95, 2);
}

TEST_F(HardRefraction, ABubbleMirrorsAllAtItsRim) {
    // Air of radius r in a block of glass. Light at h from the axis meets it under asin(h / r): up to h = r
    // / 1.5 it goes through, turned twice by asin(1.5 h / r) - asin(h / r) on its way and by the block's far
    // side; beyond, all of it is mirrored.
    const float r = 2;
    scene::Scene scene = seenStraight(7, {glass(scene::Box{{6, 6, 5}}, 1.5f), glass(scene::Sphere{r}, 1)});
    const Image found = trace(scene, kSize), exact = truthOf(scene, kSize);
    int mirrored = 0, through = 0, lost = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
            const double h = 7.0 / 128 * glm::distance(vec2(x, y) + 0.5f, vec2(64)) / double(r);
            if (h > 0.95 || std::abs(h - 1 / 1.5) < 0.03) continue; // grazing
            const bool isMirrored = h > 1 / 1.5;
            ++(isMirrored ? mirrored : through);
            if (found.at(x, y)[3] == 0) ++lost;
            const double turned = 2 * (std::asin(std::min(1.0, 1.5 * h)) - std::asin(h));
            const double leaves = 1.5 * std::sin(turned);
            const double off = test::degrees(test::angleBetween(rgb(found, {x, y}), dvec3(0, 0, -1)));
            if (!isMirrored && leaves < 0.95) {
                EXPECT_NEAR(off, test::degrees(std::asin(leaves)), 0.5) << x << " " << y;
            }
            if (isMirrored && exact.at(x, y)[3] == 1 && found.at(x, y)[3] == 1) {
                EXPECT_GT(off, 5) << x << " " << y;
            }
        }
    EXPECT_GT(mirrored, 1000);
    EXPECT_GT(through, 1000);
    const Errors errors = against(scene, 2);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.p95, 2);
    std::cout << lost << " of " << mirrored + through << " rays were given up\n";
}

TEST_F(HardRefraction, SidesWithHundredsOfTrianglesAPixelAreCrossed) {
    // Where a side is seen edge-on, all its 128 rows of cells lie in a few pixels. Walks of 64 triangles at
    // most end amid them: 0.9 % of the rays are wrong then.
    scene::Object block = glass(scene::Box{{2, 0.5f, 1.5f}}, 1.5f);
    block.transform.rotate = {25, 30, 0};
    block.wave = {.amplitude = {0, 0.12f, 0}, .direction = {1, 0, 0.4f}, .wavelength = 0.7f};
    scene::Scene scene = seenFrom(3, {block});
    scene.camera.eye = {0.4f, 0.5f, 3};
    const Errors errors = against(scene);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.wrong, 0.006);
}

TEST_F(HardRefraction, GlassThatAllButTouchesAFloorIsMetBeforeIt) {
    // A millimetre, a quarter of a pixel, lies between a cylinder's lower face, which mirrors all that comes
    // so flat, and the floor.
    scene::Scene scene = seenFrom(
        3, {test::matt(scene::Plane{{6, 6}}), glass(scene::Cylinder{0.36f, 0.95f}, 1.5f, {0, 0.476f, 0})},
        24);
    scene.camera.eye = {0, 1.25f, 2.9f};
    scene.camera.target = {0, 0.4f, 0};
    const Errors errors = against(scene, 2);
    EXPECT_GT(errors.compared, 2000);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.wrong, 0.001);
}

TEST_F(HardRefraction, ABallHalfOutsideThePictureIsRightWhereItIsShown) {
    // Half of the ball is outside: rays that leave the picture inside the glass are marked, the others are
    // right.
    scene::Scene scene = seenFrom(3, {glass(scene::Sphere{1}, 1.5f, {1.2f, 0, 0})});
    const Errors errors = against(scene, 2);
    EXPECT_LE(errors.median, 0.1);
    EXPECT_LE(errors.p95, 2);
    EXPECT_LE(errors.wrong, 0.01);
}

TEST_F(HardRefraction, TheScaleOfTheSceneDoesNotMatter) {
    const auto scaled = [](float scale) {
        scene::Scene scene = seenFrom(3 * scale, {glass(scene::Torus{0.8f * scale, 0.35f * scale}, 1.5f)});
        scene.objects[0].transform.rotate = {50, 0, 20};
        return scene;
    };
    const Image one = trace(scaled(1), kSize);
    std::vector<ivec2> pixels = withinOutlines(scaled(1), kSize, 2);
    for (const float scale : {1e-3f, 1e3f}) {
        const Errors errors = compare(trace(scaled(scale), kSize), one, pixels);
        std::cout << "scale " << scale << ": " << errors << "\n";
        EXPECT_LE(errors.median, 1e-3);
        EXPECT_LE(errors.p95, 0.05);
        EXPECT_LE(errors.wrong, 0.005);
    }
}

TEST_F(HardRefraction, MoreObjectsThanBitsAreRefused) {
    const views::Drawables many(views::kMostGlass + 1);
    const scene::Scene scene = seenFrom(3, {});
    const views::Eye eye = views::makeEye(seenFrom(3, {glass(scene::Sphere{1}, 1.5f)}), 1);
    const views::Layers layers;
    graph::FrameGraph graph;
    const Inputs in{.eye = eye,
                    .glass = many,
                    .layers = layers,
                    .opaque = {},
                    .solid = {},
                    .environment = graph::TextureHandle::None,
                    .light = nullptr,
                    .target = {},
                    .show = kDirection};
    const Status refused = Refract(*context).record(graph, in, kSize);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "refract: 32 refractive objects; must be at most 31");
}

} // namespace
} // namespace lucent::refract
