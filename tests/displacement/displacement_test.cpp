// Displaced surfaces in closed form and against exact solutions.
#include "frame/Renderer.h"
#include "scene/Displacement.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"
#include "tests/support/Gl.h"
#include "tests/support/Misplaced.h"
#include "truth/Optics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::displacement {
namespace {

using scene::DisplacementMethod;
constexpr float kPi = std::numbers::pi_v<float>;

std::shared_ptr<const Image> heightsOf(ivec2 size, const std::function<float(vec2)>& height) {
    auto map = std::make_shared<Image>(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            *map->at(x, y) = height((vec2(x, y) + 0.5f) / vec2(size));
    return map;
}

// Smooth, and the same at both ends of a tile.
std::shared_ptr<const Image> hills() {
    return heightsOf({64, 64}, [](vec2 t) {
        return 0.5f + 0.25f * std::sin(4 * kPi * t.x) +
               0.25f * std::cos(6 * kPi * t.y) * std::sin(2 * kPi * t.x);
    });
}
// One texel wide, on a plain.
std::shared_ptr<const Image> spikes() {
    return heightsOf({64, 64}, [](vec2 t) {
        const ivec2 texel(t * 64.0f);
        return texel.x % 8 == 4 && texel.y % 8 == 4 ? 1.0f : 0.05f;
    });
}
std::shared_ptr<const Image> cliffs() {
    return heightsOf({64, 64}, [](vec2 t) { return int(t.x * 4) % 2 == 1 ? 0.9f : 0.2f; });
}

// A plane of side 2 with a coordinate of its own.
scene::Mesh planeMesh(const std::function<vec2(vec2)>& coordinate) {
    scene::Mesh mesh = meshOf(scene::Plane{{2, 2}});
    for (const vec3& p : mesh.positions)
        mesh.coordinates.push_back(coordinate({0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z}));
    return mesh;
}

struct DisplacementTest : support::GlTest {
    scene::Scene scene;

    DisplacementTest() {
        scene.size = {60, 60};
        technique::addSettings(scene);
        scene.lights = {scene::DistantLight{.direction = {1, -1.2f, -0.5f}, .irradiance = 3}};
    }
    scene::Object& add(scene::Shape shape, std::shared_ptr<const Image> heights, float scale = 0.2f) {
        scene::Object& object = scene.objects.emplace_back();
        object.name = "object " + std::to_string(scene.objects.size());
        object.shape = std::move(shape);
        object.material.kind = scene::Matt{};
        object.displacement = scene::Displacement{.scale = scale, .heights = std::move(heights)};
        EXPECT_TRUE(scene::checkDisplacement(object).ok());
        return object;
    }
    scene::Object& addPlain(scene::Shape shape, vec3 place, scene::MaterialKinds kind = scene::Matt{}) {
        scene::Object& object = scene.objects.emplace_back();
        object.name = "object " + std::to_string(scene.objects.size());
        object.shape = std::move(shape);
        object.material.kind = std::move(kind);
        object.transform.translate = place;
        return object;
    }
    void lookFrom(vec3 eye) {
        scene.camera.type = scene::Camera::Type::Perspective;
        scene.camera.eye = eye;
        scene.camera.up = {0, 1, 0};
    }
    void lookDown() {
        scene.camera.eye = {0, 2, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 2;
    }
    Image picture(scene::Aov show = scene::Aov::Color) {
        scene.view.show = show;
        frame::Renderer renderer(*context);
        const Status done = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(done.ok()) << done.error().message;
        scene.view.show = scene::Aov::Color;
        return std::move(*renderer.read(scene, show));
    }
    // Depths along the view that rays meet exactly; below 0: nothing.
    std::vector<double> exactDepths() {
        const auto optics = truth::Optics::create(scene);
        const truth::Eye eye(scene.camera, scene.size);
        const dvec3 forward = glm::normalize(dvec3(scene.camera.target) - dvec3(scene.camera.eye));
        std::vector<double> depths;
        for (int y = 0; y < scene.size.y; ++y)
            for (int x = 0; x < scene.size.x; ++x) {
                const truth::Ray ray = eye.ray(ivec2(x, y));
                const auto hit = optics->rays().intersect(
                    {.origin = ray.anchor + ray.offset,
                     .direction = ray.direction,
                     .begin = eye.isPerspective() ? 0 : -std::numeric_limits<double>::infinity()});
                depths.push_back(hit ? glm::dot(hit->position - dvec3(scene.camera.eye), forward) : -1);
            }
        return depths;
    }
    // Pixels whose depth is farther from the exact one than `apart` [m], those included that show something
    // on one side only; without the border of what is seen, where rounding decides.
    struct Compared {
        int pixels = 0, wrong = 0;
        double worst = 0; // of the others, m
    };
    Compared compareDepths(double apart) {
        const Image found = picture(scene::Aov::Depth);
        const std::vector<double> exact = exactDepths();
        Compared result;
        const auto at = [&](int x, int y) { return exact[std::size_t(y * scene.size.x + x)]; };
        for (int y = 1; y + 1 < scene.size.y; ++y)
            for (int x = 1; x + 1 < scene.size.x; ++x) {
                const double here = at(x, y);
                bool isBorder = false;
                for (const ivec2 beside : {ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1)})
                    isBorder |= std::abs(at(x + beside.x, y + beside.y) - here) > 0.05;
                if (here < 0 || isBorder) continue;
                const double off = std::abs(double(found.at(x, y)[0]) - here);
                ++result.pixels;
                if (off > apart)
                    ++result.wrong;
                else
                    result.worst = std::max(result.worst, off);
            }
        return result;
    }
    double misplaced(int samples) { return support::misplaced(scene, picture(), samples); }
    double missShare(DisplacementMethod method, int searchSteps = 32) {
        scene.objects.front().displacement->method = method;
        scene.objects.front().displacement->searchSteps = searchSteps;
        const Image misses = picture(scene::Aov::Misses);
        double missed = 0, seen = 0;
        for (std::size_t i = 0; i + 3 < misses.pixels.size(); i += 4) {
            missed += double(misses.pixels[i]);
            seen += double(misses.pixels[i + 3]);
        }
        EXPECT_GT(seen, 500);
        return missed / seen;
    }
};

TEST_F(DisplacementTest, AConstantHeightIsAPlaneFoundInOneStep) {
    add(scene::Plane{{4, 4}}, heightsOf({4, 4}, [](vec2) { return 0.5f; }));
    lookDown();
    for (const DisplacementMethod method : {DisplacementMethod::Parallax, DisplacementMethod::Relief,
                                            DisplacementMethod::Interval, DisplacementMethod::Quadtree}) {
        scene.objects[0].displacement->method = method;
        scene.objects[0].displacement->searchSteps = 1;
        const Image depths = picture(scene::Aov::Depth);
        const float halves =
            method == DisplacementMethod::Relief ? 8 : 1; // 8 halvings, the middle of the last
        EXPECT_NEAR(depths.at(30, 30)[0], 1.9f, halves * 0.1f / 4096) << int(method);
        if (method == DisplacementMethod::Interval) { // begin, one step, one secant
            EXPECT_LE(picture(scene::Aov::Iterations).at(30, 30)[0], 3);
        }
    }
}

// Along a row of a bowl h = r² bilinear between texels: its chord lies above it by at most an eighth of a
// texel squared.
TEST_F(DisplacementTest, ABowlIsMetWhereItsEquationSays) {
    constexpr int kSide = 256;
    add(scene::Plane{{2, 2}},
        heightsOf({kSide, kSide},
                  [](vec2 t) {
                      const vec2 p = 2.0f * t - 1.0f;
                      return 0.5f * glm::dot(p, p);
                  }),
        1);
    lookDown();
    scene.camera.height = 1;
    const Image depths = picture(scene::Aov::Depth);
    for (int x = 0; x < scene.size.x; x += 7) {
        const double p = (x + 0.5) / scene.size.x - 0.5, q = 0.5 / scene.size.y;
        EXPECT_NEAR(depths.at(x, 30)[0], 2 - 0.5 * (p * p + q * q), 1.0 / (kSide * kSide) + 1e-5);
    }
}

TEST_F(DisplacementTest, TheQuadtreeIsExactOnPlaneSphereAndTorus) {
    lookFrom({0.4f, 1.4f, 1.9f});
    const scene::Shape shapes[] = {scene::Plane{{2, 2}}, scene::Sphere{0.6f}, scene::Torus{0.6f, 0.25f}};
    for (const scene::Shape& shape : shapes) {
        scene.objects.clear();
        scene::Object& object = add(shape, hills(), 0.15f);
        object.displacement->repeat = {2, 1};
        const Compared compared = compareDepths(0.15 / 4096);
        EXPECT_GT(compared.pixels, 500);
        EXPECT_EQ(compared.wrong, 0) << shape.index() << ", worst of the others " << compared.worst;
    }
}

TEST_F(DisplacementTest, GrazingViewsFindTheSameHills) {
    scene.camera.eye = {0, 2 * std::sin(0.1f * kPi / 180), 2 * std::cos(0.1f * kPi / 180)}; // 89.9 degrees
    scene.camera.height = 0.5f;
    add(scene::Plane{{2, 2}}, hills(), 0.2f);
    const Compared compared = compareDepths(0.2 / 1024); // hills lie ten times as slanting
    EXPECT_GT(compared.pixels, 300);
    EXPECT_LE(compared.wrong, compared.pixels / 200) << compared.worst; // crests that rays only touch
}

TEST_F(DisplacementTest, SpikesAreMissedByStepsAndNotByTheQuadtree) {
    lookFrom({0, 0.9f, 2});
    add(scene::Plane{{2, 2}}, spikes(), 0.3f);
    EXPECT_EQ(missShare(DisplacementMethod::Quadtree), 0);
    EXPECT_GT(missShare(DisplacementMethod::Interval, 8), 0.01);
    EXPECT_LT(missShare(DisplacementMethod::Interval, 512), missShare(DisplacementMethod::Interval, 8));
    scene.objects[0].displacement->method = DisplacementMethod::Quadtree;
    const Compared compared = compareDepths(0.3 / 4096);
    EXPECT_EQ(compared.wrong, 0) << compared.worst;
}

TEST_F(DisplacementTest, CliffsDoNotStallTheSecants) {
    lookFrom({0.9f, 1.2f, 1.7f});
    add(scene::Plane{{2, 2}}, cliffs(), 0.3f).displacement->refineSteps = 24;
    EXPECT_LT(missShare(DisplacementMethod::Interval, 256), 0.005);
    EXPECT_LT(missShare(DisplacementMethod::Relief, 256), 0.005);
}

TEST_F(DisplacementTest, MirroredAndSlantedCoordinatesKeepTheirTriangles) {
    lookFrom({0.4f, 1.4f, 1.9f});
    for (const auto& coordinate :
         {std::function<vec2(vec2)>([](vec2 t) { return vec2(1 - t.x, t.y); }),
          std::function<vec2(vec2)>([](vec2 t) { return vec2(t.y, 3 * t.x + 0.3f); }),
          std::function<vec2(vec2)>([](vec2 t) { return vec2(t.x, 7.25f); })}) {
        scene.objects.clear();
        auto mesh = std::make_shared<const scene::Mesh>(planeMesh(coordinate));
        add(scene::MeshShape{.source = "a.mesh", .part = "", .mesh = mesh}, hills(), 0.15f);
        EXPECT_EQ(compareDepths(0.15 / 4096).wrong, 0);
    }
}

TEST_F(DisplacementTest, ATriangleWithoutAreaIsLeftOut) {
    lookFrom({0.4f, 1.4f, 1.9f});
    scene::Mesh mesh = planeMesh([](vec2 t) { return t; });
    mesh.indices.insert(mesh.indices.end(), {0, 1, 1});
    add(scene::MeshShape{.source = "a.mesh", .part = "", .mesh = std::make_shared<const scene::Mesh>(mesh)},
        hills(), 0.15f);
    EXPECT_EQ(scene::baseOf(scene.objects[0])->triangles.size(), 2u);
    EXPECT_EQ(compareDepths(0.15 / 4096).wrong, 0);
}

TEST_F(DisplacementTest, ClosedBasesHaveNoWalls) {
    for (const scene::Shape& shape : {scene::Shape(scene::Sphere{1}), scene::Shape(scene::Torus{1, 0.3f})}) {
        scene.objects.clear();
        EXPECT_TRUE(scene::baseOf(add(shape, hills()))->closed) << shape.index();
    }
    scene.objects.clear();
    EXPECT_FALSE(scene::baseOf(add(scene::Plane{}, hills()))->closed);
}

// --- light

TEST_F(DisplacementTest, TheyShadeAndShadowThemselvesAndOthers) {
    lookFrom({0.3f, 1.1f, 2.2f});
    add(scene::Plane{{1.6f, 1.6f}}, hills(), 0.2f);
    addPlain(scene::Box{{0.3f, 0.6f, 0.3f}}, {0.2f, 0.2f, 0}); // stands in the hills
    EXPECT_LE(misplaced(16), 0.01);                            // the matrix' target for direct light
    scene.objects.clear();
    add(scene::Sphere{0.4f}, hills(), 0.1f).transform.translate = {0, 0.5f, 0};
    addPlain(scene::Plane{{4, 4}}, {0, -0.1f, 0});
    EXPECT_LE(misplaced(16), 0.01);
}

TEST_F(DisplacementTest, GlossyOnesMirrorTheLamp) {
    lookFrom({0.3f, 1.1f, 2.2f});
    add(scene::Torus{0.6f, 0.3f}, hills(), 0.05f).material.kind =
        scene::Glossy{.metallic = 1, .roughness = 0.6f};
    EXPECT_LE(misplaced(16), 0.02); // as in mirrors
}

TEST_F(DisplacementTest, TheyAreSeenInMirrors) {
    lookFrom({1.2f, 0.5f, 2});
    add(scene::Sphere{0.35f}, hills(), 0.1f).transform.translate = {0.2f, 0, 0};
    // Lit from behind: this estimator has no light that mirrors throw.
    addPlain(scene::Plane{{1.4f, 1.4f}}, {-0.5f, 0, 0}, scene::Mirror{}).transform.rotate = {0, 0, -90};
    scene.lights = {scene::DistantLight{.direction = {0.3f, -1, -0.6f}, .irradiance = 3}};
    EXPECT_LE(misplaced(16), 0.02);
}

TEST_F(DisplacementTest, TheyAreSeenThroughGlass) {
    scene.lights = {scene::PointLight{.position = {0.6f, 0.5f, 0.5f}, .intensity = 3}}; // below the pane
    add(scene::Plane{{2, 2}}, hills(), 0.2f);
    lookDown();
    addPlain(scene::Box{{3, 0.05f, 3}}, {0, 0.8f, 0}, scene::Clear{.ior = 1.5f, .fresnel = false});
    EXPECT_LE(misplaced(1), 0.02);
}

// Of glass the triangles of the surface are drawn: they say the same.
TEST_F(DisplacementTest, ClearOnesAreTheSameBody) {
    lookFrom({0.4f, 1.4f, 1.9f});
    add(scene::Sphere{0.6f}, hills(), 0.1f);
    const std::vector<double> cast = exactDepths();
    scene.objects[0].material.kind = scene::Clear{};
    const std::vector<double> cut = exactDepths();
    EXPECT_EQ(scene::openEdges(*scene::meshOf(scene.objects[0])), 0u);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < cast.size(); ++i)
        if (cast[i] > 0 && cut[i] > 0) {
            sum += std::abs(cast[i] - cut[i]);
            ++count;
        }
    EXPECT_GT(count, 500);
    EXPECT_LE(sum / count, 0.1 / 256);
}

} // namespace
} // namespace lucent::displacement
