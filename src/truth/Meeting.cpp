#include "truth/Meeting.h"

#include "truth/Relief.h"
#include "truth/Torus.h"

#include <algorithm>
#include <cmath>

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

/// The nearest hit of a sphere within a stretch. Half the chord is a product, not a difference of squares:
/// rays that graze keep their digits.
std::optional<Meeting> meet(const Sphere& sphere, const WorldRay& ray, Stretch stretch) {
    const dvec3 out = ray.origin - sphere.center;
    const double foot = -glm::dot(out, ray.direction);
    const double aside = glm::length(out + foot * ray.direction);
    if (aside > sphere.radius) return {};
    const double half = std::sqrt((sphere.radius - aside) * (sphere.radius + aside));
    for (const double distance : {foot - half, foot + half})
        if (distance > stretch.from && distance < stretch.to)
            return Meeting{distance, glm::normalize(out + distance * ray.direction)};
    return {};
}

std::optional<Meeting> meet(const Torus& torus, const WorldRay& ray, Stretch stretch) {
    const dvec3 aside = std::abs(torus.axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(torus.axis, aside));
    const glm::dmat3 worldFromTorus(first, glm::cross(torus.axis, first), torus.axis);
    const dvec3 origin = (ray.origin - torus.center) * worldFromTorus,
                direction = ray.direction * worldFromTorus;
    const TorusHits hits = torusHits(origin, direction, torus.major, torus.minor);
    for (int i = 0; i < hits.count; ++i)
        if (const double distance = hits.at[std::size_t(i)]; distance > stretch.from && distance < stretch.to)
            return Meeting{distance,
                           worldFromTorus * torusNormal(origin + distance * direction, torus.major)};
    return {};
}

/// The first place of a stretch at which a ray meets a ripple. Along the ray its height over the sheet is a
/// line less a sine: between two of the places where that turns there is one root or none.
class RippleCut {
public:
    RippleCut(const Ripple& ripple, const dvec3& origin, const dvec3& direction)
        : amplitude_(ripple.amplitude), altitude_(origin.y), climb_(direction.y),
          angle_(glm::dot(ripple.wave, dvec2(origin.x, origin.z)) - ripple.phase),
          turning_(glm::dot(ripple.wave, dvec2(direction.x, direction.z))) {}

    std::optional<double> first(Stretch stretch) const {
        for (double from = stretch.from; from < stretch.to;) {
            const double to = std::min(nextTurn(from), stretch.to);
            if ((above(from) < 0) != (above(to) < 0)) return between(from, to);
            from = to;
        }
        return {};
    }

private:
    double angle(double at) const { return angle_ + at * turning_; }
    double above(double at) const { return altitude_ + at * climb_ - amplitude_ * std::sin(angle(at)); }
    double slope(double at) const { return climb_ - amplitude_ * turning_ * std::cos(angle(at)); }

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
    /// Newton's steps that leave the bracket become bisections.
    double between(double low, double high) const {
        const bool rising = above(low) < 0;
        double at = 0.5 * (low + high);
        for (int step = 0; step < 200 && low < at && at < high; ++step) {
            const double value = above(at);
            if (value == 0) break;
            ((value < 0) == rising ? low : high) = at;
            const double next = at - value / slope(at);
            at = low < next && next < high ? next : 0.5 * (low + high);
        }
        return at;
    }
    double amplitude_, altitude_, climb_, angle_, turning_;
};

std::optional<Meeting> meet(const Ripple& ripple, const WorldRay& world, Stretch stretch) {
    const double scale = ripple.placement.scale;
    // From the place that is nearest to the sheet's middle: a whole line has no other beginning.
    const dvec3 direction = ripple.placement.directionFromWorld(world.direction);
    const dvec3 start = ripple.placement.pointFromWorld(world.origin);
    const double foot = -glm::dot(start, direction);
    const WorldRay local{start + foot * direction, direction, stretch.to / scale - foot,
                         stretch.from / scale - foot};
    const double room = ripple.amplitude + 1e-9 * (ripple.half.x + ripple.half.y);
    const Box box{{-ripple.half.x, -room, -ripple.half.y}, {ripple.half.x, room, ripple.half.y}};
    const auto at = RippleCut(ripple, local.origin, direction).first(within(box, local));
    if (!at) return {};
    const dvec3 place = local.origin + *at * direction;
    const dvec2 slope = ripple.amplitude * ripple.wave *
                        std::cos(glm::dot(ripple.wave, dvec2(place.x, place.z)) - ripple.phase);
    const dvec3 normal = glm::normalize(dvec3(-slope.x, 1, -slope.y));
    return Meeting((*at + foot) * scale, ripple.placement.directionInWorld(normal));
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

std::optional<Meeting> meet(const FieldBlock& block, const WorldRay& world, Stretch stretch) {
    const FieldRay local(block, world, stretch);
    const auto hit = firstHit(*block.field, local.ray, local.stretch);
    if (!hit) return {};
    const double distance = glm::dot(hit->position - local.ray.anchor, local.ray.direction);
    return Meeting{distance * block.placement.scale, block.placement.directionInWorld(hit->normal)};
}

/// Triangles are met one by one.
std::optional<Meeting> meet(const Triangles&, const WorldRay&, Stretch) { return {}; }

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
    return meet(shape, ray, stretch).has_value();
}

} // namespace

Box boxOf(const Shape& shape) {
    return std::visit([](const auto& known) { return boxOf(known); }, shape);
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

std::optional<Meeting> meet(const Shape& shape, const WorldRay& ray, Stretch stretch) {
    return std::visit([&](const auto& known) { return meet(known, ray, stretch); }, shape);
}

bool blocks(const Shape& shape, const WorldRay& ray, Stretch stretch) {
    return std::visit([&](const auto& known) { return blocks(known, ray, stretch); }, shape);
}

std::optional<Meeting> meetTriangle(const Triangles& triangles, unsigned number, const WorldRay& ray) {
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
    const dvec3 normal = across / std::sqrt(area);
    if (triangles.normals.empty()) return Meeting(distance, normal);
    const dvec3 smooth = (1 - u - v) * triangles.normals[index[0]] + u * triangles.normals[index[1]] +
                         v * triangles.normals[index[2]];
    return Meeting(distance, normal, glm::normalize(smooth));
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
