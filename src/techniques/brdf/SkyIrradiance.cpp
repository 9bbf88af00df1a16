#include "techniques/brdf/SkyIrradiance.h"

#include "light/EnvironmentLights.h"

namespace lucent::brdf {

namespace {

constexpr int kCells = 4096; // of the sphere: 3 degrees each, where order 2 bends by 1e-3 of itself

std::array<float, 9> basis(vec3 n) {
    return {1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
}

// Squared norm of each harmonic, (2l + 1) / 4 pi and so on, times the clamped cosine's integral.
constexpr std::array<float, 9> kScales = [] {
    constexpr float pi = kPi, linear = 3 / (4 * pi) * (2 * pi / 3), square = 15 / (4 * pi) * (pi / 4);
    return std::array<float, 9>{1 / (4 * pi) * pi, linear, linear,    linear, square, square,
                                square / 12,       square, square / 4};
}();

} // namespace

std::array<vec3, 9> skyIrradiance(const scene::Environment& environment) {
    std::array<vec3, 9> sums{};
    for (const views::EnvironmentLight& light : views::environmentLights(environment, kCells)) {
        const std::array<float, 9> values = basis(light.direction);
        const vec3 flux = 4 * kPi * light.weight * light.radiance;
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += kScales[i] * values[i] * flux;
    }
    return sums;
}

} // namespace lucent::brdf
