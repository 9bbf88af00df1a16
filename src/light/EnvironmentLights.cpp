#include "light/EnvironmentLights.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lucent::views {

namespace {

int ringsOf(int count) { return std::max(2, int(std::lround(std::sqrt(count * kPi / 4)))); }

// Rings of equal height in polar angle, but for the first and the last where they begin later; a ring's
// number of cells follows its length, so cells are nearly square.
struct Rings {
    Rings(int count, vec2 offset) : around(double(offset.y)) {
        const int whole = ringsOf(count);
        rows = offset.x > 0 ? whole + 1 : whole;
        for (int row = 0; row <= rows; ++row)
            borders.push_back(std::clamp((row - double(offset.x)) / whole, 0.0, 1.0));
        for (int row = 0; row < rows; ++row) {
            const double middle = 0.5 * (top(row) + bottom(row));
            first.push_back(total);
            columns.push_back(std::max(3, int(std::lround(2 * whole * std::sin(middle * std::numbers::pi)))));
            total += columns.back();
        }
    }
    double top(int row) const { return borders[std::size_t(row)]; } // of pi, polar
    double bottom(int row) const { return borders[std::size_t(row) + 1]; }
    double around; // of a cell, by which the first one begins later
    int rows, total = 0;
    std::vector<double> borders;
    std::vector<int> first, columns;
};

// Integral of a pixel row's radiance into the cells: each pixel is shared out by the area it has in each.
struct Sums {
    explicit Sums(int cells)
        : radiance(cells, glm::dvec3(0)), towards(cells, glm::dvec3(0)), area(cells, 0) {}
    std::vector<glm::dvec3> radiance;
    std::vector<glm::dvec3> towards; // directions, by the light from each
    std::vector<double> area;
};

// A little light is everywhere, so that dark parts have a middle too.
double lightOf(glm::dvec3 radiance) { return glm::dot(radiance, glm::dvec3(0.2126, 0.7152, 0.0722)) + 1e-4; }

// Mean direction across the axis between two places of a row, [0,1]: along x and z. Lat-long map: row 0 = +y,
// centre column = -z, to the right = +x.
glm::dvec2 acrossOf(double from, double to) {
    const double azimuth = (from + to - 1) * std::numbers::pi, half = (to - from) * std::numbers::pi;
    const double length = half > 0 ? std::sin(half) / half : 1;
    return length * glm::dvec2(std::sin(azimuth), -std::cos(azimuth));
}

// Where the pixels of a row begin and end, [0,1], and acrossOf() each: the same in all rows.
struct Row {
    explicit Row(int width) {
        for (int x = 0; x <= width; ++x)
            borders.push_back(double(x) / width);
        for (int x = 0; x < width; ++x)
            across.push_back(acrossOf(borders[std::size_t(x)], borders[std::size_t(x) + 1]));
    }
    std::vector<double> borders;
    std::vector<glm::dvec2> across;
};

// Part of a row of pixels within a ring.
struct Band {
    double solidAngle; // of a pixel
    double cosine;     // of the polar angle, mean
    double sine;
    Band(double above, double below, int width)
        : solidAngle((above - below) * 2 * std::numbers::pi / width), cosine((above + below) / 2),
          sine(std::sqrt(1 - cosine * cosine)) {}
    glm::dvec3 direction(const glm::dvec2& across) const {
        return {sine * across.x, cosine, sine * across.y};
    }
};

// Adds a pixel's part inside one ring, split at the borders of the ring's cells.
void addPixel(Sums& sums, const Rings& rings, int ring, const Row& row, std::size_t x, const Band& band,
              glm::dvec3 color) {
    const int columns = rings.columns[ring];
    const double left = row.borders[x], right = row.borders[x + 1], light = lightOf(color);
    for (double at = left; at < right - 1e-12;) {
        const int column = int(std::floor(at * columns - rings.around + 1e-9));
        const double end = std::min(right, (column + 1 + rings.around) / columns);
        const bool isWhole = at == left && end == right;
        const double share = band.solidAngle * (isWhole ? 1 : (end - at) / (right - left));
        const int cell = rings.first[ring] + (column + columns) % columns;
        sums.radiance[cell] += share * color;
        sums.towards[cell] += share * light * band.direction(isWhole ? row.across[x] : acrossOf(at, end));
        sums.area[cell] += share;
        at = std::max(end, at + 1e-12);
    }
}

// Apart: WebAssembly runs a function in its fast form only from a later call on.
[[gnu::noinline]] void addRow(Sums& sums, const Rings& rings, int ring, const Row& row, const Band& band,
                              const float* colors) {
    for (std::size_t x = 0; x < row.across.size(); ++x, colors += 3)
        addPixel(sums, rings, ring, row, x, band, {colors[0], colors[1], colors[2]});
}

// @param above, below  weights of the two rows of pixels that become one of half as many
[[gnu::noinline]] void halveRow(const Image& map, int y, float above, float below, float* out) {
    const float *top = map.at(0, y), *bottom = map.at(0, y + 1);
    for (int x = 0; x + 1 < map.width; x += 2, top += 6, bottom += 6)
        for (int c = 0; c < 3; ++c)
            *out++ = above * (top[c] + top[c + 3]) + below * (bottom[c] + bottom[c + 3]);
}

// Half the pixels along each side, each the mean of four by their solid angles.
Image halved(const Image& map) {
    Image half(map.width / 2, map.height / 2, 3);
    for (int y = 0; y < half.height; ++y) {
        const auto cosine = [&](int row) { return std::cos(row * std::numbers::pi / map.height); };
        const double top = cosine(2 * y), middle = cosine(2 * y + 1), bottom = cosine(2 * y + 2);
        const double share = (top - middle) / (top - bottom);
        halveRow(map, 2 * y, float(share / 2), float((1 - share) / 2), half.at(0, y));
    }
    return half;
}

// A map with no more pixels than cells of a size need: their means differ by what little the pixels at their
// borders hold.
const Image& mapFor(const scene::Environment& environment, int count) {
    constexpr int kAcross = 16; // pixels along a side of a cell, at least
    const Image* map = environment.map.get();
    const auto hasMore = [&] {
        return map->width % 2 == 0 && map->height % 2 == 0 && map->width / 2 >= 2 * kAcross * ringsOf(count);
    };
    for (int times = 1; hasMore(); ++times)
        map = &environment.kept.of<Image>(std::tuple(environment.map, times), [&] { return halved(*map); });
    return *map;
}

// The cells of a map, before it is turned: radiance and area of each.
std::vector<EnvironmentLight> cellsOf(const Image& map, int count, vec2 offset) {
    const Rings rings(count, offset);
    const Row pixels(map.width);
    Sums sums(rings.total);
    for (int y = 0; y < map.height; ++y) {
        const double top = double(y) / map.height, bottom = double(y + 1) / map.height;
        for (int row = 0; row < rings.rows && rings.top(row) < bottom - 1e-12; ++row) {
            if (rings.bottom(row) <= top + 1e-9) continue;
            const double low = std::max(top, rings.top(row));
            const double high = std::min(bottom, rings.bottom(row));
            // Area of a band of the unit sphere: difference of cosines times the azimuth.
            const double above = std::cos(low * std::numbers::pi), below = std::cos(high * std::numbers::pi);
            const Band band(above, below, map.width);
            addRow(sums, rings, row, pixels, band, map.at(0, y));
        }
    }
    std::vector<EnvironmentLight> cells;
    for (int row = 0; row < rings.rows; ++row) {
        for (int column = 0; column < rings.columns[row]; ++column) {
            const int cell = rings.first[row] + column;
            cells.push_back({vec3(glm::normalize(sums.towards[cell])),
                             vec3(sums.radiance[cell] / sums.area[cell]),
                             float(sums.area[cell] / (4 * std::numbers::pi)),
                             float(std::sqrt(sums.area[cell] / 12))}); // of a square
        }
    }
    return cells;
}

// A part of the sphere: some of the cells.
struct Part {
    std::vector<EnvironmentLight> cells;
    float light = 0, weight = 0;
    vec3 center{0}, spread{0}; // of the light; spread: standard deviation along x, y, z

    explicit Part(std::vector<EnvironmentLight> list) : cells(std::move(list)) {
        vec3 square(0);
        for (const EnvironmentLight& cell : cells) {
            const float part = lightOf(cell);
            light += part;
            weight += cell.weight;
            center += part * cell.direction;
            square += part * cell.direction * cell.direction;
        }
        center /= light;
        spread = glm::sqrt(glm::max(square / light - center * center, vec3(0)));
    }
    static float lightOf(const EnvironmentLight& cell) {
        return cell.weight * float(views::lightOf(glm::dvec3(cell.radiance)));
    }
    float urgency() const { return cells.size() > 1 ? light * glm::length(spread) : 0; }
    int widest() const {
        const int xy = spread.x > spread.y ? 0 : 1;
        return spread.z > spread[xy] ? 2 : xy;
    }
};

// Parts the cells along an axis where those below first have so much light. @return how many those are
std::size_t partAt(std::vector<EnvironmentLight>& cells, int axis, float light) {
    const auto below = [&](const EnvironmentLight& a, const EnvironmentLight& b) {
        const auto place = [&](const vec3& at) { // a ring has one height
            return std::tuple(at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]);
        };
        return place(a.direction) < place(b.direction);
    };
    auto first = cells.begin(), end = cells.end(); // the border is between them
    for (float left = light; end - first > 1;) {
        const auto middle = first + (end - first) / 2;
        std::nth_element(first, middle, end, below);
        const float half = std::accumulate(first, middle, 0.0f, [](float sum, const EnvironmentLight& cell) {
            return sum + Part::lightOf(cell);
        });
        if (half < left) {
            left -= half;
            first = middle;
        } else {
            end = middle;
        }
    }
    return std::size_t(end - cells.begin());
}

// @param share  of its light in the first piece
std::pair<Part, Part> cut(Part part, float share = 0.5f) {
    std::size_t split = partAt(part.cells, part.widest(), share * part.light);
    split = std::clamp<std::size_t>(split, 1, part.cells.size() - 1);
    const auto middle = part.cells.begin() + std::ptrdiff_t(split);
    return {Part({part.cells.begin(), middle}), Part({middle, part.cells.end()})};
}

// Roots of distances count, so that little light far from most of it does not: of a round part that is evenly
// bright, kOfRound times the square of their mean is the standard deviation.
EnvironmentLight lightOf(const Part& part) {
    constexpr float kOfRound = 0.78f;
    EnvironmentLight light{.direction =
                               glm::length(part.center) > 1e-6f ? glm::normalize(part.center) : vec3(0, 1, 0),
                           .radiance = vec3(0),
                           .weight = part.weight,
                           .spread = 0};
    float root = 0, within = 0;
    for (const EnvironmentLight& cell : part.cells) {
        const float share = Part::lightOf(cell) / part.light;
        light.radiance += cell.weight / part.weight * cell.radiance;
        root += share * std::sqrt(glm::distance(cell.direction, light.direction));
        within += share * cell.spread * cell.spread;
    }
    const float among = kOfRound * root * root;
    light.spread = std::sqrt(within + among * among);
    return light;
}

} // namespace

std::vector<EnvironmentLight> environmentLights(const scene::Environment& environment, int count,
                                                vec2 offset) {
    // A map is turned more often than changed, and asked for in a few numbers of cells by turns.
    auto lights =
        environment.kept.of<std::vector<EnvironmentLight>>(std::tuple(environment.map, count, offset), [&] {
            return cellsOf(mapFor(environment, count), count, offset);
        });
    const mat3 rotation = rotationFromDegrees(environment.rotation);
    for (EnvironmentLight& light : lights) {
        light.direction = rotation * light.direction;
        light.radiance *= environment.intensity;
    }
    return lights;
}

namespace {

using Samples = std::vector<std::vector<EnvironmentLight>>;

// Gives samples [first, end) their pieces of a part, or all of them the part where something small and bright
// in it would leave a piece of twice its share: few samples would have most of the light.
void shareOut(Part part, std::size_t first, std::size_t end, Samples& samples) {
    EnvironmentLight light = lightOf(part);
    if (end - first > 1 && part.cells.size() > 1) {
        const std::size_t middle = (first + end) / 2;
        const float all = part.light, share = float(middle - first) / float(end - first);
        auto [low, high] = cut(std::move(part), share);
        if (std::abs(low.light - share * all) < std::min(share, 1 - share) * all) {
            shareOut(std::move(low), first, middle, samples);
            shareOut(std::move(high), middle, end, samples);
            return;
        }
    }
    light.weight *= float(samples.size()) / float(end - first);
    for (std::size_t i = first; i < end; ++i)
        samples[i].push_back(light);
}

Samples partsOf(const scene::Environment& environment, int count, int samples) {
    constexpr int kFineCells = 16384;
    const auto lessUrgent = [](const Part& a, const Part& b) { return a.urgency() < b.urgency(); };
    std::vector<Part> parts{Part(environmentLights(environment, std::max(kFineCells, 4 * count * samples)))};
    while (int(parts.size()) < count && parts.front().urgency() > 0) {
        std::pop_heap(parts.begin(), parts.end(), lessUrgent);
        auto [low, high] = cut(std::move(parts.back()));
        parts.back() = std::move(low);
        std::push_heap(parts.begin(), parts.end(), lessUrgent);
        parts.push_back(std::move(high));
        std::push_heap(parts.begin(), parts.end(), lessUrgent);
    }
    Samples lights{std::size_t(samples)};
    for (Part& part : parts)
        shareOut(std::move(part), 0, lights.size(), lights);
    return lights;
}

} // namespace

std::vector<EnvironmentLight> importanceLights(const scene::Environment& environment, int count, int sample,
                                               int samples) {
    return environment.kept
        .of<Samples>(std::tuple(environment.map, count, samples, environment.rotation, environment.intensity),
                     [&] { return partsOf(environment, count, samples); })
        .at(std::size_t(sample));
}

float brightestWhite(const scene::Environment& environment) {
    constexpr int kDirections = 128;
    const std::vector<EnvironmentLight> lights = environmentLights(environment, kDirections);
    float most = 0;
    for (const EnvironmentLight& faced : lights) {
        vec3 sent(0); // E / pi
        for (const EnvironmentLight& light : lights)
            sent += 4 * light.weight * std::max(glm::dot(faced.direction, light.direction), 0.0f) *
                    light.radiance;
        most = std::max({most, sent.r, sent.g, sent.b});
    }
    return most;
}

} // namespace lucent::views
