#include "scene/Water.h"

#include "base/Text.h"
#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {

// The n-th of a sequence of places that fill a rectangle evenly (Roberts 2018: the plastic number's powers);
// sizes are chosen by eye.
WaterDrop fallingDrop(const Water& water, double n) {
    const dvec2 turns = n * dvec2(0.7548776662466927, 0.5698402909980532);
    const float radius = 0.04f * std::min(water.size.x, water.size.y);
    return {water.size * vec2(turns - glm::floor(turns) - 0.5), radius, 0.3f * radius};
}

// Waves of the shortest length that the grid holds must turn by less than half a turn a step. Second
// derivatives over nine points bend them by at most speed² times the larger of these.
int waterStepsPerSecond(const Water& water) {
    const dvec2 cell(water.size / vec2(waterCells(water)));
    const dvec2 perCell = 1.0 / (cell * cell);
    const double most = std::max(8.0 / 3 * (perCell.x + perCell.y), 4 * std::max(perCell.x, perCell.y));
    constexpr double kSafety = 1.05; // damping and rounding take none of it
    const double needed = kSafety * double(water.speed) * std::sqrt(most) / 2;
    return kWaterStepsPerSecond * std::max(1, int(std::ceil(needed / kWaterStepsPerSecond)));
}

Error waterTooFarAhead(const std::string& object, float time, double work) {
    return Error{"view.time: is " + shortest(time) + ", to which the waves of objects." + object + " take " +
                 shortest(work) + " steps of cells; must take at most " + shortest(kMostWaterWork)};
}

} // namespace lucent::scene
