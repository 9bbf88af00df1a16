#pragma once
/// How far a picture is from the exact one.

#include "base/Image.h"
#include "light/Samples.h"
#include "scene/Scene.h"
#include "truth/Glass.h"

#include <cmath>
#include <memory>

namespace lucent::support {

/// Half the summed difference of two pictures of 4 channels over the light of the second, pixel by pixel.
inline double misplaced(const Image& found, const Image& wanted) {
    double apart = 0, all = 0;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        apart += std::abs(double(found.pixels[i]) - double(wanted.pixels[i])) / 2;
        all += double(wanted.pixels[i]);
    }
    return apart / all;
}

/// Share of the light that lies elsewhere than in the exact picture of a scene: summed differences over the
/// sum of what is exact, 3x3 pixels at a time.
///
/// @param found    4 channels, of the scene's size
/// @param samples  of the exact picture, a pixel
inline double misplaced(const scene::Scene& scene, const Image& found, int samples) {
    const auto solving = [&](ivec2 size, int each) {
        return std::make_unique<truth::GlassEstimator>(
            std::move(*truth::GlassEstimator::create(scene, size, scene::Aov::Color, {.samples = each})));
    };
    std::unique_ptr<const truth::Estimator> exact;
    using truth::PixelMean;
    if (views::samplingOf(scene).pixelSamples == 1)
        exact = solving(scene.size, samples);
    else
        exact = std::make_unique<PixelMean>(
            solving(PixelMean::sizeOf(scene.size), PixelMean::samplesOf(samples)), 1);
    double apart = 0, sum = 0;
    for (int y = 0; y + 3 <= scene.size.y; y += 3)
        for (int x = 0; x + 3 <= scene.size.x; x += 3) {
            dvec3 cell(0), light(0);
            for (int i = 0; i < 9; ++i) {
                const float* pixel = found.at(x + i % 3, y + i / 3);
                const truth::Pixel solved = exact->solve({x + i % 3, y + i / 3});
                if (solved.coverage == 0) continue;
                cell +=
                    double(pixel[3]) * dvec3(pixel[0], pixel[1], pixel[2]) - solved.coverage * solved.value;
                light += solved.coverage * solved.value;
            }
            for (int c = 0; c < 3; ++c) {
                apart += std::abs(cell[c]);
                sum += light[c];
            }
        }
    return apart / sum;
}

} // namespace lucent::support
