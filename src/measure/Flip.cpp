#include "measure/Flip.h"

#include "base/Math.h"
#include "measure/Ssim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::measure {

namespace {

using std::numbers::pi;

// --- colour spaces, all after the paper's section 3; D65 white

// Linear Rec. 709 to XYZ: primaries and white of the standard as exact fractions.
const glm::dmat3 kXyzFromRgb =
    glm::transpose(glm::dmat3{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794, //
                              2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,   //
                              1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382});

// Relative to white, so that grey has three equal numbers.
dvec3 relativeXyz(dvec3 rgb) {
    static const dvec3 white = kXyzFromRgb * dvec3(1);
    return kXyzFromRgb * rgb / white;
}

// YyCxCz: lightness without its curve, red-green and blue-yellow.
dvec3 opponentFromXyz(dvec3 f) { return {116 * f.y - 16, 500 * (f.x - f.y), 200 * (f.y - f.z)}; }

dvec3 rgbFromOpponent(dvec3 c) {
    static const dvec3 white = kXyzFromRgb * dvec3(1);
    static const glm::dmat3 rgbFromXyz = glm::inverse(kXyzFromRgb);
    const double y = (c.x + 16) / 116;
    return rgbFromXyz * (white * dvec3(y + c.y / 500, y, y - c.z / 200));
}

// CIELAB, its chroma scaled by lightness: dark colours look less colourful (Hunt).
dvec3 huntLab(dvec3 rgb) {
    const auto curve = [](double t) {
        constexpr double kDelta = 6.0 / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
    };
    const dvec3 xyz = relativeXyz(rgb);
    const dvec3 lab = opponentFromXyz({curve(xyz.x), curve(xyz.y), curve(xyz.z)});
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

// HyAB distance: city block for lightness, Euclid for chroma.
double distance(dvec3 a, dvec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// Distance to the share of the largest one: the lower 40 % of the range take 95 % of the answer.
double colorError(dvec3 a, dvec3 b) {
    constexpr double kExponent = 0.7, kKnee = 0.4, kKneeError = 0.95;
    static const double largest = std::pow(distance(huntLab({0, 1, 0}), huntLab({0, 0, 1})), kExponent);
    const double error = std::pow(distance(a, b), kExponent), knee = kKnee * largest;
    if (error < knee) return error * kKneeError / knee;
    return kKneeError + (error - knee) / (largest - knee) * (1 - kKneeError);
}

// --- filters, all products of one for rows and one for columns

using Kernel = std::vector<double>; // odd length, centred
using Plane = std::vector<double>;  // row by row

Kernel sampled(int radius, const std::function<double(int)>& value) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i)
        kernel.push_back(value(i));
    return kernel;
}

double total(const Kernel& kernel) {
    double sum = 0;
    for (const double weight : kernel)
        sum += weight;
    return sum;
}

Kernel scaledBy(Kernel kernel, double factor) {
    for (double& weight : kernel)
        weight *= factor;
    return kernel;
}

// Positive weights sum to 1 and negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0, negative = 0;
    for (const double weight : kernel)
        (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : kernel)
        weight /= weight > 0 ? positive : negative;
    return kernel;
}

// The border's pixels go on outside.
Plane filtered(const Plane& plane, ivec2 size, const Kernel& alongX, const Kernel& alongY) {
    const auto pass = [&](const Plane& in, const Kernel& kernel, ivec2 step) {
        Plane out(in.size());
        const int radius = int(kernel.size()) / 2;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                double sum = 0;
                for (int i = -radius; i <= radius; ++i) {
                    // Kernels are applied as they stand, not mirrored.
                    const ivec2 at = glm::clamp(ivec2(x, y) + i * step, ivec2(0), size - 1);
                    sum += kernel[std::size_t(i + radius)] *
                           in[std::size_t(at.y) * std::size_t(size.x) + std::size_t(at.x)];
                }
                out[std::size_t(y) * std::size_t(size.x) + std::size_t(x)] = sum;
            }
        }
        return out;
    };
    return pass(pass(plane, alongX, {1, 0}), alongY, {0, 1});
}

// A contrast sensitivity as a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (table 1).
struct Gaussian {
    double a, b;
};
const std::vector<Gaussian> kSensitivities[] = {
    {{1, 0.0047}},                 // lightness
    {{1, 0.0053}},                 // red-green
    {{34.1, 0.04}, {13.5, 0.025}}, // blue-yellow
};

Plane seen(const Plane& plane, ivec2 size, const std::vector<Gaussian>& sensitivity, double pixelsPerDegree) {
    // Three standard deviations of the widest of all.
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixelsPerDegree));
    std::vector<Kernel> kernels;
    std::vector<double> weights;
    double sum = 0;
    for (const Gaussian& gaussian : sensitivity) {
        const Kernel kernel = sampled(radius, [&](int i) {
            const double x = i / pixelsPerDegree;
            return std::exp(-pi * pi * x * x / gaussian.b);
        });
        weights.push_back(gaussian.a * std::sqrt(pi / gaussian.b));
        sum += weights.back() * total(kernel) * total(kernel);
        kernels.push_back(kernel);
    }
    Plane out(plane.size());
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        const Plane one = filtered(plane, size, scaledBy(kernels[k], weights[k] / sum), kernels[k]);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] += one[i];
    }
    return out;
}

// --- one picture, prepared

struct Prepared {
    std::vector<dvec3> colors; // as seen, Hunt-adjusted CIELAB
    Plane edges, points;       // strength of features in lightness
};

Plane strength(const Plane& lightness, ivec2 size, const Kernel& across, const Kernel& along) {
    Plane x = filtered(lightness, size, across, along);
    const Plane y = filtered(lightness, size, along, across);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = std::hypot(x[i], y[i]);
    return x;
}

// `rgb`: linear, [0,1].
Prepared prepare(const std::vector<dvec3>& rgb, ivec2 size, double pixelsPerDegree) {
    std::array<Plane, 3> opponent;
    for (Plane& plane : opponent)
        plane.resize(rgb.size());
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const dvec3 color = opponentFromXyz(relativeXyz(rgb[i]));
        for (int c = 0; c < 3; ++c)
            opponent[std::size_t(c)][i] = color[c];
    }
    Prepared result;
    std::array<Plane, 3> blurred;
    for (std::size_t c = 0; c < 3; ++c)
        blurred[c] = seen(opponent[c], size, kSensitivities[c], pixelsPerDegree);
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const dvec3 color = rgbFromOpponent({blurred[0][i], blurred[1][i], blurred[2][i]});
        result.colors.push_back(huntLab(glm::clamp(color, 0.0, 1.0)));
    }

    Plane lightness = opponent[0];
    for (double& value : lightness)
        value = (value + 16) / 116;
    constexpr double kFeatureWidth = 0.082; // degrees, of the eye's edge detectors
    const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
    const int radius = int(std::ceil(3 * sigma));
    const auto bell = [sigma](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
    Kernel along = sampled(radius, bell);
    along = scaledBy(along, 1 / total(along));
    const Kernel slope = balanced(sampled(radius, [&](int i) { return -i * bell(i); }));
    const Kernel bend =
        balanced(sampled(radius, [&](int i) { return (i * i / (sigma * sigma) - 1) * bell(i); }));
    result.edges = strength(lightness, size, slope, along);
    result.points = strength(lightness, size, bend, along);
    return result;
}

Flip compareSeen(const std::vector<dvec3>& image, const std::vector<dvec3>& reference, ivec2 size,
                 double pixelsPerDegree) {
    const Prepared a = prepare(image, size, pixelsPerDegree), b = prepare(reference, size, pixelsPerDegree);
    Flip result;
    result.map = Image(size.x, size.y, 1);
    double sum = 0;
    for (std::size_t i = 0; i < a.colors.size(); ++i) {
        const double feature =
            std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
        const double featureError = std::sqrt(feature / std::numbers::sqrt2);
        const double error = std::pow(colorError(a.colors[i], b.colors[i]), 1 - featureError);
        result.map.pixels[i] = float(error);
        sum += error;
    }
    result.mean = sum / double(a.colors.size());
    return result;
}

/// The colours of a picture, each channel through `map`.
std::vector<dvec3> colorsOf(const Image& image, const std::function<double(double)>& map) {
    std::vector<dvec3> colors;
    for (std::size_t i = 0; i < image.pixels.size(); i += std::size_t(image.channels)) {
        const float* c = image.pixels.data() + i;
        colors.push_back(image.channels < 3 ? dvec3(map(c[0])) : dvec3(map(c[0]), map(c[1]), map(c[2])));
    }
    return colors;
}

// --- exposures

// Narkowicz's fit of the ACES curve without its exposure of 0.6: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kA = 0.36 * 2.51, kB = 0.6 * 0.03, kC = 0.36 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

double toneMapped(double x) { return std::clamp((kA * x + kB) * x / ((kC * x + kD) * x + kE), 0.0, 1.0); }

// The light that the curve maps to `shown`: the positive root of its quadratic.
double inverseToneMapped(double shown) {
    const double a = kA - kC * shown, half = 0.5 * (kB - kD * shown) / a, c = -kE * shown / a;
    return -half + std::sqrt(half * half - c);
}

// The median (the mean of the two in the middle); the smallest value above 0 when that is 0.
double medianAboveZero(std::vector<float> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median =
        values.size() % 2 ? values[half] : 0.5 * (double(values[half - 1]) + double(values[half]));
    if (median > 0) return median;
    return *std::upper_bound(values.begin(), values.end(), 0.0f);
}

} // namespace

double defaultPixelsPerDegree() { return 0.7 * (3840 / 0.7) * pi / 180; }

Flip flip(const Image& image, const Image& reference, double pixelsPerDegree) {
    assert(image.size() == reference.size());
    const auto shown = [](double value) { return std::clamp(value, 0.0, 1.0); };
    return compareSeen(colorsOf(image, shown), colorsOf(reference, shown), reference.size(), pixelsPerDegree);
}

Flip hdrFlip(const Image& image, const Image& reference, double pixelsPerDegree) {
    assert(image.size() == reference.size());
    Flip result;
    const std::vector<float> light = luminance(reference).pixels;
    const double brightest = *std::max_element(light.begin(), light.end());
    if (brightest > 0) {
        const double x = inverseToneMapped(0.85);
        result.start = std::log2(x / brightest);
        result.stop = std::log2(x / medianAboveZero(light));
        result.exposures = std::max(2, int(std::ceil(result.stop - result.start)));
    }
    result.map = Image(reference.width, reference.height, 1);
    for (int i = 0; i < result.exposures; ++i) {
        const double share = double(i) / std::max(1, result.exposures - 1);
        const double gain = std::exp2(result.start + share * (result.stop - result.start));
        const auto shown = [gain](double value) { return toneMapped(gain * std::max(0.0, value)); };
        const Flip one = compareSeen(colorsOf(image, shown), colorsOf(reference, shown), reference.size(),
                                     pixelsPerDegree);
        for (std::size_t p = 0; p < one.map.pixels.size(); ++p)
            result.map.pixels[p] = std::max(result.map.pixels[p], one.map.pixels[p]);
    }
    double sum = 0;
    for (const float error : result.map.pixels)
        sum += double(error);
    result.mean = sum / double(result.map.pixels.size());
    return result;
}

} // namespace lucent::measure
