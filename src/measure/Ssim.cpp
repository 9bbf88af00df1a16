#include "measure/Ssim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace lucent::measure {

namespace {

constexpr int kRadius = 5;

std::array<double, 2 * kRadius + 1> window() {
    constexpr double kSigma = 1.5;
    std::array<double, 2 * kRadius + 1> weights;
    double sum = 0;
    for (int i = -kRadius; i <= kRadius; ++i)
        sum += weights[std::size_t(i + kRadius)] = std::exp(-i * i / (2 * kSigma * kSigma));
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

// Means of one window: of both pictures, their squares and their product.
struct Moments {
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    void add(const Moments& other, double weight) {
        x += weight * other.x;
        y += weight * other.y;
        xx += weight * other.xx;
        yy += weight * other.yy;
        xy += weight * other.xy;
    }
};

double similarity(const Moments& m, double c1, double c2) {
    const double varianceX = m.xx - m.x * m.x, varianceY = m.yy - m.y * m.y, covariance = m.xy - m.x * m.y;
    return (2 * m.x * m.y + c1) * (2 * covariance + c2) /
           ((m.x * m.x + m.y * m.y + c1) * (varianceX + varianceY + c2));
}

} // namespace

Image luminance(const Image& image) {
    Image grey(image.width, image.height, 1);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* c = image.at(x, y);
            *grey.at(x, y) = image.channels < 3 ? c[0] : 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        }
    }
    return grey;
}

double ssim(const Image& image, const Image& reference) {
    assert(image.size() == reference.size());
    if (std::min(image.width, image.height) < 2 * kRadius + 1)
        return std::numeric_limits<double>::quiet_NaN();
    const Image a = luminance(image), b = luminance(reference);
    const double range = std::max(1.0f, *std::max_element(b.pixels.begin(), b.pixels.end()));
    const double c1 = 0.01 * range * 0.01 * range, c2 = 0.03 * range * 0.03 * range;
    const auto weights = window();
    double sum = 0;
    std::vector<Moments> rows(std::size_t(image.width)); // windows of one column each, around one row
    for (int y = kRadius; y < image.height - kRadius; ++y) {
        for (int x = 0; x < image.width; ++x) {
            Moments& column = rows[std::size_t(x)] = {};
            for (int i = -kRadius; i <= kRadius; ++i) {
                const double u = *a.at(x, y + i), v = *b.at(x, y + i);
                column.add({u, v, u * u, v * v, u * v}, weights[std::size_t(i + kRadius)]);
            }
        }
        for (int x = kRadius; x < image.width - kRadius; ++x) {
            Moments all;
            for (int i = -kRadius; i <= kRadius; ++i)
                all.add(rows[std::size_t(x + i)], weights[std::size_t(i + kRadius)]);
            sum += similarity(all, c1, c2);
        }
    }
    return sum / ((image.width - 2.0 * kRadius) * (image.height - 2.0 * kRadius));
}

} // namespace lucent::measure
