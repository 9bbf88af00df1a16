#include "measure/Compose.h"

#include "base/JsonWriter.h"
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "measure/Metrics.h"
#include "measure/SubsurfaceTruth.h"
#include "measure/TruthModel.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"
#include "truth/Glass.h"
#include "truth/LightTracer.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

namespace lucent::measure {

namespace {

constexpr std::string_view kLamps[] = {"point", "spot", "distant", "area", "projector", "environment"};
constexpr std::string_view kBetween[] = {"nothing",      "matt box", "pierced mesh", "blended mesh",
                                         "relief 2.5 %", "mirror",   "glass ball",   "absorbing glass",
                                         "marble ball",  "water"};
constexpr std::string_view kReceivers[] = {
    "matt plane", "matt mesh",   "textured mesh",    "displaced mesh",      "relief 3 %",
    "relief 0",   "marble slab", "precomputed slab", "floor through glass", "floor in a mirror"};
constexpr int kSize = 64;                 // pixels a side
constexpr int kSamples = 512;             // of the truth, a pixel
constexpr int kSkySamples = 10240;        // where an environment shines: noise of a quarter of 1 %
constexpr std::int64_t kRays = 4'000'000; // of light, where it comes by way of glass or mirrors
constexpr int kCell = 5;                  // pixels a side over which caustics may lie where they like

scene::Object objectOf(const char* name, scene::Shape shape, vec3 place = vec3(0)) {
    scene::Object object;
    object.name = name;
    object.shape = std::move(shape);
    object.transform.translate = place;
    object.material.diffuse = {0.8f, 0.7f, 0.6f};
    return object;
}

scene::HeightField waves(float width, float heightScale) {
    auto heights = std::make_shared<Image>(64, 64, 1);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            *heights->at(x, y) = 0.5f + 0.3f * std::sin(0.31f * float(x)) * std::cos(0.23f * float(y) + 1);
    scene::HeightField field;
    field.width = width;
    field.heightScale = heightScale;
    field.heights = std::move(heights);
    return field;
}

scene::Object reliefOf(const char* name, float width, float heightScale, float depth, vec3 place = vec3(0)) {
    scene::Object relief = objectOf(name, waves(width, heightScale), place);
    relief.transform.rotate = {-90, 0, 0};
    relief.material.relief().depth = depth;
    return relief;
}

// Mean free paths of some millimetres: a few pixels.
void makeMarble(scene::Material& material) {
    material.kind = scene::Translucent{.scattering = {220, 260, 300}, .absorption = {0.2f, 0.4f, 0.7f}};
}

void makeGlass(scene::Material& material, vec3 absorption = vec3(0)) {
    material.kind = scene::Clear{.absorption = absorption};
}

// Light from a bright window above and a dim rest.
std::shared_ptr<const Image> windowMap() {
    auto map = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            std::fill_n(map->at(x, y), 3, y >= 3 && y < 10 && x >= 36 && x < 48 ? 8.0f : 0.3f);
    return map;
}

// Colours that go over into each other from texel to texel.
std::shared_ptr<const Image> projected() {
    auto image = std::make_shared<Image>(16, 16, 3);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (int c = 0; c < 3; ++c)
                image->at(x, y)[c] =
                    0.6f + 0.4f * std::sin(0.8f * float(x) + float(c)) * std::cos(0.6f * float(y));
    return image;
}

void addLamp(scene::Scene& scene, std::string_view lamp) {
    const vec3 place(0.5f, 2.5f, 0.3f);
    scene::SpotLight spot{
        .position = place, .direction = -place, .intensity = 20, .innerAngle = 16, .outerAngle = 22};
    if (lamp == "point")
        scene.lights.push_back(scene::PointLight{
            .position = place, .intensity = 20, .falloff = scene::LightFalloff::InverseSquare});
    else if (lamp == "spot")
        scene.lights.push_back(spot);
    else if (lamp == "projector") {
        spot.image = projected();
        spot.fov = 36;
        scene.lights.push_back(std::move(spot));
    } else if (lamp == "distant")
        scene.lights.push_back(scene::DistantLight{.direction = -place, .irradiance = 3, .angle = 3});
    else if (lamp == "area")
        scene.lights.push_back(scene::AreaLight{.corner = place - vec3(0.15f, 0, 0.15f),
                                                .edgeU = {0.3f, 0, 0},
                                                .edgeV = {0, 0, 0.3f},
                                                .radiance = 200});
    else if (lamp == "environment")
        scene.environment.emplace().map = windowMap();
}

// A plate whose picture's alpha says where something is: holes below a cutoff, a share of it below 0.
void pierce(scene::Object& object, float cutoff) {
    constexpr float kSide = 0.4f;
    constexpr int kTexels = 16;
    scene::Mesh mesh = meshOf(scene::Plane{{kSide, kSide}});
    for (const vec3& p : mesh.positions)
        mesh.coordinates.push_back(0.5f + 2.0f * vec2(p.x, p.z) / kSide);
    auto image = std::make_shared<scene::TextureImage>();
    image->size = {kTexels, kTexels};
    for (int i = 0; i < kTexels * kTexels; ++i) {
        const vec2 angle = 2 * std::numbers::pi_v<float> / kTexels * (vec2(i % kTexels, i / kTexels) + 0.5f);
        const float alpha = 0.5f - 0.25f * (std::cos(angle.x) + std::cos(angle.y));
        image->texels.insert(image->texels.end(), {255, 255, 255, std::uint8_t(std::lround(255 * alpha))});
    }
    image->findLeast();
    mesh.images = {std::move(image)};
    scene::Mesh::Part& part = mesh.parts.emplace_back();
    part.material = "plate";
    part.indexCount = std::uint32_t(mesh.indices.size());
    part.textures.color.image = 0;
    part.textures.cutoff = cutoff;
    object.material.kind = scene::Matt{}; // which shows textures
    object.shape = scene::MeshShape{
        .source = "plate.mesh", .part = "", .mesh = std::make_shared<const scene::Mesh>(std::move(mesh))};
}

void addBetween(scene::Scene& scene, std::string_view between) {
    const vec3 place(0.1f, 0.55f, 0.05f);
    if (between == "nothing") return;
    scene::Object object = objectOf("between", scene::Sphere{0.16f}, place);
    if (between == "matt box") object.shape = scene::Box{vec3(0.25f)};
    if (between == "pierced mesh") pierce(object, 0.35f);
    if (between == "blended mesh") pierce(object, -1);
    if (between == "relief 2.5 %") object = reliefOf("between", 0.4f, 0.05f, 0.01f, place);
    if (between == "mirror") {
        object.shape = scene::Box{{0.3f, 0.02f, 0.3f}};
        object.transform.rotate = {0, 0, 50};
        object.material.kind = scene::Mirror{vec3(0.9f)};
    }
    if (between == "glass ball") makeGlass(object.material);
    if (between == "absorbing glass") makeGlass(object.material, {1, 3, 8});
    if (between == "marble ball") makeMarble(object.material);
    if (between == "water") {
        object.shape = scene::Water{.size = {0.9f, 0.9f}, .amplitude = 0.006f, .wavelength = 0.3f};
        makeGlass(object.material);
        object.material.clear().ior = 1.33f;
    }
    object.visible = false;
    scene.objects.push_back(std::move(object));
}

// The eye looks along -z at a mirror so high above that neither its shadow nor its light falls on what is
// seen, and the mirror turns its view straight down.
void seeInMirror(scene::Scene& scene) {
    const float height = 9;
    scene::Object mirror = objectOf("mirror", scene::Plane{{1.1f, 1.5f}}, {0, height, 0});
    mirror.transform.rotate = {135, 0, 0};
    mirror.material.kind = scene::Mirror{vec3(0.9f)};
    scene.objects.push_back(std::move(mirror));
    scene.camera.eye = {0, height, 4};
    scene.camera.target = {0, height, 0};
    scene.camera.up = {0, 1, 0};
}

// Waves between two colours.
std::shared_ptr<const scene::TextureImage> wavyTexture(Encoding encoding, vec3 low, vec3 high) {
    constexpr int kTexels = 16;
    auto image = std::make_shared<scene::TextureImage>();
    image->size = {kTexels, kTexels};
    image->encoding = encoding;
    for (int i = 0; i < kTexels * kTexels; ++i) {
        const vec2 angle = 2 * std::numbers::pi_v<float> / kTexels * vec2(i % kTexels, i / kTexels);
        const vec3 share =
            0.5f + 0.5f * vec3(std::sin(angle.x), std::sin(angle.y), std::cos(angle.x - angle.y));
        for (int c = 0; c < 3; ++c)
            image->texels.push_back(std::uint8_t(std::lround(255 * glm::mix(low[c], high[c], share[c]))));
        image->texels.push_back(255);
    }
    image->findLeast();
    return image;
}

// A glossy ring whose colour, roughness, share of metal and normals are pictures.
void makeTextured(scene::Object& object) {
    scene::Mesh mesh = meshOf(scene::Torus{0.35f, 0.15f});
    for (const vec3& p : mesh.positions) {
        const float across = std::atan2(p.y, glm::length(vec2(p.x, p.z)) - 0.35f);
        mesh.coordinates.push_back(vec2(5 * std::atan2(p.z, p.x), 2 * across) /
                                   (2 * std::numbers::pi_v<float>));
    }
    mesh.images = {wavyTexture(Encoding::Srgb, vec3(0.5f), vec3(1)),
                   wavyTexture(Encoding::Linear, {0, 0.55f, 0}, {0, 1, 0.6f}),
                   wavyTexture(Encoding::Linear, {0.4f, 0.4f, 0.9f}, {0.6f, 0.6f, 1})};
    scene::Mesh::Part& part = mesh.parts.emplace_back();
    part.material = "ring";
    part.indexCount = std::uint32_t(mesh.indices.size());
    part.textures.color.image = 0;
    part.textures.roughness.image = 1;
    part.textures.normal.image = 2;
    object.shape = scene::MeshShape{
        .source = "ring.mesh", .part = "", .mesh = std::make_shared<const scene::Mesh>(std::move(mesh))};
    object.material.kind = scene::Glossy{.metallic = 1, .roughness = 0.95f, .ior = 2};
}

// A ring with hills that go on from tile to tile.
void displace(scene::Object& object) {
    object.shape = scene::Torus{0.35f, 0.12f};
    auto heights = std::make_shared<Image>(64, 64, 1);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const vec2 angle = 2 * std::numbers::pi_v<float> / 64 * (vec2(x, y) + 0.5f);
            *heights->at(x, y) = 0.5f + 0.4f * std::sin(angle.x) * std::cos(angle.y);
        }
    object.displacement =
        scene::Displacement{.scale = 0.06f, .repeat = {8, 3}, .heights = std::move(heights)};
}

bool isSlab(std::string_view receiver) { return receiver == "marble slab" || receiver == "precomputed slab"; }

void addReceiver(scene::Scene& scene, std::string_view receiver) {
    scene::Object object = objectOf("receiver", scene::Plane{{2, 2}});
    if (receiver == "matt mesh") object.shape = scene::Torus{0.35f, 0.15f};
    if (receiver == "textured mesh") makeTextured(object);
    if (receiver == "displaced mesh") displace(object);
    if (receiver == "relief 3 %") object = reliefOf("receiver", 1.3f, 0.08f, 0.039f);
    if (receiver == "relief 0") object = reliefOf("receiver", 1.3f, 0.08f, 1e-6f);
    if (isSlab(receiver)) {
        object.shape = scene::Box{{1, 0.2f, 1}};
        object.transform.translate.y = -0.1f;
        makeMarble(object.material);
        object.material.translucent().precomputed = receiver == "precomputed slab";
    }
    scene.objects.push_back(std::move(object));
    if (receiver == "floor through glass") {
        scene::Object pane = objectOf("pane", scene::Box{{1.4f, 0.05f, 1.4f}}, {0, 0.2f, 0});
        makeGlass(pane.material);
        scene.objects.push_back(std::move(pane));
    }
    if (receiver == "floor in a mirror") seeInMirror(scene);
}

bool bends(std::string_view between) {
    return between == "mirror" || between == "glass ball" || between == "absorbing glass" ||
           between == "water";
}

double targetOf(std::string_view between, std::string_view receiver) {
    if (isSlab(receiver)) return 0.03;
    if (receiver == "floor in a mirror") return 0.02;
    return bends(between) || receiver == "floor through glass" ? 0.02 : 0.01;
}

// What scatters and is not seen only stands in the way: its light on others is interreflection.
scene::Scene withBlackOccluders(scene::Scene scene) {
    for (scene::Object& object : scene.objects)
        if (!object.visible && object.material.isScattering()) {
            object.material = {};
            object.material.diffuse = vec3(0);
        }
    return scene;
}

Result<truth::Picture> solve(const scene::Scene& scene) {
    const std::atomic<bool> cancel = false;
    const TruthModel model = usualTruth(scene);
    const int samples = scene.environment && model != TruthModel::Dipole ? kSkySamples : kSamples;
    if (model == TruthModel::Light)
        return truth::traceLight(scene, scene.size,
                                 {.aov = scene::Aov::Color, .photons = kRays, .samples = samples}, {}, {},
                                 cancel);
    if (model == TruthModel::Dipole) {
        truth::DipoleOptions options = dipoleOptionsOf(scene);
        options.aov = scene::Aov::Color;
        options.samples = kSamples;
        const auto dipole = truth::DipoleEstimator::create(scene, scene.size, options);
        return dipole ? truth::render(*dipole, scene.size, {}, {}, cancel) : dipole.error();
    }
    using truth::PixelMean;
    const int places = technique::modelOf(scene).overPixels ? PixelMean::placesFor(samples) : 1;
    auto exact =
        truth::GlassEstimator::create(scene, PixelMean::sizeOf(scene.size, places), scene::Aov::Color,
                                      {.samples = PixelMean::samplesOf(samples, places)});
    if (!exact) return exact.error();
    if (places == 1) return truth::render(*exact, scene.size, {}, {}, cancel);
    const PixelMean mean(std::make_unique<const truth::GlassEstimator>(std::move(*exact)), 0, places);
    return truth::render(mean, scene.size, {}, {}, cancel);
}

} // namespace

std::span<const std::string_view> composeLamps() { return kLamps; }
std::span<const std::string_view> composeBetween() { return kBetween; }
std::span<const std::string_view> composeReceivers() { return kReceivers; }

scene::Scene composeScene(std::string_view lamp, std::string_view between, std::string_view receiver) {
    scene::Scene scene;
    scene.size = ivec2(kSize);
    scene.camera.eye = {0, 4, 0};
    scene.camera.up = {0, 0, -1};
    technique::addSettings(scene);
    addReceiver(scene, receiver);
    addBetween(scene, between);
    addLamp(scene, lamp);
    technique::drawAll(scene);
    // As people see it: each sample of a pixel has other directions, and other thresholds of what is partly
    // there.
    if ((scene.environment || between == "blended mesh") && usualTruth(scene) == TruthModel::Glass)
        views::samplingOf(scene).pixelSamples = views::Sampling{}.pixelSamples;
    return scene;
}

ComposeCell measureCompose(gl::Context& context, std::string_view lamp, std::string_view between,
                           std::string_view receiver) {
    ComposeCell cell{
        .lamp = std::string(lamp), .between = std::string(between), .receiver = std::string(receiver)};
    cell.target = targetOf(between, receiver);
    const scene::Scene scene = composeScene(lamp, between, receiver);
    frame::Renderer renderer(context);
    const auto start = std::chrono::steady_clock::now();
    if (Status drawn = renderer.finish(scene, 1, scene.size); !drawn) {
        cell.message = drawn.error().message;
        return cell;
    }
    Result<Image> picture = renderer.read(scene, scene::Aov::Color);
    cell.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const scene::Scene solved = withBlackOccluders(scene);
    Result<truth::Picture> exact = solve(solved);
    if (!picture || !exact) {
        cell.message = picture ? exact.error().message : picture.error().message;
        return cell;
    }
    const bool spread = bends(between) || receiver == "floor through glass" || isSlab(receiver);
    const FluxErrors errors = compareFlux(*picture, exact->values, exact->errors, spread ? kCell : 1);
    double drawn = 0, wanted = 0;
    for (std::size_t i = 0; i < picture->pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        drawn += double(picture->pixels[i]);
        wanted += double(exact->values.pixels[i]);
    }
    cell.misplaced = errors.misplaced;
    cell.byNoise = errors.byNoise;
    cell.flux = drawn / wanted;
    cell.picture = std::move(*picture);
    cell.truth = std::move(exact->values);
    return cell;
}

std::string composeJson(std::span<const ComposeCell> cells) {
    JsonWriter json;
    json.beginObject().key("cells").beginArray();
    for (const ComposeCell& cell : cells) {
        json.beginObject().key("lamp").value(cell.lamp).key("between").value(cell.between);
        json.key("receiver").value(cell.receiver);
        if (!cell.message.empty()) json.key("message").value(cell.message);
        if (cell.isMeasured()) {
            json.key("misplaced").value(cell.misplaced).key("byNoise").value(cell.byNoise);
            json.key("flux").value(cell.flux).key("target").value(cell.target).key("met").value(cell.isMet());
            json.key("seconds").value(cell.seconds);
        }
        json.end();
    }
    return json.end().end().text();
}

} // namespace lucent::measure
