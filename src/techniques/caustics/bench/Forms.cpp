// Known answers of light on a floor by way of glass.
#include "measure/FormScenes.h"

namespace lucent::caustics {

namespace {

using namespace measure;
using scene::Aov;
using scene::Scene;

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

// --- the table

constexpr Tolerance kMap{0.002,
                         "the caustic map holds half floats: 0.1 % a store, and beams meet at its texels"};
constexpr Tolerance kUndisturbed{0.01, "rays past the ball's rim are cut at texels: 1 %"};

constexpr Check kChecks[] = {
    {"Light through a slab", "Each face lets 96 % pass: 0.9216 arrive on the floor", kMap, lightThroughSlab},
    {"Ball of index 1 in the sun", "The floor is lit as if nothing were there", kUndisturbed,
     glassBallInTheSun},
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::caustics
