#pragma once
/// Relief pictures by the renderer and by the truth, side by side.

#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "truth/RenderRelief.h"

#include <algorithm>

namespace lucent::support {

/// Largest and root-mean-square difference of the first three channels; infinite values never agree.
struct Difference {
    double max = 0, rms = 0;
    ivec2 worst{0};
};
inline Difference difference(const Image& a, const Image& b) {
    Difference result;
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double d = std::abs(double(a.at(x, y)[c]) - b.at(x, y)[c]);
                sum += d * d;
                if (!(d <= result.max)) {
                    result.max = d;
                    result.worst = {x, y};
                }
            }
        }
    }
    result.rms = std::sqrt(sum / (3.0 * a.width * a.height));
    return result;
}

inline const std::atomic<bool> kNever{false};

struct ReliefTest : GlTest {
    Image render(const scene::Scene& scene, scene::Aov aov = scene::Aov::Illumination) {
        scene::Scene copy = scene;
        copy.view.show = aov;
        frame::Renderer renderer(*context);
        const Status status = renderer.finish(copy, 1, copy.size);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        Result<Image> image = renderer.read(copy, aov);
        EXPECT_TRUE(image.ok());
        EXPECT_EQ(findNonFinite(*image), ivec2(-1)) << "NaN or Inf left a pass";
        return std::move(*image);
    }
    Image truth(const scene::Scene& scene, scene::Aov aov = scene::Aov::Illumination) {
        truth::ReliefOptions options;
        scene::Scene copy = scene;
        const relief::Settings& settings = reliefSettings(copy);
        options.attenuation = settings.attenuation == relief::Attenuation::Exponential
                                  ? truth::Attenuation::Exponential
                                  : truth::Attenuation::Ratio;
        options.normalise = settings.normalise;
        Result<Image> image = truth::renderRelief(
            scene, scene.size, aov, options, [](double) {}, kNever);
        EXPECT_TRUE(image.ok()) << (image.ok() ? "" : image.error().message);
        return std::move(*image);
    }
};

} // namespace lucent::support
