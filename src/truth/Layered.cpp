#include "truth/Layered.h"

#include "truth/Interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <math.h> // Bessel functions: <cmath> has none in some libraries
#include <numbers>
#include <utility>

namespace lucent::truth {

namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kStep = 0.06; ///< between logarithms of distances

/// Zeros of Legendre's polynomial of order 12 on [0, 1], and their weights.
struct Gauss {
    static constexpr int kCount = 12;
    std::array<double, kCount> places, weights;

    Gauss() {
        for (std::size_t i = 0; i < places.size(); ++i) {
            double x = std::cos(kPi * (double(i) + 0.75) / (kCount + 0.5)), slope = 1;
            for (int step = 0; step < 50; ++step) {
                double before = 1, now = x;
                for (int n = 2; n <= kCount; ++n)
                    before = std::exchange(now, ((2 * n - 1) * x * now - (n - 1) * before) / n);
                slope = kCount * (x * now - before) / (x * x - 1);
                x -= now / slope;
            }
            places[i] = 0.5 * (1 + x);
            weights[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

template <class Function>
double integral(const Function& f, double from, double to) {
    static const Gauss rule;
    double sum = 0;
    for (std::size_t i = 0; i < rule.places.size(); ++i)
        sum += rule.weights[i] * f(from + (to - from) * rule.places[i]);
    return (to - from) * sum;
}

/// The limit of a sequence of sums (Wynn 1956).
double limitOf(const std::vector<double>& sums) {
    std::vector<double> before(sums.size() + 1, 0.0), now = sums;
    double limit = sums.back();
    while (now.size() > 2) {
        std::vector<double> next;
        for (std::size_t i = 0; i + 1 < now.size(); ++i) {
            const double apart = now[i + 1] - now[i];
            if (apart == 0) return now[i];
            next.push_back(before[i + 1] + 1 / apart);
        }
        before = std::exchange(now, std::move(next));
        if ((sums.size() - now.size()) % 2 == 0) limit = now.back();
    }
    return limit;
}

/// The diffusion equation of a stack, for waves along it.
class Waves {
public:
    explicit Waves(const std::vector<Layer>& layers) {
        for (const Layer& layer : layers) {
            const double scattering = layer.inside.reducedScattering();
            const double extinction = scattering + layer.inside.absorption;
            // For diffusion a clear layer is not there.
            if (extinction > 0 && layer.thickness > 0)
                sheets_.push_back({1 / (3 * extinction), layer.inside.absorption, extinction,
                                   scattering / extinction, layer.thickness, layer.inside.ior});
        }
        if (sheets_.empty()) return;
        placeSource();
        top_ = edgeOf(0, 1);
        bottom_ = edgeOf(int(sheets_.size()) - 1, -1);
        for (std::size_t i = 0; i + 1 < sheets_.size(); ++i)
            gates_.push_back({sheets_[i].ior, sheets_[i + 1].ior});
    }

    double strength() const { return strength_; }
    double depth() const { return depth_; }
    double image() const { return depth_ + 2 * top_.twoA * top_.diffusion; }
    void useMixedBoundary() { top_.diffusion = bottom_.diffusion = 0; }

    /// What leaves above at spatial frequency k, > 0.
    double leaving(double k) const {
        const std::size_t count = sheets_.size(), size = 2 * count;
        Rows rows(size, std::vector<double>(size + 1, 0.0));
        // Of sheet i the unknowns a = [2 i] and b = [2 i + 1]: phi = a e^(-q z) + b e^(-q (d - z)), and in
        // that of the source e^(-q |z - s|) / (2 D q) beside.
        struct End {
            double a, b, source; ///< factors of them
        };
        const auto phi = [&](std::size_t i, bool low) -> End {
            const double q = rate(i, k), far = std::exp(-q * sheets_[i].thickness);
            const double away = low ? sheets_[i].thickness - within_ : within_;
            const double source = i == in_ ? std::exp(-q * away) / (2 * sheets_[i].diffusion * q) : 0;
            return low ? End{far, 1, source} : End{1, far, source};
        };
        const auto flux = [&](std::size_t i, bool low) -> End { // downward
            const double strength = sheets_[i].diffusion * rate(i, k);
            const End value = phi(i, low);
            return {strength * value.a, -strength * value.b, (low ? 1 : -1) * strength * value.source};
        };
        const auto add = [&](std::vector<double>& row, std::size_t i, const End& end, double factor) {
            row[2 * i] += factor * end.a;
            row[2 * i + 1] += factor * end.b;
            row[size] -= factor * end.source;
        };
        add(rows[0], 0, flux(0, false), 1);
        add(rows[0], 0, phi(0, false), top_.ratio(k));
        for (std::size_t i = 0; i + 1 < count; ++i) {
            std::vector<double>&goes = rows[2 * i + 1], &passes = rows[2 * i + 2];
            add(goes, i, flux(i, true), 1);
            add(goes, i + 1, flux(i + 1, false), -1);
            add(passes, i, phi(i, true), gates_[i].down);
            add(passes, i + 1, phi(i + 1, false), -gates_[i].up);
            add(passes, i, flux(i, true), -2 * gates_[i].lost);
        }
        if (std::isfinite(sheets_.back().thickness)) {
            add(rows[size - 1], count - 1, flux(count - 1, true), 1);
            add(rows[size - 1], count - 1, phi(count - 1, true), -bottom_.ratio(k));
        } else {
            rows[size - 1][size - 1] = 1; // nothing grows downward
        }
        const std::vector<double> found = solved(rows);
        const End up = flux(0, false);
        return -strength_ * (up.a * found[0] + up.b * found[1] + up.source);
    }

private:
    using Rows = std::vector<std::vector<double>>;
    struct Sheet {
        double diffusion, absorption, extinction, albedo, thickness, ior;
    };
    /// Flux that leaves over phi.
    struct Edge {
        double twoA, diffusion, absorption;
        double ratio(double k) const {
            if (diffusion == 0) return 1 / twoA;
            const double q = std::sqrt(absorption / diffusion + k * k);
            return diffusion * q / std::tanh(q * twoA * diffusion);
        }
    };
    /// Of partial currents, shares that pass downward and upward, and lost of a flux in both directions.
    struct Gate {
        double down = 1, up = 1, lost = 0;
        Gate(double above, double below) {
            if (above == below) return;
            const auto mean = [](double relative, int power) {
                const double critical = relative > 1 ? std::sqrt(1 - 1 / (relative * relative)) : 0;
                const auto f = [&](double t) { // squares take the roots at both ends out of it
                    const double c = critical + (1 - critical) * t * t;
                    return (power + 1) * reflectance(c, relative) * std::pow(c, power) * 2 * t *
                           (1 - critical);
                };
                return std::pow(critical, power + 1) + integral(f, 0, 0.5) + integral(f, 0.5, 1);
            };
            down = 1 - mean(above / below, 1);
            up = 1 - mean(below / above, 1);
            lost = mean(above / below, 2) + mean(below / above, 2);
        }
    };

    double rate(std::size_t i, double k) const {
        return std::sqrt(sheets_[i].absorption / sheets_[i].diffusion + k * k);
    }

    void placeSource() {
        double optical = 0;
        for (const Sheet& sheet : sheets_) {
            const double collides = -std::expm1(-sheet.extinction * sheet.thickness);
            strength_ += std::exp(-optical) * collides * sheet.albedo;
            optical += sheet.extinction * sheet.thickness;
        }
        double left = 1;
        if (optical < 1e-4)
            left = optical * (0.5 - optical / 12);
        else if (std::isfinite(optical))
            left = 1 - optical * std::exp(-optical) / -std::expm1(-optical);
        while (in_ + 1 < sheets_.size() && left > sheets_[in_].extinction * sheets_[in_].thickness) {
            left -= sheets_[in_].extinction * sheets_[in_].thickness;
            depth_ += sheets_[in_++].thickness;
        }
        within_ = left / sheets_[in_].extinction;
        depth_ += within_;
    }
    Edge edgeOf(int from, int step) const {
        double left = 1, extinction = 0, absorption = 0;
        for (int i = from; i >= 0 && i < int(sheets_.size()); i += step) {
            const Sheet& sheet = sheets_[std::size_t(i)];
            const double next = left * std::exp(-sheet.extinction * sheet.thickness);
            extinction += (left - next) * sheet.extinction;
            absorption += (left - next) * sheet.absorption;
            left = next;
        }
        const double internal = internalReflection(sheets_[std::size_t(from)].ior), all = 1 - left;
        return {2 * (1 + internal) / (1 - internal), all / (3 * extinction), absorption / all};
    }
    /// By elimination, the largest of a column first.
    static std::vector<double> solved(Rows& rows) {
        const std::size_t size = rows.size();
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = i + 1; j < size; ++j)
                if (std::abs(rows[j][i]) > std::abs(rows[i][i])) std::swap(rows[i], rows[j]);
            for (std::size_t j = i + 1; j < size; ++j) {
                const double factor = rows[j][i] / rows[i][i];
                for (std::size_t c = i; factor != 0 && c <= size; ++c)
                    rows[j][c] -= factor * rows[i][c];
            }
        }
        std::vector<double> found(size);
        for (std::size_t i = size; i-- > 0;) {
            double value = rows[i][size];
            for (std::size_t c = i + 1; c < size; ++c)
                value -= rows[i][c] * found[c];
            found[i] = value / rows[i][i];
        }
        return found;
    }

    std::vector<Sheet> sheets_;
    std::vector<Gate> gates_; ///< below each sheet but the last
    Edge top_{}, bottom_{};
    std::size_t in_ = 0; ///< sheet of the source
    double within_ = 0;  ///< m, of the source below that sheet's top
    double depth_ = 0, strength_ = 0;
};

double transformed(const Waves& waves, double r) {
    constexpr int kPanels = 40;
    const double panel = std::min(kPi / r, 2 / waves.depth());
    const auto f = [&](double k) { return waves.leaving(k) * ::j0(k * r) * k; };
    double sum = 0;
    for (int i = 10; i >= 0; --i) // near 0 absorption may bend what else is smooth
        sum += integral(f, i == 10 ? 0 : panel / (2 << i), panel / (1 << i));
    std::vector<double> sums = {sum};
    while (int(sums.size()) < kPanels || (panel < kPi / r && sums.size() * panel * waves.depth() < 40)) {
        sum += integral(f, double(sums.size()) * panel, double(sums.size() + 1) * panel);
        sums.push_back(sum);
    }
    return (panel < kPi / r ? sum : limitOf(sums)) / (2 * kPi);
}
} // namespace

double internalReflection(double ior) {
    if (ior < 1) return -0.4399 + 0.7099 / ior - 0.3319 / (ior * ior) + 0.0636 / (ior * ior * ior);
    return -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
}

LayeredResponse::LayeredResponse(const std::vector<Layer>& layers, double most) {
    Waves waves(layers);
    if (waves.strength() == 0) return;
    depths_ = {waves.depth(), waves.image()};
    first_ = std::log(1e-3 * waves.depth());
    const int count = std::max(4, int(std::ceil((std::log(most) - first_) / kStep)) + 2);
    for (int i = 0; i < count; ++i) {
        const double r = std::exp(first_ + i * kStep), value = transformed(waves, r);
        if (value * r * r < -1e-7 * waves.strength()) { // light would enter again
            waves.useMixedBoundary();
            values_.clear();
            i = -1;
            continue;
        }
        if (!(value * r * r > 1e-9 * waves.strength())) break; // rounding
        values_.push_back(std::log(value));
    }
}

double LayeredResponse::at(double r) const {
    const double place = r > 0 ? (std::log(r) - first_) / kStep : 0;
    if (values_.size() < 4 || place > double(values_.size() - 1)) return 0;
    if (place <= 0) return std::exp(values_.front()); // level
    const std::size_t below = std::clamp(std::size_t(place), std::size_t(1), values_.size() - 3);
    const double t = place - double(below);
    const double* v = &values_[below - 1];
    return std::exp(v[0] * (-t * (t - 1) * (t - 2) / 6) + v[1] * ((t + 1) * (t - 1) * (t - 2) / 2) +
                    v[2] * (-(t + 1) * t * (t - 2) / 2) + v[3] * ((t + 1) * t * (t - 1) / 6));
}

} // namespace lucent::truth
