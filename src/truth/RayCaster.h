#pragma once
/// Which shapes of a scene a ray may meet: by Embree's tree, or by one of our own where there is no Embree.

#include "truth/Intersection.h"

#include <algorithm>

namespace lucent::truth {

/// A shape of a scene as ray casters know it.
struct Entry {
    Shape shape;
    Box box; ///< a little larger than the shape
    bool hidden;
};

/// One question to the scene, and what is found.
class Query {
public:
    /// @param enters  where the ray enters the scene's box
    /// @param within  how far behind the nearest hit others count
    Query(const WorldRay& ray, const Leaving& leaving, double enters, double within)
        : ray_(ray), leaving_(leaving), enters_(enters), within_(within) {}

    const WorldRay& ray() const { return ray_; }
    double enters() const { return enters_; }
    bool asksFor(const Entry& entry) const { return ray_.hitsHidden || !entry.hidden; }
    /// Nothing farther along the ray counts.
    double farthest() const {
        return found_.count > 0 ? std::min(ray_.length, found_.at[0].distance + within_) : ray_.length;
    }
    /// Where a shape may be met.
    Stretch open(int shape) const {
        return {shape == leaving_.shape ? std::max(ray_.begin, leaving_.until) : ray_.begin, farthest()};
    }
    /// Takes a hit when it is the nearest up to now, or close behind it.
    bool offer(int shape, const Intersection& intersection);
    const Hits& found() const { return found_; }

private:
    void insert(const Hit& hit);

    WorldRay ray_;
    Leaving leaving_;
    double enters_, within_;
    Hits found_;
};

/// The search for the triangle that is nearest to a point.
class Search {
public:
    explicit Search(const dvec3& point) : point_(point) {}

    const dvec3& point() const { return point_; }
    double farthest() const { return found_ ? found_->distance : std::numeric_limits<double>::infinity(); }
    /// Takes a triangle when it is the nearest up to now.
    bool offer(const Triangles& mesh, std::size_t triangle);
    const std::optional<Nearest>& found() const { return found_; }

private:
    dvec3 point_;
    std::optional<Nearest> found_;
};

class RayCaster {
public:
    virtual ~RayCaster() = default;
    /// Offers the query what its ray meets.
    virtual void find(Query& query) const = 0;
    virtual bool isBlocked(Query& query) const = 0;
    virtual void find(Search& search) const = 0;
};

/// Error when Embree cannot work on this machine, with its own message. Entries must stay where they are.
///
/// @param middle  of the scene: Embree's origin, where floats are densest
/// @param room    what Embree may be wrong by, and more, m
Result<std::unique_ptr<RayCaster>> findByEmbree(const std::vector<Entry>& entries, const dvec3& middle,
                                                double room);
/// A tree of boxes around shapes and triangles, in double precision.
std::unique_ptr<RayCaster> findByBoxes(const std::vector<Entry>& entries, double room);

} // namespace lucent::truth
