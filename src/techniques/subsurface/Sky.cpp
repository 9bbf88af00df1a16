#include "techniques/subsurface/Sky.h"

#include "diffusion/Profile.h"
#include "light/EnvironmentLights.h"

#include <cmath>
#include <numbers>

namespace lucent::subsurface {

namespace {

constexpr int kCells = 4096; // of the sphere: 3 degrees each, where order 2 bends by 1e-3 of itself

std::array<float, 9> basis(vec3 n) {
    return {1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
}

// 2 pi times the integral of F_t(c) c P_l(c) over c in [0, 1], for l = 0, 1, 2.
std::array<double, 3> lobe(double ior) {
    constexpr int kSteps = 1024;
    std::array<double, 3> sums{};
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        const double weight = 2 * std::numbers::pi * diffusion::transmittedShare(c, ior) * c / kSteps;
        sums[0] += weight;
        sums[1] += weight * c;
        sums[2] += weight * (1.5 * c * c - 0.5);
    }
    return sums;
}

} // namespace

std::array<vec3, 9> enteringSky(const scene::Environment& environment, double ior) {
    constexpr double pi = std::numbers::pi;
    const std::array<double, 3> l = lobe(ior);
    // Squared norm of each function of the basis, times the lobe's integral.
    const double first = l[0] / (4 * pi), second = 3 / (4 * pi) * l[1], third = 15 / (4 * pi) * l[2];
    const std::array<double, 9> scales{first, second,     second, second,   third,
                                       third, third / 12, third,  third / 4};
    std::array<vec3, 9> sums{};
    for (const views::EnvironmentLight& light : views::environmentLights(environment, kCells)) {
        const std::array<float, 9> values = basis(light.direction);
        const vec3 flux = 4 * kPi * light.weight * light.radiance;
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += float(scales[i]) * values[i] * flux;
    }
    return sums;
}

} // namespace lucent::subsurface
