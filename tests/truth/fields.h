#pragma once
/// Small height fields for tests.

#include "scene/Scene.h"
#include "truth/Field.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace lucent::test {

/// A shape whose texel (column, row) has the given height; its texels are `width / columns` wide.
inline scene::HeightField shapeOf(int columns, int rows, float width, float heightScale,
                                  const std::function<float(int, int)>& height) {
    auto image = std::make_shared<Image>(columns, rows, 1);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            *image->at(x, y) = height(x, y);
    scene::HeightField shape;
    shape.width = width;
    shape.heightScale = heightScale;
    shape.heights = image;
    return shape;
}

inline truth::Field fieldOf(int columns, int rows, float width, float heightScale,
                            const std::function<float(int, int)>& height) {
    return truth::Field(shapeOf(columns, rows, width, heightScale, height));
}

/// Numbers in [0,1) that look random and are the same everywhere.
class Random {
public:
    explicit Random(std::uint32_t seed) : state_(seed * 2654435761u + 1) {}
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return double(state_ >> 40) / double(1u << 24);
    }
    double between(double low, double high) { return low + (high - low) * next(); }

private:
    std::uint64_t state_;
};

/// Uncorrelated heights: the roughest surface there is.
inline std::function<float(int, int)> noise(std::uint32_t seed) {
    return [seed](int x, int y) { return float(Random(seed + 7919u * unsigned(y) + unsigned(x)).next()); };
}

} // namespace lucent::test
