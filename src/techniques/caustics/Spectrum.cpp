#include "techniques/caustics/Spectrum.h"

#include <cmath>

namespace lucent::caustics {

namespace {

constexpr double kShortest = 400, kLongest = 700; // nm: beyond them the eye sees less than a hundredth

// A Gaussian with a width on each side, of which `below` and `above` are the inverse.
double lobe(double wavelength, double height, double middle, double below, double above) {
    const double t = (wavelength - middle) * (wavelength < middle ? below : above);
    return height * std::exp(-0.5 * t * t);
}

// Colour matching functions of the CIE 1931 observer, as sums of lobes (Wyman, Sloan, Shirley 2013).
dvec3 observed(double nm) {
    const double x = lobe(nm, 1.056, 599.8, 0.0264, 0.0323) + lobe(nm, 0.362, 442.0, 0.0624, 0.0374) -
                     lobe(nm, 0.065, 501.1, 0.0490, 0.0382);
    const double y = lobe(nm, 0.821, 568.8, 0.0213, 0.0247) + lobe(nm, 0.286, 530.9, 0.0613, 0.0322);
    const double z = lobe(nm, 1.217, 437.0, 0.0845, 0.0278) + lobe(nm, 0.681, 459.0, 0.0385, 0.0725);
    return {x, y, z};
}

// Linear Rec. 709 of XYZ (IEC 61966-2-1).
dvec3 linearFrom(const dvec3& xyz) {
    return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

// Of all light between two wavelengths that has the same power at each of them.
dvec3 colorBetween(double from, double to) {
    constexpr int kSteps = 32;
    dvec3 sum(0);
    for (int i = 0; i < kSteps; ++i)
        sum += linearFrom(observed(from + (i + 0.5) / kSteps * (to - from))) / double(kSteps);
    return sum;
}

} // namespace

std::vector<Tint> tints(int count) {
    if (count == 3) return {{{1, 0, 0}, 0}, {{0, 1, 0}, 1}, {{0, 0, 1}, 2}};
    std::vector<dvec3> colors;
    dvec3 white(0);
    const double part = (kLongest - kShortest) / count;
    for (int i = 0; i < count; ++i) {
        colors.push_back(colorBetween(kShortest + i * part, kShortest + (i + 1) * part));
        white += colors.back();
    }
    std::vector<Tint> list;
    for (int i = 0; i < count; ++i)
        list.push_back({vec3(colors[std::size_t(i)] / white), 1, float(kShortest + (i + 0.5) * part)});
    return list;
}

float iorAt(vec3 iors, float wavelength) {
    const auto inverseSquare = [](float nm) { return 1e6f / (nm * nm); }; // 1 / micrometre²
    const float c = inverseSquare(656.3f), d = inverseSquare(587.6f), f = inverseSquare(486.1f);
    return iors.g + (iors.b - iors.r) * (inverseSquare(wavelength) - d) / (f - c);
}

} // namespace lucent::caustics
