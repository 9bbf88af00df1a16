#pragma once
/// Opaque places that a picture shows through glass or in mirrors, ready to be asked which are near a place.

#include "base/Math.h"
#include "truth/LightPath.h"
#include "truth/Optics.h"
#include "truth/Sight.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace lucent::truth {

/// A place that a pixel shows.
struct SeenPlace {
    Hit hit;
    dvec3 viewer;  ///< unit, to where it is seen from
    dvec3 weight;  ///< of its radiance in the pixel, whose places have a share each
    double radius; ///< m: a pixel's width, as far away as light had to come
    bool isUnder;  ///< whether another shape stands over it, no further away
    double area; ///< m², of the shape's surface no further than that and under as it is, by kAreaRays lines
    std::size_t pixel; ///< row by row
};

class SeenPlaces {
public:
    /// Follows beams as GlassEstimator does by the chain; what is seen directly is left out.
    ///
    /// @param optics      must live as long
    /// @param overPixels  four places of each pixel, of which no two lie in a row or column, for its middle:
    ///                    an edge errs by an eighth of a pixel at most
    SeenPlaces(const Optics& optics, const Eye& eye, ivec2 size, const Media& atEye, bool overPixels = false);

    const std::vector<SeenPlace>& all() const { return places_; }

    /// Calls `visit` for the places on the same shape, lit on the side that is seen, no further than their
    /// radius; beneath what stands over the shape for those that are there themselves.
    ///
    /// @param direction  unit, of light that arrives
    template <class Visit>
    void near(const Hit& hit, const dvec3& direction, const Visit& visit) const {
        if (places_.empty()) return;
        const glm::i64vec3 middle = cellOf(hit.position);
        double clearance = -1; // once it is asked for
        for (int i = 0; i < 27; ++i) {
            const auto cell = cells_.find(key(middle + glm::i64vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
            if (cell == cells_.end()) continue;
            for (const std::size_t number : cell->second)
                if (const SeenPlace& place = places_[number]; reaches(place, hit, direction)) {
                    if (clearance < 0) clearance = clearanceOver(hit, -direction);
                    if ((clearance < place.radius) == place.isUnder) visit(place);
                }
        }
    }

private:
    glm::i64vec3 cellOf(const dvec3& place) const { return glm::i64vec3(glm::floor(place / cell_)); }
    static std::uint64_t key(const glm::i64vec3& cell);
    double clearanceOver(const Hit& hit, const dvec3& side) const;
    double areaAround(const SeenPlace& place) const;
    static bool reaches(const SeenPlace& place, const Hit& hit, const dvec3& direction);
    void add(const Eye& eye, std::size_t pixel, const Beam& beam, int channel, const dvec3& colors);

    static constexpr int kAreaRays = 64;

    const Optics* optics_;
    std::vector<SeenPlace> places_;
    double cell_ = 1;                                                   ///< m: the largest radius
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_; ///< numbers of places
};

} // namespace lucent::truth
