#include "techniques/caustics/bench/FloorLight.h"

#include <cmath>
#include <numbers>

namespace lucent::caustics {

namespace {

// Unpolarised, by sines and tangents of both angles (Born & Wolf, 1.5.2); `relative`: incident over other
// index, below 1.
double reflected(double incident, double relative) {
    if (incident < 1e-6) return std::pow((relative - 1) / (relative + 1), 2);
    const double other = std::asin(std::sin(incident) * relative);
    const double s = std::sin(incident - other) / std::sin(incident + other);
    const double p = std::tan(incident - other) / std::tan(incident + other);
    return 0.5 * (s * s + p * p);
}

Image darkFloor(ivec2 size) {
    Image light(size.x, size.y, 4);
    for (std::size_t i = 3; i < light.pixels.size(); i += 4)
        light.pixels[i] = 1;
    return light;
}

void add(float* pixel, double light) {
    for (int channel = 0; channel < 3; ++channel)
        pixel[channel] += float(light);
}

} // namespace

Image lightOfBall(ivec2 size, double height, double ior, double below) {
    constexpr double kTau = 2 * std::numbers::pi;
    constexpr int kRings = 4000, kSectors = 1600;
    Image light = darkFloor(size);
    const double pixel = height / size.y;
    for (int ring = 0; ring < kRings; ++ring) {
        const double b = (ring + 0.5) / kRings, i = std::asin(b), t = std::asin(b / ior);
        if (2 * (i - t) > kTau / 4) continue; // sideways
        const double radius = std::sin(2 * t - i) - std::tan(2 * (i - t)) * (below - std::cos(2 * t - i));
        const double kept = std::pow(1 - reflected(i, 1 / ior), 2);
        const double flux = kept * kTau * b / kRings / kSectors / (pixel * pixel);
        for (int sector = 0; sector < kSectors; ++sector) {
            const double angle = kTau * (sector + 0.5) / kSectors;
            const int x = int(std::floor(radius * std::cos(angle) / pixel + 0.5 * size.x));
            const int y = int(std::floor(radius * std::sin(angle) / pixel + 0.5 * size.y));
            if (x >= 0 && y >= 0 && x < size.x && y < size.y) add(light.at(x, y), flux);
        }
    }
    return light;
}

Image lightOfWater(ivec2 size, double width, double amplitude, double wavelength, double ior, double depth) {
    constexpr int kSamples = 400000;
    const double wave = 2 * std::numbers::pi / wavelength;
    Image light = darkFloor(size);
    for (int i = 0; i < kSamples; ++i) { // twice the picture's width: light comes in from outside
        const double x = (2 * (i + 0.5) / kSamples - 1) * width;
        const double incident = std::atan(amplitude * wave * std::cos(wave * x));
        const double deviation = incident - std::asin(std::sin(incident) / ior);
        const double landing = x + std::tan(deviation) * (depth + amplitude * std::sin(wave * x));
        const int column = int(std::floor((landing / width + 0.5) * size.x));
        if (column < 0 || column >= size.x) continue;
        const double flux = (1 - reflected(std::abs(incident), 1 / ior)) * 2 * size.x / kSamples;
        for (int y = 0; y < size.y; ++y)
            add(light.at(column, y), flux);
    }
    return light;
}

} // namespace lucent::caustics
