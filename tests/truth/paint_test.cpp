#include "truth/Paint.h"

#include "scene/Painting.h"
#include "tests/truth/bodies.h"
#include "truth/Dipole.h"
#include "truth/Walk.h"

#include <deque>

namespace lucent::truth {
namespace {

using test::fresnel;

constexpr double kPi = std::numbers::pi;
const double kEntering = 1 - fresnel(0, 1 / 1.5);
/// B over what enters evenly into a half space of marble, in closed form; see tests/diffusion.
constexpr double kHalfSpace[] = {0.8302, 0.7910, 0.7526};

std::shared_ptr<Image> evenMap(int side, vec4 value) {
    auto map = std::make_shared<Image>(side, side, 4);
    for (std::size_t i = 0; i < map->pixels.size(); ++i)
        map->pixels[i] = value[int(i % 4)];
    return map;
}

/// The same paint everywhere.
void paintEvenly(scene::Object& object, vec4 entering, vec4 leaving) {
    auto painting = std::make_shared<scene::Painting>();
    painting->entering = evenMap(64, entering);
    painting->leaving = evenMap(64, leaving);
    object.painting = painting;
}

scene::Scene painted(scene::Scene scene, vec4 entering, vec4 leaving = vec4(1)) {
    paintEvenly(scene.objects[0], entering, leaving);
    return scene;
}

/// Estimators refer to their scene: it is kept.
DipoleEstimator estimator(const scene::Scene& scene, const DipoleOptions& options) {
    static std::deque<scene::Scene> kept;
    Result<DipoleEstimator> made = DipoleEstimator::create(kept.emplace_back(scene), {8, 8}, options);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

Estimate radiosityAt(const DipoleEstimator& dipole, const dvec3& from, const dvec3& direction) {
    const Hit hit = test::intersect(dipole.bodies(), from, direction);
    return dipole.radiosity(*dipole.bodies().of(hit.shape), hit, 0);
}

Estimate onPlane(const scene::Scene& scene, const DipoleOptions& options, double x = 0.001) {
    return radiosityAt(estimator(scene, options), {x, 0.01, 0}, {0, -1, 0});
}

/// The marble sphere from the side that is lit.
scene::Scene litSphere() {
    scene::Scene scene = test::marbleSphere();
    scene.camera.eye = {0, 0, 1};
    scene.camera.height = 0.03f;
    return scene;
}

Picture walks(const scene::Scene& scene, const WalkOptions& options, ivec2 size = {4, 4}) {
    const std::atomic<bool> never = false;
    Result<Picture> picture = traceWalks(scene, size, options, {}, {.threads = 2}, never);
    EXPECT_TRUE(picture) << picture.error().message;
    return std::move(*picture);
}

TEST(Paint, OfOnesChangesNothingToTheBit) {
    const scene::Scene plain = litSphere(), ones = painted(litSphere(), vec4(1));
    for (const scene::Aov aov : {scene::Aov::Color, scene::Aov::Radiosity}) {
        const Pixel a = estimator(plain, {.aov = aov}).solve({3, 4});
        const Pixel b = estimator(ones, {.aov = aov}).solve({3, 4});
        EXPECT_GT(a.value.x, 0);
        EXPECT_EQ(a.value, b.value);
        EXPECT_EQ(a.variance, b.variance);
        EXPECT_EQ(walks(plain, {.aov = aov, .photons = 500}).values.pixels,
                  walks(ones, {.aov = aov, .photons = 500}).values.pixels);
    }
}

TEST(Paint, FactorsOfLightThatEntersAndLeavesAreFactors) {
    const auto pixel = [](vec4 entering, vec4 leaving, scene::Aov aov) {
        return estimator(painted(litSphere(), entering, leaving), {.aov = aov}).solve({3, 4}).value;
    };
    const dvec3 plain = pixel(vec4(1), vec4(1), scene::Aov::Radiosity);
    EXPECT_EQ(pixel({2, 4, 0, 1}, vec4(1), scene::Aov::Radiosity), plain * dvec3(2, 4, 0));
    EXPECT_EQ(pixel(vec4(1), {2, 4, 0, 1}, scene::Aov::Radiosity), plain * dvec3(2, 4, 0));
    // Half of it enters, half of that leaves.
    EXPECT_EQ(pixel(vec4(1), {1, 1, 1, 0.5f}, scene::Aov::Radiosity), plain * 0.25);
    const Picture once = walks(painted(litSphere(), vec4(1)), {.aov = scene::Aov::Radiosity, .photons = 500});
    const Picture twice =
        walks(painted(litSphere(), {2, 2, 2, 1}), {.aov = scene::Aov::Radiosity, .photons = 500});
    for (std::size_t i = 0; i < once.values.pixels.size(); ++i)
        EXPECT_EQ(twice.values.pixels[i], (i % 4 == 3 ? 1 : 2) * once.values.pixels[i]);
}

TEST(Paint, SharpnessKeepsTheLightOfAHalfSpace) {
    for (const float sharpness : {0.5f, 4.0f})
        for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
            const Estimate estimate = onPlane(painted(test::marbleHalfSpace(), {1, 1, 1, sharpness}),
                                              {.geometry = geometry, .samples = 4096});
            for (int c = 0; c < 3; ++c) {
                EXPECT_LT(estimate.standardError()[c], 3e-3);
                EXPECT_NEAR(estimate.mean()[c], kEntering * kHalfSpace[c],
                            4 * estimate.standardError()[c] + 5e-5);
            }
        }
}

TEST(Paint, SharpnessIsADenserMedium) {
    // Of the whole body, the scaled profile is that of scaled coefficients; twice is exact in floats.
    scene::Scene denser = litSphere();
    scene::Translucent& material = denser.objects[0].material.translucent();
    material.scattering *= 2;
    material.absorption *= 2;
    const scene::Scene sharp = painted(litSphere(), {1, 1, 1, 2});
    const double one =
        estimator(denser, {.aov = scene::Aov::Radiosity, .samples = 2048}).solve({4, 4}).value.x;
    const double other =
        estimator(sharp, {.aov = scene::Aov::Radiosity, .samples = 2048}).solve({4, 4}).value.x;
    EXPECT_NEAR(other / one, 1, 1e-5); // the same lines, and roundings
    const WalkOptions walk{.aov = scene::Aov::Radiosity, .photons = 2000};
    const Picture a = walks(denser, walk), b = walks(sharp, walk);
    EXPECT_NEAR(a.energy->absorbed.y / b.energy->absorbed.y, 1, 1e-5);
    EXPECT_NEAR(a.energy->escaped.y / b.energy->escaped.y, 1, 1e-5);
}

TEST(Paint, OpaqueSurfacesAreMatt) {
    scene::Scene scene = painted(litSphere(), vec4(1), {1, 1, 1, 0});
    scene.objects[0].material.diffuse = {0.5f, 0.25f, 0.75f};
    scene.objects[0].material.translucent().roughness = 0; // mirrors no lamp
    scene.camera.height = 0.001f;                          // its pole, where light comes from straight above
    for (int by = 0; by < 2; ++by) {
        dvec3 value;
        if (by == 0) {
            value = estimator(scene, {}).solve({4, 4}).value;
        } else {
            const Picture picture = walks(scene, {.photons = 500});
            const float* at = picture.values.at(2, 2);
            value = {at[0], at[1], at[2]};
            EXPECT_EQ(picture.energy->received, picture.energy->incident);
            EXPECT_EQ(picture.energy->escaped, dvec3(0));
        }
        for (int c = 0; c < 3; ++c) // the cosine is 0.9999 there
            EXPECT_NEAR(value[c], double(scene.objects[0].material.diffuse[c]) / kPi, 2e-4);
    }
    EXPECT_EQ(estimator(scene, {.aov = scene::Aov::Radiosity}).solve({4, 4}).value, dvec3(0));
}

TEST(Paint, LiesWhereItWasPaintedOnExactSpheresAndTori) {
    for (const bool ring : {false, true}) {
        scene::Object object = ring ? test::marble(scene::Torus{0.01f, 0.004f}, {1, 2, 3})
                                    : test::marble(scene::Sphere{0.01f}, {1, 2, 3});
        object.transform.rotate = {90, 0, 0};
        scene::Stroke fill;
        fill.brush.map = scene::PaintMap::Translucency;
        fill.brush.value = vec3(0);
        constexpr float kFar = std::numeric_limits<float>::infinity();
        fill.fill = scene::Stroke::Fill{{0, -kFar, -kFar}, {kFar, kFar, kFar}};
        const auto painting = scene::paint(object, {&fill, 1}, 256);
        ASSERT_TRUE(painting) << painting.error().message;
        object.painting = *painting;
        const auto surface = PaintedSurface::create(object, 0);
        ASSERT_TRUE(surface) << surface.error().message;
        for (int i = 0; i < 200; ++i) {
            const double a = 0.3 + i, b = 2.1 * i; // x stays an object's x: it turns about it
            const dvec3 out(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
            const dvec3 place = ring ? dvec3((0.01 + 0.004 * std::cos(b)) * std::cos(a), 0.004 * std::sin(b),
                                             (0.01 + 0.004 * std::cos(b)) * std::sin(a))
                                     : 0.01 * out;
            if (std::abs(place.x) < 5e-4) continue; // some texels from the edge
            // Turned by 90 degrees about x: y becomes z, z becomes -y.
            const dvec3 world = dvec3(1, 2, 3) + dvec3(place.x, -place.z, place.y);
            EXPECT_NEAR(surface->at(world).translucency, place.x > 0 ? 0 : 1, 1e-6) << ring << " " << i;
            EXPECT_EQ(surface->at(world).sharpness, 1);
        }
    }
}

/// The dipole on a plane by its formula, of one colour of marble.
double dipole(double scattering, double absorption, double r) {
    const double extinction = scattering + absorption, transport = std::sqrt(3 * absorption * extinction);
    const double internal = -0.64 + 0.71 / 1.5 + 0.668 + 0.0954, depth = 1 / extinction;
    double sum = 0;
    for (const double z : {depth, depth + 4 * (1 + internal) / (1 - internal) * depth / 3}) {
        const double d = std::hypot(r, z);
        sum += z * (transport + 1 / d) * std::exp(-transport * d) / (d * d);
    }
    return scattering / extinction * sum / (4 * kPi);
}

TEST(Paint, CheckerboardOnAPlaneIsItsIntegral) {
    constexpr int kSide = 64;
    scene::Scene scene = test::sceneOf({test::marble(scene::Plane{{0.02f, 0.02f}})});
    scene.lights.push_back(test::sun({0, -1, 0}));
    scene::Object& plane = scene.objects[0];
    auto painting = std::make_shared<scene::Painting>();
    auto entering = evenMap(kSide, vec4(1)), leaving = evenMap(kSide, vec4(1));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            if ((x / 8 + y / 8) % 2) {
                const float paint[] = {0.25f, 1.5f, 1, 3};
                std::copy(paint, paint + 4, entering->at(x, y));
                leaving->at(x, y)[3] = 0.5f;
            }
    painting->entering = entering;
    painting->leaving = leaving;
    plane.painting = painting;

    // The atlas of a rectangle is one chart: texels by the corners of a triangle.
    const auto atlas = scene::atlasOf(plane, kSide);
    ASSERT_TRUE(atlas);
    const scene::Mesh& mesh = *(*atlas)->mesh;
    const auto corner = [&](int i) { return mesh.indices[std::size_t(i)]; };
    const auto flat = [](vec3 p) { return dvec2(p.x, p.z); };
    const dvec2 origin = flat(mesh.positions[corner(0)]);
    const glm::dmat2 edges(flat(mesh.positions[corner(1)]) - origin,
                           flat(mesh.positions[corner(2)]) - origin);
    const dvec2 start((*atlas)->places[corner(0)]);
    const glm::dmat2 steps(dvec2((*atlas)->places[corner(1)]) - start,
                           dvec2((*atlas)->places[corner(2)]) - start);
    const glm::dmat2 texelFromPlane = steps * glm::inverse(edges);
    const auto read = [&](const Image& map, const dvec2& place, int channel) {
        const dvec2 at = start + texelFromPlane * (place - origin) - 0.5;
        const dvec2 low = glm::floor(at), part = at - low;
        const auto value = [&](double x, double y) {
            return double(
                map.at(std::clamp(int(x), 0, kSide - 1), std::clamp(int(y), 0, kSide - 1))[channel]);
        };
        return glm::mix(glm::mix(value(low.x, low.y), value(low.x + 1, low.y), part.x),
                        glm::mix(value(low.x, low.y + 1), value(low.x + 1, low.y + 1), part.x), part.y);
    };
    const DipoleEstimator found = estimator(scene, {.samples = 8192});
    for (const dvec2 to : {dvec2(0.0001, 0.0002), dvec2(0.0021, -0.0013)}) {
        dvec2 sum(0); // red and green, by the midpoint rule: squares a sixteenth of a mean free path wide
        constexpr int kCells = 800;
        constexpr double kWidth = 0.02 / kCells;
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const dvec2 from = -0.01 + kWidth * (dvec2(x, y) + 0.5);
                const double sharp = read(*entering, from, 3), r = sharp * glm::distance(from, to);
                const double factor = kEntering * kWidth * kWidth * sharp * sharp * read(*leaving, from, 3);
                sum.x += factor * read(*entering, from, 0) * dipole(2190, 2.1, r);
                sum.y += factor * read(*entering, from, 1) * dipole(2620, 4.1, r);
            }
        const Estimate estimate = radiosityAt(found, {to.x, 0.01, to.y}, {0, -1, 0});
        for (int c = 0; c < 2; ++c) {
            EXPECT_LT(estimate.standardError()[c], 0.01 * sum[c]);
            EXPECT_NEAR(estimate.mean()[c], sum[c], 4 * estimate.standardError()[c] + 5e-4 * sum[c]);
        }
    }
}

} // namespace
} // namespace lucent::truth
