// Known answers of light off matt surfaces.
#include "measure/FormScenes.h"

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
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::brdf
