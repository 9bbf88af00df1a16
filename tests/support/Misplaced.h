#pragma once
/// How far a picture is from the exact one.

#include "base/Image.h"
#include "scene/Scene.h"
#include "truth/Glass.h"

#include <cmath>

namespace lucent::support {

/// Share of the light that lies elsewhere than in the exact picture of a scene: summed differences over the
/// sum of what is exact, 3x3 pixels at a time.
///
/// @param found    4 channels, of the scene's size
/// @param samples  of the exact picture, a pixel
inline double misplaced(const scene::Scene& scene, const Image& found, int samples) {
    const auto exact =
        truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = samples});
    double apart = 0, sum = 0;
    for (int y = 0; y + 3 <= scene.size.y; y += 3)
        for (int x = 0; x + 3 <= scene.size.x; x += 3) {
            dvec3 cell(0), light(0);
            for (int i = 0; i < 9; ++i) {
                const float* pixel = found.at(x + i % 3, y + i / 3);
                const truth::Pixel solved = exact->solve({x + i % 3, y + i / 3});
                if (solved.coverage == 0) continue;
                cell += dvec3(pixel[0], pixel[1], pixel[2]) - solved.value;
                light += solved.value;
            }
            for (int c = 0; c < 3; ++c) {
                apart += std::abs(cell[c]);
                sum += light[c];
            }
        }
    return apart / sum;
}

} // namespace lucent::support
