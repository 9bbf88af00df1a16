#pragma once
/// Height fields and light from all around to measure on.

#include "scene/Scene.h"

#include <memory>
#include <string>

namespace lucent::measure {

/// A height map to measure on, as a field 1 m wide.
struct BenchField {
    std::string name;
    std::shared_ptr<const Image> heights;
    float heightScale; ///< m
};

/// Light from all around to measure under.
struct BenchEnvironment {
    std::string name;
    std::shared_ptr<const Image> map; ///< 3 channels, linear
};

/// The field with one pixel a texel, seen from above, `depth` metres deep, without lights; shows d.
scene::Scene fieldScene(const BenchField& field, float depth);

/// Sum of sines of falling amplitude over seven octaves, heights in [0, 1].
BenchField benchNoise(int size);

/// Heights by column and row of the texel.
template <class Function>
std::shared_ptr<const Image> heightsOf(ivec2 size, const Function& height) {
    auto image = std::make_shared<Image>(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            *image->at(x, y) = float(height(x, y));
    return image;
}

} // namespace lucent::measure
