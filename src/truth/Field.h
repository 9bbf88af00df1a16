#pragma once
/// A height field in double precision, and rays cut where its surface changes formula.
///
/// Samples stand at texel centres, bilinear between them, constant in the outer half texel; the footprint's
/// border is a wall to outside. Between two cuts height minus altitude is a quadratic along the ray. It is
/// recovered from three samples of the surface, not from an expanded product, and altitudes are taken
/// relative to the ray's anchor: a shading point 1e-6 below the surface keeps its digits.

#include "base/Math.h"
#include "scene/Scene.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

namespace lucent::truth {

/// Points anchor + offset + s * direction. Altitudes are compared relative to the anchor.
struct Ray {
    dvec3 anchor;
    dvec3 offset;
    dvec3 direction; ///< unit
};

/// A stretch of a ray, as ray parameters; empty when `to` is not above `from`.
struct Stretch {
    double from, to;
};

/// A stretch on which height minus altitude is one quadratic, given by its values at both ends and in the
/// middle. Positive values are inside.
struct Piece {
    Stretch stretch;
    double first, middle, last;
};

/// A point of the surface (or of a side wall) and the unit normal there.
struct SurfacePoint {
    dvec3 position;
    dvec3 normal;
};

/// A height field in its object's space: metres before the object's scale.
class Field {
public:
    explicit Field(const scene::HeightField& shape);

    double texel() const { return texel_; }
    /// Half width and half height of the footprint.
    dvec2 half() const { return half_; }
    double lowest() const { return lowest_; }
    double highest() const { return highest_; }
    /// The side walls are drawn down to here. Light knows no floor: for it the solid goes on below.
    double bottom() const { return std::min(0.0, lowest_); }

    /// Height of the surface at (x, y); beside the footprint that of its nearest point.
    double height(dvec2 at) const;
    /// Central differences per texel in world units, one-sided at the border, normalised, then bilinear
    /// between texels and normalised again.
    dvec3 normal(dvec2 at) const;
    /// Place on a map that is stretched over the footprint, (0, 0) at its first texel's outer corner.
    dvec2 placeOnMap(const dvec3& position) const {
        return dvec2(position.x + half_.x, half_.y - position.y) / (2.0 * half_);
    }
    SurfacePoint pointAbove(dvec2 at) const { return {dvec3(at, height(at)), normal(at)}; }

    /// The part of a stretch that lies strictly above or below the footprint.
    Stretch overFootprint(const Ray& ray, Stretch stretch) const;

    /// Calls `visit` for the pieces of a stretch (its end may be infinite), nearest first, until it returns
    /// false. What lies above the highest point or beside the footprint is left out; what lies below the
    /// lowest point comes as one piece that is inside.
    void cut(const Ray& ray, Stretch stretch, const std::function<bool(const Piece&)>& visit) const;

private:
    class Cell;
    double sample(int x, int y) const {
        return heights_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)];
    }
    dvec3 texelNormal(int x, int y) const;
    bool cutBetweenLines(const Ray& ray, Stretch stretch,
                         const std::function<bool(const Piece&)>& visit) const;

    int columns_, rows_;
    double texel_;
    dvec2 half_;
    std::vector<double> heights_;
    double lowest_, highest_;
};

} // namespace lucent::truth
