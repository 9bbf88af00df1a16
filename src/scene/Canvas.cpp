#include "scene/Canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lucent::scene {
namespace {

using Corners = std::array<dvec2, 3>;

constexpr std::uint32_t kNone = ~0u;

// Reading takes texels whose middles are less than one away along each axis.
constexpr double kReach = std::numbers::sqrt2; // texels

double twiceArea(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How much of each corner there is at a place in the triangle's plane.
dvec3 weightsAt(const Corners& t, const dvec2& p) {
    const dvec3 parts(twiceArea(t[1], t[2], p), twiceArea(t[2], t[0], p), twiceArea(t[0], t[1], p));
    return parts / (parts.x + parts.y + parts.z);
}

dvec3 nearestOnEdge(const Corners& t, std::size_t side, const dvec2& p) {
    const std::size_t from = side, to = (side + 1) % 3;
    const dvec2 way = t[to] - t[from];
    const double length = glm::dot(way, way);
    const double along = length > 0 ? glm::clamp(glm::dot(p - t[from], way) / length, 0.0, 1.0) : 0;
    dvec3 weights(0);
    weights[int(from)] = 1 - along;
    weights[int(to)] = along;
    return weights;
}

dvec2 placeAt(const Corners& t, const dvec3& weights) {
    return weights.x * t[0] + weights.y * t[1] + weights.z * t[2];
}

struct Nearest {
    double distance; // texels
    dvec3 weights;   // of the corners, at the triangle's nearest place
};

Nearest nearestPlace(const Corners& t, const dvec2& p) {
    if (twiceArea(t[0], t[1], t[2]) != 0) {
        const dvec3 weights = weightsAt(t, p);
        if (weights.x >= 0 && weights.y >= 0 && weights.z >= 0) return {0, weights};
    }
    Nearest nearest{std::numeric_limits<double>::infinity(), {}};
    for (std::size_t side = 0; side < 3; ++side) {
        const dvec3 weights = nearestOnEdge(t, side, p);
        const double distance = glm::length(placeAt(t, weights) - p);
        if (distance < nearest.distance) nearest = {distance, weights};
    }
    return nearest;
}

// Left and right end of what the triangle has between two heights.
dvec2 spanBetween(const Corners& t, double top, double bottom) {
    dvec2 span(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec2 &a = t[i], &b = t[(i + 1) % 3];
        if (std::max(a.y, b.y) < top || std::min(a.y, b.y) > bottom) continue;
        for (const double y : {top, bottom}) {
            const double along =
                a.y == b.y ? (y == top ? 0 : 1) : glm::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
            const double x = a.x + (b.x - a.x) * along;
            span = {std::min(span.x, x), std::max(span.y, x)};
        }
    }
    return span;
}

// A triangle this narrow does not say where its plane goes on; places are floats of up to 12 bits before the
// point.
bool isNarrow(const Corners& t) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, glm::dot(t[(i + 1) % 3] - t[i], t[(i + 1) % 3] - t[i]));
    return std::abs(twiceArea(t[0], t[1], t[2])) < 0.02 * std::max(longest, std::sqrt(longest));
}

// Of each texel's middle: a triangle that is nearer than those before, and near enough to read the texel.
void takeNearer(const Atlas& atlas, std::uint32_t t, std::vector<std::uint32_t>& triangles,
                std::vector<float>& distances) {
    const int side = atlas.side;
    Corners places;
    for (std::size_t i = 0; i < 3; ++i)
        places[i] = dvec2(atlas.places[atlas.mesh->indices[3 * std::size_t(t) + i]]);
    const auto [top, bottom] = std::minmax({places[0].y, places[1].y, places[2].y});
    const int last = std::min(side - 1, int(std::floor(bottom + kReach - 0.5)));
    for (int y = std::max(0, int(std::ceil(top - kReach - 0.5))); y <= last; ++y) {
        const dvec2 span = spanBetween(places, y + 0.5 - kReach, y + 0.5 + kReach);
        const int right = std::min(side - 1, int(std::floor(span.y + kReach - 0.5)));
        for (int x = std::max(0, int(std::ceil(span.x - kReach - 0.5))); x <= right; ++x) {
            const std::size_t number = std::size_t(y) * std::size_t(side) + std::size_t(x);
            if (distances[number] == 0) continue;
            const auto away = float(nearestPlace(places, {x + 0.5, y + 0.5}).distance);
            if (away >= distances[number]) continue;
            distances[number] = away;
            triangles[number] = t;
        }
    }
}

PaintSurface::Texel texelOf(const Atlas& atlas, std::uint32_t triangle, std::uint32_t number) {
    const dvec2 middle(double(number % std::uint32_t(atlas.side)) + 0.5,
                       double(number / std::uint32_t(atlas.side)) + 0.5);
    const Mesh& mesh = *atlas.mesh;
    Corners places;
    std::array<std::uint32_t, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = mesh.indices[3 * std::size_t(triangle) + i];
        places[i] = dvec2(atlas.places[corners[i]]);
    }
    const dvec3 inside = nearestPlace(places, middle).weights;
    const dvec3 weights = isNarrow(places) ? inside : weightsAt(places, middle);
    dvec3 place(0), normal(0);
    for (int i = 0; i < 3; ++i) {
        place += weights[i] * dvec3(mesh.positions[corners[std::size_t(i)]]);
        normal += inside[i] * dvec3(mesh.normals[corners[std::size_t(i)]]);
    }
    const double length = glm::length(normal);
    return {vec3(place), length > 0 ? vec3(normal / length) : vec3(0), number};
}

// Share of its strength that a dab has at a distance in radii.
float falloff(float distance, float hardness) {
    if (distance <= hardness) return 1;
    if (distance >= 1) return 0;
    const float t = (distance - hardness) / (1 - hardness);
    return 1 - t * t * (3 - 2 * t);
}

constexpr vec3 kMirror(-1, 1, 1); // at the object's plane x = 0

int mapOf(PaintMap map) { return map == PaintMap::Translucency || map == PaintMap::Outgoing; }

std::shared_ptr<const Image> unpaintedMap(int side) {
    auto map = std::make_shared<Image>(side, side, 4);
    std::fill(map->pixels.begin(), map->pixels.end(), 1.0f);
    return map;
}

vec4 texelAt(const Image& map, std::uint32_t number) {
    const float* p = map.pixels.data() + 4 * std::size_t(number);
    return {p[0], p[1], p[2], p[3]};
}

void setTexel(Image& map, std::uint32_t number, const vec4& value) {
    for (int i = 0; i < 4; ++i)
        map.pixels[4 * std::size_t(number) + std::size_t(i)] = value[i];
}

} // namespace

PaintSurfaceMaking::PaintSurfaceMaking(std::shared_ptr<const Atlas> atlas)
    : atlas_(std::move(atlas)), triangles_(std::size_t(atlas_->side) * std::size_t(atlas_->side), kNone),
      distances_(triangles_.size(), float(kReach)), surface_(std::make_shared<PaintSurface>()) {
    surface_->side_ = atlas_->side;
}

std::optional<PaintSurfaceMaking::Made> PaintSurfaceMaking::advance() {
    constexpr std::size_t kPieces = 16; // of either part
    const std::size_t count = atlas_->mesh->indices.size() / 3;
    if (triangle_ < count) {
        for (std::size_t end = std::min(count, triangle_ + count / kPieces + 1); triangle_ < end; ++triangle_)
            takeNearer(*atlas_, std::uint32_t(triangle_), triangles_, distances_);
        return {};
    }
    if (texel_ == triangles_.size()) {
        if (!surface_->starts_.empty()) return surface_;
        surface_->sort();
        return {};
    }
    const std::size_t end = std::min(triangles_.size(), texel_ + triangles_.size() / kPieces + 1);
    for (; texel_ < end; ++texel_)
        if (triangles_[texel_] != kNone)
            surface_->texels_.push_back(texelOf(*atlas_, triangles_[texel_], std::uint32_t(texel_)));
    return {};
}

void PaintSurface::sort() {
    if (texels_.empty()) {
        starts_.assign(2, 0);
        return;
    }
    low_ = vec3(std::numeric_limits<float>::max());
    vec3 high = -low_;
    for (const Texel& texel : texels_) {
        low_ = glm::min(low_, texel.place);
        high = glm::max(high, texel.place);
    }
    const vec3 size = high - low_;
    const float longest = std::max({size.x, size.y, size.z});
    // A surface meets about 6 n² of n³ cells: some 16 texels in each of them.
    const float along = glm::clamp(std::sqrt(float(texels_.size()) / 96), 1.0f, 128.0f);
    if (longest > 0) cell_ = longest / along;
    cells_ = ivec3(size / cell_) + 1;
    const auto cellNumber = [&](const Texel& texel) {
        const ivec3 cell = cellOf(texel.place);
        return (std::size_t(cell.z) * std::size_t(cells_.y) + std::size_t(cell.y)) * std::size_t(cells_.x) +
               std::size_t(cell.x);
    };
    starts_.assign(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z) + 1, 0);
    for (const Texel& texel : texels_)
        ++starts_[cellNumber(texel) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i)
        starts_[i] += starts_[i - 1];
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    std::vector<Texel> sorted(texels_.size());
    for (const Texel& texel : texels_)
        sorted[next[cellNumber(texel)]++] = texel;
    texels_ = std::move(sorted);
}

Result<std::shared_ptr<const PaintSurface>> paintSurfaceOf(const Object& object, int side) {
    const auto atlas = atlasOf(object, side);
    if (!atlas) return atlas.error();
    return object.kept.of<PaintSurfaceMaking::Made>(*atlas, [&] {
        PaintSurfaceMaking making(*atlas);
        std::optional<PaintSurfaceMaking::Made> made;
        while (!made)
            made = making.advance();
        return *made;
    });
}

Canvas::Canvas(std::shared_ptr<const PaintSurface> surface, float scale,
               std::shared_ptr<const Image> entering, std::shared_ptr<const Image> leaving,
               std::size_t budget, std::optional<float> start)
    : surface_(std::move(surface)), scale_(scale), budget_(budget),
      start_(start), maps_{std::move(entering), std::move(leaving)} {
    const int side = surface_->side(), tiles = (side + kTile - 1) / kTile;
    for (auto& map : maps_)
        if (!map) map = unpaintedMap(side);
    coverage_.assign(std::size_t(side) * std::size_t(side), 0);
    tileNumbers_.assign(std::size_t(tiles) * std::size_t(tiles), -1);
    checkpoints_[0] = maps_;
}

void Canvas::begin(const Brush& brush) {
    end();
    open_ = true;
    brush_ = brush;
    stroke_ = {brush, {}, {}};
    step_ = {mapOf(brush.map), {}};
    filled_ = 0;
}

void Canvas::dab(const Dab& dab) {
    stroke_.dabs.push_back(dab);
    const float radius = brush_.radius * dab.pressure / scale_;
    touch(dab.place, dab.normal, radius);
    if (brush_.symmetric) touch(dab.place * kMirror, dab.normal * kMirror, radius);
}

void Canvas::end() {
    if (!std::exchange(open_, false)) return;
    strokes_.resize(done_);
    checkpoints_.erase(checkpoints_.upper_bound(done_), checkpoints_.end());
    strokes_.push_back(std::move(stroke_));
    close();
}

void Canvas::add(const Stroke& stroke) {
    end();
    while (!addSome(stroke)) {
    }
}

bool Canvas::addSome(const Stroke& stroke) {
    if (!open_) {
        begin(stroke.brush);
        for (const Dab& one : stroke.dabs)
            dab(one);
    }
    if (stroke.fill && !fillSome(*stroke.fill)) return false;
    end();
    return true;
}

// Paints the stroke that stands at done_ in the list.
void Canvas::apply(const Stroke& stroke) {
    begin(stroke.brush);
    for (const Dab& one : stroke.dabs)
        dab(one);
    while (stroke.fill && !fillSome(*stroke.fill)) {
    }
    open_ = false;
    close();
}

// Keeps what the stroke changed, as far as there is room.
void Canvas::close() {
    for (const Tile& tile : step_.tiles)
        tileNumbers_[std::size_t(tile.number)] = -1;
    std::fill(coverage_.begin(), coverage_.end(), 0.0f);
    stepBytes_ += step_.bytes();
    steps_.push_back(std::move(step_));
    step_ = {};
    ++done_;
    while (stepBytes_ > budget_ / 2) {
        stepBytes_ -= steps_.front().bytes();
        steps_.pop_front();
    }
    if (done_ % interval_ == 0 && budget_ > 0) {
        checkpoints_[done_] = maps_;
        own_ = {};
    }
    while (checkpointBytes() > budget_ / 2) { // they become rarer and rarer
        interval_ *= 2;
        std::erase_if(checkpoints_, [&](const auto& one) { return one.first % interval_ != 0; });
    }
}

std::size_t Canvas::checkpointBytes() const {
    const std::size_t each = 2 * maps_[0]->pixels.size() * sizeof(float);
    return (checkpoints_.size() - 1) * each; // the first one is what there is anyway
}

std::size_t Canvas::bytes() const { return stepBytes_ + checkpointBytes(); }

bool Canvas::undo() {
    end();
    if (done_ == 0) return false;
    if (steps_.empty()) {
        replay(done_ - 1);
        return true;
    }
    restore(steps_.back());
    stepBytes_ -= steps_.back().bytes();
    steps_.pop_back();
    --done_;
    return true;
}

bool Canvas::redo() {
    end();
    if (done_ == strokes_.size()) return false;
    apply(Stroke(strokes_[done_]));
    return true;
}

void Canvas::restore(const Step& step) {
    Image& map = writable(step.map);
    const int side = surface_->side(), across = (side + kTile - 1) / kTile;
    for (const Tile& tile : step.tiles) {
        const ivec2 first(tile.number % across * kTile, tile.number / across * kTile);
        for (int y = first.y; y < std::min(first.y + kTile, side); ++y)
            for (int x = first.x; x < std::min(first.x + kTile, side); ++x) {
                const auto number = std::uint32_t(y * side + x);
                setTexel(map, number, tile.before[inTile(number)]);
            }
    }
}

// The state after so many strokes, from the nearest one before that was kept.
void Canvas::replay(std::size_t count) {
    const auto from = std::prev(checkpoints_.upper_bound(count));
    maps_ = from->second;
    own_ = {};
    done_ = from->first;
    steps_.clear();
    stepBytes_ = 0;
    while (done_ < count)
        apply(Stroke(strokes_[done_]));
}

void Canvas::touch(vec3 centre, vec3 normal, float radius) {
    if (!(radius > 0)) return;
    surface_->forEachNear(centre, radius, [&](const PaintSurface::Texel& texel) {
        const float away = glm::length(texel.place - centre);
        if (away < radius && glm::dot(texel.normal, normal) > 0)
            cover(texel.number, falloff(away / radius, brush_.hardness));
    });
}

// Goes on with so many texels. @return whether all are done
bool Canvas::fillSome(const Stroke::Fill& fill) {
    constexpr std::size_t kTexels = 1 << 16;
    stroke_.fill = fill;
    const auto isIn = [&](const vec3& p) {
        return glm::all(glm::greaterThanEqual(p, fill.low)) && glm::all(glm::lessThanEqual(p, fill.high));
    };
    const auto cover = [&](std::uint32_t texel, const vec3& p) {
        if (isIn(p)) this->cover(texel, fill.veins > 0 ? veinAt(p * (scale_ / fill.veins)) : 1);
    };
    const std::vector<PaintSurface::Texel>& texels = surface_->texels();
    for (const std::size_t end = std::min(texels.size(), filled_ + kTexels); filled_ < end; ++filled_) {
        const PaintSurface::Texel& texel = texels[filled_];
        cover(texel.number, texel.place);
        if (brush_.symmetric) cover(texel.number, texel.place * kMirror);
    }
    return filled_ == texels.size();
}

// What a texel becomes depends on its largest coverage alone.
void Canvas::cover(std::uint32_t texel, float coverage) {
    if (coverage <= coverage_[texel]) return;
    const Tile& tile = tileOf(texel);
    coverage_[texel] = coverage;
    setTexel(writable(step_.map), texel, blended(tile.before[inTile(texel)], brush_.strength * coverage));
}

// What the open stroke aims at.
vec3 Canvas::target() const {
    if (!brush_.erase) return brush_.value;
    return vec3(brush_.map == PaintMap::Translucency ? start_.value_or(startOf(strokes())) : kUnpainted.x);
}

vec4 Canvas::blended(const vec4& before, float share) const {
    vec3 target = this->target();
    vec4 after = before;
    // At the whole share the value itself, to the bit.
    const auto mixed = [&](float from, float to) { return share >= 1 ? to : from + (to - from) * share; };
    switch (brush_.map) {
    case PaintMap::Translucency:
        after.a = mixed(before.a, target.x);
        break;
    case PaintMap::Blur:
        target.x = 1 / target.x;
        after.a = share >= 1 ? target.x
                             : glm::clamp(std::exp(mixed(std::log(before.a), std::log(target.x))),
                                          kLeastSharpness, kMostSharpness);
        break;
    case PaintMap::Glow:
    case PaintMap::Outgoing:
        for (int i = 0; i < 3; ++i)
            after[i] = mixed(before[i], target[i]);
        break;
    }
    return after;
}

Image& Canvas::writable(int map) {
    const auto m = std::size_t(map);
    if (!own_[m]) {
        auto copy = std::make_shared<Image>(*maps_[m]);
        own_[m] = copy.get();
        maps_[m] = std::move(copy);
    }
    return *own_[m];
}

Canvas::Tile& Canvas::tileOf(std::uint32_t texel) {
    const int side = surface_->side(), across = (side + kTile - 1) / kTile;
    const ivec2 at(int(texel) % side, int(texel) / side);
    int& number = tileNumbers_[std::size_t(at.y / kTile * across + at.x / kTile)];
    if (number >= 0) return step_.tiles[std::size_t(number)];
    number = int(step_.tiles.size());
    Tile& tile = step_.tiles.emplace_back(
        Tile{at.y / kTile * across + at.x / kTile, std::vector<vec4>(kTile * kTile, vec4(0))});
    const ivec2 first = at / kTile * kTile, end = glm::min(first + kTile, ivec2(side));
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            const auto one = std::uint32_t(y * side + x);
            tile.before[inTile(one)] = texelAt(*maps_[std::size_t(step_.map)], one);
        }
    return tile;
}

std::size_t Canvas::inTile(std::uint32_t texel) const {
    const auto side = std::uint32_t(surface_->side());
    return std::size_t(texel / side % kTile * kTile + texel % side % kTile);
}

} // namespace lucent::scene
