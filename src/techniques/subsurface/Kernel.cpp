#include "techniques/subsurface/Kernel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

namespace lucent::subsurface {

namespace {

constexpr double kPi = std::numbers::pi;

// How the error of a split profile is shared out. A lattice that errs by less has few points more. The rest
// is left to the places between which the light of the narrowest band is linear, where nearly all pixels are
// drawn; few are drawn of the others, whose light is all that dim places have. A wave has most of its light
// in one band, so that these errors do not add up.
constexpr double kOfLattice = 0.25, kOfNearPlaces = 0.75, kOfFarPlaces = 0.25;

// Bessel function J0 (Abramowitz, Stegun 9.4.1 and 9.4.3; 1e-7 of 1).
double besselJ(double x) {
    const auto series = [](double t, std::initializer_list<double> coefficients) {
        double sum = 0, power = 1;
        for (const double c : coefficients) {
            sum += c * power;
            power *= t;
        }
        return sum;
    };
    if (x < 3)
        return series(x * x / 9, {1, -2.2499997, 1.2656208, -0.3163866, 0.0444479, -0.0039444, 0.0002100});
    const double t = 3 / x;
    const double f =
        series(t, {0.79788456, -0.00000077, -0.00552740, -0.00009512, 0.00137237, -0.00072805, 0.00014476});
    const double phase =
        series(t, {-0.78539816, -0.04166397, -0.00003954, 0.00262573, -0.00054125, -0.00029333, 0.00013558});
    return f * std::cos(x + phase) / std::sqrt(x);
}

// e^-x I0(x), x >= 0 (Abramowitz, Stegun 9.8.1 and 9.8.2; 2e-7).
double scaledBesselI(double x) {
    if (x < 3.75) {
        const double t = x * x / 14.0625;
        const double sum =
            1 + t * (3.5156229 +
                     t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
        return std::exp(-x) * sum;
    }
    const double t = 3.75 / x;
    const double sum =
        0.39894228 +
        t * (0.01328592 +
             t * (0.00225319 +
                  t * (-0.00157565 +
                       t * (0.00916281 +
                            t * (-0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))));
    return sum / std::sqrt(x);
}

using Radial = std::function<dvec3(double)>; // a profile of three colours over r

// The same, looked up: dense where profiles are steep.
Radial sampled(const Radial& profile, double reach, int count) {
    auto values = std::make_shared<std::vector<dvec3>>(); // copies of what is returned share them
    for (int i = 0; i < count; ++i) {
        const double u = std::max(i, 1) / (count - 1.0); // the middle may be infinite
        values->push_back(profile(reach * u * u));
    }
    return [values, reach, count](double r) {
        if (r > reach) return dvec3(0);
        const double u = std::sqrt(r / reach) * (count - 1);
        const int i = std::min(int(u), count - 2);
        return glm::mix((*values)[std::size_t(i)], (*values)[std::size_t(i) + 1], u - i);
    };
}

// A profile as rings around the middle that hold its light.
struct Rings {
    std::vector<double> radii;
    std::vector<dvec3> masses;

    Rings(const Radial& profile, double reach, int count = 4000) {
        for (int i = 0; i < count; ++i) { // dense where profiles are steep
            const double low = reach * i * i / count / count;
            const double high = reach * (i + 1) * (i + 1) / count / count;
            radii.push_back(0.5 * (low + high));
            masses.push_back(kPi * (high * high - low * low) * profile(radii.back()));
        }
    }
    dvec3 total() const {
        dvec3 sum(0);
        for (const dvec3& mass : masses)
            sum += mass;
        return sum;
    }
    // Within which half of the light of all colours lies.
    double half() const {
        const auto light = [](const dvec3& mass) { return mass.r + mass.g + mass.b; };
        const double wanted = 0.5 * light(total());
        double sum = 0;
        for (std::size_t i = 0; i < radii.size(); ++i)
            if ((sum += light(masses[i])) >= wanted) return radii[i];
        return radii.back();
    }
    // The light at a spatial frequency, radians a metre.
    dvec3 at(double frequency) const {
        dvec3 sum(0);
        for (std::size_t i = 0; i < radii.size(); ++i)
            sum += besselJ(frequency * radii[i]) * masses[i];
        return sum;
    }
};

constexpr int kFewRings =
    1000; // where a wave's light need be known to a hundredth of what it may err by only

double most(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

Radial blurred(const Rings& rings, double deviation) {
    return [rings, deviation](double r) {
        constexpr double kAway = 7; // beyond so many deviations a Gaussian is 1e-11
        const double square = deviation * deviation;
        const auto first = std::lower_bound(rings.radii.begin(), rings.radii.end(), r - kAway * deviation);
        const auto last = std::upper_bound(first, rings.radii.end(), r + kAway * deviation);
        dvec3 sum(0);
        for (auto ring = first; ring != last; ++ring) {
            const double away = r - *ring;
            sum += rings.masses[std::size_t(ring - rings.radii.begin())] *
                   (std::exp(-0.5 * away * away / square) * scaledBesselI(r * *ring / square));
        }
        return sum / (2 * kPi * square);
    };
}

// The profile beyond c and an even polynomial within.
Radial smoothed(const Radial& profile, double c) {
    const double h = 0.1 * c;
    const dvec3 value = profile(c), before = profile(c - h), behind = profile(c + h);
    const dvec3 slope = (behind - before) / (2 * h), bend = (behind - 2.0 * value + before) / (h * h);
    const dvec3 first = 0.5 * c * slope, second = 0.25 * (c * c * bend - c * slope); // by x = (r / c)²
    return [=](double r) {
        if (r >= c) return profile(r);
        const double x = r * r / (c * c) - 1;
        return value + x * first + 0.5 * x * x * second;
    };
}

std::vector<vec4> tabulated(const Radial& values, double reach, double scale) {
    // At r = scale, where the profile bends most, places are a twentieth of it apart.
    const int count = int(std::clamp(40 * std::sqrt(reach / scale), 64.0, double(diffusion::kMostEntries)));
    std::vector<vec4> table;
    for (int i = 0; i < count; ++i) {
        const double u = double(i) / (count - 1);
        table.push_back(vec4(vec3(values(reach * u * u)), 0));
    }
    return table;
}

using Profiles = std::array<diffusion::Profile, 3>;

double leastDepth(const std::array<diffusion::Medium, 3>& media, const Profiles& profiles,
                  const KernelWish& wish) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < 3; ++c) {
        const bool layered = wish.shape == diffusion::Shape::Multipole && media[c].isLayered();
        const double depth = layered ? profiles[c].depth() : 1 / media[c].extinction();
        if (depth > 0) least = std::min(least, depth);
    }
    return least;
}

// The profile cut at its reach, each colour with the integral that it has without the cut. What the object
// has no place for is not cut off but absent.
struct Cut {
    Radial profile;
    double reach = 0;
    dvec3 total{0};
};

Cut cutOf(const Profiles& profiles, const KernelWish& wish) {
    constexpr double kTableError = 1e-4; // far below any that is asked for: bends are taken from it
    // Far light of bands costs little, and sources along the normal leave light where a plane has none.
    const double beyond = (wish.split || wish.shares ? 0.1 : 1) * wish.epsilon;
    const double size = wish.sharpest * wish.size;
    Cut cut;
    for (const diffusion::Profile& profile : profiles)
        cut.reach = std::max(cut.reach, profile.reach(beyond, size));
    const diffusion::Table table = diffusion::tableOf(profiles, cut.reach, kTableError, cut.reach < size);
    cut.profile = sampled([&](double r) { return dvec3(diffusion::valueAt(table, r)); }, cut.reach, 4096);
    cut.total = Rings(cut.profile, cut.reach).total();
    return cut;
}

// Shares of colours that a profile has any of.
dvec3 over(const dvec3& part, const dvec3& whole) {
    dvec3 share(0);
    for (int c = 0; c < 3; ++c)
        if (whole[c] > 0) share[c] = part[c] / whole[c];
    return share;
}

// Where the smooth part of the next band may begin so that a lattice sums it; 0: nowhere before the reach.
double smoothFrom(const Cut& cut, double spacing, double epsilon) {
    for (double ratio = 1.5; ratio * spacing < 0.7 * cut.reach; ratio *= 1.15) {
        const Rings rings(smoothed(cut.profile, ratio * spacing), cut.reach, kFewRings);
        if (4 * most(over(rings.at(2 * kPi / spacing), cut.total)) <= epsilon) return ratio * spacing;
    }
    return 0;
}

// Distance of places between which the light of a band is linear, but for `epsilon`: the error of a wave of
// frequency k is (k p)² / 8.
double placesOf(const Rings& rings, const dvec3& total, double reach, double epsilon) {
    double bend = 0;
    for (double k = 1 / reach; k < 300 / reach; k *= 1.2)
        bend = std::max(bend, k * k * most(over(rings.at(k), total)));
    return bend > 0 ? std::sqrt(8 * epsilon / bend) : reach;
}

} // namespace

double latticeSpacing(double epsilon, double depth) { return 2 * kPi * depth / std::log(4 / epsilon); }

Kernel kernelOf(const std::array<diffusion::Medium, 3>& media, const KernelWish& wish) {
    Kernel kernel;
    const Profiles profiles = diffusion::profilesOf(media, wish.shape, wish.thickness);
    Cut cut = cutOf(profiles, wish);
    const double depth = leastDepth(media, profiles, wish);
    const double epsilon = (wish.split ? kOfLattice : 1) * wish.epsilon;
    // Burley's profile is infinite in its middle, which no lattice sums.
    const bool singular = wish.shape == diffusion::Shape::Burley;
    const double wanted =
        std::min(latticeSpacing(epsilon, depth) * (singular ? 0.5 : 1), wish.size / kLeastPoints);
    const double spacing = std::max(wanted, wish.leastSpacing);
    const double excess = std::log(4 / epsilon) - (singular ? 0 : 2 * kPi * depth / spacing);
    double scale = std::min(depth, cut.reach);
    kernel.sharpest = wish.sharpest;
    if (wish.leastSpacing > 0) kernel.sharpest = std::min(wish.sharpest, wanted / wish.leastSpacing);
    if (excess > 1e-9) {
        kernel.blur = spacing * std::sqrt(excess / 2) / kPi;
        const double wider = std::hypot(cut.reach, kernel.blur * std::sqrt(2 * std::log(1 / wish.epsilon)));
        Rings rings(cut.profile, cut.reach);
        if (most(rings.total()) == 0) rings.masses.front() = cut.total;
        kernel.spread = rings.half();
        const dvec3 sum = rings.total();
        for (dvec3& mass : rings.masses)
            mass *= over(cut.total, sum);
        // Wider than a few deviations, it has no detail: linear between its values to 1e-4.
        const Radial soft = sampled(blurred(rings, kernel.blur), wider, 512);
        const dvec3 kept = over(cut.total, Rings(soft, wider).total()); // its tail is cut off again
        cut.profile = [soft, kept](double r) { return kept * soft(r); };
        cut.reach = wider;
        scale = std::max(scale, kernel.blur);
    }
    Radial rest = cut.profile;
    double step = spacing, from = cut.reach;
    const auto add = [&](const Radial& values, double reach, double pixel) {
        const auto shares = [&](double r) {
            return wish.shares ? over(values(r), cut.profile(r)) : values(r);
        };
        kernel.bands.push_back({step, pixel, reach, tabulated(shares, reach, scale)});
    };
    const auto pixelOf = [&](const Radial& values, double reach) {
        if (!wish.split) return 0.0;
        const double share = kernel.bands.empty() ? kOfNearPlaces : kOfFarPlaces;
        return placesOf(Rings(values, reach, kFewRings), cut.total, reach, share * wish.epsilon);
    };
    while (wish.split && 2 * step <= wish.size / kLeastPoints) {
        from = smoothFrom(cut, 2 * step, epsilon);
        if (from == 0) break;
        const Radial next = smoothed(cut.profile, from);
        const Radial part = [rest, next](double r) { return rest(r) - next(r); };
        add(part, from, pixelOf(part, from));
        rest = next;
        step *= 2;
        scale = std::max(scale, 0.25 * from);
    }
    add(rest, cut.reach, pixelOf(rest, cut.reach));
    return kernel;
}

double papersSplats(const std::array<diffusion::Medium, 3>& media, const KernelWish& wish, double width) {
    double splats = 0;
    for (const diffusion::Medium& medium : media) {
        const diffusion::Profile profile(medium, wish.shape, wish.thickness);
        const double reach = profile.reach(wish.epsilon, wish.size);
        const double nearest = std::min(reach, 1e-3 / medium.extinction()); // the middle may be infinite
        const double overlapping = profile.at(nearest) / (wish.epsilon * profile.at(reach));
        splats = std::max(splats, 0.5 * overlapping * width / reach);
    }
    return splats;
}

} // namespace lucent::subsurface
