#include "truth/SeenPlaces.h"

#include "truth/Glass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace lucent::truth {

SeenPlaces::SeenPlaces(const Optics& optics, const Eye& eye, ivec2 size, const Media& atEye,
                       bool overPixels) {
    constexpr dvec2 kMiddle[] = {{0.5, 0.5}};
    constexpr dvec2 kSpread[] = {{0.125, 0.625}, {0.375, 0.125}, {0.625, 0.875}, {0.875, 0.375}};
    const std::span<const dvec2> places = overPixels ? std::span<const dvec2>(kSpread) : kMiddle;
    const double share = 1 / double(places.size());
    const auto addPlace = [&](std::size_t pixel, const dvec2& place) {
        const Beam beam = beamFrom(eye, place, atEye);
        if (!optics.disperses()) return add(optics, eye, pixel, beam, 1, dvec3(share));
        for (int channel = 0; channel < 3; ++channel) {
            dvec3 only(0);
            only[channel] = share;
            add(optics, eye, pixel, beam, channel, only);
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

void SeenPlaces::add(const Optics& optics, const Eye& eye, std::size_t pixel, const Beam& beam, int channel,
                     const dvec3& colors) {
    Random unused(0, 0, 0);
    const auto addEnd = [&](const Arrival& arrival, double before) {
        if (arrival.at != Arrival::At::Opaque || arrival.surfaces + (before > 0 ? 1 : 0) == 0) return;
        const double away = before + arrival.length;
        SeenPlace place{arrival.hit, -arrival.direction, colors * arrival.weight, eye.pixelWidth(away), 0,
                        pixel};
        place.area = areaAround(optics, place);
        places_.push_back(place);
    };
    const Arrival arrival = follow(optics, beam, channel, Branching::Chain, {}, unused);
    addEnd(arrival, 0);
    if (arrival.mirrored)
        addEnd(follow(optics, *arrival.mirrored, channel, Branching::Chain, {}, unused),
               arrival.firstDistance);
}

/// Lines along the normal, evenly over the disc around a place, meet the surface where neither an edge of its
/// shape nor another shape that stands on it takes its place. One that begins behind such a shape counts as
/// met by that.
double SeenPlaces::areaAround(const Optics& optics, const SeenPlace& place) {
    const dvec3 up = glm::dot(place.hit.normal, place.viewer) < 0 ? -place.hit.normal : place.hit.normal;
    const dvec3 right =
        glm::normalize(glm::cross(up, std::abs(up.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 front = glm::cross(up, right);
    const dvec3 above = place.hit.position + place.radius * up;
    const auto firstOpaque = [&](const dvec3& origin, const dvec3& direction, double length) {
        WorldRay ray{origin, direction, length};
        std::optional<Hit> hit;
        while ((hit = optics.rays().intersect(ray)) && !optics.isOpaque(hit->shape))
            ray.begin = hit->distance + optics.rays().gap();
        return hit;
    };
    double sum = 0;
    for (int i = 0; i < kAreaRays; ++i) {
        const double reach = place.radius * std::sqrt((i + 0.5) / kAreaRays);
        const double angle =
            i * std::numbers::pi * (3 - std::sqrt(5.0)); // golden: evenly spread (Vogel 1979)
        const dvec3 aside = std::cos(angle) * right + std::sin(angle) * front;
        if (firstOpaque(above, aside, reach)) continue;
        const auto hit = firstOpaque(above + reach * aside, -up, 2 * place.radius);
        if (!hit || hit->shape != place.hit.shape) continue;
        const double slope = std::abs(glm::dot(hit->normal, up));
        if (slope > 0 && glm::distance(hit->position, place.hit.position) <= place.radius) sum += 1 / slope;
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
