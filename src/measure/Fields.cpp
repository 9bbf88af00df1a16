#include "measure/Fields.h"

#include "technique/Technique.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace lucent::measure {

scene::Scene fieldScene(const BenchField& field, float depth) {
    scene::Scene scene;
    scene::Object object;
    object.name = field.name;
    object.field().heights = field.heights;
    object.field().heightScale = field.heightScale;
    object.material.relief().depth = depth;
    scene.size = object.field().texels();
    scene.camera.height = object.field().footprint().y;
    scene.camera.eye.z = 2 + field.heightScale;
    scene.view.show = scene::Aov::Illumination;
    technique::addSettings(scene);
    scene.objects.push_back(std::move(object));
    return scene;
}

BenchField benchNoise(int size) {
    struct Wave {
        float x, y, phase, amplitude;
    };
    std::vector<Wave> waves;
    std::mt19937 random(1); // the same numbers everywhere: only its raw output is used
    const auto turn = [&] { return float(random() & 0xffff) / 65536.0f * 2 * kPi; };
    for (int octave = 0; octave < 7; ++octave) {
        for (int i = 0; i < 4; ++i) {
            const float angle = turn(), frequency = 3.0f * float(1 << octave);
            waves.push_back({frequency * std::cos(angle), frequency * std::sin(angle), turn(),
                             0.06f / float(1 << octave)});
        }
    }
    return {"noise",
            heightsOf(ivec2(size),
                      [&](int x, int y) {
                          float height = 0.5f;
                          for (const Wave& wave : waves)
                              height += wave.amplitude *
                                        std::sin((wave.x * float(x) + wave.y * float(y)) / float(size) +
                                                 wave.phase);
                          return std::clamp(height, 0.0f, 1.0f);
                      }),
            0.12f};
}

} // namespace lucent::measure
