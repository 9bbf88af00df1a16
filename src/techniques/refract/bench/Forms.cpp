// Known answers of what is seen through glass.
#include "measure/FormScenes.h"

#include <cmath>

namespace lucent::refract {

namespace {

using namespace measure;
using scene::Aov;
using scene::Scene;

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

// --- the table

constexpr Tolerance kExact{0, "nothing is rounded"};
constexpr Tolerance kRounded{2e-6, "a dozen roundings of 6e-8, and normals of as much"};
constexpr Tolerance kFacets{
    0.02, "degrees; the ball is of triangles 1.4 degrees wide, normals between them are linear"};

constexpr Check kChecks[] = {
    {"Glass of index 1", "Nothing is bent, nothing mirrored", kRounded, glassOfIndexOne},
    {"Slanted slab of glass", "Light leaves it in the direction in which it came", kRounded,
     slabKeepsDirection},
    {"Ball of glass", "A ray is turned by 2 (asin b - asin(b / 1.5)); mean distance in degrees", kFacets,
     ballBendsRays},
    {"Ball in a ball", "The middle of the picture has four interfaces, beside the inner ball two", kExact,
     interfaces},
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::refract
