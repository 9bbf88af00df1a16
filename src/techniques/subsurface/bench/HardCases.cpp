#include "techniques/subsurface/bench/Bench.h"

namespace lucent::subsurface {

namespace {

using namespace measure;

constexpr int kSize = 48;                      // pixels
constexpr float kPixel = 2.2f * 0.01f / kSize; // m, of the ball's picture

using Change = void (*)(scene::Scene&);

HardCase ballWith(const std::string& name, Change change) {
    scene::Scene scene = marbleBall(kSize);
    change(scene);
    return {name, {[=]() -> Result<scene::Scene> { return scene; }, double(kSize) * kSize}, {}};
}

scene::Translucent& materialOf(scene::Scene& scene) { return scene.objects.front().material.translucent(); }

// Of marble's colours, with another mean free path [m].
void setPath(scene::Scene& scene, float path) {
    scene::Translucent& material = materialOf(scene);
    const float denser = 1 / (path * (material.scattering.g + material.absorption.g));
    material.scattering *= denser;
    material.absorption *= denser;
}

} // namespace

HardTable hardCases() {
    // Twice the error that splats are asked for, of light of 1 W/m².
    HardTable table{"subsurface", {}, {{"multires"}, {"splat"}}, 0.02};
    table.cases = {
        ballWith("nothing is absorbed", [](scene::Scene& s) { materialOf(s).absorption = vec3(0); }),
        ballWith("nearly nothing scatters", [](scene::Scene& s) { materialOf(s).scattering = vec3(1e-6f); }),
        ballWith("mean free path of 100 balls", [](scene::Scene& s) { setPath(s, 100 * 0.02f); }),
        ballWith("mean free path of 1/100 pixel", [](scene::Scene& s) { setPath(s, kPixel / 100); }),
        ballWith("anisotropy 0.99",
                 [](scene::Scene& s) {
                     materialOf(s).anisotropy = 0.99f;
                     materialOf(s).scattering *= 100.0f;
                 }),
        ballWith("index 1", [](scene::Scene& s) { materialOf(s).ior = 1; }),
        ballWith("a profile that is infinite at 0",
                 [](scene::Scene& s) { settingsOf(s).profile = diffusion::Shape::Burley; }),
        ballWith("32 splats a side", [](scene::Scene& s) { settingsOf(s).mostSplats = 32; }),
    };
    return table;
}

} // namespace lucent::subsurface
