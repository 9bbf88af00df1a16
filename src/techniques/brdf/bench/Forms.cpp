// Known answers of light off matt and glossy surfaces.
#include "measure/FormScenes.h"
#include "techniques/brdf/Reflector.h"

#include <algorithm>
#include <cmath>

namespace lucent::brdf {

namespace {

using namespace measure;
using scene::Aov;
using scene::Scene;

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

scene::Object planeOf(scene::MaterialKinds kind, float diffuse) {
    scene::Object plane = objectOf(scene::Plane{vec2(4)});
    plane.material.diffuse = vec3(diffuse);
    plane.material.kind = std::move(kind);
    return plane;
}

// Light and view along the normal: F = ((n - 1) / (n + 1))², D = 1 / (pi m²), G = 1.
Finding glossyHighlight(Studio& studio) {
    Finding finding;
    for (const float roughness : {0.3f, 0.5f, 0.8f}) {
        const double square = std::pow(double(roughness), 4), mirrored = 0.04 / (4 * double(kPi) * square);
        for (const bool isGlossy : {true, false}) {
            scene::MaterialKinds kind = scene::CookTorrance{.roughness = roughness};
            if (isGlossy) kind = scene::Glossy{.roughness = roughness};
            Scene scene = sceneOf({planeOf(std::move(kind), 0)}, 1);
            addSun(scene);
            takeAll(finding, studio.draw(scene, Aov::Color), dvec3(mirrored));
        }
    }
    return finding;
}

Finding metalAround(Studio& studio) {
    Scene scene = sceneOf({planeOf(scene::Glossy{.metallic = 1, .roughness = 0}, 1)}, 1);
    addWhiteSphere(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Color), dvec3(1));
    return finding;
}

// What the furnace shows of each model, by the sum over four thousand directions of its lobe.
Finding glossAround(Studio& studio) {
    Finding finding;
    for (const scene::MaterialKinds& kind :
         {scene::MaterialKinds(scene::Glossy{.roughness = 0.8f}),
          scene::MaterialKinds(scene::Glossy{.metallic = 1, .roughness = 0.7f}),
          scene::MaterialKinds(scene::Phong{.exponent = 2}),
          scene::MaterialKinds(scene::Blinn{.exponent = 8}),
          scene::MaterialKinds(scene::OrenNayar{.roughness = 0.7f})}) {
        Scene scene = sceneOf({planeOf(kind, 0.5f)}, 1);
        addWhiteSphere(scene);
        takeAll(finding, studio.draw(scene, Aov::Color),
                dvec3(directionalAlbedo(scene.objects[0].material, 1)));
    }
    return finding;
}

// --- the table

constexpr Tolerance kRounded{2e-6, "a dozen roundings of 6e-8, and normals of as much"};
constexpr Tolerance kDirections{0.005,
                                "256 directions stand for all: 0.5 % at any tilt, measured 0.2 % here"};

constexpr Check kChecks[] = {
    {"Matt plane in the sun", "Irradiance is the cosine of the light's angle, from 0 to 85 degrees", kRounded,
     mattSun},
    {"Matt plane in white light", "A white surface in a white sphere is as bright as the sphere", kDirections,
     mattSphereAround},
    {"Shadow of a block", "Every pixel but those on its edge is dark inside and lit outside", kRounded,
     mattShadow},
    {"Highlight along the normal",
     "A glossy surface that faces lamp and eye shows F / (4 pi m²) of the light", kRounded, glossyHighlight},
    {"Smooth metal in white light",
     "A white metal in a white sphere is as bright as the sphere",
     {1e-3, "facets of a slope of 1e-3 stand for a smooth surface"},
     metalAround},
    {"Rough surfaces in white light", "Each model shows as much of an even sky as its lobe sums to",
     kDirections, glossAround},
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::brdf
