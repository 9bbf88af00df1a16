#include "truth/Lights.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lucent::truth {

namespace {
constexpr double kTwoPi = 2 * std::numbers::pi;

/// Two unit vectors perpendicular to a unit vector and to each other.
struct Across {
    dvec3 first, second;
    explicit Across(const dvec3& axis) {
        const dvec3 aside = std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        first = glm::normalize(glm::cross(axis, aside));
        second = glm::cross(axis, first);
    }
    dvec3 at(dvec2 place) const { return place.x * first + place.y * second; }
};

/// Direction on a lat-long map, turns from its left edge and cosine of the polar angle: row 0 is +y, the
/// centre column -z, to the right of it +x.
dvec3 mapDirection(double turns, double cosine) {
    const double azimuth = kTwoPi * (turns - 0.5), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth)};
}

/// Cosine of the polar angle at the upper edge of a map's row.
double rowEdge(const Image& map, int row) { return std::cos(std::numbers::pi * row / map.height); }

/// Part of a lat-long map between two meridians (in turns) and two parallels (cosine of the polar angle).
struct SkyCell {
    double left, right, top, bottom;
    /// Share of the whole sphere.
    double weight() const { return (right - left) * (top - bottom) / 2; }
    dvec3 direction(dvec2 within) const {
        return mapDirection(glm::mix(left, right, within.x), glm::mix(top, bottom, within.y));
    }
};

/// The sphere in `count` cells of equal area: belts of about equal angle, each cut into about square cells.
std::vector<SkyCell> equalCells(int count) {
    std::vector<SkyCell> cells;
    const int belts = std::max(1, int(std::lround(std::sqrt(count * std::numbers::pi / 4))));
    const auto cellsAbove = [&](int belt) {
        return int(std::lround(count * (1 - std::cos(std::numbers::pi * belt / belts)) / 2));
    };
    for (int belt = 0; belt < belts; ++belt) {
        const int first = cellsAbove(belt), last = cellsAbove(belt + 1);
        const double top = 1 - 2.0 * first / count, bottom = 1 - 2.0 * last / count, columns = last - first;
        for (int column = 0; column < last - first; ++column)
            cells.push_back({column / columns, (column + 1) / columns, top, bottom});
    }
    return cells;
}

/// A place inside a list of stretches that lie one after the other, each as long as its share.
struct Chosen {
    std::size_t index;
    double within; ///< [0,1) of the stretch
};

/// @param upTo   running sums, the last above 0
/// @param share  [0,1)
Chosen choose(std::span<const double> upTo, double share) {
    const double target = share * upTo.back();
    const auto last = std::lower_bound(upTo.begin(), upTo.end(), upTo.back()); // dark ones may follow
    const auto found = std::min(std::upper_bound(upTo.begin(), upTo.end(), target), last);
    const double before = found == upTo.begin() ? 0 : *(found - 1);
    return {std::size_t(found - upTo.begin()), std::clamp((target - before) / (*found - before), 0.0, 1.0)};
}

/// Radiance of one pixel, and the sum of magnitudes by which it is chosen.
struct Radiance {
    dvec3 color;
    double sum;
    Radiance(const Image& map, int x, int y) {
        const float* pixel = map.at(x, y);
        color = dvec3(pixel[0], pixel[1], pixel[2]);
        sum = std::abs(color.r) + std::abs(color.g) + std::abs(color.b);
    }
};

/// Chooses directions inside one cell of the sky in proportion to the light that comes from each.
class CellLight {
public:
    CellLight(const Image& map, const SkyCell& cell) : cell_(cell) {
        const auto rowOf = [&](double cosine) {
            return int(std::acos(std::clamp(cosine, -1.0, 1.0)) / std::numbers::pi * map.height);
        };
        double light = 0;
        for (int y = std::max(0, rowOf(cell.top) - 1); y <= std::min(rowOf(cell.bottom) + 1, map.height - 1);
             ++y) {
            const double top = std::min(cell.top, rowEdge(map, y));
            const double bottom = std::max(cell.bottom, rowEdge(map, y + 1));
            if (bottom >= top) continue;
            const int first = int(cell.left * map.width), last = int(std::ceil(cell.right * map.width));
            for (int x = first; x < std::min(last, map.width); ++x) {
                const SkyCell part{std::max(cell.left, double(x) / map.width),
                                   std::min(cell.right, double(x + 1) / map.width), top, bottom};
                const Radiance radiance(map, x, y);
                light += part.weight() * radiance.sum;
                parts_.push_back(part);
                colors_.push_back(radiance.sum > 0 ? radiance.color / radiance.sum : dvec3(0));
                upTo_.push_back(light);
            }
        }
    }
    /// A direction on the map, and in `color` the whole cell's light as that one direction tells it.
    LightSource choose(dvec2 within) const {
        LightSource light;
        light.distant = true;
        if (upTo_.back() > 0) {
            const Chosen chosen = truth::choose(upTo_, within.x);
            light.place = parts_[chosen.index].direction({chosen.within, within.y});
            light.color = upTo_.back() * colors_[chosen.index];
        } else {
            light.place = cell_.direction(within);
            light.color = dvec3(0);
        }
        return light;
    }

private:
    SkyCell cell_;
    std::vector<SkyCell> parts_; ///< pixels, cut at the cell's border
    std::vector<dvec3> colors_;  ///< for a light of 1
    std::vector<double> upTo_;
};

/// The pixel of a map at a place of the sphere, in turns from the left edge and from the top.
Radiance radianceAt(const Image& map, double turns, double down) {
    const int x = std::min(int(turns * map.width), map.width - 1);
    const int y = std::min(int(down * map.height), map.height - 1);
    return Radiance(map, x, y);
}

/// Where a unit direction of the map lies on it.
struct MapPlace {
    double turns, down; ///< [0,1]: in turns from the left edge, in half turns from the top
    explicit MapPlace(const dvec3& on)
        : turns(std::atan2(on.x, -on.z) / kTwoPi + 0.5),
          down(std::atan2(std::hypot(on.x, on.z), on.y) / std::numbers::pi) {}
};

/// A direction of the map from anywhere inside a cell, even by area.
LightSource evenlyFrom(const Image& map, const SkyCell& cell, dvec2 within) {
    const double turns = glm::mix(cell.left, cell.right, within.x);
    const double cosine = glm::mix(cell.top, cell.bottom, within.y);
    LightSource light;
    light.distant = true;
    light.place = mapDirection(turns, cosine);
    const double down = std::acos(std::clamp(cosine, -1.0, 1.0)) / std::numbers::pi;
    light.color = cell.weight() * radianceAt(map, turns, down).color;
    return light;
}

constexpr SkyCell kWholeSky{0, 1, 1, -1};
constexpr std::uint64_t kSkyStream = ~std::uint64_t(0); // a number that no sample of a pixel has

double shareOfOneLight(const scene::Scene& scene, bool normalise) {
    const bool sky = scene.environment && scene.environment->enabled;
    const std::size_t count = scene.lights.size() + (sky ? 1 : 0);
    return normalise && count > 0 ? 1 / double(count) : 1;
}
} // namespace

glm::dmat3 rotation(vec3 degrees) {
    const auto about = [](double angle, int first, int second) {
        glm::dmat3 turn(1);
        turn[first][first] = turn[second][second] = std::cos(angle);
        turn[first][second] = std::sin(angle);
        turn[second][first] = -std::sin(angle);
        return turn;
    };
    const dvec3 angles = dvec3(degrees) * (kTwoPi / 360);
    return about(angles.z, 0, 1) * about(angles.y, 2, 0) * about(angles.x, 1, 2);
}

LightSource pointOnDisc(const LightSource& light, const dvec3& from, dvec2 place) {
    LightSource point = light;
    point.radius = 0;
    if (light.distant) {
        point.place = glm::normalize(light.place + light.radius * Across(light.place).at(place));
    } else {
        const dvec3 way = light.place - from;
        const double distance = glm::length(way);
        const dvec3 axis = distance > 0 ? way / distance : dvec3(0, 0, 1);
        point.place += light.radius * Across(axis).at(place);
    }
    return point;
}

dvec2 placeInDiscCell(int rings, int cell, dvec2 within) {
    const int ring = int(std::sqrt(double(cell))), sector = cell - ring * ring; // ring² cells lie further in
    const double inner = double(ring) * ring, outer = double(ring + 1) * (ring + 1);
    const double radius = std::sqrt(glm::mix(inner, outer, within.x)) / rings;
    const double angle = kTwoPi * (sector + within.y) / (2 * ring + 1);
    return radius * dvec2(std::cos(angle), std::sin(angle));
}

dvec2 placeInDisc(dvec2 within) { return placeInDiscCell(1, 0, within); }

std::array<dvec2, 4> mirroredPairs(Random& random) {
    const dvec2 first = random.nextPair(), second = random.nextPair();
    return {first, 1.0 - first, second, 1.0 - second};
}

std::optional<LightSource> sourceOf(const scene::Light& light) {
    LightSource source;
    if (const auto* point = std::get_if<scene::PointLight>(&light)) {
        source.place = dvec3(point->position);
        source.inverseSquare = point->falloff == scene::LightFalloff::InverseSquare;
        source.color = double(point->intensity) * dvec3(point->color);
        source.radius = double(point->radius);
        return source;
    }
    if (const auto* sun = std::get_if<scene::DistantLight>(&light)) {
        source.place = -glm::normalize(dvec3(sun->direction));
        source.distant = true;
        source.color = double(sun->irradiance) * dvec3(sun->color);
        source.radius = std::tan(double(sun->angle) * kTwoPi / 720);
        return source;
    }
    return {};
}

std::vector<LightSource> worldLamps(const scene::Scene& scene, bool normalise) {
    std::vector<LightSource> lamps;
    for (const scene::Light& light : scene.lights)
        if (auto source = sourceOf(light)) {
            source->color *= shareOfOneLight(scene, normalise) / std::numbers::pi;
            lamps.push_back(*source);
        }
    return lamps;
}

Sky::Sky(const scene::Environment& environment)
    : map_(environment.map), worldFromMap_(rotation(environment.rotation)),
      intensity_(double(environment.intensity)) {}

dvec3 Sky::radiance(const dvec3& direction) const {
    const auto [turns, down] = MapPlace(direction * worldFromMap_); // transposed
    const double x = turns * map_->width - 0.5;
    const double y = std::clamp(down * map_->height - 0.5, 0.0, map_->height - 1.0);
    const int left = int(std::floor(x)), top = std::min(int(y), std::max(map_->height - 2, 0));
    const auto texel = [&](int column, int row) {
        const int around = (column + map_->width) % map_->width;
        return Radiance(*map_, around, std::min(row, map_->height - 1)).color;
    };
    const auto along = [&](int row) { return glm::mix(texel(left, row), texel(left + 1, row), x - left); };
    return intensity_ * glm::mix(along(top), along(top + 1), y - top);
}

std::optional<scene::Environment> shiningEnvironment(const scene::Scene& scene, bool normalise) {
    if (!scene.environment || !scene.environment->enabled) return {};
    std::optional<scene::Environment> environment = scene.environment;
    environment->intensity *= float(shareOfOneLight(scene, normalise));
    return environment;
}

std::vector<LightSource> environmentLights(const scene::Environment& environment, int count, Choice choice,
                                           std::uint64_t seed) {
    const Image& map = *environment.map;
    const glm::dmat3 worldFromMap = rotation(environment.rotation);
    std::vector<LightSource> lights;
    const std::vector<SkyCell> cells = equalCells((count + 3) / 4);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        Random random(seed, cell, kSkyStream);
        const auto four = mirroredPairs(random);
        std::optional<CellLight> light;
        if (choice == Choice::ByLight) light.emplace(map, cells[cell]);
        for (const dvec2 within : four) {
            LightSource source = light ? light->choose(within) : evenlyFrom(map, cells[cell], within);
            source.place = worldFromMap * source.place;
            source.weight = cells[cell].weight() / 4;
            source.color *= double(environment.intensity) / 4;
            lights.push_back(source);
        }
    }
    return lights;
}

EnvironmentSampler::EnvironmentSampler(const scene::Environment& environment, Choice choice)
    : map_(environment.map), choice_(choice), worldFromMap_(rotation(environment.rotation)),
      intensity_(double(environment.intensity)) {
    double light = 0;
    for (int y = 0; y < map_->height; ++y)
        for (int x = 0; x < map_->width; ++x) {
            const double area = (rowEdge(*map_, y) - rowEdge(*map_, y + 1)) / (2.0 * map_->width);
            upTo_.push_back(light += area * Radiance(*map_, x, y).sum);
        }
}

LightSource EnvironmentSampler::choose(dvec2 within) const {
    LightSource light;
    if (isEven()) {
        light = evenlyFrom(*map_, kWholeSky, within);
    } else {
        const Chosen chosen = truth::choose(upTo_, within.x);
        const int x = int(chosen.index) % map_->width, y = int(chosen.index) / map_->width;
        const SkyCell pixel{double(x) / map_->width, double(x + 1) / map_->width, rowEdge(*map_, y),
                            rowEdge(*map_, y + 1)};
        const Radiance radiance(*map_, x, y);
        light.distant = true;
        light.place = pixel.direction({chosen.within, within.y});
        light.color = upTo_.back() / radiance.sum * radiance.color;
    }
    light.place = worldFromMap_ * light.place;
    light.color *= intensity_;
    return light;
}

double EnvironmentSampler::density(const dvec3& direction) const {
    constexpr double kWholeSphere = 2 * kTwoPi; // sr
    if (isEven()) return 1 / kWholeSphere;
    const auto [turns, down] = MapPlace(direction * worldFromMap_); // transposed
    return radianceAt(*map_, turns, down).sum / (kWholeSphere * upTo_.back());
}

} // namespace lucent::truth
