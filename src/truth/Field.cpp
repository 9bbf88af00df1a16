#include "truth/Field.h"

#include <cmath>
#include <limits>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The two texels around a place on one axis and the weight of the second.
struct Between {
    int low, high;
    double weight;
};

/// @param place  in texels from the border of the first one
Between between(double place, int texels) {
    const double base = std::floor(std::clamp(place, 0.0, double(texels)) - 0.5);
    return {std::max(int(base), 0), std::min(int(base) + 1, texels - 1), place - 0.5 - base};
}

/// Steps through the ray parameters at which one coordinate, in texels, meets the lines through texel
/// centres.
class LineCrossings {
public:
    /// @param anchor, offset  the coordinate at parameter 0 is their sum
    LineCrossings(double anchor, double offset, double speed, double from, int texels)
        : anchor_(anchor), offset_(offset), speed_(speed), texels_(texels) {
        const double place = anchor + offset + from * speed - 0.5;
        line_ = std::clamp(speed > 0 ? std::floor(place) : std::ceil(place), -1.0, double(texels));
    }
    /// First crossing past `at`; infinite when there is none.
    double next(double at) {
        if (speed_ == 0) return kInfinity;
        for (; line_ >= -1 && line_ <= texels_; line_ += speed_ > 0 ? 1 : -1) {
            const double crossing = (line_ + 0.5 - anchor_ - offset_) / speed_;
            if (crossing > at) return crossing;
        }
        return kInfinity;
    }

private:
    double anchor_, offset_, speed_;
    int texels_;
    double line_;
};

Stretch common(Stretch a, Stretch b) { return {std::max(a.from, b.from), std::min(a.to, b.to)}; }

/// Where start + s * speed is strictly below `limit`.
Stretch below(double start, double speed, double limit) {
    if (speed == 0) return start < limit ? Stretch{-kInfinity, kInfinity} : Stretch{kInfinity, -kInfinity};
    const double crossing = (limit - start) / speed;
    return speed > 0 ? Stretch{-kInfinity, crossing} : Stretch{crossing, kInfinity};
}
} // namespace

Field::Field(const scene::HeightField& shape)
    : columns_(shape.heights->width), rows_(shape.heights->height), texel_(double(shape.width) / columns_),
      half_(0.5 * texel_ * dvec2(columns_, rows_)),
      heights_(shape.heights->pixels.begin(), shape.heights->pixels.end()) {
    for (double& value : heights_)
        value *= double(shape.heightScale);
    const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
    lowest_ = *low;
    highest_ = *high;
}

double Field::height(dvec2 at) const {
    const Between x = between((at.x + half_.x) / texel_, columns_);
    const Between y = between((half_.y - at.y) / texel_, rows_);
    const auto along = [&](int row) {
        const double left = sample(x.low, row);
        return left + x.weight * (sample(x.high, row) - left);
    };
    const double top = along(y.low);
    return top + y.weight * (along(y.high) - top);
}

dvec3 Field::texelNormal(int x, int y) const {
    const int left = std::max(x - 1, 0), right = std::min(x + 1, columns_ - 1);
    const int up = std::max(y - 1, 0), down = std::min(y + 1, rows_ - 1);
    const double dx = right > left ? (sample(right, y) - sample(left, y)) / ((right - left) * texel_) : 0;
    const double dy = down > up ? (sample(x, up) - sample(x, down)) / ((down - up) * texel_) : 0;
    return glm::normalize(dvec3(-dx, -dy, 1));
}

dvec3 Field::normal(dvec2 at) const {
    const Between x = between((at.x + half_.x) / texel_, columns_);
    const Between y = between((half_.y - at.y) / texel_, rows_);
    const dvec3 top = glm::mix(texelNormal(x.low, y.low), texelNormal(x.high, y.low), x.weight);
    const dvec3 bottom = glm::mix(texelNormal(x.low, y.high), texelNormal(x.high, y.high), x.weight);
    return glm::normalize(glm::mix(top, bottom, y.weight));
}

Stretch Field::overFootprint(const Ray& ray, Stretch stretch) const {
    for (int axis = 0; axis < 2; ++axis) {
        const double start = ray.anchor[axis] + ray.offset[axis], speed = ray.direction[axis];
        stretch = common(stretch, below(start, speed, half_[axis]));
        stretch = common(stretch, below(-start, -speed, half_[axis]));
    }
    return stretch;
}

void Field::cut(const Ray& ray, Stretch stretch, const std::function<bool(const Piece&)>& visit) const {
    const double altitude = ray.offset.z, climb = ray.direction.z;
    stretch = common(overFootprint(ray, stretch), below(altitude, climb, highest_ - ray.anchor.z));
    if (!(stretch.from < stretch.to)) return;

    const Stretch deep = common(stretch, below(altitude, climb, lowest_ - ray.anchor.z));
    const auto visitDeep = [&] { return visit({deep, 1, 1, 1}); };
    if (!(deep.from < deep.to)) {
        cutBetweenLines(ray, stretch, visit);
    } else if (climb > 0) {
        if (visitDeep()) cutBetweenLines(ray, {deep.to, stretch.to}, visit);
    } else {
        if (cutBetweenLines(ray, {stretch.from, deep.from}, visit)) visitDeep();
    }
}

/// The bilinear patch between four texel centres, relative to an altitude.
class Field::Cell {
public:
    /// @param place  inside the patch, in texels from the footprint's first corner
    Cell(const Field& field, dvec2 place, double altitude) : base_(glm::floor(place - 0.5)) {
        const auto column = [&](double x) { return std::clamp(int(x), 0, field.columns_ - 1); };
        const auto row = [&](double y) { return std::clamp(int(y), 0, field.rows_ - 1); };
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x)
                corners_[y][x] = field.sample(column(base_.x + x), row(base_.y + y)) - altitude;
    }
    double height(dvec2 anchor, dvec2 offset) const {
        const dvec2 at = (anchor - base_ - 0.5) + offset;
        const double top = corners_[0][0] + at.x * (corners_[0][1] - corners_[0][0]);
        const double bottom = corners_[1][0] + at.x * (corners_[1][1] - corners_[1][0]);
        return top + at.y * (bottom - top);
    }

private:
    dvec2 base_;
    double corners_[2][2];
};

bool Field::cutBetweenLines(const Ray& ray, Stretch stretch,
                            const std::function<bool(const Piece&)>& visit) const {
    // Image rows run against y.
    const dvec2 anchor = dvec2(ray.anchor.x + half_.x, half_.y - ray.anchor.y) / texel_;
    const dvec2 offset = dvec2(ray.offset.x, -ray.offset.y) / texel_;
    const dvec2 speed = dvec2(ray.direction.x, -ray.direction.y) / texel_;
    LineCrossings columns(anchor.x, offset.x, speed.x, stretch.from, columns_);
    LineCrossings rows(anchor.y, offset.y, speed.y, stretch.from, rows_);

    for (double from = stretch.from; from < stretch.to;) {
        const double to = std::min({columns.next(from), rows.next(from), stretch.to});
        const double middle = 0.5 * (from + to);
        const Cell cell(*this, anchor + offset + middle * speed, ray.anchor.z);
        const auto inside = [&](double s) {
            return cell.height(anchor, offset + s * speed) - (ray.offset.z + s * ray.direction.z);
        };
        if (!visit({{from, to}, inside(from), inside(middle), inside(to)})) return false;
        from = to;
    }
    return true;
}

} // namespace lucent::truth
