// Known answers of bodies that have subsurface scattering.
#include "measure/FormScenes.h"
#include "scene/MaterialPresets.h"
#include "techniques/subsurface/bench/Bench.h"

#include <cmath>

namespace lucent::subsurface {

namespace {

using namespace measure;
using scene::Aov;
using scene::Scene;

Finding halfSpace(Studio& studio) {
    Scene scene = sceneOf({objectOf(scene::Plane{vec2(0.02f)})}, 0.002f);
    scene::Material& material = scene.objects[0].material;
    material = marble();
    material.translucent().scattering = {2000, 3000, 4000};
    material.translucent().absorption =
        vec3(100); // no colour goes farther than 1.3 mm: the plane is without end
    addSun(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Radiosity), radiosityOfHalfSpace(material));
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

// --- the table

constexpr Tolerance kExact{0, "nothing is rounded"};
constexpr Tolerance kProfile{0.0025, "0.5 % of the brightest colour"};

constexpr Check kChecks[] = {
    {"Half space that scatters", "The share that leaves again, by the dipole's closed form", kProfile,
     halfSpace},
    {"Two bodies that touch", "No light goes over from one to the other", kExact, noLeak},
};

} // namespace

scene::Material marble() {
    scene::Translucent inside;
    for (const scene::MaterialPreset& preset : scene::materialPresets())
        if (preset.name == "marble") apply(preset, inside);
    scene::Material material;
    material.kind = inside;
    return material;
}

dvec3 radiosityOfHalfSpace(const scene::Material& material) {
    const scene::Translucent& inside = material.translucent();
    const double ior = double(inside.ior);
    const double entering = 1 - std::pow((ior - 1) / (ior + 1), 2);
    const double reflected = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior; // Fresnel's, diffuse
    const double a = (1 + reflected) / (1 - reflected);
    const dvec3 absorption(inside.absorption);
    dvec3 leaving;
    for (int c = 0; c < 3; ++c) {
        const double scattering = double(inside.scattering[c]) * (1 - double(inside.anisotropy));
        const double albedo = scattering / (scattering + absorption[c]);
        const double root = std::sqrt(3 * (1 - albedo));
        leaving[c] = entering * 0.5 * albedo * (1 + std::exp(-4.0 / 3 * a * root)) * std::exp(-root);
    }
    return leaving;
}

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::subsurface
