#include "truth/Basin.h"

#include "scene/Mesh.h"
#include "scene/Water.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lucent::truth {

namespace {
/// What a number behind a wall mirrors.
int mirrored(int i, int last) {
    const int turned = std::abs(i) % (2 * last);
    return std::min(turned, 2 * last - turned);
}

/// Turns samples into the weights of the cubic B-splines that go through them, ends mirrored (Unser,
/// Aldroubi, Eden 1993): a recursion forwards, then one backwards, by the pole sqrt 3 - 2.
///
/// @param at  the i-th of `count` samples
template <class At>
void makeWeights(int count, const At& at) {
    const double pole = std::numbers::sqrt3 - 2;
    constexpr int kHorizon = 40; // pole^40 is 1e-23
    double sum = 0;
    for (int k = kHorizon; k >= 0; --k)
        sum = pole * sum + 6 * at(mirrored(k, count - 1));
    at(0) = sum;
    for (int i = 1; i < count; ++i)
        at(i) = 6 * at(i) + pole * at(i - 1);
    at(count - 1) = pole / (pole * pole - 1) * (at(count - 1) + pole * at(count - 2));
    for (int i = count - 2; i >= 0; --i)
        at(i) = pole * (at(i + 1) - at(i));
}

struct Weights {
    std::array<double, 4> value, slope; ///< of the lines before, at, behind and two behind a place
    explicit Weights(double f)
        : value{(1 - f) * (1 - f) * (1 - f) / 6, (4 - 6 * f * f + 3 * f * f * f) / 6,
                (1 + 3 * f + 3 * f * f - 3 * f * f * f) / 6, f * f * f / 6},
          slope{-(1 - f) * (1 - f) / 2, f * (1.5 * f - 2), 0.5 + f - 1.5 * f * f, f * f / 2} {}
};

struct Steps {
    double length; ///< s
    double whole;  ///< until the time
    double rest;   ///< s since the last one
};
Steps stepsUntil(const scene::Water& water, double time) {
    constexpr double kRounding = 1e-5; // of a step: times come as floats
    const double length = 1.0 / scene::waterStepsPerSecond(water), steps = time / length;
    const double whole = std::floor(steps + kRounding);
    return {length, whole, std::max(0.0, (steps - whole) * length)};
}
} // namespace

double Basin::work(const scene::Water& water, double time) {
    const dvec2 cells(scene::waterCells(water));
    return stepsUntil(water, time).whole * cells.x * cells.y;
}

Basin::Basin(const scene::Water& water, double time)
    : last_(scene::waterCells(water)), half_(0.5 * dvec2(water.size)), cell_(2.0 * half_ / dvec2(last_)) {
    const Steps steps = stepsUntil(water, time);
    begin(water, steps.length);
    const auto fallen = [&](double step) {
        return water.dropInterval > 0 ? std::floor(step * steps.length / double(water.dropInterval)) : 0;
    };
    for (double done = 1; done <= steps.whole; ++done) {
        advance(water, steps.length);
        if (fallen(done) > fallen(done - 1)) drop(water, fallen(done));
    }
    for (std::size_t i = 0; i < heights_.size(); ++i)
        heights_[i] += steps.rest * rises_[i];
    makeSpline();
}

std::size_t Basin::number(int x, int z) const {
    return std::size_t(mirrored(z, last_.y)) * std::size_t(last_.x + 1) + std::size_t(mirrored(x, last_.x));
}

void Basin::begin(const scene::Water& water, double step) {
    const double k = 2 * std::numbers::pi / double(water.wavelength), damping = double(water.damping);
    const dvec2 wave = k * glm::normalize(dvec2(water.direction));
    const double fastest = double(water.speed) * k;
    const double frequency = std::sqrt(std::max(0.0, fastest * fastest - damping * damping / 4));
    const double early = -step / 2;
    for (int z = 0; z <= last_.y; ++z)
        for (int x = 0; x <= last_.x; ++x) {
            const double turn = glm::dot(wave, dvec2(x, z) * cell_ - half_), then = turn - frequency * early;
            heights_.push_back(double(water.amplitude) * std::sin(turn));
            rises_.push_back(double(water.amplitude) * std::exp(-damping * early / 2) *
                             (-damping / 2 * std::sin(then) - frequency * std::cos(then)));
        }
}

void Basin::advance(const scene::Water& water, double step) {
    const dvec2 perCell = 1.0 / (cell_ * cell_);
    const double speed = double(water.speed), drag = double(water.damping) * step / 2;
    for (int z = 0; z <= last_.y; ++z) {
        const std::size_t rows[] = {number(0, z - 1), number(0, z), number(0, z + 1)};
        for (int x = 0; x <= last_.x; ++x) {
            const std::size_t columns[] = {number(x - 1, 0), number(x, 0), number(x + 1, 0)};
            const auto h = [&](int i, int j) { return heights_[rows[j + 1] + columns[i + 1]]; };
            const double here = h(0, 0), alongX = h(-1, 0) - 2 * here + h(1, 0),
                         alongZ = h(0, -1) - 2 * here + h(0, 1);
            // The second difference along x of that along z.
            const double both = h(-1, -1) + h(1, -1) + h(-1, 1) + h(1, 1) - 4 * here - 2 * (alongX + alongZ);
            const double bend = perCell.x * alongX + perCell.y * alongZ + (perCell.x + perCell.y) * both / 12;
            double& rise = rises_[rows[1] + columns[1]];
            rise = (rise * (1 - drag) + step * speed * speed * bend) / (1 + drag);
        }
    }
    for (std::size_t i = 0; i < heights_.size(); ++i)
        heights_[i] += step * rises_[i];
}

void Basin::drop(const scene::Water& water, double n) {
    const scene::WaterDrop drop = scene::fallingDrop(water, n);
    const dvec2 middle(drop.place);
    const double radius = std::max(double(drop.radius), 2 * std::max(cell_.x, cell_.y));
    for (int z = 0; z <= last_.y; ++z)
        for (int x = 0; x <= last_.x; ++x)
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) {
                    const dvec2 image(i == 0 ? middle.x : 2 * i * half_.x - middle.x,
                                      j == 0 ? middle.y : 2 * j * half_.y - middle.y);
                    const dvec2 apart = (dvec2(x, z) * cell_ - half_ - image) / radius;
                    const double q = glm::dot(apart, apart);
                    heights_[number(x, z)] -= double(drop.depth) * (1 - q) * std::exp(-q);
                }
}

void Basin::makeSpline() {
    spline_ = heights_;
    for (int z = 0; z <= last_.y; ++z)
        makeWeights(last_.x + 1, [&](int x) -> double& { return spline_[number(x, z)]; });
    for (int x = 0; x <= last_.x; ++x)
        makeWeights(last_.y + 1, [&](int z) -> double& { return spline_[number(x, z)]; });
    const auto [low, high] = std::minmax_element(spline_.begin(), spline_.end());
    range_ = {*low, *high};
}

Basin::Surface Basin::at(const dvec2& place) const {
    const dvec2 cells = inCells(place), low = glm::floor(cells);
    const Weights x(cells.x - low.x), z(cells.y - low.y);
    Surface surface{0, dvec2(0)};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const double weight = spline_[number(int(low.x) + i - 1, int(low.y) + j - 1)];
            const auto column = std::size_t(i), row = std::size_t(j);
            surface.height += weight * x.value[column] * z.value[row];
            surface.slope += weight * dvec2(x.slope[column] * z.value[row], x.value[column] * z.slope[row]);
        }
    surface.slope /= cell_;
    return surface;
}

// B-splines are positive and sum to 1: the surface lies among their weights.
std::pair<double, double> Basin::range(ivec2 cell) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) {
            const double weight = spline_[number(cell.x + i, cell.y + j)];
            low = std::min(low, weight);
            high = std::max(high, weight);
        }
    return {low, high};
}

} // namespace lucent::truth
