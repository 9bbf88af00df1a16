#include "views/EnvironmentLights.h"

#include <algorithm>
#include <cmath>

namespace lucent::views {

namespace {

// Rings of equal height in polar angle; a ring's number of cells follows its length, so cells are nearly
// square.
struct Rings {
    explicit Rings(int count) : rows(std::max(2, int(std::lround(std::sqrt(count * kPi / 4))))) {
        for (int row = 0; row < rows; ++row) {
            first.push_back(total);
            columns.push_back(std::max(3, int(std::lround(2 * rows * std::sin((row + 0.5) * kPi / rows)))));
            total += columns.back();
        }
    }
    int rows, total = 0;
    std::vector<int> first, columns;
};

// Direction of a place on a lat-long map: row 0 = +y, centre column = -z, to the right = +x.
glm::dvec3 directionAt(double u, double v) {
    const double azimuth = (2 * u - 1) * std::numbers::pi;
    const double polar = v * std::numbers::pi;
    return {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)};
}

// Integral of a pixel row's radiance into the cells: each pixel is shared out by the area it has in each.
struct Sums {
    explicit Sums(int cells) : radiance(cells, glm::dvec3(0)), area(cells, 0) {}
    std::vector<glm::dvec3> radiance;
    std::vector<double> area;
};

// Adds a pixel's part inside one ring, split at the borders of the ring's cells.
void addPixel(Sums& sums, const Rings& rings, int row, double left, double right, double solidAngle,
              glm::dvec3 color) {
    const int columns = rings.columns[row];
    for (double at = left; at < right - 1e-12;) {
        const int column = std::min(int(at * columns + 1e-9), columns - 1);
        const double end = std::min(right, double(column + 1) / columns);
        const double share = solidAngle * (end - at) / (right - left);
        sums.radiance[rings.first[row] + column] += share * color;
        sums.area[rings.first[row] + column] += share;
        at = std::max(end, at + 1e-12);
    }
}

} // namespace

std::vector<EnvironmentLight> environmentLights(const scene::Environment& environment, int count) {
    const Image& map = *environment.map;
    const Rings rings(count);
    Sums sums(rings.total);
    for (int y = 0; y < map.height; ++y) {
        const double top = double(y) / map.height, bottom = double(y + 1) / map.height;
        for (int row = int(top * rings.rows + 1e-9);
             row < rings.rows && double(row) / rings.rows < bottom - 1e-12; ++row) {
            const double low = std::max(top, double(row) / rings.rows);
            const double high = std::min(bottom, double(row + 1) / rings.rows);
            // Area of a band of the unit sphere: difference of cosines times the azimuth.
            const double band = std::cos(low * std::numbers::pi) - std::cos(high * std::numbers::pi);
            const double solidAngle = band * 2 * std::numbers::pi / map.width;
            for (int x = 0; x < map.width; ++x) {
                const float* color = map.at(x, y);
                addPixel(sums, rings, row, double(x) / map.width, double(x + 1) / map.width, solidAngle,
                         {color[0], color[1], color[2]});
            }
        }
    }
    const mat3 rotation = rotationFromDegrees(environment.rotation);
    std::vector<EnvironmentLight> lights;
    for (int row = 0; row < rings.rows; ++row) {
        for (int column = 0; column < rings.columns[row]; ++column) {
            const int cell = rings.first[row] + column;
            const vec3 inMap(directionAt((column + 0.5) / rings.columns[row], (row + 0.5) / rings.rows));
            lights.push_back({rotation * inMap,
                              environment.intensity * vec3(sums.radiance[cell] / sums.area[cell]),
                              float(sums.area[cell] / (4 * std::numbers::pi))});
        }
    }
    return lights;
}

} // namespace lucent::views
