#include "truth/SeenPlaces.h"

#include "truth/Glass.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>

namespace lucent::truth {

SeenPlaces::SeenPlaces(const Optics& optics, const Eye& eye, ivec2 size, const Media& atEye, bool overPixels)
    : optics_(&optics) {
    constexpr dvec2 kMiddle[] = {{0.5, 0.5}};
    constexpr dvec2 kSpread[] = {{0.125, 0.625}, {0.375, 0.125}, {0.625, 0.875}, {0.875, 0.375}};
    const std::span<const dvec2> places = overPixels ? std::span<const dvec2>(kSpread) : kMiddle;
    const double share = 1 / double(places.size());
    const auto addPlace = [&](std::size_t pixel, const dvec2& place) {
        const Beam beam = beamFrom(eye, place, atEye);
        if (!optics.disperses()) return add(eye, pixel, beam, 1, dvec3(share));
        for (int channel = 0; channel < 3; ++channel) {
            dvec3 only(0);
            only[channel] = share;
            add(eye, pixel, beam, channel, only);
        }
    };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (const dvec2& place : places)
                addPlace(std::size_t(y) * std::size_t(size.x) + std::size_t(x), dvec2(x, y) + place);
    if (places_.empty()) return;
    cell_ = std::max_element(places_.begin(), places_.end(), [](const SeenPlace& a, const SeenPlace& b) {
                return a.radius < b.radius;
            })->radius;
    for (std::size_t i = 0; i < places_.size(); ++i)
        cells_[key(cellOf(places_[i].hit.position))].push_back(i);
}

void SeenPlaces::add(const Eye& eye, std::size_t pixel, const Beam& beam, int channel, const dvec3& colors) {
    Random unused(0, 0, 0);
    const auto addEnd = [&](const Arrival& arrival, double before) {
        if (arrival.at != Arrival::At::Opaque || arrival.surfaces + (before > 0 ? 1 : 0) == 0) return;
        SeenPlace place{.hit = arrival.hit,
                        .viewer = -arrival.direction,
                        .weight = colors * arrival.weight,
                        .radius = eye.pixelWidth(before + arrival.length),
                        .isUnder = false,
                        .area = 0,
                        .pixel = pixel};
        place.isUnder = clearanceOver(place.hit, place.viewer) < place.radius;
        place.area = areaAround(place);
        places_.push_back(place);
    };
    const Arrival arrival = follow(*optics_, beam, channel, Branching::Chain, {}, unused);
    addEnd(arrival, 0);
    if (arrival.mirrored)
        addEnd(follow(*optics_, *arrival.mirrored, channel, Branching::Chain, {}, unused),
               arrival.firstDistance);
}

namespace {

// The first surface that is meant.
std::optional<Hit> firstOf(const Optics& optics, WorldRay ray,
                           const std::function<bool(const Hit&)>& isMeant) {
    std::optional<Hit> hit;
    while ((hit = optics.rays().intersect(ray)) && !isMeant(*hit))
        ray.begin = hit->distance + optics.rays().gap();
    return hit;
}

std::optional<Hit> otherOver(const Optics& optics, int shape, const dvec3& at, const dvec3& way) {
    return firstOf(optics, {at, way, std::numeric_limits<double>::infinity(), optics.rays().gap()},
                   [&](const Hit& hit) { return hit.shape != shape && optics.isOpaque(hit.shape); });
}

// From inside a solid that stands on a surface every line meets a back of it first; from below a sheet those
// that lean do not.
bool isCovered(const Optics& optics, int shape, const dvec3& at, const dvec3& up, const dvec3& right) {
    const dvec3 ways[] = {up, glm::normalize(up + 2.0 * right), glm::normalize(up - 2.0 * right)};
    return std::all_of(std::begin(ways), std::end(ways), [&](const dvec3& way) {
        const auto hit = otherOver(optics, shape, at, way);
        return hit && glm::dot(hit->normal, way) > 0;
    });
}

dvec3 normalTo(const Hit& hit, const dvec3& side) {
    return glm::dot(hit.normal, side) < 0 ? -hit.normal : hit.normal;
}

} // namespace

/// How far another shape stands over a place, m.
double SeenPlaces::clearanceOver(const Hit& hit, const dvec3& side) const {
    const auto other = otherOver(*optics_, hit.shape, hit.position, normalTo(hit, side));
    return other ? other->distance : std::numeric_limits<double>::infinity();
}

/// Lines along the normal, evenly over the disc around a place, meet its shape where light counts for it.
double SeenPlaces::areaAround(const SeenPlace& place) const {
    const int shape = place.hit.shape;
    const dvec3 up = normalTo(place.hit, place.viewer);
    const dvec3 right =
        glm::normalize(glm::cross(up, std::abs(up.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 front = glm::cross(up, right);
    double sum = 0;
    for (int i = 0; i < kAreaRays; ++i) {
        const double reach = place.radius * std::sqrt((i + 0.5) / kAreaRays);
        const double angle =
            i * std::numbers::pi * (3 - std::sqrt(5.0)); // golden: evenly spread (Vogel 1979)
        const dvec3 aside = std::cos(angle) * right + std::sin(angle) * front;
        const auto hit =
            firstOf(*optics_, {place.hit.position + place.radius * up + reach * aside, -up, 2 * place.radius},
                    [&](const Hit& one) { return one.shape == shape; });
        if (!hit || glm::distance(hit->position, place.hit.position) > place.radius) continue;
        const double slope = std::abs(glm::dot(hit->normal, up));
        const bool isUnder = clearanceOver(*hit, up) < place.radius;
        if (slope > 0 && isUnder == place.isUnder && !isCovered(*optics_, shape, hit->position, up, right))
            sum += 1 / slope;
    }
    const double disc = std::numbers::pi * place.radius * place.radius;
    return disc * std::max(sum, 1.0) / kAreaRays; // it is on the surface itself
}

/// Cells that share a key cost time only: places are compared by themselves.
std::uint64_t SeenPlaces::key(const glm::i64vec3& cell) {
    return std::uint64_t(cell.x) * 0x9e3779b97f4a7c15u + std::uint64_t(cell.y) * 0xc2b2ae3d27d4eb4fu +
           std::uint64_t(cell.z) * 0x165667b19e3779f9u;
}

bool SeenPlaces::reaches(const SeenPlace& place, const Hit& hit, const dvec3& direction) {
    const dvec3 apart = hit.position - place.hit.position;
    return place.hit.shape == hit.shape && glm::dot(apart, apart) <= place.radius * place.radius &&
           glm::dot(hit.normal, direction) * glm::dot(place.hit.normal, place.viewer) < 0;
}

} // namespace lucent::truth
