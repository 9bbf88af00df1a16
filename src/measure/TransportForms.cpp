// Known answers of light off matt surfaces, through glass and onto floors, and inside of bodies, as pictures
// of a thousand pixels.
#include "measure/SelfCheck.h"

#include "frame/Renderer.h"
#include "technique/Technique.h"

#include <algorithm>
#include <cmath>

namespace lucent::measure {

namespace {

using scene::Aov;
using scene::Scene;

constexpr int kSide = 32; // of the pictures

// --- scenes

scene::Object objectOf(scene::Shape shape, vec3 place = vec3(0)) {
    scene::Object object;
    object.shape = std::move(shape);
    object.material.diffuse = vec3(1);
    object.transform.translate = place;
    return object;
}

scene::Object glassOf(scene::Shape shape, float ior, vec3 place = vec3(0)) {
    scene::Object object = objectOf(std::move(shape), place);
    object.material.transmission = 1;
    object.material.ior = ior;
    return object;
}

// Seen along -y: column grows with x, row with z.
Scene sceneOf(std::vector<scene::Object> objects, float height) {
    Scene scene;
    scene.size = {kSide, kSide};
    scene.objects = std::move(objects);
    scene.camera.eye = {0, 4, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    for (const ParamTable* table : technique::tables())
        scene.technique.emplace(std::string(table->name), Settings(*table));
    return scene;
}

// Light of irradiance 1 on what faces it, which comes down at an angle from straight above, from +x.
void addSun(Scene& scene, double angle = 0) {
    scene.lights.push_back(
        scene::DistantLight{.direction = {float(-std::sin(angle)), float(-std::cos(angle)), 0}});
}

void addWhiteSphere(Scene& scene) {
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 1.0f);
    scene.environment.emplace().map = map;
}

dvec3 valueAt(const Image& image, ivec2 pixel) {
    const float* value = image.at(pixel.x, pixel.y);
    return {value[0], value[1], value[2]};
}

// All colours of all pixels.
void takeAll(Finding& finding, const Image& image, dvec3 expected) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int channel = 0; channel < 3; ++channel)
                finding.take(expected[channel], image.at(x, y)[channel]);
}

// --- matt surfaces

Finding mattSun(Studio& studio) {
    Finding finding;
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
        Scene scene = sceneOf({objectOf(scene::Plane{vec2(4)})}, 1);
        addSun(scene, glm::radians(degrees));
        takeAll(finding, studio.draw(scene, Aov::Irradiance), dvec3(std::cos(glm::radians(degrees))));
    }
    return finding;
}

Finding mattSphereAround(Studio& studio) {
    Scene scene = sceneOf({objectOf(scene::Plane{vec2(4)})}, 1);
    addWhiteSphere(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Color), dvec3(1)); // a white surface in white light
    return finding;
}

// Light falls past the edges of a block onto the floor: which pixels lie in its shadow is known.
Finding mattShadow(Studio& studio) {
    Scene scene = sceneOf({objectOf(scene::Plane{vec2(4)}), objectOf(scene::Box{vec3(0.5f)}, {0, 1, 0})}, 4);
    scene.objects[1].visible = false; // seen from above it would hide its shadow
    addSun(scene, std::atan(0.5)); // its top and bottom, 1.25 m and 0.75 m above, move by 0.625 m and 0.375 m
    const Image light = studio.draw(scene, Aov::Irradiance);
    Finding finding;
    const double pixel = 4.0 / kSide, cosine = std::cos(std::atan(0.5));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const dvec2 place = (dvec2(x, y) + 0.5 - 0.5 * kSide) * pixel;
            const dvec2 low(-0.25 - 0.625, -0.25), high(0.25 - 0.375, 0.25);
            const dvec2 outside = glm::max(low - place, place - high);
            const double away = std::max(outside.x, outside.y);
            if (std::abs(away) > 0.5 * pixel) finding.take(away < 0 ? 0 : cosine, valueAt(light, {x, y}).x);
        }
    return finding;
}

// --- glass

Finding glassOfIndexOne(Studio& studio) {
    Scene scene = sceneOf({glassOf(scene::Torus{0.7f, 0.25f}, 1), glassOf(scene::Sphere{0.4f}, 1)}, 2.2f);
    addWhiteSphere(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Color), dvec3(1));
    takeAll(finding, studio.draw(scene, Aov::Direction), {0, -1, 0});
    return finding;
}

Finding slabKeepsDirection(Studio& studio) {
    Scene scene = sceneOf({glassOf(scene::Box{{6, 0.2f, 6}}, 1.5f)}, 1);
    scene.objects[0].transform.rotate = {0, 0, 40};
    const Image direction = studio.draw(scene, Aov::Direction);
    Finding finding;
    for (int y = 0; y < kSide;
         ++y) // the way through is 5 cm to the side: near the border rays leave the view
        for (int x = 4; x < kSide - 4; ++x)
            for (int channel = 0; channel < 3; ++channel)
                finding.take(channel == 1 ? -1 : 0, direction.at(x, y)[channel]);
    return finding;
}

// In and out of the ball at angles i and t: the ray turns by 2 (i - t). Means over pixels: single ones meet
// the triangles of which the ball is made.
Finding ballBendsRays(Studio& studio) {
    Scene scene = sceneOf({glassOf(scene::Sphere{1}, 1.5f)}, 2);
    const Image direction = studio.draw(scene, Aov::Direction);
    double off = 0;
    int count = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const dvec2 place = (dvec2(x, y) + 0.5) * (2.0 / kSide) - 1.0;
            const double b = glm::length(place);
            if (b > 0.9) continue;
            const double turn = 2 * (std::asin(b) - std::asin(b / 1.5));
            const dvec2 inwards = -place / b * std::sin(turn);
            const dvec3 expected(inwards.x, -std::cos(turn), inwards.y);
            off += glm::degrees(2 * std::asin(0.5 * glm::distance(expected, valueAt(direction, {x, y}))));
            ++count;
        }
    Finding finding;
    finding.take(0, off / count);
    return finding;
}

Finding interfaces(Studio& studio) {
    Scene scene = sceneOf({glassOf(scene::Sphere{1}, 1.5f), glassOf(scene::Sphere{0.5f}, 1.2f)}, 2);
    const Image layers = studio.draw(scene, Aov::Layers);
    Finding finding;
    finding.take(4, valueAt(layers, ivec2(kSide / 2)).x);
    finding.take(2, valueAt(layers, {kSide / 2, 4}).x);
    finding.take(0, valueAt(layers, ivec2(0)).x);
    return finding;
}

// --- caustics

// 4 % are mirrored at each face of a slab of index 1.5 that light meets straight.
Finding lightThroughSlab(Studio& studio) {
    Scene scene =
        sceneOf({objectOf(scene::Plane{vec2(6)}), glassOf(scene::Box{{2, 0.2f, 2}}, 1.5f, {0, 1, 0})}, 1);
    scene.objects[1].visible = false; // the camera looks past it
    addSun(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Irradiance), dvec3(0.96 * 0.96));
    return finding;
}

Finding glassBallInTheSun(Studio& studio) {
    Scene scene =
        sceneOf({objectOf(scene::Plane{vec2(6)}), glassOf(scene::Sphere{0.5f}, 1, {0, 1, 0})}, 0.6f);
    scene.objects[1].visible = false;
    addSun(scene);
    const Image light = studio.draw(scene, Aov::Irradiance);
    double mean = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            mean += valueAt(light, {x, y}).x / (kSide * kSide);
    Finding finding;
    finding.take(1, mean);
    return finding;
}

// --- light inside

scene::Material marble() {
    scene::Material material; // Jensen et al. 2001, 1/m
    material.scattering = {2190, 2620, 3000};
    material.setAbsorption({2.1f, 4.1f, 7.1f});
    material.ior = 1.5f;
    return material;
}

// B over what enters is (a'/2) (1 + e^(-(4/3) A s)) e^-s with s = sqrt(3 (1 - a')), A = (1 + F_dr) / (1 -
// F_dr).
double leaving(double albedo) {
    constexpr double kLost = -1.440 / (1.5 * 1.5) + 0.710 / 1.5 + 0.668 + 0.0636 * 1.5; // F_dr at 1.5
    const double s = std::sqrt(3 * (1 - albedo)), a = (1 + kLost) / (1 - kLost);
    return albedo / 2 * (1 + std::exp(-4.0 / 3 * a * s)) * std::exp(-s);
}

Finding halfSpace(Studio& studio) {
    Scene scene = sceneOf({objectOf(scene::Plane{vec2(0.02f)})}, 0.002f);
    scene::Material& material = scene.objects[0].material;
    material = marble();
    material.scattering = {2000, 3000, 4000};
    material.setAbsorption(vec3(100)); // no colour goes farther than 1.3 mm: the plane is without end
    addSun(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Radiosity),
            0.96 * dvec3(leaving(20.0 / 21), leaving(30.0 / 31), leaving(40.0 / 41)));
    return finding;
}

// Two bodies touch, one of them in the other's shadow: no light goes over.
Finding noLeak(Studio& studio) {
    Scene scene = sceneOf(
        {objectOf(scene::Box{{0.02f, 0.01f, 0.02f}}), objectOf(scene::Box{{0.02f, 0.01f, 0.02f}})}, 0.05f);
    scene.objects[0].transform.translate = {0, 0.005f, 0};
    scene.objects[1].transform.translate = {0, -0.005f, 0};
    for (scene::Object& object : scene.objects)
        object.material = marble();
    scene.camera.eye = {0, -4, 0}; // sees the lower one
    scene.camera.height = 0.018f;
    addSun(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Radiosity), dvec3(0));
    return finding;
}

Finding brokenValues(Studio& studio) {
    Finding finding;
    finding.take(0, studio.brokenValues());
    return finding;
}

// --- the table

constexpr Tolerance kExact{0, "nothing is rounded"};
constexpr Tolerance kRounded{2e-6, "a dozen roundings of 6e-8, and normals of as much"};
constexpr Tolerance kDirections{0.005,
                                "256 directions stand for all: 0.5 % at any tilt, measured 0.2 % here"};
constexpr Tolerance kFacets{
    0.02, "degrees; the ball is of triangles 1.4 degrees wide, normals between them are linear"};
constexpr Tolerance kMap{0.002,
                         "the caustic map holds half floats: 0.1 % a store, and beams meet at its texels"};
constexpr Tolerance kUndisturbed{0.01, "rays past the ball's rim are cut at texels: 1 %"};
constexpr Tolerance kProfile{0.0025, "0.5 % of the brightest colour"};

constexpr Check kChecks[] = {
    {"Matt plane in the sun", "Irradiance is the cosine of the light's angle, from 0 to 85 degrees", kRounded,
     mattSun},
    {"Matt plane in white light", "A white surface in a white sphere is as bright as the sphere", kDirections,
     mattSphereAround},
    {"Shadow of a block", "Every pixel but those on its edge is dark inside and lit outside", kRounded,
     mattShadow},
    {"Glass of index 1", "Nothing is bent, nothing mirrored", kRounded, glassOfIndexOne},
    {"Slanted slab of glass", "Light leaves it in the direction in which it came", kRounded,
     slabKeepsDirection},
    {"Ball of glass", "A ray is turned by 2 (asin b - asin(b / 1.5)); mean distance in degrees", kFacets,
     ballBendsRays},
    {"Ball in a ball", "The middle of the picture has four interfaces, beside the inner ball two", kExact,
     interfaces},
    {"Light through a slab", "Each face lets 96 % pass: 0.9216 arrive on the floor", kMap, lightThroughSlab},
    {"Ball of index 1 in the sun", "The floor is lit as if nothing were there", kUndisturbed,
     glassBallInTheSun},
    {"Half space that scatters", "The share that leaves again, by the dipole's closed form", kProfile,
     halfSpace},
    {"Two bodies that touch", "No light goes over from one to the other", kExact, noLeak},
    {"No NaN, no infinity behind", "Values that are none, in all pictures so far", kExact, brokenValues},
};

} // namespace

std::span<const Check> transportForms() { return kChecks; }

} // namespace lucent::measure
