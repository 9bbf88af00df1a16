#include "scene/Atlas.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace lucent::scene {
namespace {

using Corners = std::array<dvec2, 3>;

constexpr int kNone = -1;

// Unless charts are fitted, one looks along one of the six axes of its mesh. Every normal has one within 54.7
// degrees, so that charts may take all within 60: lengths shrink to a half at most.

// Overlaps are looked for while charts grow at the scale at which the whole mesh, all of it as steep as may
// be, fills a picture of this side. What is closer together is found when all charts have their places.
constexpr int kMaskSide = 512;

// No chart is longer, in sides of the mask, for the longest one bounds the scale of all.
constexpr double kLongest = 4;

// Between two places over one texel of the mask a surface as steep as that rises by sqrt(2) tan(60°) = 2.45.
constexpr double kSameLayer = 3; // texels

struct Axis {
    dvec3 out, right, down; // as one sees it from outside
};
constexpr Axis kAxes[] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                          {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                          {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};

// Looks along a unit normal.
Axis axisAlong(const dvec3& out) {
    const dvec3 aside = std::abs(out.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 right = glm::normalize(glm::cross(aside, out));
    return {out, right, -glm::cross(out, right)};
}

dvec2 flattened(const Axis& axis, const dvec3& place) {
    return {glm::dot(place, axis.right), glm::dot(place, axis.down)};
}

// Twice the signed area of (a, b, p), computed in one order of a and b for both triangles at an edge.
double edge(const dvec2& a, const dvec2& b, const dvec2& p) {
    const bool swap = b.x < a.x || (b.x == a.x && b.y < a.y);
    const dvec2 &from = swap ? b : a, &to = swap ? a : b;
    const double area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return swap ? -area : area;
}

// What of the triangle has this y, from left to right.
std::optional<dvec2> spanAt(const Corners& t, double y) {
    dvec2 span(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec2 &a = t[i], &b = t[(i + 1) % 3];
        if (y < std::min(a.y, b.y) || y > std::max(a.y, b.y) || a.y == b.y) continue;
        const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
        span = {std::min(span.x, x), std::max(span.y, x)};
    }
    if (span.x > span.y) return std::nullopt;
    return span;
}

// Calls `found(x, y)` for each texel whose middle lies inside, not on an edge, until it returns false.
template <class Found>
bool forEachMiddle(const Corners& t, Found found) {
    const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto last = std::int64_t(std::floor(bottom - 0.5));
    for (auto y = std::int64_t(std::ceil(top - 0.5)); y <= last; ++y) {
        const std::optional<dvec2> span = spanAt(t, double(y) + 0.5);
        if (!span) continue;
        const auto right = std::int64_t(std::floor(span->y)) + 1;
        for (auto x = std::int64_t(std::floor(span->x)) - 1; x <= right; ++x) {
            const dvec2 p(double(x) + 0.5, double(y) + 0.5);
            const double a = edge(t[0], t[1], p), b = edge(t[1], t[2], p), c = edge(t[2], t[0], p);
            const bool inside = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
            if (inside && !found(x, y)) return false;
        }
    }
    return true;
}

// Texels of a plane without end, of which few are used: in tiles, since neighbours are asked for one after
// another.
template <class Texel>
class Texels {
public:
    // Null where nothing was made.
    Texel* find(std::int64_t x, std::int64_t y) {
        Tile* tile = tileAt(x, y, false);
        return tile && tile->isMade[placeIn(x, y)] ? &tile->texels[placeIn(x, y)] : nullptr;
    }
    Texel& findOrMake(std::int64_t x, std::int64_t y, const Texel& made) {
        Tile& tile = *tileAt(x, y, true);
        const std::size_t place = placeIn(x, y);
        if (!tile.isMade[place]) tile.texels[place] = made;
        tile.isMade[place] = true;
        return tile.texels[place];
    }

private:
    static constexpr int kBits = 4; // of a side
    static constexpr std::size_t kInTile = std::size_t(1) << 2 * kBits;
    struct Tile {
        std::array<Texel, kInTile> texels;
        std::bitset<kInTile> isMade;
    };
    static std::size_t placeIn(std::int64_t x, std::int64_t y) {
        constexpr std::int64_t kInside = (1 << kBits) - 1;
        return std::size_t((y & kInside) << kBits | (x & kInside));
    }
    Tile* tileAt(std::int64_t x, std::int64_t y, bool makes) {
        const std::uint64_t key = std::uint64_t(std::uint32_t(x >> kBits)) << 32 | std::uint32_t(y >> kBits);
        if (last_ && key == lastKey_) return last_;
        const auto found = tiles_.find(key);
        if (found == tiles_.end() && !makes) return nullptr;
        lastKey_ = key;
        return last_ = found != tiles_.end() ? found->second.get()
                                             : (tiles_[key] = std::make_unique<Tile>()).get();
    }
    std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
    Tile* last_ = nullptr;
    std::uint64_t lastKey_ = 0;
};

// Where a growing chart lies already, so that no second layer of it comes to lie there.
class Mask {
public:
    // Takes the triangle in, unless it meets another layer.
    bool take(const Corners& corners, const dvec3& heights) {
        const dvec3 slope = slopeOf(corners, heights);
        const auto heightAt = [&](std::int64_t x, std::int64_t y) {
            return slope.x * (double(x) + 0.5) + slope.y * (double(y) + 0.5) + slope.z;
        };
        bool free = forEachMiddle(corners, [&](std::int64_t x, std::int64_t y) {
            const Texel* found = texels_.find(x, y);
            return !found || (!found->covered && isNear(*found, heightAt(x, y)));
        });
        for (int i = 0; i < 3 && free; ++i) {
            const Texel* found = texels_.find(columnOf(corners, i), rowOf(corners, i));
            free = !found || isNear(*found, heights[i]);
        }
        if (!free) return false;
        for (int i = 0; i < 3; ++i)
            texels_.findOrMake(columnOf(corners, i), rowOf(corners, i), {heights[i]});
        forEachMiddle(corners, [&](std::int64_t x, std::int64_t y) {
            texels_.findOrMake(x, y, {heightAt(x, y)}).covered = true;
            return true;
        });
        return true;
    }

private:
    struct Texel {
        double height = 0;
        bool covered = false; // its middle
    };
    static std::int64_t columnOf(const Corners& t, int corner) {
        return std::int64_t(std::floor(t[std::size_t(corner)].x));
    }
    static std::int64_t rowOf(const Corners& t, int corner) {
        return std::int64_t(std::floor(t[std::size_t(corner)].y));
    }
    static bool isNear(const Texel& texel, double height) {
        return std::abs(texel.height - height) <= kSameLayer;
    }
    // Height as a x + b y + c.
    static dvec3 slopeOf(const Corners& t, const dvec3& heights) {
        const dvec2 u = t[1] - t[0], v = t[2] - t[0];
        const double det = u.x * v.y - u.y * v.x, h = heights[1] - heights[0], k = heights[2] - heights[0];
        if (det == 0) return {0, 0, heights[0]};
        const dvec2 slope((h * v.y - k * u.y) / det, (k * u.x - h * v.x) / det);
        return {slope, heights[0] - glm::dot(slope, t[0])};
    }
    Texels<Texel> texels_;
};

struct Box {
    dvec2 low{std::numeric_limits<double>::infinity()}, high{-low};
    void add(const dvec2& place) {
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    dvec2 size() const { return high.x < low.x ? dvec2(0) : high - low; }
};

// Triangles that are seen along one axis, or, without one, that have no area and no neighbour.
struct Chart {
    std::optional<Axis> axis;
    Box box; // flattened, m
};

// The corners of the convex shape around some places, counter-clockwise (Andrew's monotone chain).
std::vector<dvec2> hullOf(std::vector<dvec2> places) {
    std::sort(places.begin(), places.end(),
              [](const dvec2& a, const dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<dvec2> hull;
    const auto add = [&](const dvec2& p, std::size_t keep) {
        while (hull.size() > keep && edge(hull[hull.size() - 2], hull.back(), p) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const dvec2& p : places)
        add(p, 1);
    const std::size_t lower = hull.size();
    for (auto p = places.rbegin(); p != places.rend(); ++p)
        add(*p, lower);
    return hull;
}

// The way along which the box around some places is smallest: one side of it lies along the hull (the
// paper's rotating calipers find the same).
dvec2 smallestBoxAlong(const std::vector<dvec2>& places) {
    const std::vector<dvec2> hull = hullOf(places);
    dvec2 best(1, 0);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < hull.size(); ++i) {
        const dvec2 way = hull[i + 1] - hull[i];
        const double length = glm::length(way);
        if (!(length > 0)) continue;
        const dvec2 along = way / length;
        Box box;
        for (const dvec2& p : hull)
            box.add({glm::dot(p, along), along.x * p.y - along.y * p.x});
        const double area = box.size().x * box.size().y;
        if (area < least) {
            least = area;
            best = along;
        }
    }
    return best;
}

// Parts a mesh into charts and lays them out.
class Layout {
public:
    Layout(const Mesh& mesh, const Charting& charting)
        : mesh_(mesh), charting_(charting), side_(charting.side), count_(mesh.indices.size() / 3),
          chartOf_(count_, kNone) {}

    // Works until every triangle has a place; Error when there is no room. @return whether all have one
    Result<bool> advance() {
        if (!isMeasured_) {
            measure();
            isMeasured_ = true;
            return false;
        }
        if (!isJoined_) {
            join();
            isJoined_ = true;
            return false;
        }
        if (!grows()) return false;
        if (!isPacked_) {
            if (Status packed = pack(); !packed) return packed.error();
            covered_.assign(std::size_t(side_) * std::size_t(side_), false);
            hidden_.clear();
            covering_ = 0;
            isPacked_ = true;
            return false;
        }
        if (!covers()) return false;
        for (const std::size_t t : hidden_)
            chartOf_[t] = kNone;
        seed_ = 0; // more charts each time: it ends when every triangle is one, at the latest
        isPacked_ = false;
        return hidden_.empty();
    }

    double scale() const { return scale_; }
    int chartOf(std::size_t triangle) const { return chartOf_[triangle]; }
    vec2 placeOf(std::uint32_t vertex, int chart) const {
        const Chart& in = charts_[std::size_t(chart)];
        const dvec2 inside = in.axis ? flattened(*in.axis, position(vertex)) - in.box.low : dvec2(0);
        return vec2(dvec2(offsets_[std::size_t(chart)] + charting_.border) + inside * scale_);
    }

private:
    dvec3 position(std::uint32_t vertex) const { return dvec3(mesh_.positions[vertex]); }
    std::uint32_t corner(std::size_t triangle, std::size_t which) const {
        return mesh_.indices[3 * triangle + which];
    }

    // Normals, and the scale of masks.
    void measure() {
        double area = 0;
        for (std::size_t t = 0; t < count_; ++t) {
            const dvec3 a = position(corner(t, 0)), u = position(corner(t, 1)) - a,
                        v = position(corner(t, 2)) - a;
            const dvec3 across = glm::cross(u, v);
            const double longest = std::max(glm::dot(u, u), glm::dot(v, v)), twice = glm::length(across);
            const bool flat = !(twice > 1e-14 * longest); // rounding
            normals_.push_back(flat ? dvec3(0) : across / twice);
            areas_.push_back(twice / 2);
            area += twice / 2;
        }
        maskScale_ = area > 0 ? kMaskSide / std::sqrt(area * charting_.cosine) : 0;
    }

    // Finds the neighbours over edges that two triangles share the same way round.
    void join() {
        const std::vector<std::uint32_t> welded = weldedVertices(mesh_.positions);
        struct Side {
            std::uint32_t low, high;
            bool forward;
            std::size_t place; // 3 triangle + side
            auto order() const { return std::tie(low, high, place); }
        };
        std::vector<Side> sides;
        sides.reserve(3 * count_);
        for (std::size_t i = 0; i < 3 * count_; ++i) {
            const std::uint32_t a = welded[mesh_.indices[i]],
                                b = welded[mesh_.indices[i % 3 == 2 ? i - 2 : i + 1]];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b), a < b, i});
        }
        std::sort(sides.begin(), sides.end(),
                  [](const Side& a, const Side& b) { return a.order() < b.order(); });
        across_.assign(3 * count_, kNone);
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i;
            while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
                ++end;
            if (end == i + 2 && sides[i].forward != sides[i + 1].forward) {
                across_[sides[i].place] = int(sides[i + 1].place / 3);
                across_[sides[i + 1].place] = int(sides[i].place / 3);
            }
            i = end;
        }
    }

    // Puts triangles that are in no chart into new ones. @return whether all are in one
    bool grows() {
        std::size_t left = count_ / kPieces + 1;
        for (; seed_ < count_; ++seed_) {
            if (!growth_ && (chartOf_[seed_] != kNone || normals_[seed_] == dvec3(0))) continue;
            if (left == 0 || !growsFrom(seed_, left)) return false;
        }
        const auto first = std::find(chartOf_.begin(), chartOf_.end(), kNone);
        if (first == chartOf_.end()) return true;
        std::replace(first, chartOf_.end(), kNone, int(charts_.size()));
        charts_.push_back({});
        return true;
    }

    // A chart that grows.
    struct Growth {
        Growth(const Axis& axis, std::size_t seed) : chart{axis, {}}, waiting{seed} {}
        Chart chart;
        Mask mask{};
        std::vector<std::size_t> taken{};
        std::deque<std::size_t> waiting;
    };

    // Works on the chart of a triangle. @param left  how many triangles may be looked at, and then still may.
    // @return whether it is whole
    bool growsFrom(std::size_t seed, std::size_t& left) {
        if (charting_.fitted) {
            left -= std::min(left, fitFrom(seed));
            return true;
        }
        if (!growth_) {
            const auto facing = [&](const Axis& axis) { return glm::dot(axis.out, normals_[seed]); };
            const Axis* axis =
                std::max_element(std::begin(kAxes), std::end(kAxes),
                                 [&](const Axis& a, const Axis& b) { return facing(a) < facing(b); });
            growth_.emplace(*axis, seed);
        }
        if (!grow(*growth_, left)) return false;
        charts_.push_back(growth_->chart);
        growth_.reset();
        return true;
    }

    // First across the seed's own normal, then across the mean of what that took. @return how many triangles
    // its chart has
    std::size_t fitFrom(std::size_t seed) {
        Chart tried;
        std::vector<std::size_t> taken = take(tried, axisAlong(normals_[seed]), seed);
        dvec3 mean(0);
        for (const std::size_t t : taken) {
            mean += areas_[t] * normals_[t];
            chartOf_[t] = kNone;
        }
        const double length = glm::length(mean);
        const bool holdsSeed =
            length > 0 && glm::dot(mean, normals_[seed]) > (charting_.cosine + 1e-9) * length;
        Chart chart;
        taken = take(chart, axisAlong(holdsSeed ? mean / length : normals_[seed]), seed);
        turn(chart, taken);
        charts_.push_back(chart);
        return taken.size();
    }

    // Grows a chart from a triangle on. @return  its triangles
    std::vector<std::size_t> take(Chart& chart, const Axis& axis, std::size_t seed) {
        Growth growth(axis, seed);
        std::size_t left = std::numeric_limits<std::size_t>::max();
        grow(growth, left);
        chart = growth.chart;
        return std::move(growth.taken);
    }

    // @param left  as of growsFrom(). @return whether it is whole
    bool grow(Growth& growth, std::size_t& left) {
        Chart& chart = growth.chart;
        for (; !growth.waiting.empty(); --left) {
            if (left == 0) return false;
            const std::size_t t = growth.waiting.front();
            growth.waiting.pop_front();
            if (chartOf_[t] != kNone || !accepts(chart, t, growth.mask)) continue;
            chartOf_[t] = int(charts_.size());
            growth.taken.push_back(t);
            for (std::size_t i = 0; i < 3; ++i) {
                chart.box.add(flattened(*chart.axis, position(corner(t, i))));
                const int next = across_[3 * t + i];
                if (next != kNone && chartOf_[std::size_t(next)] == kNone)
                    growth.waiting.push_back(std::size_t(next));
            }
        }
        return true;
    }

    // Turns a chart in its plane until its box is smallest.
    void turn(Chart& chart, const std::vector<std::size_t>& triangles) const {
        std::vector<dvec2> places;
        for (const std::size_t t : triangles)
            for (std::size_t i = 0; i < 3; ++i)
                places.push_back(flattened(*chart.axis, position(corner(t, i))));
        const dvec2 along = smallestBoxAlong(places);
        const Axis axis = *chart.axis;
        chart.axis = Axis{axis.out, along.x * axis.right + along.y * axis.down,
                          along.x * axis.down - along.y * axis.right};
        chart.box = {};
        for (const std::size_t t : triangles)
            for (std::size_t i = 0; i < 3; ++i)
                chart.box.add(flattened(*chart.axis, position(corner(t, i))));
    }

    bool accepts(const Chart& chart, std::size_t t, Mask& mask) const {
        if (normals_[t] == dvec3(0)) return true; // it covers nothing
        if (glm::dot(normals_[t], chart.axis->out) < charting_.cosine) return false;
        Corners corners;
        dvec3 heights(0);
        Box box = chart.box;
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 place = position(corner(t, i));
            const dvec2 flat = flattened(*chart.axis, place);
            box.add(flat);
            corners[i] = flat * maskScale_;
            heights[int(i)] = glm::dot(place, chart.axis->out) * maskScale_;
        }
        const dvec2 most = glm::max(chart.box.size(), dvec2(kLongest * kMaskSide / maskScale_));
        const bool first = chart.box.high.x < chart.box.low.x;
        if (!first && (box.size().x > most.x || box.size().y > most.y)) return false;
        return mask.take(corners, heights);
    }

    // Shelves from the top down, the highest charts first, at the largest scale that fits.
    Status pack() {
        std::vector<std::size_t> order(charts_.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return charts_[a].box.size().y > charts_[b].box.size().y;
        });
        if (!place(order, 0))
            return Error{"the mesh falls into " + std::to_string(charts_.size()) +
                         " charts, too many for a picture of " + std::to_string(side_) +
                         " texels a side; must be larger"};
        double area = 0, longest = 0;
        for (const Chart& chart : charts_) {
            const dvec2 size = chart.box.size();
            area += size.x * size.y;
            longest = std::max({longest, size.x, size.y});
        }
        double most = longest > 0 ? (side_ - 2 * charting_.border) / longest : 0; // scale
        if (area > 0) most = std::min(most, side_ / std::sqrt(area));
        constexpr int kHalvings = 40;
        double fits = place(order, most) ? most : 0;
        for (int i = 0; i < kHalvings && fits < most; ++i) {
            const double middle = (fits + most) / 2;
            (place(order, middle) ? fits : most) = middle;
        }
        place(order, scale_ = fits);
        return Done{};
    }

    // Offsets of all boxes at this scale, each with its border; false when there is no room.
    bool place(const std::vector<std::size_t>& order, double scale) {
        offsets_.resize(charts_.size());
        ivec2 at(0);
        int shelf = 0; // its height
        for (const std::size_t chart : order) {
            // What rounding adds may hang into the texel around: reading goes half a texel farther at most.
            const dvec2 size = glm::max(glm::ceil(charts_[chart].box.size() * scale - 1e-3), dvec2(1)) +
                               2.0 * charting_.border;
            if (size.x > side_ || size.y > side_) return false;
            if (at.x + int(size.x) > side_) at = {0, at.y + std::exchange(shelf, 0)};
            if (at.y + int(size.y) > side_) return false;
            offsets_[chart] = at;
            at.x += int(size.x);
            shelf = std::max(shelf, int(size.y));
        }
        return true;
    }

    // Finds some of those that cover the middle of a texel whose middle another one covers. @return whether
    // all are found
    bool covers() {
        const std::size_t end = std::min(count_, covering_ + count_ / kPieces + 1);
        for (std::size_t t = covering_; t < end; ++t) {
            Corners corners;
            for (std::size_t i = 0; i < 3; ++i)
                corners[i] = dvec2(placeOf(corner(t, i), chartOf_[t]));
            const auto index = [&](std::int64_t x, std::int64_t y) { return std::size_t(y * side_ + x); };
            const bool free = forEachMiddle(
                corners, [&](std::int64_t x, std::int64_t y) { return !covered_[index(x, y)]; });
            if (!free)
                hidden_.push_back(t);
            else
                forEachMiddle(corners,
                              [&](std::int64_t x, std::int64_t y) { return covered_[index(x, y)] = true; });
        }
        covering_ = end;
        return covering_ == count_;
    }

    static constexpr std::size_t kPieces = 32; // of what is done triangle by triangle

    const Mesh& mesh_;
    Charting charting_;
    int side_;
    std::size_t count_;
    std::vector<dvec3> normals_; // of the triangles; 0: without area
    std::vector<double> areas_;  // m²
    std::vector<int> across_;    // three a triangle
    double maskScale_ = 0;       // texels a metre
    std::vector<int> chartOf_;
    bool isMeasured_ = false, isJoined_ = false;
    std::size_t seed_ = 0;         // of charts to come, a triangle
    std::optional<Growth> growth_; // of the chart that is being made
    std::vector<Chart> charts_;
    std::vector<ivec2> offsets_; // of the boxes with their borders
    double scale_ = 0;           // texels a metre
    bool isPacked_ = false;      // these are there, for the charts that there are
    std::vector<bool> covered_;  // texels whose middle a triangle covers
    std::size_t covering_ = 0;   // the next triangle
    std::vector<std::size_t> hidden_;
};

// Grows the lists of a mesh by copies of vertices.
void copyVertices(Mesh& mesh, const std::vector<std::uint32_t>& sources) {
    const auto copy = [&](auto& list) {
        if (list.empty()) return;
        for (const std::uint32_t source : sources) {
            const auto value = list[source];
            list.push_back(value);
        }
    };
    copy(mesh.positions);
    copy(mesh.normals);
    copy(mesh.joints);
    copy(mesh.jointWeights);
    for (MorphTarget& target : mesh.rig.targets) {
        copy(target.positions);
        copy(target.normals);
    }
}

// Each vertex stays what it is in the first chart that uses it; for others it is copied.
Atlas atlasFrom(const Mesh& source, const Layout& layout, int side) {
    Mesh mesh = source;
    if (mesh.normals.empty()) mesh.normals = areaWeightedNormals(mesh.positions, mesh.indices);
    struct Copy {
        int chart = kNone;
        std::uint32_t vertex = 0, next = 0; // 0: the last one; no copy has that number
    };
    std::vector<Copy> copies(source.positions.size());
    std::vector<std::uint32_t> sources;
    Atlas atlas{nullptr, std::vector<vec2>(copies.size(), vec2(0)), side, layout.scale()};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t vertex = source.indices[i];
        const int chart = layout.chartOf(i / 3);
        std::size_t at = vertex;
        while (copies[at].chart != chart && copies[at].next)
            at = copies[at].next;
        if (copies[at].chart == kNone) {
            copies[at] = {chart, vertex, 0};
            atlas.places[vertex] = layout.placeOf(vertex, chart);
        } else if (copies[at].chart != chart) {
            copies[at].next = std::uint32_t(copies.size());
            at = copies.size();
            copies.push_back({chart, std::uint32_t(at), 0});
            sources.push_back(vertex);
            atlas.places.push_back(layout.placeOf(vertex, chart));
        }
        mesh.indices[i] = copies[at].vertex;
    }
    copyVertices(mesh, sources);
    atlas.mesh = std::make_shared<const Mesh>(std::move(mesh));
    return atlas;
}

} // namespace

Result<std::shared_ptr<const Atlas>> atlasOf(const Mesh& mesh, int side) {
    return atlasOf(mesh, Charting{side});
}

Result<std::shared_ptr<const Atlas>> atlasOf(const Mesh& mesh, const Charting& charting) {
    AtlasMaking making(std::shared_ptr<const Mesh>(std::shared_ptr<void>(), &mesh), charting); // lives longer
    std::optional<AtlasMaking::Made> made;
    while (!made)
        made = making.advance();
    return *made;
}

struct AtlasMaking::State {
    std::shared_ptr<const Mesh> mesh;
    Charting charting;
    std::optional<Layout> layout{};
    bool isLaid = false;
};

AtlasMaking::AtlasMaking(std::shared_ptr<const Mesh> mesh, const Charting& charting)
    : state_(std::make_unique<State>(State{std::move(mesh), charting})) {}
AtlasMaking::~AtlasMaking() = default;

std::optional<AtlasMaking::Made> AtlasMaking::advance() {
    State& s = *state_;
    if (s.isLaid) return Made(std::make_shared<const Atlas>(atlasFrom(*s.mesh, *s.layout, s.charting.side)));
    if (!s.layout) {
        s.layout.emplace(*s.mesh, s.charting);
        return {};
    }
    const Result<bool> isLaid = s.layout->advance();
    if (!isLaid) return Made(isLaid.error());
    s.isLaid = *isLaid;
    return {};
}

Result<std::shared_ptr<const Atlas>> atlasOf(const Object& object, int side) {
    using Made = std::shared_ptr<const Atlas>;
    const std::pair source(meshOf(object), side);
    if (const Made* made = object.kept.find<Made>(source)) return *made;
    Result<Made> made = atlasOf(*source.first, side);
    return made ? object.kept.keep(source, *made) : made;
}

} // namespace lucent::scene
