#include "diffusion/Stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::diffusion {

namespace {
using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// (1 - e^(-2x)) / (2x): sinh(x) / x over e^x.
Complex fall(Complex x) {
    if (std::abs(x) < 1e-4) return 1.0 - x + 2.0 / 3 * x * x;
    return (1.0 - std::exp(-2.0 * x)) / (2.0 * x);
}

/// Between two indices of refraction: see Stack::Passage. With partial currents phi / 4 -+ flux / 2, of which
/// each direction loses its own share to reflection, T_ab phi_a - T_ba phi_b = 2 (R_ab + R_ba) flux, R the
/// share that a flux loses, 3 integral of R(c) c² dc, and T n² the same from both sides.
struct Jump {
    double ratio = 1, drop = 0;
    Jump(double from, double to) {
        if (from == to) return;
        const double lost = 2 - fluxTransmittance(to / from) - fluxTransmittance(from / to); // R_ab + R_ba
        ratio = to * to / (from * from);
        drop = 2 * lost / meanTransmittance(from / to);
    }
};

/// Integrals over frequencies, R(r) = integral of R(k) J0(k r) k dk / 2 pi, by the trapezium rule over
/// log |k| along the ray arg k = pi / 4, where nothing oscillates: what diffuses has its poles and cuts on
/// the imaginary axis (k² < 0), J0 is the real part of Hankel's function, and that falls along the ray. Both
/// lie pi / 4 off, so that steps h leave e^(-pi² / (2 h)) of the light.
///
/// Distances are powers of e^kStep and frequencies of e^(2 kStep): products of both are powers again, for
/// which Hankel's functions are kept.
constexpr double kStep = 0.075;
const Complex kRay = std::polar(1.0, kPi / 4);

/// Hankel's functions at e^(kStep n) kRay, of order 0, and of order 1 without its pole.
struct Hankel {
    Complex zero, one;
};

/// K_v(x) = integral of e^(-x cosh t) cosh(v t) dt over t > 0, x = e^(kStep n) / kRay.
Hankel hankelAt(int n) {
    constexpr double kFine = 0.12; // e^(-pi² / (2 h)) again
    const double size = std::exp(kStep * n);
    const Complex x = size / kRay, outer = std::exp(-x);
    Complex zero = 0.5 * outer, one = zero;
    for (int i = 1; size * (std::cosh(i * kFine) - 1) < 60; ++i) {
        const double cosine = std::cosh(i * kFine);
        const Complex value = outer * std::exp(-x * (cosine - 1));
        zero += value;
        one += cosine * value;
    }
    const Complex i(0, 1);
    return {2 / kPi * kFine * zero / i, -2 / kPi * kFine * one + 2.0 * i / (kPi * size * kRay)};
}

constexpr int kLeastHankel = -600, kMostHankel = 60; // k r from 3e-20 to 90

const Hankel& hankel(int n) {
    static const auto known = [] {
        std::vector<Hankel> list;
        for (int i = kLeastHankel; i <= kMostHankel; ++i)
            list.push_back(hankelAt(i));
        return list;
    }();
    return known[std::size_t(n - kLeastHankel)];
}

/// Cubic through four values at whole numbers, at a place `t` between the two in the middle.
double between(const double* values, double t) {
    return values[0] * (-t * (t - 1) * (t - 2) / 6) + values[1] * ((t + 1) * (t - 1) * (t - 2) / 2) +
           values[2] * (-(t + 1) * t * (t - 2) / 2) + values[3] * ((t + 1) * t * (t - 1) / 6);
}
} // namespace

/// phi and the flux that leaves, over e^exponent.
struct Stack::Wave {
    Complex fluence, flux, exponent = 0;

    void cross(const Sheet& sheet, Complex square) {
        const Complex slope = sheet.absorption / sheet.diffusion + square; // q²
        const Complex x = std::sqrt(slope) * sheet.thickness;
        const Complex even = 0.5 * (1.0 + std::exp(-2.0 * x)), odd = sheet.thickness * fall(x);
        const Complex before = fluence;
        fluence = even * before + odd / sheet.diffusion * flux;
        flux = even * flux + odd * sheet.diffusion * slope * before;
        exponent += x;
    }
};

Stack::Stack(const Medium& medium, double thickness, Side side) {
    const bool endless = !(thickness > 0 && std::isfinite(thickness));
    std::vector<Sheet> sheets;
    double densest = 0;
    const auto add = [&](double scattering, double absorption, double thick, double ior) {
        const double extinction = scattering + absorption;
        // What is clear is crossed straight: for diffusion it is not there.
        if (!(extinction > 0 && thick > 0)) return;
        densest = std::max(densest, extinction);
        sheets.push_back({1 / (3 * extinction), absorption, extinction, scattering / extinction, thick, ior});
    };
    for (const Slab& slab : medium.above)
        add(slab.scattering, slab.absorption, slab.thickness, slab.ior);
    add(medium.scattering, medium.absorption, endless ? kInfinity : thickness, medium.ior);
    if (densest == 0 || (endless && side == Side::Other)) return;
    // Nothing comes back from an endless clear medium: it is as black.
    if (endless && medium.extinction() == 0) add(0, densest, kInfinity, medium.ior);
    placeSource(std::move(sheets));
    if (side == Side::Other) std::swap(near_, far_);
    if (!tabulate()) {
        near_.ending.diffusion = far_.ending.diffusion = 0;
        tabulate();
    }
}

/// The media of the first collision, by their shares of it.
Stack::Ending Stack::endingOf(const std::vector<Sheet>& sheets) {
    double extinction = 0, absorption = 0, left = 1;
    for (const Sheet& sheet : sheets) {
        const double share = -left * std::expm1(-sheet.extinction * sheet.thickness);
        extinction += share * sheet.extinction;
        absorption += share * sheet.absorption;
        left -= share;
    }
    const double internal = diffuseReflectance(sheets.front().ior);
    return {2 * (1 + internal) / (1 - internal), (1 - left) / (3 * extinction), absorption / (1 - left)};
}

Stack::Way Stack::wayOf(std::vector<Sheet> sheets, const Ending& ending) {
    Way way{std::move(sheets), {}, ending, !std::isfinite(way.sheets.front().thickness)};
    for (std::size_t i = 0; i + 1 < way.sheets.size(); ++i) {
        const Jump jump(way.sheets[i].ior, way.sheets[i + 1].ior);
        way.passages.push_back({jump.ratio, jump.drop});
    }
    return way;
}

/// Parts the sheets where the source of diffuse light stands.
void Stack::placeSource(std::vector<Sheet> sheets) {
    double optical = 0, collides = 0;
    for (const Sheet& sheet : sheets) {
        collides -= std::exp(-optical) * std::expm1(-sheet.extinction * sheet.thickness) * sheet.albedo;
        optical += sheet.extinction * sheet.thickness;
    }
    strength_ = collides;
    // Of an exponential distribution that ends; half of it, by its series, where little collides.
    double left = !std::isfinite(optical) ? 1
                  : optical < 1e-4        ? optical * (0.5 - optical / 12)
                                          : 1 + optical * std::exp(-optical) / std::expm1(-optical);
    std::vector<Sheet> above, below = sheets;
    slowest_ = kInfinity;
    for (const Sheet& sheet : sheets)
        slowest_ = std::min(slowest_, std::sqrt(sheet.absorption / sheet.diffusion));
    while (below.size() > 1 && left > below.front().extinction * below.front().thickness) {
        left -= below.front().extinction * below.front().thickness;
        depth_ += below.front().thickness;
        above.push_back(below.front());
        below.erase(below.begin());
    }
    const double within = std::min(left / below.front().extinction, below.front().thickness);
    depth_ += within;
    above.push_back(below.front());
    above.back().thickness = within;
    below.front().thickness -= within;
    std::reverse(below.begin(), below.end());
    near_ = wayOf(std::move(above), endingOf(sheets));
    std::reverse(sheets.begin(), sheets.end());
    far_ = wayOf(std::move(below), endingOf(sheets));
}

Stack::Wave Stack::follow(const Way& way, Complex square) {
    const Sheet& outer = way.sheets.front();
    Wave wave{};
    std::size_t next = 0;
    if (way.isEndless) {
        wave = {1, outer.diffusion * std::sqrt(outer.absorption / outer.diffusion + square)};
        if (!way.passages.empty())
            wave.fluence = way.passages[0].ratio * wave.fluence + way.passages[0].drop * wave.flux;
        next = 1;
    } else {
        const Ending& ending = way.ending;
        const Complex x =
            ending.twoA * std::sqrt(ending.diffusion * (ending.absorption + ending.diffusion * square));
        wave = {ending.twoA * 2.0 * fall(x) / (1.0 + std::exp(-2.0 * x)), 1};
    }
    for (; next < way.sheets.size(); ++next) {
        wave.cross(way.sheets[next], square);
        if (next < way.passages.size())
            wave.fluence = way.passages[next].ratio * wave.fluence + way.passages[next].drop * wave.flux;
    }
    return wave;
}

/// At a spatial frequency, of which this is the square.
Complex Stack::leaving(Complex square) const {
    const Wave near = follow(near_, square), far = follow(far_, square);
    const Complex both = near.flux * far.fluence + far.flux * near.fluence;
    return strength_ * std::exp(-near.exponent) * far.fluence / both;
}

/// False where light would enter again.
bool Stack::tabulate() {
    values_.clear(), shares_.clear();
    total_ = leaving(0).real();
    if (!(total_ > 0)) return true;
    // From where the profile is level to where it ends; what lies farther than 1e5 depths is little even
    // without absorption.
    double away = 0; // the source, from this side
    for (const Sheet& sheet : near_.sheets)
        away += sheet.thickness;
    const double farthest = std::min(1e5 * away, 20 / slowest_);
    first_ = int(std::floor(std::log(1e-3 * away) / kStep));
    const int last = int(std::ceil(std::log(std::max(farthest, 1e-2 * away)) / kStep));
    const int lowest = int(std::floor(std::log(1e-7 / std::max(farthest, away)) / (2 * kStep)));
    const int highest = int(std::ceil(std::log(60 / away) / (2 * kStep))); // e^(-60 / sqrt 2)

    struct Part { // of one frequency
        Complex light, rising;
        double pole;
    };
    std::vector<Part> parts;
    for (int i = lowest; i <= highest; ++i) {
        const Complex k = std::exp(2 * kStep * i) * kRay, light = k * 2.0 * kStep * leaving(k * k);
        parts.push_back({light, light * k, (light * (2.0 / kPi) * Complex(0, 1) / k).real()});
    }
    // Of a product that is finite: what std::complex does for others takes most of the time.
    const auto realOf = [](const Complex& a, const Complex& b) {
        return a.real() * b.real() - a.imag() * b.imag();
    };
    for (int j = first_; j <= last; ++j) {
        const double r = std::exp(kStep * j);
        double value = 0, share = 0;
        for (int i = lowest; i <= highest; ++i) {
            const Part& part = parts[std::size_t(i - lowest)];
            const int product = 2 * i + j;
            if (product > kMostHankel) { // of which only the pole is left, that was taken out
                share += part.pole;
                continue;
            }
            const Hankel& known = hankel(std::max(product, kLeastHankel));
            value += realOf(part.rising, known.zero);
            share += r * realOf(part.light, known.one);
        }
        if (!(value * r * r > 1e-9 * total_) || !(share > 0)) // rounding, or all of it
            return std::abs(value) * r * r < 1e-9 * total_ || total_ < 1e-9;
        values_.push_back(std::log(value / (2 * kPi)));
        shares_.push_back(std::log(share));
    }
    return true;
}

double Stack::at(double r) const {
    if (values_.size() < 4) return 0;
    const double place = r > 0 ? std::log(r) / kStep - first_ : 0;
    if (place > double(values_.size() - 1)) return 0;
    if (place <= 0) return std::exp(values_.front()); // level
    const std::size_t below = std::clamp(std::size_t(place), std::size_t(1), values_.size() - 3);
    return std::exp(between(&values_[below - 1], place - double(below)));
}

double Stack::within(double r) const {
    if (shares_.size() < 4 || !(r > 0)) return 0;
    const double place = std::log(r) / kStep - first_;
    if (place > double(shares_.size() - 1)) return total_;
    if (place <= 0) return std::exp(shares_.front() + 2 * kStep * place);
    const std::size_t below = std::clamp(std::size_t(place), std::size_t(1), shares_.size() - 3);
    return std::min(total_, std::exp(between(&shares_[below - 1], place - double(below))));
}

} // namespace lucent::diffusion
