#include "truth/Displaced.h"

#include "scene/Displacement.h"
#include "truth/RayScene.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Neighbours overlap by so much of their edges, and the ceiling stands so much above the highest height.
constexpr double kRoom = 1e-9;
/// What begins this much of the highest height below the surface came in by a face.
constexpr double kSunk = 1e-7;
constexpr double kPiecesPerTexel = 4;
constexpr int kBlock = 8, kPiecesPerStride = 16;
/// Of the highest height: a ray bends less over a stride.
constexpr double kBend = 0.02;

/// The real roots of a z² + b z + c.
struct Roots {
    std::array<double, 2> at{};
    int count = 0;
    Roots(double a, double b, double c) {
        if (std::abs(a) * 1e14 <= std::abs(b)) { // a line, as far as doubles can tell
            if (b != 0) at[std::size_t(count++)] = -c / b;
            return;
        }
        const double square = b * b - 4 * a * c;
        if (square < 0) return;
        const double larger = -0.5 * (b + std::copysign(std::sqrt(square), b));
        at[std::size_t(count++)] = larger / a;
        if (larger != 0) at[std::size_t(count++)] = c / larger;
    }
};

} // namespace

/// A ray in the space above one triangle, from the place nearest to the triangle's middle on.
class DisplacedBody::Ray {
public:
    Ray(const Triangle& triangle, const WorldRay& world, double top)
        : triangle_(triangle), direction_(world.direction) {
        const dvec3 middle = (triangle.places[0] + triangle.places[1] + triangle.places[2]) / 3.0;
        start_ = glm::dot(middle - world.origin, direction_);
        origin_ = world.origin + start_ * direction_;
        for (int side = 0; side < 3; ++side)
            meetSide(side, top);
        meetCap(3, 0);
        meetCap(4, top);
    }

    double start() const { return start_; } ///< of the world's ray
    double enters() const { return enters_; }
    double leaves() const { return leaves_; }
    int face() const { return face_; } ///< by which it enters: three sides, floor, ceiling

    /// Weights and height of a place of the ray, by Newton's steps from one nearby.
    Place placeAt(double at, Place near) const {
        const dvec3 goal = origin_ + at * direction_;
        for (int step = 0; step < 50; ++step) {
            dvec3 place(0), up(0);
            std::array<dvec3, 3> lifted;
            for (std::size_t i = 0; i < 3; ++i) {
                lifted[i] = triangle_.places[i] + near.height * triangle_.directions[i];
                place += near.weights[int(i)] * lifted[i];
                up += near.weights[int(i)] * triangle_.directions[i];
            }
            const glm::dmat3 change(lifted[1] - lifted[0], lifted[2] - lifted[0], up);
            const dvec3 by = glm::inverse(change) * (goal - place);
            near.weights += dvec3(-by.x - by.y, by.x, by.y);
            near.height += by.z;
            if (!(std::abs(by.x) + std::abs(by.y) > 1e-15) || !std::isfinite(by.x)) break;
        }
        return near;
    }

private:
    void meet(double at, int face) {
        if (at < enters_) {
            enters_ = at;
            face_ = face;
        }
        leaves_ = std::max(leaves_, at);
    }
    /// The triangle lifted to one height.
    void meetCap(int face, double height) {
        const dvec3 a = triangle_.places[0] + height * triangle_.directions[0],
                    b = triangle_.places[1] + height * triangle_.directions[1],
                    c = triangle_.places[2] + height * triangle_.directions[2];
        const dvec3 across = glm::cross(b - a, c - a);
        const double at = glm::dot(a - origin_, across) / glm::dot(direction_, across);
        if (!std::isfinite(at)) return;
        const dvec3 place = origin_ + at * direction_;
        const double area = glm::dot(across, across);
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            if (glm::dot(glm::cross(to - from, place - from), across) < -kRoom * area) return;
        meet(at, face);
    }
    /// Straight edges from one height to the next: those that the ray touches lie with it in one plane.
    void meetSide(int side, double top) {
        const auto i = std::size_t(side), j = (i + 1) % 3;
        const dvec3 foot = triangle_.places[i] - origin_, edge = triangle_.places[j] - triangle_.places[i];
        const dvec3 rise = triangle_.directions[i], turn = triangle_.directions[j] - triangle_.directions[i];
        const auto volume = [&](const dvec3& a, const dvec3& b) {
            return glm::dot(direction_, glm::cross(a, b));
        };
        const Roots heights(volume(rise, turn), volume(foot, turn) + volume(rise, edge), volume(foot, edge));
        for (int k = 0; k < heights.count; ++k) {
            const double height = heights.at[std::size_t(k)];
            if (!(height >= -kRoom * top && height <= (1 + kRoom) * top)) continue;
            const dvec3 from = foot + height * rise, along = edge + height * turn;
            const dvec3 aside = along - glm::dot(along, direction_) * direction_;
            if (glm::dot(aside, aside) < 1e-20 * glm::dot(along, along)) continue; // the ray runs along it
            const double share = -glm::dot(from, aside) / glm::dot(aside, aside);
            if (share >= -kRoom && share <= 1 + kRoom) meet(glm::dot(from + share * along, direction_), side);
        }
    }

    const Triangle& triangle_;
    dvec3 direction_, origin_;
    double start_, enters_ = kNever, leaves_ = -kNever;
    int face_ = 4;
};

DisplacedBody::DisplacedBody(const scene::Object& object)
    : heights_(object.displacement->heights),
      highest_(double(*std::max_element(heights_->pixels.begin(), heights_->pixels.end()))), closed_(true) {
    const auto base = scene::baseOf(object);
    const glm::dmat4 worldFromObject(object.transform.worldFromObject());
    const double scale = double(object.transform.scale);
    scale_ = double(object.displacement->scale);
    closed_ = base->closed;
    blocks_ = (heights_->size() + kBlock - 1) / kBlock;
    const bool isWhole = blocks_ * kBlock == heights_->size(); // else blocks shift from tile to tile
    highestOf_.assign(std::size_t(blocks_.x * blocks_.y), isWhole ? 0 : highest_);
    for (int y = 0; isWhole && y < heights_->height; ++y)
        for (int x = 0; x < heights_->width; ++x) {
            double& most = highestOf_[std::size_t(y / kBlock * blocks_.x + x / kBlock)];
            most = std::max(most, stored(x, y));
        }
    for (const scene::DisplacedTriangle& one : base->triangles) {
        Triangle& triangle = triangles_.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.places[i] = dvec3(worldFromObject * glm::dvec4(dvec3(one.places[i]), 1));
            triangle.directions[i] =
                scale * glm::normalize(glm::dmat3(worldFromObject) * dvec3(one.directions[i]));
            triangle.coordinates[i] = dvec2(one.coordinates[i]) * dvec2(heights_->size());
        }
        triangle.walls = one.walls;
        triangle.vertices = one.vertices;
    }
}

Box DisplacedBody::boxOf(unsigned part) const {
    const Triangle& triangle = triangles_[part];
    const double top = (1 + 1e-6) * std::max(highest_, 1e-6) * scale_;
    Box box;
    for (std::size_t i = 0; i < 3; ++i) {
        box.add(triangle.places[i]);
        box.add(triangle.places[i] + top * triangle.directions[i]);
    }
    return box;
}

dvec3 DisplacedBody::weightsAt(unsigned part, const dvec3& place) const {
    const Triangle& triangle = triangles_[part];
    const Ray ray(triangle, {place, triangle.directions[0] / glm::length(triangle.directions[0])}, highest_);
    return ray.placeAt(-ray.start(), {dvec3(1.0 / 3), 0}).weights;
}

double DisplacedBody::stored(int x, int y) const {
    const auto wrapped = [](int at, int size) { return (at % size + size) % size; };
    return double(*heights_->at(wrapped(x, heights_->width), wrapped(y, heights_->height)));
}

double DisplacedBody::highestBetween(const dvec2& a, const dvec2& b) const {
    const ivec2 low(glm::floor((glm::min(a, b) - 1.0) / double(kBlock))),
        high(glm::floor((glm::max(a, b) + 1.0) / double(kBlock)));
    if (high.x - low.x >= blocks_.x || high.y - low.y >= blocks_.y) return highest_ * scale_;
    const auto wrapped = [](int at, int size) { return (at % size + size) % size; };
    double most = 0;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            most = std::max(
                most, highestOf_[std::size_t(wrapped(y, blocks_.y) * blocks_.x + wrapped(x, blocks_.x))]);
    return most * scale_;
}

double DisplacedBody::metresAt(const dvec2& texel) const {
    const dvec2 at = texel - 0.5, f = glm::fract(at);
    const ivec2 low(glm::floor(at));
    const double upper = glm::mix(stored(low.x, low.y), stored(low.x + 1, low.y), f.x);
    const double lower = glm::mix(stored(low.x, low.y + 1), stored(low.x + 1, low.y + 1), f.x);
    return scale_ * glm::mix(upper, lower, f.y);
}

dvec2 DisplacedBody::slopeAt(const dvec2& texel) const {
    const dvec2 at = texel - 0.5, f = glm::fract(at);
    const ivec2 low(glm::floor(at));
    const double a = stored(low.x, low.y), b = stored(low.x + 1, low.y), c = stored(low.x, low.y + 1),
                 d = stored(low.x + 1, low.y + 1);
    return scale_ * dvec2(glm::mix(b - a, d - c, f.y), glm::mix(c - a, d - b, f.x));
}

dvec2 DisplacedBody::smoothSlopeAt(const dvec2& texel) const {
    const dvec2 at = texel - 0.5, f = glm::fract(at);
    const ivec2 low(glm::floor(at));
    const auto central = [&](int x, int y) {
        return dvec2(stored(x + 1, y) - stored(x - 1, y), stored(x, y + 1) - stored(x, y - 1));
    };
    const dvec2 upper = glm::mix(central(low.x, low.y), central(low.x + 1, low.y), f.x);
    const dvec2 lower = glm::mix(central(low.x, low.y + 1), central(low.x + 1, low.y + 1), f.x);
    return 0.5 * scale_ * glm::mix(upper, lower, f.y);
}

dvec3 DisplacedBody::normalAt(const Triangle& triangle, const Place& place, const dvec2& slope,
                              bool isSmooth) const {
    dvec3 up(0);
    for (std::size_t i = 0; i < 3; ++i)
        up += place.weights[int(i)] * triangle.directions[i];
    const dvec3 unit = glm::normalize(up);
    const auto along = [&](std::size_t corner) {
        const dvec3 level = triangle.places[corner] - triangle.places[0] +
                            place.height * (triangle.directions[corner] - triangle.directions[0]);
        const double rise = glm::dot(slope, triangle.coordinates[corner] - triangle.coordinates[0]);
        return (isSmooth ? level - glm::dot(level, unit) * unit : level) + rise * up;
    };
    return glm::normalize(glm::cross(along(1), along(2)));
}

std::optional<Intersection> DisplacedBody::firstHit(unsigned part, const WorldRay& world,
                                                    Stretch stretch) const {
    const Triangle& triangle = triangles_[part];
    const double most = std::max(highest_, 1e-6) * scale_, top = (1 + 1e-6) * most;
    const Ray ray(triangle, world, top);
    const double from = std::max(ray.enters(), stretch.from - ray.start()),
                 to = std::min(ray.leaves(), stretch.to - ray.start());
    if (!(from < to)) return {};

    const auto texelOf = [&](const Place& place) {
        dvec2 texel(0);
        for (std::size_t i = 0; i < 3; ++i)
            texel += place.weights[int(i)] * triangle.coordinates[i];
        return texel;
    };
    const auto above = [&](const Place& place) { return place.height - metresAt(texelOf(place)); };
    const auto hitAt = [&](double at, const dvec3& normal,
                           const dvec3& smooth) -> std::optional<Intersection> {
        const double distance = ray.start() + at;
        if (!(distance > stretch.from && distance < stretch.to)) return {};
        Intersection found{distance, normal, smooth};
        found.triangle = int(part);
        return found;
    };

    const auto surfaceAt = [&](double at, const Place& place) {
        const dvec2 texel = texelOf(place);
        return hitAt(at, normalAt(triangle, place, slopeAt(texel), false),
                     normalAt(triangle, place, smoothSlopeAt(texel), true));
    };
    Place here = ray.placeAt(from, {dvec3(1.0 / 3), 0});
    double height = above(here);
    if (height < -kSunk * most && from == ray.enters()) {
        const int face = ray.face();
        const bool isOpen = face == 3 ? !closed_ : face < 3 && (triangle.walls >> face & 1) != 0;
        if (!isOpen) return {};
        const auto& places = triangle.places;
        dvec3 normal = -glm::normalize(glm::cross(places[1] - places[0], places[2] - places[0]));
        if (face < 3) {
            const auto i = std::size_t(face), j = (i + 1) % 3;
            dvec3 up(0);
            for (std::size_t k = 0; k < 3; ++k)
                up += here.weights[int(k)] * triangle.directions[k];
            normal = glm::normalize(glm::cross(places[j] - places[i], up));
        }
        return hitAt(from, normal, normal);
    }
    if (height < 0 && from == ray.enters()) return surfaceAt(from, here); // crossed on the border of two

    // In so short a piece the surface under the ray is one parabola, or two.
    const Place end = ray.placeAt(to, here);
    const double texels = glm::distance(texelOf(here), texelOf(end));
    const int pieces = std::clamp(int(std::ceil(kPiecesPerTexel * texels)), 4, 1 << 16);
    for (int i = 0; i < pieces; ++i) {
        if (i % kPiecesPerStride == 0 && i + kPiecesPerStride < pieces) {
            const Place far = ray.placeAt(glm::mix(from, to, double(i + kPiecesPerStride) / pieces), here);
            const double highest = highestBetween(texelOf(here), texelOf(far));
            if (std::min(here.height, far.height) > highest + kBend * most) {
                here = far;
                height = above(here);
                i += kPiecesPerStride - 1;
                continue;
            }
        }
        const double first = glm::mix(from, to, double(i) / pieces),
                     last = i + 1 == pieces ? to : glm::mix(from, to, double(i + 1) / pieces);
        const Place there = ray.placeAt(last, here);
        const double next = above(there);
        double low = first, high = last;
        bool crosses = height >= 0 && next < 0;
        if (height >= 0 && next >= 0) { // may dip below between: at the parabola's lowest place
            const Place middle = ray.placeAt(0.5 * (first + last), here);
            const double half = above(middle), bend = 2 * (height + next - 2 * half),
                         slope = -3 * height + 4 * half - next;
            const double lowest = bend > 0 ? -slope / (2 * bend) : -1;
            if (lowest > 0 && lowest < 1) {
                high = glm::mix(first, last, lowest);
                crosses = above(ray.placeAt(high, middle)) < 0;
            }
        }
        if (crosses) {
            Place hit = here;
            for (int step = 0; step < 100 && high - low > 1e-15 * (std::abs(low) + std::abs(high)); ++step) {
                const double middle = 0.5 * (low + high);
                if (!(middle > low && middle < high)) break;
                hit = ray.placeAt(middle, hit);
                (above(hit) < 0 ? high : low) = middle;
            }
            return surfaceAt(low, hit);
        }
        here = there;
        height = next;
    }
    return {};
}

} // namespace lucent::truth
