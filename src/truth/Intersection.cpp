#include "truth/Intersection.h"

#include "truth/Random.h"
#include "truth/Relief.h"
#include "truth/Torus.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box boxOf(const Triangles& triangles) {
    Box box;
    for (const dvec3& position : triangles.positions)
        box.add(position);
    return box;
}
Box boxOf(const FieldBlock& block) {
    Box box;
    const Field& field = *block.field;
    for (const double z : {field.bottom(), field.highest()})
        for (const double y : {-field.half().y, field.half().y})
            for (const double x : {-field.half().x, field.half().x})
                box.add(block.placement.pointInWorld({x, y, z}));
    return box;
}
Box boxOf(const Sphere& sphere) { return {sphere.center - sphere.radius, sphere.center + sphere.radius}; }
Box boxOf(const Torus& torus) {
    const dvec3 reach = torus.major * glm::sqrt(glm::max(1.0 - torus.axis * torus.axis, 0.0)) + torus.minor;
    return {torus.center - reach, torus.center + reach};
}

Box boxOf(const Ripple& ripple) {
    Box box;
    for (const double y : {-ripple.amplitude, ripple.amplitude})
        for (const double z : {-ripple.half.y, ripple.half.y})
            for (const double x : {-ripple.half.x, ripple.half.x})
                box.add(ripple.placement.pointInWorld({x, y, z}));
    return box;
}

Box boxOf(const Displaced& displaced) {
    Box box;
    for (unsigned part = 0; part < displaced.body->parts(); ++part)
        box.add(displaced.body->boxOf(part));
    return box;
}

Box boxOf(const Waves& waves) {
    Box box;
    const auto [low, high] = waves.basin->range();
    const dvec2 half = waves.basin->half();
    for (const double y : {low, high})
        for (const double z : {-half.y, half.y})
            for (const double x : {-half.x, half.x})
                box.add(waves.placement.pointInWorld({x, y, z}));
    return box;
}

/// The nearest hit of a sphere within a stretch. Half the chord is a product, not a difference of squares:
/// rays that graze keep their digits.
std::optional<Intersection> intersect(const Sphere& sphere, const WorldRay& ray, Stretch stretch) {
    const dvec3 out = ray.origin - sphere.center;
    const double foot = -glm::dot(out, ray.direction);
    const double aside = glm::length(out + foot * ray.direction);
    if (aside > sphere.radius) return {};
    const double half = std::sqrt((sphere.radius - aside) * (sphere.radius + aside));
    for (const double distance : {foot - half, foot + half})
        if (distance > stretch.from && distance < stretch.to)
            return Intersection{distance, glm::normalize(out + distance * ray.direction)};
    return {};
}

std::optional<Intersection> intersect(const Torus& torus, const WorldRay& ray, Stretch stretch) {
    const dvec3 aside = std::abs(torus.axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(torus.axis, aside));
    const glm::dmat3 worldFromTorus(first, glm::cross(torus.axis, first), torus.axis);
    const dvec3 origin = (ray.origin - torus.center) * worldFromTorus,
                direction = ray.direction * worldFromTorus;
    const TorusHits hits = torusHits(origin, direction, torus.major, torus.minor);
    for (int i = 0; i < hits.count; ++i)
        if (const double distance = hits.at[std::size_t(i)]; distance > stretch.from && distance < stretch.to)
            return Intersection{distance,
                                worldFromTorus * torusNormal(origin + distance * direction, torus.major)};
    return {};
}

/// Where a ray's height above a sheet changes its sign. Newton's steps that leave the bracket become
/// bisections.
double rootBetween(double low, double high, const auto& cut) {
    const bool rising = cut.above(low) < 0;
    double at = 0.5 * (low + high);
    for (int step = 0; step < 200 && low < at && at < high; ++step) {
        const double value = cut.above(at);
        if (value == 0) break;
        ((value < 0) == rising ? low : high) = at;
        const double next = at - value / cut.slope(at);
        at = low < next && next < high ? next : 0.5 * (low + high);
    }
    return at;
}

/// The first place of a stretch at which a ray meets a ripple. Along the ray its height over the sheet is a
/// line less a sine: between two of the places where that turns there is one root or none.
class RippleCut {
public:
    RippleCut(const Ripple& ripple, const dvec3& origin, const dvec3& direction)
        : amplitude_(ripple.amplitude), altitude_(origin.y), climb_(direction.y),
          angle_(glm::dot(ripple.wave, dvec2(origin.x, origin.z))),
          turning_(glm::dot(ripple.wave, dvec2(direction.x, direction.z))) {}

    std::optional<double> first(Stretch stretch) const {
        for (double from = stretch.from; from < stretch.to;) {
            const double to = std::min(nextTurn(from), stretch.to);
            if ((above(from) < 0) != (above(to) < 0)) return rootBetween(from, to, *this);
            from = to;
        }
        return {};
    }

    double above(double at) const { return altitude_ + at * climb_ - amplitude_ * std::sin(angle(at)); }
    double slope(double at) const { return climb_ - amplitude_ * turning_ * std::cos(angle(at)); }

private:
    double angle(double at) const { return angle_ + at * turning_; }

    /// The nearest place past `at` where the height over the sheet turns: cos(angle) = climb / (A turning).
    double nextTurn(double at) const {
        const double cosine = climb_ / (amplitude_ * turning_);
        if (!(std::abs(cosine) < 1)) return kInfinity;
        constexpr double kRound = 2 * std::numbers::pi;
        double nearest = kInfinity;
        for (const double turn : {std::acos(cosine), -std::acos(cosine)})
            for (const int more : {-1, 0, 1, 2}) {
                const double rounds = std::floor((angle(at) - turn) / kRound) + more;
                const double place = (turn + kRound * rounds - angle_) / turning_;
                if (place > at) nearest = std::min(nearest, place);
            }
        return nearest;
    }
    double amplitude_, altitude_, climb_, angle_, turning_;
};

/// The same for the cubic spline of a basin: in every cell of the grid that the ray passes at the heights of
/// its surface, the ray is cut into short pieces, of which one shows where the sign changes.
class BasinCut {
public:
    BasinCut(const Basin& basin, const dvec3& origin, const dvec3& direction)
        : basin_(basin), origin_(origin), direction_(direction), start_(basin.inCells({origin.x, origin.z})),
          way_(dvec2(direction.x, direction.z) / basin.cell()) {}

    std::optional<double> first(Stretch stretch) const {
        bool below = above(stretch.from) < 0;
        for (double from = stretch.from; from < stretch.to;) {
            const double to = std::min(nextLine(from), stretch.to);
            const int pieces = passes(from, to) ? kPieces : 1;
            for (int i = 0; i < pieces; ++i) {
                const double low = glm::mix(from, to, double(i) / pieces),
                             high = i + 1 == pieces ? to : glm::mix(from, to, double(i + 1) / pieces);
                if ((above(high) < 0) != below) return rootBetween(low, high, *this);
            }
            from = to;
        }
        return {};
    }
    double above(double at) const { return height(at) - basin_.at(place(at)).height; }
    double slope(double at) const {
        return direction_.y - glm::dot(basin_.at(place(at)).slope, dvec2(direction_.x, direction_.z));
    }

private:
    static constexpr int kPieces = 16;
    double height(double at) const { return origin_.y + at * direction_.y; }
    dvec2 place(double at) const {
        return dvec2(origin_.x, origin_.z) + at * dvec2(direction_.x, direction_.z);
    }
    /// Where the ray crosses the next line of the grid past `at`.
    double nextLine(double at) const {
        double nearest = kInfinity;
        for (int axis = 0; axis < 2; ++axis) {
            if (way_[axis] == 0) continue;
            const double side = way_[axis] > 0 ? 1 : -1;
            double line = std::floor(side * (start_[axis] + at * way_[axis]));
            double crossing;
            do
                crossing = (side * ++line - start_[axis]) / way_[axis];
            while (crossing <= at); // what rounding has put before it
            nearest = std::min(nearest, crossing);
        }
        return nearest;
    }
    bool passes(double from, double to) const {
        const auto [low, high] = basin_.range(ivec2(glm::floor(start_ + 0.5 * (from + to) * way_)));
        return std::max(height(from), height(to)) >= low && std::min(height(from), height(to)) <= high;
    }
    const Basin& basin_;
    dvec3 origin_, direction_;
    dvec2 start_, way_; ///< in cells
};

/// A ray in the space of a sheet, from the place that is nearest to the sheet's middle: a whole line has no
/// other beginning.
struct SheetRay {
    double scale, foot;
    dvec3 origin, direction;
    SheetRay(const Placement& placement, const WorldRay& world)
        : scale(placement.scale), direction(placement.directionFromWorld(world.direction)) {
        const dvec3 start = placement.pointFromWorld(world.origin);
        foot = -glm::dot(start, direction);
        origin = start + foot * direction;
    }
    /// Of the world's stretch, what lies over the sheet's rectangle between two heights.
    Stretch over(Stretch stretch, const dvec2& half, double low, double high) const {
        const double room = 1e-9 * (half.x + half.y);
        const WorldRay local{origin, direction, stretch.to / scale - foot, stretch.from / scale - foot};
        return within({{-half.x, low - room, -half.y}, {half.x, high + room, half.y}}, local);
    }
    dvec2 below(double at) const { return {origin.x + at * direction.x, origin.z + at * direction.z}; }
    Intersection intersection(const Placement& placement, double at, const dvec2& slope) const {
        const dvec3 normal = glm::normalize(dvec3(-slope.x, 1, -slope.y));
        return {(at + foot) * scale, placement.directionInWorld(normal)};
    }
};

std::optional<Intersection> intersect(const Ripple& ripple, const WorldRay& world, Stretch stretch) {
    const SheetRay ray(ripple.placement, world);
    const auto at = RippleCut(ripple, ray.origin, ray.direction)
                        .first(ray.over(stretch, ripple.half, -ripple.amplitude, ripple.amplitude));
    if (!at) return {};
    const dvec2 slope = ripple.amplitude * ripple.wave * std::cos(glm::dot(ripple.wave, ray.below(*at)));
    return ray.intersection(ripple.placement, *at, slope);
}

std::optional<Intersection> intersect(const Waves& waves, const WorldRay& world, Stretch stretch) {
    const SheetRay ray(waves.placement, world);
    const auto [low, high] = waves.basin->range();
    const auto at = BasinCut(*waves.basin, ray.origin, ray.direction)
                        .first(ray.over(stretch, waves.basin->half(), low, high));
    if (!at) return {};
    return ray.intersection(waves.placement, *at, waves.basin->at(ray.below(*at)).slope);
}

/// A ray in a field's object space, and a stretch of it there.
struct FieldRay {
    Ray ray;
    Stretch stretch;
    FieldRay(const FieldBlock& block, const WorldRay& world, Stretch stretch)
        : ray{block.placement.pointFromWorld(world.origin), dvec3(0),
              block.placement.directionFromWorld(world.direction)},
          stretch{stretch.from / block.placement.scale, stretch.to / block.placement.scale} {}
    double altitude(double at) const { return ray.anchor.z + at * ray.direction.z; }
};

std::optional<Intersection> intersect(const FieldBlock& block, const WorldRay& world, Stretch stretch) {
    const FieldRay local(block, world, stretch);
    const auto hit = firstHit(*block.field, local.ray, local.stretch);
    if (!hit) return {};
    const double distance = glm::dot(hit->position - local.ray.anchor, local.ray.direction);
    return Intersection{distance * block.placement.scale, block.placement.directionInWorld(hit->normal)};
}

/// Triangles and displaced triangles are met one by one.
std::optional<Intersection> intersect(const Triangles&, const WorldRay&, Stretch) { return {}; }
std::optional<Intersection> intersect(const Displaced&, const WorldRay&, Stretch) { return {}; }

/// Whether a ray meets the block from its surface to its bottom. Field knows no bottom: what enters below it
/// is in the way only when it climbs into the block afterwards. A ray that leaves this block's own surface (a
/// stretch that does not begin at 0) reaches what is below only through it.
bool blocks(const FieldBlock& block, const WorldRay& world, Stretch stretch) {
    const Field& field = *block.field;
    const FieldRay local(block, world, stretch);
    const double first = firstInside(field, local.ray, local.stretch);
    if (first == kInfinity) return false;
    const Stretch over = field.overFootprint(local.ray, local.stretch);
    if (stretch.from > 0 || first > over.from || local.altitude(first) >= field.bottom()) return true;
    const double climb = local.ray.direction.z;
    return climb > 0 && (field.bottom() - local.ray.anchor.z) / climb < over.to;
}
bool blocks(const auto& shape, const WorldRay& ray, Stretch stretch) {
    return intersect(shape, ray, stretch).has_value();
}

} // namespace

Box boxOf(const Shape& shape) {
    return std::visit([](const auto& known) { return boxOf(known); }, shape);
}

unsigned partsOf(const Shape& shape) {
    const auto* displaced = std::get_if<Displaced>(&shape);
    return displaced ? displaced->body->parts() : 1;
}

Box boxOf(const Shape& shape, unsigned part) {
    const auto* displaced = std::get_if<Displaced>(&shape);
    return displaced ? displaced->body->boxOf(part) : boxOf(shape);
}

Stretch within(const Box& box, const WorldRay& ray) {
    Stretch stretch{ray.begin, ray.length};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return {0, 0};
            continue;
        }
        const double one = (box.low[axis] - ray.origin[axis]) / ray.direction[axis];
        const double other = (box.high[axis] - ray.origin[axis]) / ray.direction[axis];
        stretch = {std::max(stretch.from, std::min(one, other)), std::min(stretch.to, std::max(one, other))};
    }
    return stretch;
}

std::optional<Intersection> intersect(const Shape& shape, unsigned part, const WorldRay& ray,
                                      Stretch stretch) {
    if (const auto* displaced = std::get_if<Displaced>(&shape))
        return displaced->body->firstHit(part, ray, stretch);
    return std::visit([&](const auto& known) { return intersect(known, ray, stretch); }, shape);
}

bool blocks(const Shape& shape, unsigned part, const WorldRay& ray, Stretch stretch) {
    if (std::holds_alternative<Displaced>(shape)) return intersect(shape, part, ray, stretch).has_value();
    return std::visit([&](const auto& known) { return blocks(known, ray, stretch); }, shape);
}

namespace {
/// Even in [0,1) over rays and triangles, always the same for the same two.
double chanceOf(const WorldRay& ray, unsigned triangle) {
    std::uint64_t bits[6];
    static_assert(sizeof bits == 2 * sizeof(dvec3));
    std::memcpy(bits, &ray.origin, sizeof(dvec3));
    std::memcpy(bits + 3, &ray.direction, sizeof(dvec3));
    std::uint64_t seed = triangle;
    for (const std::uint64_t part : bits)
        seed = seed * 0x100000001b3u + part; // after Fowler, Noll, Vo's hash
    return Random(seed, 0, 0).next();
}
} // namespace

std::optional<Intersection> intersectTriangle(const Triangles& triangles, unsigned number,
                                              const WorldRay& ray) {
    const std::uint32_t* index = &triangles.indices[3 * std::size_t(number)];
    const dvec3 corner = triangles.positions[index[0]];
    const dvec3 first = triangles.positions[index[1]] - corner;
    const dvec3 second = triangles.positions[index[2]] - corner;
    const dvec3 across = glm::cross(first, second); // twice the area long
    const double distance = glm::dot(corner - ray.origin, across) / glm::dot(ray.direction, across);
    const dvec3 place = ray.origin + distance * ray.direction - corner;
    const double area = glm::dot(across, across);
    const double u = glm::dot(glm::cross(place, second), across) / area;
    const double v = glm::dot(glm::cross(first, place), across) / area;
    constexpr double kOver = 1e-3;
    if (!(u > -kOver && v > -kOver && u + v < 1 + kOver)) return {};
    const double opacity = triangles.opacity ? triangles.opacity(number, {1 - u - v, u, v}) : 1;
    if (opacity < 1 && opacity <= (ray.hitsBlended ? 0 : chanceOf(ray, number))) return {};
    const dvec3 normal = across / std::sqrt(area);
    Intersection found(distance, normal);
    found.triangle = int(number);
    if (ray.hitsBlended) found.opacity = opacity;
    if (triangles.normals.empty()) return found;
    const dvec3 smooth = (1 - u - v) * triangles.normals[index[0]] + u * triangles.normals[index[1]] +
                         v * triangles.normals[index[2]];
    found.smoothNormal = glm::normalize(smooth);
    return found;
}

/// A corner, on an edge, or inside (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
dvec3 nearestWeights(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& point) {
    const dvec3 ab = b - a, ac = c - a;
    const double d1 = glm::dot(ab, point - a), d2 = glm::dot(ac, point - a);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = glm::dot(ab, point - b), d4 = glm::dot(ac, point - b);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double overC = d1 * d4 - d3 * d2;
    if (overC <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = glm::dot(ab, point - c), d6 = glm::dot(ac, point - c);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double overB = d5 * d2 - d1 * d6;
    if (overB <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double overA = d3 * d6 - d5 * d4;
    if (overA <= 0 && d4 >= d3 && d5 >= d6) {
        const double along = (d4 - d3) / (d4 - d3 + d5 - d6);
        return {0, 1 - along, along};
    }
    const double sum = overA + overB + overC;
    return {overA / sum, overB / sum, overC / sum};
}

} // namespace lucent::truth
