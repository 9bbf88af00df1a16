#include "measure/Metrics.h"

#include "measure/Flip.h"
#include "measure/Ssim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::measure {

namespace {
/// Channels that hold colour: grey or red, green, blue.
int colorChannels(const Image& image) { return image.channels < 3 ? 1 : 3; }

std::string sizeText(const Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height) + " pixels with " +
           std::to_string(colorChannels(image)) + " colour channel" + (colorChannels(image) == 1 ? "" : "s");
}

Status checkFinite(const Image& image, const std::string& name) {
    const auto count = std::count_if(image.pixels.begin(), image.pixels.end(),
                                     [](float value) { return !std::isfinite(value); });
    if (count == 0) return Done{};
    const ivec2 first = findNonFinite(image);
    return Error{name + ": " + std::to_string(count) + " values are NaN or infinite, the first at pixel (" +
                 std::to_string(first.x) + ", " + std::to_string(first.y) + "); must be finite"};
}

/// Calls visit(x, y, value, reference) for every colour value that counts.
template <class Visit>
void forEachValue(const Image& image, const Image& reference, const Image* coverage, Visit visit) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (coverage && coverage->at(x, y)[coverage->channels - 1] <= 0) continue;
            for (int channel = 0; channel < colorChannels(image); ++channel)
                visit(x, y, double(image.at(x, y)[channel]), double(reference.at(x, y)[channel]));
        }
    }
}

/// A share of a sum; NaN when there is nothing to be a share of, as where directions cancel or turn below 0.
double shareOf(double part, double whole) {
    return whole > 0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

/// Degrees between two directions, exact for small angles too.
double degreesBetween(const float* a, const float* b) {
    const dvec3 u(a[0], a[1], a[2]), v(b[0], b[1], b[2]);
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * 180 / std::numbers::pi;
}

/// Gathers the pixels of some Angles.
class AngleSum {
public:
    void add(const float* direction, const float* exact) {
        ++pixels_;
        if (direction[3] > 0) degrees_.push_back(degreesBetween(direction, exact));
    }
    Angles angles() {
        Angles angles;
        angles.pixels = pixels_;
        if (pixels_ > 0) angles.lost = 1 - double(degrees_.size()) / pixels_;
        if (degrees_.empty()) return angles;
        angles.median = percentile(degrees_, 0.5);
        angles.p95 = percentile(degrees_, 0.95);
        angles.p99 = percentile(degrees_, 0.99);
        return angles;
    }

private:
    std::vector<double> degrees_;
    int pixels_ = 0;
};

/// Whether all pixels around one, none of them beside the picture, see as many layers.
bool isInside(const Image& layers, ivec2 at) {
    if (at.x < 1 || at.y < 1 || at.x + 1 >= layers.width || at.y + 1 >= layers.height) return false;
    for (int i = 0; i < 9; ++i)
        if (*layers.at(at.x + i % 3 - 1, at.y + i / 3 - 1) != *layers.at(at.x, at.y)) return false;
    return true;
}

void write(JsonWriter& json, std::string_view name, const Angles& angles) {
    json.key(name).beginObject();
    json.key("median").value(angles.median).key("p95").value(angles.p95).key("p99").value(angles.p99);
    json.key("lost").value(angles.lost).key("pixels").value(angles.pixels).end();
}

double sumOfColors(const Image& image, int x, int y) {
    double sum = 0;
    for (int channel = 0; channel < colorChannels(image); ++channel)
        sum += double(image.at(x, y)[channel]);
    return sum;
}

/// The flux of two pictures within growing circles around the middle of the second's flux: the largest
/// difference.
double encircledDifference(const Image& image, const Image& reference) {
    struct Spot {
        double radius, found, wanted;
    };
    std::vector<Spot> spots;
    dvec2 middle(0);
    double all = 0;
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x) {
            const double wanted = sumOfColors(reference, x, y);
            middle += wanted * dvec2(x, y);
            all += wanted;
        }
    middle /= all;
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x)
            spots.push_back(
                {glm::distance(dvec2(x, y), middle), sumOfColors(image, x, y), sumOfColors(reference, x, y)});
    std::sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.radius < b.radius; });
    double difference = 0, most = 0;
    for (const Spot& spot : spots) {
        difference += spot.found - spot.wanted;
        most = std::max(most, std::abs(difference));
    }
    return shareOf(most, all);
}

bool exceedsOne(const Image& image) {
    bool found = false;
    forEachValue(image, image, nullptr, [&](int, int, double value, double) { found = found || value > 1; });
    return found;
}
} // namespace

Result<Metrics> compare(const Image& image, const std::string& imageName, const Image& reference,
                        const std::string& referenceName, const Image* coverage) {
    if (image.size() != reference.size() || colorChannels(image) != colorChannels(reference))
        return Error{imageName + ": has " + sizeText(image) + "; must have " + sizeText(reference) +
                     " like " + referenceName};
    if (Status finite = checkFinite(image, imageName); !finite) return finite.error();
    if (Status finite = checkFinite(reference, referenceName); !finite) return finite.error();

    Metrics metrics;
    std::vector<double> differences;
    double squares = 0, sum = 0, referenceSum = 0;
    forEachValue(image, reference, coverage, [&](int x, int y, double value, double wanted) {
        const double difference = value - wanted;
        squares += difference * difference;
        sum += value;
        referenceSum += wanted;
        metrics.relMse += difference * difference / (wanted * wanted + kRelMseEpsilon);
        metrics.mae += std::abs(difference);
        metrics.bias += difference;
        if (std::abs(difference) > metrics.maximum) {
            metrics.maximum = std::abs(difference);
            metrics.maximumAt = {x, y};
        }
        differences.push_back(std::abs(difference));
    });
    if (differences.empty()) return Error{imageName + ": no pixel is covered; at least one must be"};
    const double count = double(differences.size());
    metrics.rmse = std::sqrt(squares / count);
    metrics.relRmse = shareOf(metrics.rmse, referenceSum / count);
    metrics.relMse /= count;
    metrics.mae /= count;
    metrics.bias /= count;
    metrics.psnr = -20 * std::log10(metrics.rmse);
    metrics.fluxRatio = shareOf(sum, referenceSum);
    metrics.p50 = percentile(differences, 0.5);
    metrics.p90 = percentile(differences, 0.9);
    metrics.p99 = percentile(differences, 0.99);
    return metrics;
}

double percentile(std::vector<double>& values, double share) {
    const auto place = values.begin() + (std::ptrdiff_t(std::ceil(share * double(values.size()))) - 1);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

Result<Metrics> compareDirections(const Image& image, const std::string& imageName, const Image& exact,
                                  const Image& layers) {
    Image seen(exact.width, exact.height, 1);
    for (int y = 0; y < exact.height; ++y)
        for (int x = 0; x < exact.width; ++x)
            *seen.at(x, y) = *layers.at(x, y) > 0 && exact.at(x, y)[3] > 0 ? 1 : 0;
    Result<Metrics> metrics = compare(image, imageName, exact, "exact directions", &seen);
    if (!metrics) return metrics;
    metrics->relRmse = metrics->fluxRatio =
        std::numeric_limits<double>::quiet_NaN(); // directions have no sum
    AngleSum all, inside;
    for (int y = 0; y < exact.height; ++y)
        for (int x = 0; x < exact.width; ++x) {
            if (*seen.at(x, y) == 0) continue;
            all.add(image.at(x, y), exact.at(x, y));
            if (isInside(layers, {x, y})) inside.add(image.at(x, y), exact.at(x, y));
        }
    metrics->angles = {all.angles(), inside.angles()};
    return metrics;
}

FluxErrors compareFlux(const Image& image, const Image& reference, const Image& errors, int cell) {
    FluxErrors flux;
    double apart = 0, noise = 0, all = 0;
    for (int top = 0; top + cell <= reference.height; top += cell)
        for (int left = 0; left + cell <= reference.width; left += cell) {
            double difference = 0, variance = 0;
            for (int i = 0; i < cell * cell; ++i) {
                const int x = left + i % cell, y = top + i / cell;
                const double wanted = sumOfColors(reference, x, y), deviation = sumOfColors(errors, x, y);
                difference += sumOfColors(image, x, y) - wanted;
                variance += deviation * deviation;
                all += wanted;
            }
            apart += std::abs(difference);
            noise += std::sqrt(variance * 2 / std::numbers::pi); // mean of the absolute value of a Gaussian
        }
    flux.misplaced = shareOf(0.5 * apart, all);
    flux.byNoise = shareOf(0.5 * noise, all);
    flux.encircled = encircledDifference(image, reference);
    return flux;
}

void addPerceptual(Metrics& metrics, const Image& image, const Image& reference) {
    const bool unclamped = exceedsOne(image) || exceedsOne(reference);
    metrics.ssim = ssim(image, reference);
    metrics.flip = unclamped ? hdrFlip(image, reference).mean : flip(image, reference).mean;
}

void writeMembers(JsonWriter& json, const Metrics& metrics) {
    const auto member = [&](std::string_view name, double value) { json.key(name).value(value); };
    member("rmse", metrics.rmse);
    member("relRmse", metrics.relRmse);
    member("relMse", metrics.relMse);
    member("mae", metrics.mae);
    member("p50", metrics.p50);
    member("p90", metrics.p90);
    member("p99", metrics.p99);
    member("max", metrics.maximum);
    member("bias", metrics.bias);
    member("psnr", metrics.psnr);
    if (metrics.ssim) member("ssim", *metrics.ssim);
    if (metrics.flip) member("flip", *metrics.flip);
    member("fluxRatio", metrics.fluxRatio);
    if (metrics.flux) {
        json.key("flux").beginObject();
        member("misplaced", metrics.flux->misplaced);
        member("byNoise", metrics.flux->byNoise);
        member("encircled", metrics.flux->encircled);
        json.end();
    }
    if (!metrics.angles) return;
    json.key("degrees").beginObject();
    write(json, "all", metrics.angles->all);
    write(json, "inside", metrics.angles->inside);
    json.end();
}

dvec3 heatColor(double share) {
    // A path through Oklab (Ottosson 2020): lightness grows evenly, the hue turns from blue over red to
    // yellow. The chroma, chosen by eye, keeps the path within Rec. 709 nearly everywhere.
    const double u = std::clamp(share, 0.0, 1.0);
    const double lightness = 0.97 * u, chroma = 0.16 * std::sin(std::numbers::pi * std::sqrt(u)) + 0.05 * u;
    const double hue = (-90 + 195 * u) * std::numbers::pi / 180;
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    const dvec3 linear{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                       -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                       -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
    return glm::clamp(linear, 0.0, 1.0);
}

Image heatMap(const Image& image, const Image& reference, double full) {
    Image map(image.width, image.height, 3);
    std::vector<double> differences(std::size_t(image.width) * std::size_t(image.height));
    forEachValue(image, reference, nullptr, [&](int x, int y, double value, double wanted) {
        double& difference = differences[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
        difference = std::max(difference, std::abs(value - wanted));
    });
    for (std::size_t i = 0; i < differences.size(); ++i) {
        const dvec3 color = heatColor(differences[i] / full);
        for (int channel = 0; channel < 3; ++channel)
            map.pixels[3 * i + std::size_t(channel)] = srgbFromLinear(float(color[channel]));
    }
    return map;
}

} // namespace lucent::measure
