#include "diffusion/Profile.h"

#include "diffusion/Stack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::diffusion {

namespace {
constexpr double kPi = std::numbers::pi;

/// sinh(x) / sinh(y) for 0 <= x <= y, of which both may be 0 or far beyond what exp() holds.
double sinhRatio(double x, double y) {
    if (y == 0) return 0;
    return std::exp(x - y) * std::expm1(-2 * x) / std::expm1(-2 * y);
}

bool isSlab(double thickness) { return thickness > 0 && std::isfinite(thickness); }

/// A layer of a medium between two boundaries, or a half space.
struct Layer {
    double depth;         ///< of the source, m
    double share;         ///< of the light, that collides in the layer
    double extrapolation; ///< z_b = 2 A D: so far outside a boundary diffuse light would be 0, m
    double thickness;     ///< m, infinite for half spaces
    double transport;     ///< 1/m

    Layer(const Medium& medium, double thickness)
        : depth(1 / medium.extinction()), share(1), thickness(std::numeric_limits<double>::infinity()),
          transport(medium.transport()) {
        const double internal = diffuseReflectance(medium.ior);
        extrapolation = 2 * (1 + internal) / (1 - internal) / (3 * medium.extinction());
        if (!isSlab(thickness)) return;
        this->thickness = thickness;
        const double optical = thickness * medium.extinction();
        share = -std::expm1(-optical);
        // The mean of an exponential distribution that ends; half the thickness, by its series, in thin
        // layers.
        depth = optical < 1e-4 ? thickness * (0.5 - optical / 12)
                               : depth - thickness * std::exp(-optical) / share;
    }
    double period() const { return 2 * (thickness + 2 * extrapolation); }
    double virtualDepth() const { return depth + 2 * extrapolation; }

    /// What leaves through a boundary over what collides without absorption, with a source this far from it.
    double leaving(double from) const {
        if (!std::isfinite(thickness))
            return 0.5 * (std::exp(-transport * from) + std::exp(-transport * (from + 2 * extrapolation)));
        // The series of images summed up: a sine of imaginary angle that is 0 at both extrapolated
        // boundaries.
        const double whole = 0.5 * period();
        const double near = thickness - from, far = whole - from;
        if (transport * whole < 1e-12) return 0.5 * (near + far) / whole;
        return 0.5 * (sinhRatio(transport * near, transport * whole) +
                      sinhRatio(transport * far, transport * whole));
    }
};

/// (1 + sigma d) e^(-sigma d) / d³: the slope of e^(-sigma d) / d over -d.
double fall(double transport, double d) {
    return (1 + transport * d) * std::exp(-transport * d) / (d * d * d);
}

/// Integral of F_t(c) c weight(c) dc.
template <class Weight>
double transmitted(double ior, const Weight& weight) {
    // Simpson's rule; squares take the root at grazing angles, or at the critical one, out of the integrand.
    constexpr int kSteps = 256;
    const double first = ior < 1 ? std::sqrt(1 - ior * ior) : 0;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double t = double(i) / kSteps, cosine = first + (1 - first) * t * t;
        const double share = i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2;
        sum += share * transmittedShare(cosine, ior) * cosine * weight(cosine) * 2 * t;
    }
    return (1 - first) * sum / (3 * kSteps);
}

/// Integral over the plane of what is linear in i between the values of a table, over pi reach². The ring of
/// r = reach u², u = (i + t) h, has the area 4 pi reach² u³ du.
double integralOf(const std::vector<double>& values) {
    const double h = 1 / double(values.size() - 1);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const auto k = double(i);
        const double whole = k * k * k + 1.5 * k * k + k + 0.25;        // of (k + t)³ over t in [0, 1]
        const double rising = 0.5 * k * k * k + k * k + 0.75 * k + 0.2; // of t (k + t)³
        sum += values[i] * (whole - rising) + values[i + 1] * rising;
    }
    return 4 * sum * h * h * h * h;
}

/// One colour of a table with a given number of entries.
class Column {
public:
    Column(const Profile& profile, double reach, std::size_t count)
        : profile_(profile), reach_(reach), values_(count) {
        for (std::size_t i = 0; i < count; ++i)
            values_[i] = profile.at(distanceAt(double(i)));
        if (std::isfinite(values_[0])) return;
        // The light of the innermost disc, of which the other end of the cell holds a share: see
        // integralOf().
        const double inner = distanceAt(1);
        values_[0] = 5 * profile.within(inner) / (kPi * inner * inner) - 4 * values_[1];
    }

    /// The largest error between two entries, over the value there.
    double error(double asked) const {
        const double floor = 1e-3 * profile_.within(reach_) / (kPi * reach_ * reach_);
        double worst = 0;
        for (std::size_t i = 0; i + 1 < values_.size(); ++i) {
            if (profile_.within(distanceAt(double(i + 1))) <= asked * profile_.total()) continue;
            const double exact = profile_.at(distanceAt(double(i) + 0.5));
            const double linear = 0.5 * (values_[i] + values_[i + 1]);
            worst = std::max(worst, std::abs(linear - exact) / std::max(exact, floor));
        }
        return worst;
    }

    /// The values, with the integral that they shall have.
    std::vector<double> scaledTo(double integral) const {
        const double found = kPi * reach_ * reach_ * integralOf(values_);
        std::vector<double> scaled = values_;
        for (double& value : scaled)
            value *= found > 0 ? integral / found : 0;
        return scaled;
    }

private:
    double distanceAt(double i) const {
        const double u = i / double(values_.size() - 1);
        return reach_ * u * u;
    }
    const Profile& profile_;
    double reach_;
    std::vector<double> values_;
};
} // namespace

double Medium::albedo() const { return extinction() > 0 ? scattering / extinction() : 0; }

double Medium::transport() const { return std::sqrt(3 * absorption * extinction()); }

bool Medium::isLayered() const {
    return std::any_of(above.begin(), above.end(), [](const Slab& slab) { return slab.thickness > 0; });
}

std::array<Medium, 3> mediaOf(const scene::Material& material) {
    const scene::Translucent& inside = material.translucent();
    std::array<Medium, 3> media;
    for (int i = 0; i < 3; ++i)
        media[std::size_t(i)] = {(1 - double(inside.anisotropy)) * double(inside.scattering[i]),
                                 double(inside.absorption[i]), double(inside.ior)};
    for (const scene::MediumLayer& layer : inside.stackedLayers())
        for (int i = 0; i < 3; ++i)
            media[std::size_t(i)].above.push_back(
                {(1 - double(layer.anisotropy)) * double(layer.scattering[i]), double(layer.absorption[i]),
                 double(layer.ior), double(layer.thickness)});
    return media;
}

double diffuseReflectance(double ior) {
    const double inverse = 1 / ior;
    // The dissertation prints 0.0668 for 0.668: below 0 at 1.5.
    if (ior >= 1) return -1.440 * inverse * inverse + 0.710 * inverse + 0.668 + 0.0636 * ior;
    return -0.4399 + 0.7099 * inverse - 0.3319 * inverse * inverse + 0.0636 * inverse * inverse * inverse;
}

double transmittedShare(double cosine, double ior) {
    const double square = 1 - (1 - cosine * cosine) / (ior * ior);
    if (square <= 0) return 0;
    const double other = std::sqrt(square);
    const double across = (cosine - ior * other) / (cosine + ior * other);
    const double along = (ior * cosine - other) / (ior * cosine + other);
    return 1 - 0.5 * (across * across + along * along);
}

double meanTransmittance(double ior) {
    return transmitted(ior, [](double) { return 2; });
}

double fluxTransmittance(double ior) {
    return transmitted(ior, [](double cosine) { return 3 * cosine; });
}

std::vector<Pole> polesOf(const Medium& medium, double thickness, double epsilon) {
    const Layer layer(medium, thickness);
    const double source = layer.depth, image = layer.virtualDepth();
    std::vector<Pole> poles = {{source, layer.share * source}, {-image, layer.share * image}};
    if (!isSlab(thickness)) return poles;

    // Past i periods the four poles of one more pair hold about period³ f''' / 4 of f = 1/z², 24 / (16 i⁴) of
    // the first ones' least; absorption ends the series earlier.
    const double period = layer.period();
    const double series = 0.5 * std::pow(epsilon, -0.25);
    const double absorbed = -std::log(epsilon) / (layer.transport * period);
    const int pairs = int(std::ceil(std::max(1.0, std::min(series, absorbed))));
    for (int i = 1; i <= pairs; ++i)
        for (const double turn : {-i * period, i * period})
            for (const auto& [depth, sign] : {std::pair(turn + source, 1.0), std::pair(turn - image, -1.0)})
                poles.push_back({depth, layer.share * sign * depth});
    // On either side the others are a sum over slopes of f at whole periods: f itself, half a period earlier.
    for (const double rest : {-(pairs + 0.5) * period, (pairs + 0.5) * period})
        poles.push_back({rest, -layer.share * (source + image) / period * std::abs(rest)});
    return poles;
}

double kernel(const Medium& medium, double d) {
    return medium.albedo() / (4 * kPi) * fall(medium.transport(), d);
}

Profile::Profile(const Medium& medium, Shape shape, double thickness) : medium_(medium) {
    if (shape == Shape::Multipole && medium.isLayered()) {
        stack_ = std::make_shared<const Stack>(medium, thickness);
        total_ = stack_->total();
        depth_ = stack_->depth();
        return;
    }
    if (medium.extinction() == 0) return;
    constexpr double kPoleError = 1e-6; // far below any table's
    if (shape != Shape::Multipole) thickness = 0;
    const Layer layer(medium, thickness);
    depth_ = layer.depth;
    total_ = medium.albedo() * layer.share * layer.leaving(layer.depth);
    if (shape == Shape::Burley)
        burley_ = medium.extinction() * (1.85 - total_ + 7 * std::pow(std::abs(total_ - 0.8), 3));
    else if (total_ > 0)
        poles_ = polesOf(medium, thickness, kPoleError);
}

double Profile::at(double r) const {
    if (total_ == 0) return 0;
    if (stack_) return stack_->at(r);
    if (burley_ > 0)
        return total_ * burley_ / (8 * kPi * r) * (std::exp(-burley_ * r) + std::exp(-burley_ * r / 3));
    double sum = 0;
    for (const Pole& pole : poles_)
        sum += pole.weight * kernel(medium_, std::hypot(r, pole.depth));
    return sum;
}

double Profile::within(double r) const {
    if (total_ == 0) return 0;
    if (stack_) return stack_->within(r);
    if (burley_ > 0) return -total_ * (0.25 * std::expm1(-burley_ * r) + 0.75 * std::expm1(-burley_ * r / 3));
    // A pole leaves -e^(-sigma d) / d as the integral of its d fall(d).
    const double transport = medium_.transport();
    double beyond = 0;
    for (const Pole& pole : poles_) {
        const double d = std::hypot(r, pole.depth);
        beyond += pole.weight * std::exp(-transport * d) / d;
    }
    return total_ - 0.5 * medium_.albedo() * beyond;
}

double Profile::reach(double epsilon, double most) const {
    if (total_ == 0) return 0;
    const double wanted = (1 - epsilon) * total_;
    if (within(most) <= wanted) return most;
    double low = 0, high = most;
    while (high - low > 1e-9 * high) {
        const double middle = 0.5 * (low + high);
        (within(middle) < wanted ? low : high) = middle;
    }
    return high;
}

double reflectance(const Medium& medium, Shape shape, double thickness, double r) {
    return Profile(medium, shape, thickness).at(r);
}

double totalReflectance(const Medium& medium, Shape shape, double thickness) {
    return Profile(medium, shape, thickness).total();
}

double reflectanceWithin(const Medium& medium, Shape shape, double thickness, double r) {
    return Profile(medium, shape, thickness).within(r);
}

double transmittance(const Medium& medium, double thickness, double r) {
    if (medium.isLayered()) return Stack(medium, thickness, Stack::Side::Other).at(r);
    if (!isSlab(thickness) || medium.albedo() == 0) return 0;
    double sum = 0;
    for (const Pole& pole : polesOf(medium, thickness, 1e-6)) {
        const double away = thickness - pole.depth; // seen from the other side
        const double strength = pole.weight / pole.depth;
        sum += strength * away * kernel(medium, std::hypot(r, away));
    }
    return sum;
}

double totalTransmittance(const Medium& medium, double thickness) {
    if (medium.isLayered()) return Stack(medium, thickness, Stack::Side::Other).total();
    if (!isSlab(thickness) || medium.albedo() == 0) return 0;
    const Layer layer(medium, thickness);
    return medium.albedo() * layer.share * layer.leaving(thickness - layer.depth);
}

std::array<Profile, 3> profilesOf(const std::array<Medium, 3>& media, Shape shape, double thickness) {
    return {Profile(media[0], shape, thickness), Profile(media[1], shape, thickness),
            Profile(media[2], shape, thickness)};
}

Table tableOf(const std::array<Profile, 3>& profiles, double reach, double error, bool whole) {
    Table table{reach, {vec3(0), vec3(0)}, 0};
    if (reach == 0) return table;
    for (const Profile& profile : profiles) {
        std::size_t count = 32;
        double reached = 0;
        const auto fits = [&](const Column& column) {
            reached = profile.total() == 0 ? 0 : column.error(error);
            return reached <= error || count >= std::size_t(kMostEntries);
        };
        while (!fits(Column(profile, reach, count)))
            count *= 2;
        table.error = std::max(table.error, reached);
        table.values.resize(std::max(table.values.size(), count));
    }
    for (int i = 0; i < 3; ++i) {
        const Profile& profile = profiles[std::size_t(i)];
        const Column column(profile, reach, table.values.size());
        const std::vector<double> values = column.scaledTo(whole ? profile.total() : profile.within(reach));
        for (std::size_t k = 0; k < values.size(); ++k)
            table.values[k][i] = float(values[k]);
    }
    return table;
}

vec3 valueAt(const Table& table, double r) {
    if (!(r < table.reach)) return vec3(0);
    const double i = std::sqrt(r / table.reach) * double(table.values.size() - 1);
    const std::size_t below = std::min(std::size_t(i), table.values.size() - 2);
    return glm::mix(table.values[below], table.values[below + 1], float(i - double(below)));
}

} // namespace lucent::diffusion
