#include "techniques/throughput/Surface.h"

#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace lucent::throughput {

namespace {

using Corners = std::array<dvec2, 3>;

constexpr double kChartCosine = 0.8660254037844387; // 30 degrees, as the paper has it

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }
double areaOf(const Corners& t) { return 0.5 * std::abs(cross(t[1] - t[0], t[2] - t[0])); }

// Of a triangle that has an area.
dvec3 weightsAt(const Corners& t, const dvec2& p) {
    const double whole = cross(t[1] - t[0], t[2] - t[0]);
    const double second = cross(p - t[0], t[2] - t[0]) / whole, third = cross(t[1] - t[0], p - t[0]) / whole;
    return {1 - second - third, second, third};
}

// A convex shape of few corners.
struct Polygon {
    std::array<dvec2, 8> corners;
    int count = 0;
    void add(const dvec2& p) { corners[std::size_t(count++)] = p; }

    // What of it has sign * (p[axis] - at) >= 0 (Sutherland, Hodgman 1974).
    Polygon cut(int axis, double at, double sign) const {
        Polygon rest;
        for (int i = 0; i < count; ++i) {
            const dvec2 &a = corners[std::size_t(i)], &b = corners[std::size_t((i + 1) % count)];
            const double from = sign * (a[axis] - at), to = sign * (b[axis] - at);
            if (from >= 0) rest.add(a);
            if ((from < 0) != (to < 0)) rest.add(a + (b - a) * (from / (from - to)));
        }
        return rest;
    }
    // Area and centroid.
    std::pair<double, dvec2> measure() const {
        double twice = 0;
        dvec2 moment(0);
        for (int i = 1; i + 1 < count; ++i) {
            const dvec2 &a = corners[0], &b = corners[std::size_t(i)], &c = corners[std::size_t(i + 1)];
            const double part = cross(b - a, c - a);
            twice += part;
            moment += part * (a + b + c) / 3.0;
        }
        return {std::abs(twice) / 2, twice != 0 ? moment / twice : corners[0]};
    }
};

Polygon inTexel(const Corners& t, ivec2 at) {
    Polygon polygon;
    for (const dvec2& corner : t)
        polygon.add(corner);
    for (int axis = 0; axis < 2 && polygon.count > 0; ++axis) {
        polygon = polygon.cut(axis, at[axis], 1);
        if (polygon.count > 0) polygon = polygon.cut(axis, at[axis] + 1, -1);
    }
    return polygon;
}

// Lays the surface out in texels.
class Paver {
public:
    /// @param scale  of the atlas, texels a metre
    Paver(Surface& surface, std::shared_ptr<const scene::Atlas> atlas, double scale, int border)
        : surface_(surface), hats_(surface.hats), texels_(surface.texels), duals_(surface.duals),
          atlas_(std::move(atlas)), scale_(scale), border_(border) {
        const std::size_t side = std::size_t(atlas_->side);
        texels_.side = atlas_->side;
        texels_.size = float(1 / scale_);
        texels_.indexAt.assign(side * side, -1);
        shares_.resize(hats_.count());
    }

    void add(Stages& stages) {
        stages.inOrder(0, hats_.triangles.size(), [this](std::size_t t) { cutUp(std::uint32_t(t)); });
        stages.then([this, &stages]() -> Status {
            const std::size_t own = texels_.list.size();
            stages.inOrder(0, own, [this](std::size_t i) { findMiddle(i); });
            stages.inOrder(0, own, [this](std::size_t i) { reachAround(i); });
            return Done{};
        });
        stages.then([this, &stages]() -> Status {
            around_ = {nearest_.begin(), nearest_.end()};
            stages.inOrder(0, around_.size(), [this](std::size_t k) { addAround(k); });
            return Done{};
        });
        stages.then([this, &stages]() -> Status {
            stages.inOrder(0, texels_.list.size(),
                           [this](std::size_t i) { texels_.list[i].isShown = isShown(texels_.list[i]); });
            stages.inOrder(0, shares_.size(), [this](std::size_t v) { joinShares(v); });
            return Done{};
        });
    }

private:
    // Where a texel's own surface is known to lie, which walks begin at.
    struct Start {
        std::uint32_t triangle = 0;
        dvec2 place{0};
        double area = -1;
        bool hasMiddle = false;
    };

    Corners cornersOf(std::uint32_t t) const {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = dvec2(atlas_->places[atlas_->mesh->indices[3 * hats_.sources[t] + i]]);
        return corners;
    }

    std::size_t texelAt(ivec2 at) {
        std::int32_t& index =
            texels_.indexAt[std::size_t(at.y) * std::size_t(texels_.side) + std::size_t(at.x)];
        if (index < 0) {
            index = std::int32_t(texels_.list.size());
            texels_.list.push_back({.at = at, .place = {}});
            starts_.emplace_back();
        }
        return std::size_t(index);
    }

    ivec2 inside(ivec2 at) const { return glm::clamp(at, ivec2(0), ivec2(texels_.side - 1)); }

    // Gives each texel its part of a triangle.
    void cutUp(std::uint32_t t) {
        const Corners corners = cornersOf(t);
        surface_.places.push_back({vec2(corners[0]), vec2(corners[1]), vec2(corners[2])});
        const double flat = areaOf(corners);
        const dvec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        if (!(flat > 1e-9)) { // smaller than what the places' floats can tell
            give(t, texelAt(inside(ivec2(glm::floor(middle)))), hats_.triangleAreas[t], middle,
                 dvec3(1.0 / 3));
            return;
        }
        const dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]),
                    high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
        const ivec2 first = inside(ivec2(glm::floor(low))), last = inside(ivec2(glm::floor(high)));
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const Polygon part = inTexel(corners, {x, y});
                if (part.count < 3) continue;
                const auto [area, centre] = part.measure();
                if (!(area > 0)) continue;
                const std::size_t texel = texelAt({x, y});
                give(t, texel, hats_.triangleAreas[t] * area / flat, centre, weightsAt(corners, centre));
                const dvec3 weights = weightsAt(corners, dvec2(x, y) + 0.5);
                if (std::min({weights.x, weights.y, weights.z}) >= 0 && !starts_[texel].hasMiddle) {
                    setPlace(texel, t, weights, corners);
                    starts_[texel].hasMiddle = true;
                }
            }
    }

    // @param weights  of the part's centre: their products with its area are the hats' integrals
    void give(std::uint32_t t, std::size_t texel, double area, const dvec2& centre, const dvec3& weights) {
        texels_.list[texel].own += float(area);
        Start& start = starts_[texel];
        if (area > start.area) {
            start.triangle = t;
            start.place = centre;
            start.area = area;
        }
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t v = hats_.triangles[t][std::size_t(i)];
            shares_[v][std::uint32_t(texel)] += area * 3 / hats_.areas[v] * (4 * weights[i] - 1);
        }
    }

    void setPlace(std::size_t texel, std::uint32_t t, const dvec3& weights, const Corners& corners) {
        texels_.list[texel].place = {t, vec3(weights)};
        const double flat = areaOf(corners);
        texels_.list[texel].area = flat > 0 ? float(hats_.triangleAreas[t] / flat) : 0;
    }

    // Follows a straight line over the surface, unfolded into the atlas.
    bool walk(std::size_t texel, const Start& from, const dvec2& to) {
        constexpr int kMostSteps = 256;
        std::uint32_t t = from.triangle;
        Corners corners = cornersOf(t);
        for (int step = 0; step < kMostSteps && areaOf(corners) > 1e-12; ++step) {
            const dvec3 begin = weightsAt(corners, from.place), end = weightsAt(corners, to);
            // The first side that the line leaves by; sides are opposite to the corners.
            int out = -1;
            double least = std::numeric_limits<double>::infinity();
            for (int i = 0; i < 3; ++i)
                if (end[i] < -1e-9 && end[i] < begin[i]) {
                    const double way = begin[i] / (begin[i] - end[i]);
                    if (way < least) {
                        least = way;
                        out = i;
                    }
                }
            if (out < 0) {
                setPlace(texel, t, end, corners);
                return true;
            }
            if (!goAcross(t, corners, (out + 1) % 3)) return false;
        }
        return false;
    }

    // Goes on to the triangle across a side. @return false: there is none
    bool goAcross(std::uint32_t& t, Corners& corners, int side) const {
        const std::uint32_t next = hats_.across[t][std::size_t(side)];
        if (next == Hats::kNone) return false;
        const auto here = [&](int i) { return std::size_t((side + i) % 3); };
        const std::uint32_t a = hats_.triangles[t][here(0)], b = hats_.triangles[t][here(1)];
        const dvec2 atA = corners[here(0)], atB = corners[here(1)], atRest = corners[here(2)];
        std::size_t second = 0; // in the next triangle the side goes from b to a
        while (hats_.triangles[next][second] != b)
            ++second;
        const Corners flat = cornersOf(next);
        const std::size_t first = (second + 1) % 3, third = (second + 2) % 3;
        Corners unfolded;
        unfolded[second] = atB;
        unfolded[first] = atA;
        if (glm::length(flat[second] - atB) < 1e-3 && glm::length(flat[first] - atA) < 1e-3) {
            unfolded[third] = flat[third]; // of the same chart
        } else {
            const dvec3 p = dvec3(hats_.positions[a]), edge = dvec3(hats_.positions[b]) - p,
                        rest = dvec3(hats_.positions[hats_.triangles[next][third]]) - p;
            const double along = glm::dot(rest, edge) / glm::dot(edge, edge);
            const double away = glm::length(rest - along * edge) * scale_;
            const dvec2 way = atB - atA;
            const double length = glm::length(way);
            if (!(length > 0)) return false;
            dvec2 outward = dvec2(way.y, -way.x) / length;
            if (glm::dot(outward, atRest - atA) > 0) outward = -outward;
            unfolded[third] = atA + along * way + away * outward;
        }
        t = next;
        corners = unfolded;
        return true;
    }

    // The middle of a texel, where it lies beside the texel's own surface.
    void findMiddle(std::size_t i) {
        const Start& start = starts_[i];
        if (start.hasMiddle) return;
        if (walk(i, start, dvec2(texels_.list[i].at) + 0.5)) return;
        // Past an open edge: the middle of what there is stands for it.
        const Corners corners = cornersOf(start.triangle);
        const bool isFlat = !(areaOf(corners) > 1e-12);
        setPlace(i, start.triangle, isFlat ? dvec3(1.0 / 3) : weightsAt(corners, start.place), corners);
        texels_.list[i].area = texels_.list[i].own;
    }

    // Offers a texel with some of the chart to places of the border.
    void reachAround(std::size_t i) {
        for (int y = -border_; y <= border_; ++y)
            for (int x = -border_; x <= border_; ++x) {
                const ivec2 at = texels_.list[i].at + ivec2(x, y);
                if (at != inside(at) || texels_.find(at) >= 0) continue;
                const double away = glm::length(dvec2(at) + 0.5 - starts_[i].place);
                auto [found, isNew] = nearest_.try_emplace({at.y, at.x}, away, i);
                if (!isNew && away < found->second.first) found->second = {away, i};
            }
    }

    // Goes on from there.
    void addAround(std::size_t k) {
        const auto& [at, from] = around_[k];
        const ivec2 place(at.second, at.first);
        const Start start = starts_[from.second];
        const std::size_t texel = texelAt(place);
        if (walk(texel, start, dvec2(place) + 0.5)) return;
        texels_.list.pop_back(); // nothing goes on there
        starts_.pop_back();
        texels_.indexAt[std::size_t(place.y) * std::size_t(texels_.side) + std::size_t(place.x)] = -1;
    }

    bool isShown(const Texel& texel) const {
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const int beside = texels_.find(texel.at + ivec2(x, y));
                if (beside >= 0 && texels_.list[std::size_t(beside)].own > 0) return true;
            }
        return false;
    }

    void joinShares(std::size_t vertex) {
        for (const auto& [texel, share] : shares_[vertex]) {
            duals_.columns.push_back(texel);
            duals_.values.push_back(float(share));
        }
        duals_.starts.push_back(std::uint32_t(duals_.columns.size()));
    }

    Surface& surface_;
    const Hats& hats_;
    Texels& texels_;
    Rows<float>& duals_;
    std::shared_ptr<const scene::Atlas> atlas_;
    double scale_;
    int border_;
    std::vector<Start> starts_; // one a texel
    std::vector<std::map<std::uint32_t, double>> shares_;
    // Places of the border, and for each the nearest texel with some of the chart and how far that is.
    using Around = std::map<std::pair<int, int>, std::pair<double, std::size_t>>;
    Around nearest_;
    std::vector<Around::value_type> around_; // the same
};

// Finds the triangles across sides that exactly two share.
void join(Hats& hats) {
    struct Side {
        std::uint32_t triangle, number;
        int count = 0;
        std::uint32_t otherTriangle = 0, otherNumber = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Side> sides;
    hats.across.assign(hats.triangles.size(), {Hats::kNone, Hats::kNone, Hats::kNone});
    for (std::uint32_t t = 0; t < hats.triangles.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = hats.triangles[t][i], b = hats.triangles[t][(i + 1) % 3];
            Side& side = sides[std::minmax(a, b)];
            if (side.count++ == 0) {
                side.triangle = t;
                side.number = i;
            } else {
                side.otherTriangle = t;
                side.otherNumber = i;
            }
        }
    for (const auto& [ends, side] : sides) {
        const bool opposite =
            side.count == 2 && hats.triangles[side.triangle][side.number] ==
                                   hats.triangles[side.otherTriangle][(side.otherNumber + 1) % 3];
        if (!opposite) continue;
        hats.across[side.triangle][side.number] = side.otherTriangle;
        hats.across[side.otherTriangle][side.otherNumber] = side.triangle;
    }
}

} // namespace

double Hats::area() const { return std::accumulate(triangleAreas.begin(), triangleAreas.end(), 0.0); }

double Hats::spacing() const {
    // A vertex of equal triangles of side s has the area sqrt(3) / 2 s².
    return std::sqrt(2 / std::sqrt(3.0) * area() / double(count()));
}

double Hats::longestSide() const {
    float longest = 0;
    for (const auto& [a, b, c] : triangles)
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            longest = std::max(longest, glm::distance(positions[from], positions[to]));
    return double(longest);
}

Hats hatsOf(const scene::Mesh& mesh, float scale) {
    const std::vector<std::uint32_t> welded = scene::weldedVertices(mesh.positions);
    const std::vector<vec3> own =
        mesh.normals.empty() ? scene::areaWeightedNormals(mesh.positions, mesh.indices) : mesh.normals;
    Hats hats;
    std::vector<std::uint32_t> number(mesh.positions.size(), Hats::kNone);
    std::vector<dvec3> normals;
    for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
        std::array<std::uint32_t, 3> corners;
        std::array<dvec3, 3> places;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = mesh.indices[3 * t + i];
            places[i] = double(scale) * dvec3(mesh.positions[corners[i]]);
        }
        const dvec3 u = places[1] - places[0], v = places[2] - places[0], across = glm::cross(u, v);
        const double area = glm::length(across) / 2;
        if (!(2 * area > 1e-14 * std::max(glm::dot(u, u), glm::dot(v, v)))) continue; // rounding
        std::array<std::uint32_t, 3> vertices;
        for (std::size_t i = 0; i < 3; ++i) {
            std::uint32_t& vertex = number[welded[corners[i]]];
            if (vertex == Hats::kNone) {
                vertex = std::uint32_t(hats.positions.size());
                hats.positions.push_back(vec3(places[i]));
                hats.areas.push_back(0);
                normals.emplace_back(0);
            }
            vertices[i] = vertex;
            hats.areas[vertex] += area;
            normals[vertex] += area * dvec3(own[corners[i]]);
        }
        hats.triangles.push_back(vertices);
        hats.triangleAreas.push_back(area);
        hats.sources.push_back(t);
    }
    for (const dvec3& normal : normals) {
        const double length = glm::length(normal);
        hats.normals.push_back(length > 0 ? vec3(normal / length) : vec3(0, 1, 0));
    }
    join(hats);
    return hats;
}

vec3 positionAt(const Hats& hats, const Place& place) {
    vec3 sum(0);
    for (int i = 0; i < 3; ++i)
        sum += place.weights[i] * hats.positions[hats.triangles[place.triangle][std::size_t(i)]];
    return sum;
}

vec3 normalAt(const Hats& hats, const Place& place) {
    vec3 sum(0);
    for (int i = 0; i < 3; ++i)
        sum += place.weights[i] * hats.normals[hats.triangles[place.triangle][std::size_t(i)]];
    const float length = glm::length(sum);
    return length > 0 ? sum / length : hats.normals[hats.triangles[place.triangle][0]];
}

namespace {

// Lays one mesh out.
class Laying : public std::enable_shared_from_this<Laying> {
public:
    Laying(std::shared_ptr<const scene::Mesh> mesh, float scale, const scene::Charting& charting,
           std::function<Status(Result<Surface>)> taken)
        : mesh_(std::move(mesh)), scale_(scale), charting_(charting), taken_(std::move(taken)) {}

    Status begin(Stages& stages) {
        surface_.hats = hatsOf(*mesh_, scale_);
        if (surface_.hats.triangles.empty())
            return taken_(Error{"the mesh has no triangle with an area; must have one"});
        making_.emplace(mesh_, charting_);
        advance(stages);
        return Done{};
    }

private:
    // The atlas, piece by piece, and the texels in it. Stages keep this as long as there are any.
    void advance(Stages& stages) {
        stages.then([self = shared_from_this(), &stages]() -> Status {
            const std::optional<scene::AtlasMaking::Made> atlas = self->making_->advance();
            if (!atlas) {
                self->advance(stages);
                return Done{};
            }
            if (!*atlas) return self->taken_(atlas->error());
            self->paver_.emplace(self->surface_, **atlas, (**atlas)->scale / double(self->scale_),
                                 self->charting_.border);
            self->paver_->add(stages);
            stages.then([self]() -> Status { return self->taken_(std::move(self->surface_)); });
            return Done{};
        });
    }

    std::shared_ptr<const scene::Mesh> mesh_;
    float scale_;
    scene::Charting charting_;
    std::function<Status(Result<Surface>)> taken_;
    Surface surface_;
    std::optional<scene::AtlasMaking> making_;
    std::optional<Paver> paver_;
};

} // namespace

void addSurface(Stages& stages, std::shared_ptr<const scene::Mesh> mesh, float scale, int side, int border,
                std::function<Status(Result<Surface>)> taken) {
    const scene::Charting charting{.side = side, .cosine = kChartCosine, .border = border, .fitted = true};
    const auto laying = std::make_shared<Laying>(std::move(mesh), scale, charting, std::move(taken));
    stages.then([laying, &stages] { return laying->begin(stages); });
}

} // namespace lucent::throughput
