// Pictures of textured surfaces in closed form and against exact solutions.
#include "frame/Renderer.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"
#include "tests/support/Gl.h"
#include "tests/support/Misplaced.h"
#include "truth/Glass.h"
#include "views/Eye.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::brdf {
namespace {

using Texel = std::array<std::uint8_t, 4>;

std::shared_ptr<const scene::TextureImage> imageOf(ivec2 size, Encoding encoding,
                                                   const std::function<Texel(int, int)>& texel) {
    auto image = std::make_shared<scene::TextureImage>();
    image->size = size;
    image->encoding = encoding;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const Texel one = texel(x, y);
            image->texels.insert(image->texels.end(), one.begin(), one.end());
        }
    image->findLeast();
    return image;
}

// A ball with u around it and v from its top down, all four textures to be set.
scene::Mesh texturedBall() {
    scene::Mesh mesh = meshOf(scene::Sphere{0.5f}, 48);
    for (const vec3& p : mesh.positions)
        mesh.coordinates.emplace_back(std::atan2(p.z, p.x) / std::numbers::pi_v<float>,
                                      std::acos(std::clamp(2 * p.y, -1.0f, 1.0f)) /
                                          std::numbers::pi_v<float>);
    mesh.parts = {{"ball", 0, std::uint32_t(mesh.indices.size()), {}}};
    return mesh;
}

// The plane y = 0 of side 2: u to the right and v towards the eye, once from edge to edge.
scene::Mesh texturedPlane() {
    scene::Mesh mesh = meshOf(scene::Plane{{2, 2}});
    for (const vec3& p : mesh.positions)
        mesh.coordinates.emplace_back(0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z);
    mesh.parts = {{"plane", 0, std::uint32_t(mesh.indices.size()), {}}};
    return mesh;
}

struct TexturedTest : support::GlTest {
    scene::Scene scene;

    TexturedTest() {
        scene.size = {48, 48};
        technique::addSettings(scene);
    }
    scene::Object& add(const scene::Mesh& mesh, scene::MaterialKinds kind) {
        scene::Object object;
        object.name = "object " + std::to_string(scene.objects.size());
        object.shape = scene::MeshShape{
            .source = "a.mesh", .part = "", .mesh = std::make_shared<const scene::Mesh>(mesh)};
        object.material.diffuse = {1, 0.5f, 1};
        object.material.kind = std::move(kind);
        return scene.objects.emplace_back(std::move(object));
    }
    void lookDown() {
        scene.camera.eye = {0, 2, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 2;
    }
    // Bright above on one side, and dim elsewhere.
    void addSky() {
        auto map = std::make_shared<Image>(64, 32, 3);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    map->at(x, y)[c] =
                        0.3f + 2 * std::exp(-0.02f * float((x - 40) * (x - 40) + 2 * (y - 9) * (y - 9)));
        scene.environment.emplace().map = std::move(map);
    }
    Image picture() {
        frame::Renderer renderer(*context);
        const Status done = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(done.ok()) << done.error().message;
        return std::move(*renderer.read(scene, scene.view.show));
    }
    // Of the finished picture, whose pixels are means, where they are as the middle: away from edges.
    vec3 at(const Image& image, vec2 place) {
        const ivec2 pixel((place * 0.5f + 0.5f) * vec2(scene.size));
        const float* value = image.at(pixel.x, pixel.y);
        return {value[0], value[1], value[2]};
    }
    double misplaced(int samples) { return support::misplaced(scene, picture(), samples); }
};

TEST_F(TexturedTest, ColoursMultiplyTheMaterialInLinearLight) {
    scene::Mesh mesh = texturedPlane();
    // Two by two: white, middle grey; black, red.
    mesh.images = {imageOf({2, 2}, Encoding::Srgb, [](int x, int y) {
        const std::uint8_t left = y == 0 ? 255 : 0, right = y == 0 ? 128 : 255;
        return x == 0 ? Texel{left, left, left, 255}
                      : Texel{right, y == 0 ? right : left, y == 0 ? right : left, 255};
    })};
    scene::Textures& textures = mesh.parts[0].textures;
    textures.color = {.image = 0, .u = scene::Wrap::Clamp, .v = scene::Wrap::Clamp};
    lookDown();
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = std::numbers::pi_v<float>}};
    add(mesh, scene::Matt{});
    const Image image = picture();
    // Outside of the middles of texels a clamped texture is of one colour; upper left in the picture: u, v =
    // 0.
    const float grey = linearFromSrgb(128 / 255.0f);
    const auto expectColor = [&](vec2 place, vec3 color) {
        EXPECT_LT(glm::distance(at(image, place), color * vec3(1, 0.5f, 1)),
                  2e-3f) // half a code: drivers decode so
            << place.x << " " << place.y;
    };
    expectColor({-0.75f, -0.75f}, vec3(1));
    expectColor({0.75f, -0.75f}, vec3(grey));
    expectColor({-0.75f, 0.75f}, vec3(0));
    expectColor({0.75f, 0.75f}, vec3(1, 0, 0));
    // Between texels light is mixed, not codes: half way from white to black.
    EXPECT_NEAR(at(image, {-0.75f, 0.02f}).r, 0.48f, 0.02f);
}

TEST_F(TexturedTest, ANormalsSlopeTiltsTheSurface) {
    // x along u, y against v, which points to the eye here: up in the picture.
    const auto brightness = [&](Texel normal, vec3 direction) {
        scene::Mesh mesh = texturedPlane();
        mesh.images = {imageOf({1, 1}, Encoding::Linear, [&](int, int) { return normal; })};
        mesh.parts[0].textures.normal = {.image = 0};
        lookDown();
        scene.objects.clear();
        add(mesh, scene::Matt{});
        scene.lights = {
            scene::DistantLight{.direction = -direction, .irradiance = std::numbers::pi_v<float>}};
        return at(picture(), {0.3f, 0.2f}).r;
    };
    // (0.6, 0, 0.8) as 8 bits, against light from the right, from above the picture, from the eye.
    const Texel right{204, 128, 230, 255}, up{128, 204, 230, 255};
    const vec3 fromRight(1, 0, 0), fromUp(0, 0, -1), fromEye(0, 1, 0);
    EXPECT_NEAR(brightness(right, glm::normalize(fromRight + fromEye)), 1.4 / std::sqrt(2), 0.006); // 8 bits
    EXPECT_NEAR(brightness(up, glm::normalize(fromUp + fromEye)), 1.4 / std::sqrt(2), 0.006);
    EXPECT_NEAR(brightness(up, glm::normalize(-fromUp + fromEye)), 0.2 / std::sqrt(2), 0.006);
    EXPECT_NEAR(brightness(right, fromEye), 0.8, 0.004);
}

// A ball with all four textures, which repeat and mirror.
scene::Mesh fullBall() {
    scene::Mesh mesh = texturedBall();
    mesh.images = {imageOf({8, 4}, Encoding::Srgb,
                           [](int x, int y) {
                               return Texel{std::uint8_t(90 + 20 * x), std::uint8_t(60 * y + 60), 200, 255};
                           }),
                   imageOf({4, 4}, Encoding::Srgb,
                           [](int x, int y) {
                               return (x + y) % 4 ? Texel{0, 0, 0, 255} : Texel{255, 120, 0, 255};
                           }),
                   imageOf({4, 8}, Encoding::Linear,
                           [](int x, int y) {
                               return Texel{0, std::uint8_t(130 + 15 * y), std::uint8_t(80 * x), 255};
                           }),
                   imageOf({16, 16}, Encoding::Linear, [](int x, int y) {
                       return Texel{std::uint8_t(128 + 40 * std::sin(0.8 * x)),
                                    std::uint8_t(128 + 40 * std::cos(0.8 * y)), 240, 255};
                   })};
    scene::Textures& textures = mesh.parts[0].textures;
    textures.color = {.image = 0};
    textures.emission = {.image = 1, .u = scene::Wrap::Mirror};
    textures.roughness = {.image = 2, .u = scene::Wrap::Mirror, .v = scene::Wrap::Clamp};
    textures.normal = {.image = 3};
    textures.normalScale = 0.8f;
    return mesh;
}

TEST_F(TexturedTest, AllTexturesTogetherAreTheTruths) {
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.5f, 1.6f};
    scene.lights = {scene::PointLight{.position = {0.8f, 0.9f, 0.7f}, .intensity = 3},
                    scene::DistantLight{.direction = {1, -0.7f, -0.6f}, .irradiance = 2}};
    for (const scene::MaterialKinds& kind :
         {scene::MaterialKinds(scene::Matt{}),
          scene::MaterialKinds(scene::Glossy{.metallic = 1, .roughness = 0.9f})}) {
        scene.objects.clear();
        add(fullBall(), kind).material.base = vec3(0.3f);
        EXPECT_LE(misplaced(16), 0.01) << kind.index(); // the matrix' target for direct light
    }
}

scene::Displacement hills() {
    auto heights = std::make_shared<Image>(32, 32, 1);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            *heights->at(x, y) =
                0.5f + 0.4f * float(std::sin(std::numbers::pi * x / 8) * std::cos(std::numbers::pi * y / 16));
    return {.scale = 0.12f, .repeat = {1, 2}, .heights = std::move(heights)};
}

// Of a displaced surface each point has the coordinates of its foot.
TEST_F(TexturedTest, DisplacedSurfacesShowThemAll) {
    scene::Mesh ball = fullBall();
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        ball.colors.push_back(vec3(0.6f) + 0.8f * ball.positions[i]);
        ball.secondCoordinates.push_back({ball.coordinates[i].y, ball.coordinates[i].x + 0.3f});
    }
    scene::Textures& textures = ball.parts[0].textures;
    textures.vertexColors = textures.color.second = true;
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.5f, 1.9f};
    scene.lights = {scene::PointLight{.position = {0.8f, 0.9f, 0.7f}, .intensity = 3},
                    scene::DistantLight{.direction = {1, -0.7f, -0.6f}, .irradiance = 2}};
    const auto show = [&](scene::MaterialKinds kind) -> scene::Object& {
        scene.objects.clear();
        scene::Object& object = add(ball, std::move(kind));
        object.material.base = vec3(0.3f);
        object.displacement = hills();
        return object;
    };
    const scene::Glossy metal{.metallic = 1, .roughness = 0.9f};
    show(scene::Matt{});
    EXPECT_LE(misplaced(64), 0.01); // the matrix' target for direct light
    show(metal);
    EXPECT_LE(misplaced(64), 0.01);
    const Image shown = picture();
    std::get<scene::MeshShape>(show(metal).shape).textured = false;
    EXPECT_NE(picture().pixels, shown.pixels);
}

TEST_F(TexturedTest, ColoursOfVerticesAreLinearBetweenThem) {
    scene::Mesh mesh = texturedPlane();
    mesh.coordinates.clear(); // they need none
    for (const vec3& p : mesh.positions)
        mesh.colors.push_back({0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z, 1});
    mesh.parts[0].textures.vertexColors = true;
    lookDown();
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = std::numbers::pi_v<float>}};
    add(mesh, scene::Matt{});
    const Image image = picture();
    for (const vec2 place : {vec2(-0.75f, -0.5f), {0.25f, 0.75f}, {0.5f, 0.125f}}) {
        const vec2 middle = (glm::floor((place * 0.5f + 0.5f) * 48.0f) + 0.5f) / 48.0f; // of its pixel, [0,1]
        const vec3 wanted = vec3(middle, 1) * vec3(1, 0.5f, 1);
        EXPECT_LT(glm::distance(at(image, place), wanted), 2e-3f) << place.x << " " << place.y; // half floats
    }
    // Beside pictures both count.
    mesh = fullBall();
    for (const vec3& p : mesh.positions)
        mesh.colors.push_back(vec3(0.6f) + 0.8f * p);
    mesh.parts[0].textures.vertexColors = true;
    scene.objects.clear();
    add(mesh, scene::Matt{});
    EXPECT_LE(misplaced(16), 0.01);
}

TEST_F(TexturedTest, OneByTheSecondCoordinatesLiesThere) {
    scene::Mesh mesh = fullBall();
    for (const vec2& coordinate : mesh.coordinates)
        mesh.secondCoordinates.push_back({coordinate.y, coordinate.x + 0.3f});
    mesh.parts[0].textures.normal.second = true;
    mesh.parts[0].textures.color.second = true;
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.5f, 1.6f};
    scene.lights = {scene::PointLight{.position = {0.3f, 0.7f, 1.8f},
                                      .intensity = 3}}; // facets shade none of what is seen
    add(mesh, scene::Matt{});
    views::samplingOf(scene).pixelSamples = 1; // texels are about as large as pixels
    EXPECT_LE(misplaced(4), 0.01);
}

// A ball with holes over a plane, which is lit through them.
TEST_F(TexturedTest, HolesLetLightAndSightThrough) {
    scene::Mesh ball = fullBall();
    ball.images[0] = imageOf({8, 4}, Encoding::Srgb, [](int x, int y) {
        return Texel{200, 180, 90, std::uint8_t((x + y) % 2 ? 255 : 0)};
    });
    ball.parts[0].textures.cutoff = 0.5f;
    scene.size = {96, 96};
    views::samplingOf(scene).pixelSamples =
        1; // edges are everywhere, of which means would be known by noise alone
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.9f, 2.2f};
    add(ball, scene::Matt{});
    add(texturedPlane(), scene::Matt{}).transform.translate = {0, -0.6f, 0};
    scene.lights = {scene::PointLight{.position = {0.4f, 1.9f, 1.8f}, .intensity = 3}};
    EXPECT_LE(misplaced(64), 0.01);
    addSky();
    EXPECT_LE(misplaced(256), 0.02); // as in mirrors
    // Without them it is a closed ball: holes are no error of that size.
    const Image holed = picture();
    ball.parts[0].textures.cutoff = 0;
    std::get<scene::MeshShape>(scene.objects[0].shape).mesh = std::make_shared<const scene::Mesh>(ball);
    EXPECT_NE(picture().pixels, holed.pixels);
}

// Two sheets above a floor, each of which light and sight pass by a share of their own.
TEST_F(TexturedTest, BlendedSheetsLetTheirShareOfLightAndSightThrough) {
    const auto sheet = [&](std::uint8_t alpha, float height) {
        scene::Mesh mesh = texturedPlane();
        mesh.images = {imageOf({1, 1}, Encoding::Srgb, [&](int, int) { return Texel{0, 0, 0, alpha}; })};
        mesh.parts[0].textures.color = {.image = 0};
        mesh.parts[0].textures.cutoff = -1;
        add(mesh, scene::Matt{}).transform.translate = {0, height, 0};
    };
    lookDown();
    scene.camera.height = 1;
    views::samplingOf(scene).pixelSamples = 16;
    const vec3 down = glm::normalize(vec3(0.2f, -1, 0.3f));
    scene.lights = {scene::DistantLight{.direction = down, .irradiance = std::numbers::pi_v<float>}};
    add(texturedPlane(), scene::Matt{}).material.diffuse = vec3(1);
    sheet(102, 0.1f);
    sheet(153, 0.2f);
    const auto mean = [&] {
        const Image image = picture();
        double sum = 0;
        for (int y = 8; y < 40; ++y)
            for (int x = 8; x < 40; ++x)
                sum += double(image.at(x, y)[0]);
        return sum / (32 * 32);
    };
    // 0.6 and 0.4 pass, light that comes and light that is seen: 1,024 pixels of 16 samples know each to 0.5
    // %.
    EXPECT_NEAR(mean(), -double(down.y) * 0.6 * 0.6 * 0.4 * 0.4, 0.01 * 0.057);
    scene.lights = {scene::PointLight{.position = {0.1f, 1.9f, 0.2f}, .intensity = 9, .radius = 0.3f}};
    const double soft = mean();
    scene.objects.resize(1);
    EXPECT_NEAR(soft / mean(), 0.6 * 0.6 * 0.4 * 0.4, 0.01 * 0.057);
}

// Against the exact picture, which counts each path through it by its share.
TEST_F(TexturedTest, BlendedSurfacesAreAsExactAsOpaqueOnes) {
    scene::Mesh ball = fullBall();
    ball.images[0] = imageOf({8, 4}, Encoding::Srgb, [](int x, int y) {
        return Texel{200, 180, 90, std::uint8_t(60 + 20 * x + 10 * y)};
    });
    ball.parts[0].textures.cutoff = -0.8f;
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.9f, 2.2f};
    views::samplingOf(scene).pixelSamples = 16;
    add(ball, scene::Matt{});
    add(texturedPlane(), scene::Matt{}).transform.translate = {0, -0.6f, 0};
    scene.lights = {scene::PointLight{.position = {0.4f, 1.9f, 1.8f}, .intensity = 3}};
    EXPECT_LE(misplaced(1024), 0.01);
    addSky();
    EXPECT_LE(misplaced(1024), 0.01);
}

TEST_F(TexturedTest, TheEnvironmentIsSeenInWhatATextureMakesSmooth) {
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.3f, 0.5f, 1.6f};
    addSky();
    add(fullBall(), scene::Glossy{.metallic = 1, .roughness = 0.7f});
    EXPECT_LE(misplaced(256), 0.02); // as in mirrors
}

TEST_F(TexturedTest, MirrorsShowThem) {
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0.6f, 2.4f};
    addSky(); // which throws no caustics
    add(fullBall(), scene::Matt{}).transform.translate = {-0.55f, 0, 0};
    scene::Object& mirror = scene.objects.emplace_back();
    mirror.name = "mirror";
    mirror.shape = scene::Plane{{3, 3}};
    mirror.material.kind = scene::Mirror{};
    mirror.transform.translate = {0, -0.6f, 0};
    EXPECT_LE(misplaced(64), 0.02);
    scene.objects[0].displacement = hills();
    scene.objects[0].transform.scale = 0.8f;
    EXPECT_LE(misplaced(64), 0.02);
}

TEST_F(TexturedTest, TheyAreSeenThroughGlass) {
    scene::Mesh mesh = texturedPlane();
    mesh.images = fullBall().images;
    mesh.parts[0].textures.color = {.image = 0};
    mesh.parts[0].textures.normal = {.image = 3};
    lookDown();
    scene.size = {96, 96};
    scene.lights = {scene::PointLight{.position = {0.6f, 0.2f, 0.5f}, .intensity = 3}}; // below the pane
    add(mesh, scene::Matt{});
    scene::Object& pane = scene.objects.emplace_back();
    pane.name = "pane";
    pane.shape = scene::Box{{3, 0.05f, 3}};
    pane.material.kind = scene::Clear{.ior = 1.5f, .fresnel = false};
    pane.transform.translate = {0, 0.3f, 0};
    EXPECT_LE(misplaced(1), 0.02);
    scene.objects[0].displacement = hills();
    EXPECT_LE(misplaced(1), 0.02);
}

TEST_F(TexturedTest, CoordinatesFarOutsideFindTexelsAllTheSame) {
    scene::Mesh mesh = texturedPlane();
    for (vec2& coordinate : mesh.coordinates)
        coordinate = 1e30f * (coordinate - 0.3f);
    mesh.images = fullBall().images;
    lookDown();
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    for (const scene::Wrap wrap : {scene::Wrap::Repeat, scene::Wrap::Mirror, scene::Wrap::Clamp}) {
        mesh.parts[0].textures.color = {.image = 0, .u = wrap, .v = wrap};
        scene.objects.clear();
        add(mesh, scene::Matt{});
        const auto exact =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = 1});
        for (int i = 0; i < scene.size.x; ++i) {
            const dvec3 light = exact->solve({i, i}).value;
            EXPECT_TRUE(light.r >= 0 && light.r <= 1) << int(wrap) << " " << i;
        }
    }
}

// What textures say of a view is kept while surface and textures stay, and not a picture longer.
TEST_F(TexturedTest, PicturesOfOneRendererAreThoseOfAFreshOne) {
    scene::Mesh red = texturedBall();
    red.images = {imageOf({2, 1}, Encoding::Srgb, [](int x, int) {
        return x == 0 ? Texel{255, 40, 40, 255} : Texel{200, 200, 0, 255};
    })};
    red.parts[0].textures.color.image = 0;
    scene::Mesh blue = red;
    blue.images = {imageOf({1, 1}, Encoding::Srgb, [](int, int) { return Texel{40, 40, 255, 255}; })};
    scene.lights = {scene::DistantLight{.direction = {0, -1, -0.5f}, .irradiance = 3}};
    add(red, scene::Matt{});
    frame::Renderer renderer(*context);
    int revision = 0;
    const auto expectFresh = [&](const char* change) {
        const Status done = renderer.finish(scene, ++revision, scene.size);
        ASSERT_TRUE(done) << done.error().message;
        EXPECT_EQ(renderer.read(scene, scene.view.show)->pixels, picture().pixels) << change;
    };
    expectFresh("nothing");
    std::get<scene::DistantLight>(scene.lights[0]).direction = {1, -1, 0};
    expectFresh("the light");
    scene.camera.eye.x += 0.3f;
    expectFresh("the camera");
    scene.objects[0].material.kind = scene::Translucent{.scattering = vec3(1000), .absorption = vec3(1)};
    expectFresh("the kind of material");
    scene.objects[0].material.kind = scene::Matt{};
    expectFresh("the kind of material, back");
    std::get<scene::MeshShape>(scene.objects[0].shape).mesh = std::make_shared<const scene::Mesh>(blue);
    expectFresh("the mesh");
    addSky(); // in several slices
    expectFresh("the environment");
}

TEST_F(TexturedTest, WithoutTexturesItIsTheMaterialAlone) {
    scene.camera.eye = {0, 0, 2};
    scene.lights = {scene::DistantLight{}};
    scene::Mesh bare = texturedBall();
    add(bare, scene::Matt{});
    const Image expected = picture();
    scene.objects.clear();
    std::get<scene::MeshShape>(add(fullBall(), scene::Matt{}).shape).textured = false;
    EXPECT_EQ(picture().pixels, expected.pixels);
}

} // namespace
} // namespace lucent::brdf
