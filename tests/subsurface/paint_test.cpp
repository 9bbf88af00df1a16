// Painted objects in whole pictures: closed forms and sums by brute force first, then where paint stays.
#include "frame/Renderer.h"
#include "scene/Painting.h"
#include "technique/Technique.h"
#include "techniques/subsurface/Subsurface.h"
#include "tests/support/Gl.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace lucent::frame {
namespace {

using subsurface::Method;

/// Absorbs so much that light reaches a few millimetres only: a small plane is a half space.
scene::Material dense() {
    scene::Material material;
    material.kind = scene::Translucent{.scattering = {2190, 2620, 3000},
                                       .absorption = {200, 200, 200},
                                       .roughness = 0}; // shows no lamp that is a point
    return material;
}

// Share of light that enters a surface of index 1.5 head-on.
constexpr double kEntering = 0.96;

struct Paint {
    vec4 entering{1}, leaving{1};
};
using PaintAt = std::function<Paint(vec3 place, vec3 normal)>; // in the object's space

constexpr int kSide = 256;

// Paints every texel that lies in a triangle of the atlas or within two texels of one, as its plane goes on.
std::shared_ptr<const scene::Painting> painted(const scene::Object& object, const PaintAt& paintAt,
                                               int side = kSide) {
    const auto atlas = scene::atlasOf(object, side);
    EXPECT_TRUE(atlas.ok()) << atlas.error().message;
    auto entering = std::make_shared<Image>(side, side, 4), leaving = std::make_shared<Image>(side, side, 4);
    std::fill(entering->pixels.begin(), entering->pixels.end(), 1.0f);
    std::fill(leaving->pixels.begin(), leaving->pixels.end(), 1.0f);
    std::vector<float> outside(std::size_t(side * side), std::numeric_limits<float>::max());
    const scene::Mesh& mesh = *(*atlas)->mesh;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        vec2 corners[3];
        vec3 places[3];
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = (*atlas)->places[mesh.indices[t + i]];
            places[i] = mesh.positions[mesh.indices[t + i]];
        }
        const vec2 u = corners[1] - corners[0], v = corners[2] - corners[0];
        const float area = u.x * v.y - u.y * v.x;
        const vec3 across = glm::cross(places[1] - places[0], places[2] - places[0]);
        if (area == 0 || across == vec3(0)) continue;
        const vec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]) - 2.0f;
        const vec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]) + 2.0f;
        for (int y = std::max(0, int(low.y)); y < std::min(side, int(high.y) + 1); ++y)
            for (int x = std::max(0, int(low.x)); x < std::min(side, int(high.x) + 1); ++x) {
                const vec2 at = vec2(x, y) + 0.5f - corners[0];
                const float b = (at.x * v.y - at.y * v.x) / area, c = (u.x * at.y - u.y * at.x) / area;
                const float away = std::max({0.0f, -b, -c, b + c - 1}) * std::sqrt(std::abs(area));
                float& nearest = outside[std::size_t(y * side + x)];
                if (away >= nearest || away > 3) continue;
                nearest = away;
                const Paint paint =
                    paintAt(places[0] + b * (places[1] - places[0]) + c * (places[2] - places[0]),
                            glm::normalize(across));
                for (int i = 0; i < 4; ++i) {
                    entering->at(x, y)[i] = paint.entering[i];
                    leaving->at(x, y)[i] = paint.leaving[i];
                }
            }
    }
    auto painting = std::make_shared<scene::Painting>();
    painting->entering = entering;
    painting->leaving = leaving;
    return painting;
}

std::shared_ptr<const scene::Painting> evenly(const Paint& paint) {
    auto painting = std::make_shared<scene::Painting>();
    auto entering = std::make_shared<Image>(16, 16, 4), leaving = std::make_shared<Image>(16, 16, 4);
    for (std::size_t i = 0; i < entering->pixels.size(); ++i) {
        entering->pixels[i] = paint.entering[int(i % 4)];
        leaving->pixels[i] = paint.leaving[int(i % 4)];
    }
    painting->entering = entering;
    painting->leaving = leaving;
    return painting;
}

Paint sharp(float times) { return {.entering = {1, 1, 1, times}}; }

struct Painted : support::GlTest {
    scene::Scene scene;

    Painted() {
        scene.size = {48, 48};
        scene.camera.eye = {0, 0, 1};
        scene.camera.height = 0.022f;
        technique::addSettings(scene);
        scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    }
    scene::Object& add(scene::Shape shape) {
        scene::Object object;
        object.name = "body " + std::to_string(scene.objects.size());
        object.shape = std::move(shape);
        object.material = dense();
        scene.objects.push_back(object);
        return scene.objects.back();
    }
    // In the picture's plane, lit head-on.
    scene::Object& addSheet(float width, float height) {
        scene.camera.height = height;
        scene::Object& sheet = add(scene::Plane{{width, width}});
        sheet.transform.rotate = {90, 0, 0};
        return sheet;
    }
    void shineAround(float intensity) {
        scene.environment.emplace();
        auto map = std::make_shared<Image>(8, 4, 3);
        for (std::size_t i = 0; i < map->pixels.size(); ++i)
            map->pixels[i] = 0.1f * float(i % 7);
        scene.environment->map = map;
        scene.environment->intensity = intensity;
    }
    subsurface::Settings& settings() {
        return *static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data());
    }
    Image picture(scene::Aov aov = scene::Aov::Radiosity) {
        Renderer renderer(*context);
        scene.view.show = aov;
        const Status drawn = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(drawn.ok()) << drawn.error().message;
        Result<Image> image = renderer.read(scene, aov);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
    std::string explained() {
        Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, scene.size);
        EXPECT_TRUE(text.ok()) << text.error().message;
        return *text;
    }
};

float atMiddle(const Image& image) { return image.at(image.width / 2, image.height / 2)[1]; }

// Sum of |a - b| over that of |b|, green.
double apart(const Image& a, const Image& b) {
    double difference = 0, sum = 0;
    for (std::size_t i = 1; i < a.pixels.size(); i += 4) {
        difference += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
        sum += std::abs(double(b.pixels[i]));
    }
    return difference / sum;
}

TEST_F(Painted, AnUnpaintedObjectRunsNoPassOfPaint) {
    add(scene::Sphere{0.01f});
    EXPECT_EQ(explained().find("views.paint"), std::string::npos);
    EXPECT_EQ(explained().find("brdf.shade"), std::string::npos);
    scene.objects[0].painting = evenly({});
    const std::string text = explained();
    EXPECT_NE(text.find("\n  views.paint: what is painted where light enters object \"body 0\""),
              std::string::npos);
    EXPECT_NE(text.find("\n  subsurface.matt:"), std::string::npos);
    EXPECT_NE(text.find("brdf: object \"body 0\" is painted"), std::string::npos);
    // Paint on what is opaque does nothing.
    scene.objects[0].material.kind = scene::Matt{};
    EXPECT_EQ(explained().find("views.paint"), std::string::npos);
}

TEST_F(Painted, ExplainNamesBlurThatDiffusionLeavesOut) {
    add(scene::Sphere{0.01f}).painting = evenly(sharp(2));
    const char* const line =
        "blur painted on object \"body 0\": method diffusion spreads light as the material says";
    EXPECT_EQ(explained().find(line), std::string::npos);
    settings().method = Method::Diffusion;
    settings().cells = 8;
    EXPECT_NE(explained().find(line), std::string::npos);
    scene.objects[0].painting = evenly({.entering = {2, 2, 2, 1}});
    EXPECT_EQ(explained().find(line), std::string::npos);
}

TEST_F(Painted, ALayerOfPaintNeedsNoLight) {
    add(scene::Sphere{0.01f}).painting =
        evenly({.entering = {0.5f, 1, 2, 0.25f}, .leaving = {1, 1, 1, 0.5f}});
    scene.view.paintLayer = scene::PaintLayer::Glow;
    const std::string text = explained();
    EXPECT_NE(text.find("\n  subsurface.layer:"), std::string::npos);
    for (const char* pass : {"subsurface.splat", "subsurface.flux", "subsurface.matt"})
        EXPECT_EQ(text.find(std::string("\n  ") + pass + ":"), std::string::npos) << pass;
    scene.lights.clear();
    const auto shown = [&](scene::PaintLayer layer) {
        scene.view.paintLayer = layer;
        const Image image = picture(scene::Aov::Color);
        const float* pixel = image.at(image.width / 2, image.height / 2);
        return vec3(pixel[0], pixel[1], pixel[2]);
    };
    EXPECT_EQ(shown(scene::PaintLayer::Glow), vec3(0.5f, 1, 2));
    EXPECT_EQ(shown(scene::PaintLayer::Translucency), vec3(0.5f));
    EXPECT_EQ(shown(scene::PaintLayer::Blur), vec3(0.75f)); // four times as far
    EXPECT_EQ(shown(scene::PaintLayer::Outgoing), vec3(1));
    EXPECT_EQ(shown(scene::PaintLayer::None), vec3(0));
}

TEST_F(Painted, OnesAreTheUnpaintedPictureBitForBit) {
    add(scene::Sphere{0.008f}).material.translucent().roughness = 0.4f;
    add(scene::Box{vec3(0.006f)}).transform = {.translate = {0.007f, 0.004f, 0.004f}, .rotate = {20, 30, 0}};
    scene::Object& floor = add(scene::Plane{{0.03f, 0.03f}});
    floor.material.kind = scene::Matt{};
    floor.transform = {.translate = {0, -0.009f, 0}, .rotate = {40, 0, 0}};
    scene.lights = {scene::DistantLight{.direction = {-0.3f, -0.6f, -0.5f}},
                    scene::PointLight{.position = {0.02f, 0.01f, 0.02f},
                                      .intensity = 3e-4f,
                                      .falloff = scene::LightFalloff::InverseSquare}};
    shineAround(0.5f);
    scene.size = {32, 32};
    settings().epsilon = 0.1f;
    struct Case {
        Method method;
        subsurface::DipoleGeometry geometry;
        diffusion::Shape profile;
    };
    const Case cases[] = {{Method::Multires, subsurface::DipoleGeometry::Planar, diffusion::Shape::Dipole},
                          {Method::Multires, subsurface::DipoleGeometry::Offset, diffusion::Shape::Dipole},
                          {Method::Splat, subsurface::DipoleGeometry::Planar, diffusion::Shape::Burley},
                          {Method::Diffusion, subsurface::DipoleGeometry::Planar, diffusion::Shape::Dipole}};
    for (const Case& one : cases) {
        settings().method = one.method;
        settings().dipoleGeometry = one.geometry;
        settings().profile = one.profile;
        settings().cells = 24;
        for (std::size_t i = 0; i < 2; ++i)
            scene.objects[i].painting = nullptr;
        const Image without = picture(scene::Aov::Color);
        scene.objects[0].painting = evenly({});
        EXPECT_EQ(picture(scene::Aov::Color).pixels, without.pixels) << int(one.method);
        scene.objects[1].painting = evenly({});
        EXPECT_EQ(picture(scene::Aov::Color).pixels, without.pixels) << int(one.method);
        EXPECT_GT(atMiddle(without), 0);
    }
}

TEST_F(Painted, BlurKeepsTheLightOfAHalfSpace) {
    // B/E = (a'/2)(1 + e^(-4/3 A s)) e^-s, s = sqrt(3 (1 - a')), knows no length. Light of M_d = 1/2 reaches
    // 10 mm, of 2 twice as close points are needed.
    const diffusion::Medium medium = diffusion::mediaOf(dense())[1];
    const double expected = kEntering * diffusion::totalReflectance(medium, diffusion::Shape::Dipole, 0);
    scene.size = {8, 8};
    settings().mostSplats = 512;
    for (const float sharpness : {0.5f, 2.0f}) {
        scene.objects.clear();
        addSheet(sharpness < 1 ? 0.05f : 0.016f, 0.0005f).painting = evenly(sharp(sharpness));
        for (const Method method : {Method::Splat, Method::Multires}) {
            settings().method = method;
            settings().blurEnergy = subsurface::BlurEnergy::Kept;
            const float kept = atMiddle(picture());
            EXPECT_NEAR(double(kept) / expected, 1, 0.01) << sharpness;
            settings().blurEnergy = subsurface::BlurEnergy::Paper;
            EXPECT_NEAR(atMiddle(picture()) * sharpness * sharpness / kept, 1, 1e-5) << sharpness;
        }
    }
}

TEST_F(Painted, BlurBeyondWhatPointsTellApartKeepsTheLightToo) {
    // Points stand eight times too far apart for the material itself, more so for M_d = 4.
    const double expected =
        kEntering * diffusion::totalReflectance(diffusion::mediaOf(dense())[1], diffusion::Shape::Dipole, 0);
    scene.size = {8, 8};
    settings().mostSplats = 32;
    addSheet(0.06f, 0.0005f);
    for (const float sharpness : {0.5f, 1.0f, 4.0f}) {
        scene.objects[0].painting = evenly(sharp(sharpness));
        EXPECT_NEAR(double(atMiddle(picture())) / expected, 1, 0.02) << sharpness;
    }
}

TEST_F(Painted, GlowScalesTheLightThatEnters) {
    add(scene::Sphere{0.008f});
    for (const Method method : {Method::Multires, Method::Splat, Method::Diffusion}) {
        settings().method = method;
        settings().cells = 24;
        scene.objects[0].painting = nullptr;
        const Image whole = picture();
        scene.objects[0].painting = evenly({.entering = {0.5f, 0.5f, 0.5f, 1}, .leaving = {1, 2, 0.5f, 1}});
        const Image glow = picture();
        for (std::size_t i = 0; i < whole.pixels.size(); i += 4) {
            // Powers of two: every sum of floats is the same but for its exponent.
            EXPECT_EQ(glow.pixels[i], 0.5f * whole.pixels[i]);
            EXPECT_EQ(glow.pixels[i + 1], whole.pixels[i + 1]);
            EXPECT_EQ(glow.pixels[i + 2], 0.25f * whole.pixels[i + 2]);
        }
    }
}

TEST_F(Painted, TranslucencyMixesWithTheMattSurface) {
    scene::Object& ball = add(scene::Sphere{0.008f});
    ball.material.diffuse = {0.7f, 0.5f, 0.3f};
    shineAround(0);
    const Image scattered = picture(scene::Aov::Color);
    ball.material.kind = scene::Matt{};
    const Image matt = picture(scene::Aov::Color);
    ball.material = dense();
    ball.material.diffuse = {0.7f, 0.5f, 0.3f};
    ball.painting = evenly({.leaving = {1, 1, 1, 0}});
    EXPECT_EQ(picture(scene::Aov::Color).pixels, matt.pixels);
    ball.painting = evenly({.leaving = {1, 1, 1, 0.5f}});
    const Image half = picture(scene::Aov::Color);
    // Half of the light enters, of which half is let out, beside half of the matt surface.
    for (std::size_t i = 0; i < half.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        EXPECT_NEAR(half.pixels[i], 0.25f * scattered.pixels[i] + 0.5f * matt.pixels[i], 1e-6);
    }
}

// Radiosity of a painted half space at a place of it, by the sum over points so dense that it is the
// integral.
double summed(dvec2 at, double half, const std::function<double(dvec2)>& glow,
              const std::function<double(dvec2)>& sharpness) {
    constexpr double kSpacing = 1e-4; // the dipole's first harmonic: 4 e^(-2 pi 0.34 mm / (2 * 0.1 mm)), 1e-4
    const diffusion::Medium medium = diffusion::mediaOf(dense())[1];
    double sum = 0;
    const int count = int(2 * half / kSpacing);
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
            const dvec2 from = (dvec2(x, y) + 0.5) * kSpacing - half;
            const double times = sharpness(from), r = times * glm::distance(at, from);
            if (r > 0.008) continue; // e^-11 of the light
            sum +=
                glow(from) * times * times * diffusion::reflectance(medium, diffusion::Shape::Dipole, 0, r);
        }
    return kEntering * sum * kSpacing * kSpacing;
}

TEST_F(Painted, ACheckerboardIsTheSumOverAllItsPoints) {
    // Figure 7.8: fields of 3 mm, more and more blurred; and one blurred side beside a sharp one.
    constexpr double kField = 0.003, kHalf = 0.012;
    const auto glow = [](dvec2 at) {
        return (int(std::floor(at.x / kField)) + int(std::floor(at.y / kField))) % 2 == 0 ? 1.0 : 0.2;
    };
    scene.size = {24, 24};
    settings().mostSplats = 512; // for M_d = 2
    addSheet(float(2 * kHalf), 0.012f);
    struct Case {
        double left, right;
    };
    for (const Case& one : {Case{1, 1}, Case{0.5, 0.5}, Case{0.25, 0.25}, Case{2, 0.25}}) {
        const auto sharpness = [&](dvec2 at) { return at.x < 0 ? one.left : one.right; };
        scene::Object& sheet = scene.objects[0];
        // The sheet's own z points down in the picture.
        sheet.painting = painted(
            sheet,
            [&](vec3 place, vec3) {
                const dvec2 at(place.x, -place.z);
                const auto value = float(glow(at));
                return Paint{.entering = {value, value, value, float(sharpness(at))}};
            },
            1024);
        for (const Method method : {Method::Multires, Method::Splat}) {
            settings().method = method;
            const Image image = picture();
            double most = 0, worst = 0;
            for (int y = 1; y < 24; y += 5)
                for (int x = 0; x < 24; x += 3) {
                    const dvec2 at = (dvec2(x + 0.5, 23.5 - y) / 24.0 - 0.5) * 0.012;
                    const double expected = summed(at, kHalf, glow, sharpness);
                    most = std::max(most, expected);
                    worst = std::max(worst, std::abs(double(image.at(x, y)[1]) - expected));
                }
            // The integral's own error, 1 %, and edges that lie up to half a texel of 0.024 mm beside, where
            // light changes by 1 in 1 mm.
            EXPECT_LT(worst / most, 0.02) << one.left << " " << one.right << " " << int(method);
        }
    }
}

TEST_F(Painted, PaintIsWhereItsPlaceIsSeenOverAllSeams) {
    // What leaves is painted by place: its share of the unpainted light tells where each pixel looked it up.
    const auto factor = [](vec3 p) { return vec3(0.5f) + 40.0f * p; };
    scene::Object& body = add(scene::Sphere{0.009f});
    for (const scene::Shape& shape :
         {scene::Shape(scene::Sphere{0.009f}), scene::Shape(scene::Box{vec3(0.01f)}),
          scene::Shape(scene::Torus{0.007f, 0.002f})}) {
        body.shape = shape;
        body.transform.rotate = {25, 35, 0};
        body.painting = nullptr;
        shineAround(1);
        settings().epsilon = 0.1f;
        const Image without = picture(), places = picture(scene::Aov::Position);
        body.painting = painted(body, [&](vec3 p, vec3) { return Paint{.leaving = vec4(factor(p), 1)}; });
        const Image with = picture();
        const mat3 objectFromWorld = glm::transpose(mat3(body.transform.worldFromObject()));
        double worst = 0;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 48; ++x) {
                if (!(without.at(x, y)[1] > 0)) continue;
                const vec3 world(places.at(x, y)[0], places.at(x, y)[1], places.at(x, y)[2]);
                const vec3 expected = factor(objectFromWorld * world);
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst,
                                     double(std::abs(with.at(x, y)[c] / without.at(x, y)[c] - expected[c])));
            }
        EXPECT_LT(worst, 0.02); // half a texel of 0.2 mm may lie beyond the plane of a triangle
    }
}

TEST_F(Painted, AWaveCarriesThePaintAlong) {
    scene::Object& body = add(scene::Sphere{0.006f});
    body.painting = painted(body, [](vec3 p, vec3) {
        return Paint{.entering = vec4(p.x < 0 ? 0.0f : 1.0f, 1, p.y < 0 ? 0.2f : 1.0f, 1)};
    });
    // So long that all of it moves alike, to the left by six pixels.
    body.wave = {
        .amplitude = {6 * 0.022f / 48, 0, 0}, .direction = {0, 0, 1}, .wavelength = 1e4f, .period = 1};
    const Image still = picture();
    scene.view.time = 0.25f;
    const Image moved = picture();
    Image back = still;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 42; ++x)
            for (int c = 0; c < 4; ++c)
                back.at(x + 6, y)[c] = moved.at(x, y)[c];
    for (int y = 0; y < 48; ++y)
        for (int x = 10; x < 42; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(back.at(x, y)[c], still.at(x, y)[c], 0.01); // points of another lattice: epsilon
    EXPECT_LT(still.at(14, 24)[0], 0.1f * still.at(34, 24)[0]);
}

TEST_F(Painted, AThinSheetHasTwoSides) {
    scene::Object& sheet = add(scene::Box{{0.02f, 0.02f, 0.0005f}});
    const Image front = picture();
    scene.lights = {scene::DistantLight{.direction = {0, 0, 1}}};
    const Image back = picture();
    EXPECT_GT(atMiddle(back), 0);
    // No light enters where the camera looks.
    sheet.painting =
        painted(sheet, [](vec3, vec3 n) { return Paint{.entering = vec4(vec3(n.z > 0.5f ? 0 : 1), 1)}; });
    const Image through = picture();
    for (int y = 10; y < 38; ++y)
        for (int x = 10; x < 38; ++x)
            EXPECT_NEAR(through.at(x, y)[1], back.at(x, y)[1], 1e-6);
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    EXPECT_EQ(atMiddle(picture()), 0);
    EXPECT_GT(atMiddle(front), 0);
}

// M_d from 1/8 to 4 over a body.
Paint variously(vec3 p) {
    const float along = glm::clamp(p.x / 0.008f, -1.0f, 1.0f);
    return {.entering = vec4(1, 1, p.y > 0 ? 1 : 0.3f, std::exp2(2.5f * along - 0.5f))};
}

TEST_F(Painted, BandsAddUpToTheWholeProfileAtEveryBlur) {
    scene::Object& body = add(scene::Sphere{0.008f});
    body.painting = painted(body, [](vec3 p, vec3) { return variously(p); });
    const Image bands = picture();
    settings().method = Method::Splat;
    const Image whole = picture();
    EXPECT_LT(apart(bands, whole), 0.01); // epsilon
    // Beside that of another picture: what is compared is no constant.
    body.painting = nullptr;
    EXPECT_GT(apart(picture(), whole), 0.05);
}

// The last one: another context stays behind.
TEST_F(Painted, WithoutFloatBlendingPaintIsGathered) {
    scene::Object& body = add(scene::Sphere{0.008f});
    body.painting = painted(body, [](vec3 p, vec3) { return variously(p); });
    scene.size = {24, 24};
    settings().epsilon = 0.1f;
    settings().mostSplats = 64;
    const Image splatted = picture();
    const std::string_view missing[] = {"EXT_float_blend"};
    const auto lesser = gl::Context::create(missing);
    ASSERT_TRUE(lesser.ok());
    gl::Context* const before = std::exchange(context, lesser->get());
    const Image gathered = picture();
    EXPECT_EQ(context->takeError(), "");
    context = before;
    EXPECT_LT(apart(gathered, splatted), 0.01); // sums rounded to 11 bits
}

} // namespace
} // namespace lucent::frame
