// Known answers of objects whose subsurface scattering is precomputed.
#include "measure/FormScenes.h"
#include "scene/Mesh.h"
#include "techniques/throughput/bench/Bench.h"

#include <cmath>

namespace lucent::throughput {

namespace {

using namespace measure;
using scene::Aov;
using scene::Scene;

// The dipole's integral over a plane (Jensen et al. 2001), of light from straight above.
dvec3 halfSpaceOf(const scene::Translucent& inside) {
    const double ior = double(inside.ior), entering = 1 - std::pow((ior - 1) / (ior + 1), 2);
    const double reflected = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
    const double a = (1 + reflected) / (1 - reflected);
    dvec3 leaving;
    for (int c = 0; c < 3; ++c) {
        const double scattering = double(inside.scattering[c]), absorption = double(inside.absorption[c]);
        const double albedo = scattering / (scattering + absorption), root = std::sqrt(3 * (1 - albedo));
        leaving[c] = entering * 0.5 * albedo * (1 + std::exp(-4.0 / 3 * a * root)) * std::exp(-root);
    }
    return leaving;
}

// Texels' light and that of vertices together, and none twice.
Finding halfSpace(Studio& studio) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(scene::meshOf(scene::Plane{vec2(0.016f)}, 24));
    Scene scene = sceneOf({objectOf(shape)}, 0.002f);
    scene.objects[0].material = bakedMarble();
    scene::Translucent& inside = scene.objects[0].material.translucent();
    inside.absorption = vec3(200); // no colour goes farther than 0.85 mm: the plane is without end
    settingsOf(scene).side = 128;
    addSun(scene);
    Finding finding;
    takeAll(finding, studio.draw(scene, Aov::Radiosity), halfSpaceOf(inside));
    return finding;
}

constexpr Tolerance kBake{0.01, "1 % of the light that falls in"};

constexpr Check kChecks[] = {
    {"Half space that is precomputed", "Close light and far light are the share that leaves again", kBake,
     halfSpace},
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::throughput
