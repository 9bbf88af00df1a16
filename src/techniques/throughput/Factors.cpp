#include "techniques/throughput/Factors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <queue>
#include <unordered_map>

namespace lucent::throughput {

namespace {

constexpr double kQuadratureDepths = 6; // of the shallowest source: within so many
constexpr int kMostDepth = 8;           // of triangles in quarters

template <class Value>
void append(Rows<Value>& rows, const std::vector<std::pair<std::uint32_t, Value>>& row) {
    for (const auto& [column, value] : row) {
        rows.columns.push_back(column);
        rows.values.push_back(value);
    }
    rows.starts.push_back(std::uint32_t(rows.columns.size()));
}

void multiply(const Rows<vec3>& rows, std::span<const vec3> by, std::vector<vec3>& sums) {
    for (std::size_t j = 0; j < rows.count(); ++j) {
        vec3 sum(0);
        for (std::uint32_t k = rows.starts[j]; k < rows.starts[j + 1]; ++k)
            sum += rows.values[k] * by[rows.columns[k]];
        sums[j] += sum;
    }
}

} // namespace

FactorRows::FactorRows(const Hats& hats, const Response& response, const FactorOptions& options)
    : hats_(hats), response_(response), options_(options) {
    rings_.resize(hats.count());
    for (std::uint32_t t = 0; t < hats.triangles.size(); ++t)
        for (const std::uint32_t vertex : hats.triangles[t])
            rings_[vertex].push_back(t);
    // Where vertices stand much closer than z_r the sum over them is the integral from a few rings on.
    longest_ = hats.longestSide();
    const double spacing = hats.spacing();
    radius_ = std::clamp(kQuadratureDepths * response.finest(), 3 * spacing, 12 * spacing);
    radius_ = std::max(radius_, response.cut() + 2 * spacing);
    vec3 high(-std::numeric_limits<float>::infinity());
    low_ = -high;
    for (const vec3& p : hats.positions) {
        low_ = glm::min(low_, p);
        high = glm::max(high, p);
    }
    constexpr float kMostCells = 64;
    cells_ = ivec3(glm::clamp((high - low_) / float(radius_), vec3(1), vec3(kMostCells)));
    cellSize_ = glm::max((high - low_) / vec3(cells_), vec3(float(radius_)));
    grid_.resize(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z));
    for (std::uint32_t t = 0; t < hats.triangles.size(); ++t)
        grid_[cellAt(cellOf(hats.positions[hats.triangles[t][0]]))].push_back(t);
}

ivec3 FactorRows::cellOf(const vec3& place) const {
    return glm::clamp(ivec3((place - low_) / cellSize_), ivec3(0), cells_ - 1);
}

std::size_t FactorRows::cellAt(ivec3 cell) const {
    return (std::size_t(cell.z) * std::size_t(cells_.y) + std::size_t(cell.y)) * std::size_t(cells_.x) +
           std::size_t(cell.x);
}

// Those whose first corner is.
std::vector<std::uint32_t> FactorRows::trianglesNear(const vec3& place, double radius) const {
    std::vector<std::uint32_t> found;
    const ivec3 first = cellOf(place - float(radius)), last = cellOf(place + float(radius));
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                for (const std::uint32_t t : grid_[cellAt({x, y, z})]) {
                    const vec3 away = hats_.positions[hats_.triangles[t][0]] - place;
                    if (glm::dot(away, away) < float(radius * radius)) found.push_back(t);
                }
    return found;
}

vec3 FactorRows::onePoint(std::uint32_t i, std::uint32_t j) const {
    if (i == j && !options_.diagonal) return vec3(0);
    return float(hats_.areas[i] / 3) *
           response_.far(hats_.positions[i], hats_.normals[i], hats_.positions[j]);
}

namespace {

// A piece of a triangle, by its corners' weights in the whole.
using Piece = std::array<vec3, 3>;

struct Integrand {
    const std::array<vec3, 3> positions, normals;
    const Response& response;
    bool isWhole, isNear; // or the far part
    vec3 to;
    float scale2; // m², of the finest detail

    vec3 placeAt(const vec3& w) const { return w.x * positions[0] + w.y * positions[1] + w.z * positions[2]; }
    vec3 at(const vec3& w) const {
        const vec3 normal = w.x * normals[0] + w.y * normals[1] + w.z * normals[2];
        if (isNear) return response.near(placeAt(w), normal, to);
        return isWhole ? response.whole(placeAt(w), normal, to) : response.far(placeAt(w), normal, to);
    }
    bool isSmooth(const Piece& piece) const {
        const vec3 a = placeAt(piece[0]), b = placeAt(piece[1]), c = placeAt(piece[2]);
        const auto square = [](const vec3& v) { return glm::dot(v, v); };
        const float longest = std::max({square(b - a), square(c - b), square(a - c)});
        return longest <= 0.15f * (scale2 + square((a + b + c) / 3.0f - to));
    }
    // Adds the integral of each corner's hat times the response, over the whole triangle's area.
    void add(const Piece& piece, double share, int depth, std::array<dvec3, 3>& sums) const {
        const vec3 ab = 0.5f * (piece[0] + piece[1]), bc = 0.5f * (piece[1] + piece[2]),
                   ca = 0.5f * (piece[2] + piece[0]);
        if (depth < kMostDepth && !isSmooth(piece)) {
            for (const Piece& quarter : {Piece{piece[0], ab, ca}, Piece{ab, piece[1], bc},
                                         Piece{ca, bc, piece[2]}, Piece{ab, bc, ca}})
                add(quarter, share / 4, depth + 1, sums);
            return;
        }
        for (const vec3& middle : {ab, bc, ca}) { // exact to the second degree
            const dvec3 value = share / 3 * dvec3(at(middle));
            for (int k = 0; k < 3; ++k)
                sums[std::size_t(k)] += double(middle[k]) * value;
        }
    }
};

} // namespace

// Which of the triangles near a place the near part reaches through space alone.
//
// @param seeds  those that the place lies on
std::vector<bool> FactorRows::beyondWalls(const std::vector<std::uint32_t>& near, const vec3& place,
                                          std::span<const std::uint32_t> seeds) const {
    std::vector<bool> beyond(near.size(), false);
    if (response_.cut() == 0) return beyond;
    // Filters of texels reach around the corners of their square; a way over triangles' middles is longer
    // than the straight one by a third at most.
    const float longest = 1.9f * float(response_.cut()) + float(hats_.spacing());
    const auto middleOf = [&](std::uint32_t t) {
        const auto& corners = hats_.triangles[t];
        return (hats_.positions[corners[0]] + hats_.positions[corners[1]] + hats_.positions[corners[2]]) /
               3.0f;
    };
    std::unordered_map<std::uint32_t, float> ways;
    std::priority_queue<std::pair<float, std::uint32_t>> waiting; // the least first, negative
    for (const std::uint32_t t : near)
        ways[t] = std::numeric_limits<float>::infinity();
    for (const std::uint32_t t : seeds)
        waiting.emplace(-(ways[t] = glm::distance(middleOf(t), place)), t);
    while (!waiting.empty()) {
        const auto [way, t] = waiting.top();
        waiting.pop();
        if (-way > ways[t]) continue;
        for (const std::uint32_t next : hats_.across[t]) {
            const auto known = next == Hats::kNone ? ways.end() : ways.find(next);
            if (known == ways.end()) continue;
            const float longer = -way + glm::distance(middleOf(t), middleOf(next));
            if (longer >= known->second) continue;
            known->second = longer;
            waiting.emplace(-longer, next);
        }
    }
    for (std::size_t k = 0; k < near.size(); ++k)
        beyond[k] = ways[near[k]] > longest;
    return beyond;
}

void FactorRows::integrate(std::uint32_t triangle, const vec3& to, Part part,
                           std::array<dvec3, 3>& sums) const {
    const auto& corners = hats_.triangles[triangle];
    const auto of = [&](const std::vector<vec3>& list) {
        return std::array{list[corners[0]], list[corners[1]], list[corners[2]]};
    };
    const double finest = part == Part::Far ? std::max(response_.finest(), response_.cut() / 3) // as smooth
                                            : response_.finest();
    const Integrand integrand{of(hats_.positions),   of(hats_.normals),  response_,
                              part == Part::Whole,   part == Part::Near, to,
                              float(finest * finest)};
    integrand.add({vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}, hats_.triangleAreas[triangle], 0, sums);
}

vec3 FactorRows::nearAround(const Place& place) const {
    const vec3 to = positionAt(hats_, place);
    const std::vector<std::uint32_t> near = trianglesNear(to, response_.cut() + longest_);
    const std::vector<bool> beyond = beyondWalls(near, to, std::span(&place.triangle, 1));
    std::array<dvec3, 3> sums{dvec3(0), dvec3(0), dvec3(0)};
    for (std::size_t n = 0; n < near.size(); ++n)
        if (!beyond[n]) integrate(near[n], to, Part::Near, sums);
    return vec3(sums[0] + sums[1] + sums[2]);
}

std::vector<std::pair<std::uint32_t, vec3>> FactorRows::close(std::uint32_t j) const {
    std::vector<std::pair<std::uint32_t, vec3>> row;
    if (!options_.quadrature) return row;
    struct Entry {
        std::uint32_t vertex;
        double area; // of the triangle
        dvec3 sum;
    };
    std::vector<Entry> parts;
    const std::vector<std::uint32_t> near = trianglesNear(hats_.positions[j], radius_);
    const std::vector<bool> beyond = beyondWalls(near, hats_.positions[j], rings_[j]);
    for (std::size_t n = 0; n < near.size(); ++n) {
        const std::uint32_t t = near[n];
        std::array<dvec3, 3> sums{dvec3(0), dvec3(0), dvec3(0)};
        integrate(t, hats_.positions[j], beyond[n] ? Part::Whole : Part::Far, sums);
        for (std::size_t k = 0; k < 3; ++k)
            parts.push_back({hats_.triangles[t][k], hats_.triangleAreas[t], sums[k]});
    }
    std::sort(parts.begin(), parts.end(), [](const Entry& a, const Entry& b) { return a.vertex < b.vertex; });
    for (std::size_t k = 0; k < parts.size();) {
        const std::uint32_t i = parts[k].vertex;
        double area = 0;
        dvec3 sum(0);
        for (; k < parts.size() && parts[k].vertex == i; ++k) {
            area += parts[k].area;
            sum += parts[k].sum;
        }
        if (i == j && !options_.diagonal) {
            row.emplace_back(i, vec3(0));
            continue;
        }
        // The triangles around it that are not near are one point.
        const double rest = std::max(0.0, 1 - area / hats_.areas[i]);
        row.emplace_back(i, vec3(sum) + float(rest) * onePoint(i, j));
    }
    return row;
}

void FactorRows::fill(std::uint32_t j, std::span<vec3> row) const {
    for (std::uint32_t i = 0; i < row.size(); ++i)
        row[i] = onePoint(i, j);
    for (const auto& [i, factor] : close(j))
        row[i] = factor;
}

std::vector<vec3> Factors::product(std::span<const vec3> irradiance) const {
    std::vector<vec3> sums(count, vec3(0));
    if (method == Global::Dense) {
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t i = 0; i < count; ++i)
                sums[j] += dense[j * count + i] * irradiance[i];
        return sums;
    }
    multiply(close, irradiance, sums);
    if (method == Global::Hierarchical) {
        std::vector<vec3> moments(inner.count(), vec3(0));
        multiply(inner, irradiance, moments);
        multiply(outer, moments, sums);
    }
    return sums;
}

std::size_t Factors::kept() const {
    return dense.size() + close.values.size() + inner.values.size() + outer.values.size();
}

std::size_t Factors::bytes() const {
    return dense.size() * sizeof(vec3) + close.bytes() + inner.bytes() + outer.bytes();
}

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t(2) << 30; // of factors, while they are made too

// Counts what several threads keep.
class Room {
public:
    template <class List>
    void take(const List& list) {
        bytes_ += list.size() * sizeof(list[0]);
    }
    bool isFull() const { return bytes_ > kMostBytes; }
    Error error(std::size_t vertices) const {
        return {"close factors of " + std::to_string(vertices) + " vertices are more than " +
                    std::to_string(kMostBytes >> 20) + " MiB; must be of fewer vertices",
                Fault::Machine};
    }

private:
    std::atomic<std::uint64_t> bytes_{0};
};

void addDense(Stages& stages, double share, const FactorRows& rows, std::size_t count, Factors& made) {
    stages.then([&stages, share, &rows, count, &made]() -> Status {
        const std::uint64_t bytes = std::uint64_t(count) * count * sizeof(vec3);
        if (bytes > kMostBytes)
            return Error{"all factors of " + std::to_string(count) + " vertices are " +
                             std::to_string(bytes >> 20) +
                             " MiB; must be sparse or hierarchical, or fewer than 13,377",
                         Fault::Machine};
        made.dense.resize(count * count);
        stages.forEach(share, count, [&rows, count, &made](std::size_t j) {
            rows.fill(std::uint32_t(j), std::span(made.dense).subspan(j * count, count));
        });
        return Done{};
    });
}

void addSparse(Stages& stages, double share, const FactorRows& rows, std::size_t count, float threshold,
               Factors& made) {
    struct Kept {
        std::vector<std::vector<std::pair<std::uint32_t, vec3>>> rows;
        Room room;
    };
    const auto kept = std::make_shared<Kept>();
    kept->rows.resize(count);
    stages.forEach(share, count, [kept, &rows, count, threshold](std::size_t j) {
        if (kept->room.isFull()) return;
        std::vector<vec3> row(count);
        rows.fill(std::uint32_t(j), row);
        for (std::uint32_t i = 0; i < count; ++i)
            if (std::max({row[i].r, row[i].g, row[i].b}) >= threshold) kept->rows[j].emplace_back(i, row[i]);
        kept->room.take(kept->rows[j]);
    });
    stages.then([kept, count, &made]() -> Status {
        if (kept->room.isFull()) return kept->room.error(count);
        for (const auto& row : kept->rows)
            append(made.close, row);
        return Done{};
    });
}

// --- hierarchical: a matrix of blocks (Hackbusch 1999), far ones as sums of few products of a column and a
// row of themselves (adaptive cross approximation with full pivoting, Bebendorf 2000)

struct Cluster {
    std::uint32_t first, end; // in the order of the tree
    vec3 low, high;
    double area = 0;
    int children[2] = {-1, -1};
    bool isLeaf() const { return children[0] < 0; }
    std::uint32_t count() const { return end - first; }
};

struct Tree {
    std::vector<std::uint32_t> order; // vertices
    std::vector<Cluster> clusters;

    explicit Tree(const Hats& hats) : order(hats.count()) {
        std::iota(order.begin(), order.end(), 0u);
        add(hats, 0, std::uint32_t(order.size()));
    }
    int add(const Hats& hats, std::uint32_t first, std::uint32_t end) {
        constexpr std::uint32_t kLeaf = 16;
        Cluster cluster{first, end, hats.positions[order[first]], hats.positions[order[first]]};
        for (std::uint32_t k = first; k < end; ++k) {
            cluster.low = glm::min(cluster.low, hats.positions[order[k]]);
            cluster.high = glm::max(cluster.high, hats.positions[order[k]]);
            cluster.area += hats.areas[order[k]];
        }
        const int number = int(clusters.size());
        clusters.push_back(cluster);
        if (end - first <= kLeaf) return number;
        const vec3 size = cluster.high - cluster.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t middle = (first + end) / 2;
        std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return std::pair(hats.positions[a][axis], a) <
                                    std::pair(hats.positions[b][axis], b);
                         });
        const int left = add(hats, first, middle), right = add(hats, middle, end);
        clusters[std::size_t(number)].children[0] = left;
        clusters[std::size_t(number)].children[1] = right;
        return number;
    }
};

bool isFar(const Cluster& a, const Cluster& b) {
    const vec3 gap = glm::max(glm::max(a.low - b.high, b.low - a.high), vec3(0));
    return glm::length(gap) >= 0.3f * std::min(glm::length(a.high - a.low), glm::length(b.high - b.low));
}

// Factors that a block may have: each thread keeps one whole, and 10,000 vertices have no larger far ones.
constexpr std::size_t kMostInBlock = std::size_t(1) << 23;

// What is left of a block: rows are vertices that receive, columns those that are lit.
class Block {
public:
    Block(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), rest_(rows * columns) {}
    std::span<vec3> row(std::size_t j) { return std::span(rest_).subspan(j * columns_, columns_); }

    struct Product {
        std::vector<vec3> column, row; // outer(j) and inner(i)
    };

    // Whether no row's sum of what is left exceeds its tolerance.
    bool isWithin(std::span<const vec3> tolerances) const {
        for (std::size_t j = 0; j < rows_; ++j) {
            vec3 sum(0);
            for (std::size_t i = 0; i < columns_; ++i)
                sum += glm::abs(rest_[j * columns_ + i]);
            if (glm::any(glm::greaterThan(sum, tolerances[j]))) return false;
        }
        return true;
    }

    // Takes the cross through the largest entry, in shares of what rows tolerate, out of the rest.
    Product takeCross(std::span<const vec3> tolerances) {
        std::size_t pivot = 0;
        float most = -1;
        for (std::size_t j = 0; j < rows_; ++j)
            for (std::size_t i = 0; i < columns_; ++i) {
                const vec3 share = glm::abs(rest_[j * columns_ + i]) / tolerances[j];
                const float sum = share.r + share.g + share.b;
                if (sum > most) {
                    most = sum;
                    pivot = j * columns_ + i;
                }
            }
        const std::size_t at = pivot % columns_, in = pivot / columns_;
        Product product{std::vector<vec3>(rows_), std::vector<vec3>(columns_)};
        vec3 inverse;
        for (int c = 0; c < 3; ++c)
            inverse[c] = rest_[pivot][c] != 0 ? 1 / rest_[pivot][c] : 0;
        for (std::size_t j = 0; j < rows_; ++j)
            product.column[j] = rest_[j * columns_ + at] * inverse;
        for (std::size_t i = 0; i < columns_; ++i)
            product.row[i] = rest_[in * columns_ + i];
        for (std::size_t j = 0; j < rows_; ++j)
            for (std::size_t i = 0; i < columns_; ++i)
                rest_[j * columns_ + i] -= product.column[j] * product.row[i];
        return product;
    }

private:
    std::size_t rows_, columns_;
    std::vector<vec3> rest_;
};

class Hierarchy {
public:
    Hierarchy(const FactorRows& rows, const Hats& hats, float epsilon)
        : rows_(rows), tree_(hats), epsilon_(epsilon), area_(3 * hats.area()), places_(hats.count()),
          exact_(hats.count()), close_(hats.count()), outer_(hats.count()), sums_(hats.count()), hats_(hats) {
        for (std::uint32_t k = 0; k < places_.size(); ++k)
            places_[tree_.order[k]] = k;
    }

    void add(Stages& stages, double share, Factors& made) {
        constexpr double kExact = 0.35; // of the work
        stages.forEach(kExact * share, close_.size(), [this](std::size_t j) {
            if (room_.isFull()) return;
            exact_[j] = rows_.close(std::uint32_t(j));
            room_.take(exact_[j]);
            sums_[j] = sumOf(std::uint32_t(j));
        });
        stages.then([this, &stages, share, &made]() -> Status {
            if (room_.isFull()) return room_.error(close_.size());
            pairs_ = {{0, 0}};
            addBlocks(stages, (1 - kExact) * share);
            stages.inOrder(0, close_.size(), [this, &made](std::size_t j) { join(std::uint32_t(j), made); });
            stages.then([this, &made]() -> Status {
                made.inner = std::move(inner_);
                return Done{};
            });
            return Done{};
        });
    }

private:
    struct Pair {
        int to, from;
    };
    struct Made {
        std::vector<Pair> children; // to be made instead
        std::vector<Block::Product> products;
        bool isClose = false; // factor by factor
    };

    std::span<const std::uint32_t> verticesOf(const Cluster& cluster) const {
        return std::span(tree_.order).subspan(cluster.first, cluster.count());
    }

    // F_ij of some vertices i that lie together in the tree.
    void fill(std::uint32_t j, const Cluster& from, std::span<vec3> row) const {
        for (std::uint32_t k = from.first; k < from.end; ++k)
            row[k - from.first] = rows_.onePoint(tree_.order[k], j);
        for (const auto& [i, factor] : exact_[j])
            if (places_[i] >= from.first && places_[i] < from.end) row[places_[i] - from.first] = factor;
    }
    vec3 sumOf(std::uint32_t j) const {
        std::vector<vec3> row(close_.size());
        fill(j, tree_.clusters.front(), row);
        dvec3 sum(0);
        for (const vec3& factor : row)
            sum += dvec3(factor);
        return vec3(sum);
    }

    // Makes blocks of one size, and then those that are to be made instead.
    void addBlocks(Stages& stages, double share) {
        made_.assign(pairs_.size(), {});
        stages.forEach(share / 3, pairs_.size(), [this](std::size_t k) { made_[k] = make(pairs_[k]); });
        stages.then([this, &stages, share]() -> Status {
            std::vector<Pair> rest;
            for (std::size_t k = 0; k < pairs_.size(); ++k) {
                put(pairs_[k], made_[k]);
                rest.insert(rest.end(), made_[k].children.begin(), made_[k].children.end());
            }
            pairs_ = std::move(rest);
            if (!pairs_.empty()) addBlocks(stages, share * 2 / 3);
            return Done{};
        });
    }

    // What a block, or a factor, of so much of the area may leave out of a row.
    vec3 toleranceOf(std::uint32_t j, double area) const {
        return glm::max(epsilon_ * float(area / area_) * sums_[j], vec3(1e-30f));
    }

    Made make(const Pair& pair) const {
        const Cluster &to = tree_.clusters[std::size_t(pair.to)],
                      &from = tree_.clusters[std::size_t(pair.from)];
        Made made;
        if (isFar(to, from) && std::size_t(to.count()) * from.count() <= kMostInBlock) {
            std::vector<vec3> tolerances;
            Block block(to.count(), from.count());
            for (const std::uint32_t j : verticesOf(to)) {
                fill(j, from, block.row(tolerances.size()));
                tolerances.push_back(toleranceOf(j, from.area));
            }
            const std::size_t most =
                std::size_t(to.count()) * from.count() / (2 * (to.count() + from.count()));
            while (!block.isWithin(tolerances) && made.products.size() <= most)
                made.products.push_back(block.takeCross(tolerances));
            if (made.products.size() <= most) return made;
            made.products.clear();
        }
        if (to.isLeaf() && from.isLeaf()) {
            made.isClose = true;
        } else if (from.isLeaf() || (!to.isLeaf() && to.count() >= from.count())) {
            for (const int child : to.children)
                made.children.push_back({child, pair.from});
        } else {
            for (const int child : from.children)
                made.children.push_back({pair.to, child});
        }
        return made;
    }

    void put(const Pair& pair, const Made& made) {
        const Cluster &to = tree_.clusters[std::size_t(pair.to)],
                      &from = tree_.clusters[std::size_t(pair.from)];
        const auto receiving = verticesOf(to), lit = verticesOf(from);
        if (made.isClose)
            for (const std::uint32_t j : receiving)
                close_[j].insert(close_[j].end(), lit.begin(), lit.end());
        for (const Block::Product& product : made.products) {
            std::vector<std::pair<std::uint32_t, vec3>> row;
            for (std::size_t i = 0; i < lit.size(); ++i)
                row.emplace_back(lit[i], product.row[i]);
            std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
            for (std::size_t j = 0; j < receiving.size(); ++j)
                outer_[receiving[j]].emplace_back(std::uint32_t(inner_.count()), product.column[j]);
            append(inner_, row);
        }
    }

    // The rows of one vertex.
    void join(std::uint32_t j, Factors& made) {
        std::sort(close_[j].begin(), close_[j].end());
        auto known = exact_[j].begin();
        std::vector<std::pair<std::uint32_t, vec3>> row;
        for (const std::uint32_t i : close_[j]) {
            while (known != exact_[j].end() && known->first < i)
                ++known;
            const bool isExact = known != exact_[j].end() && known->first == i;
            const vec3 factor = isExact ? known->second : rows_.onePoint(i, j);
            if (glm::any(glm::greaterThan(factor, toleranceOf(j, hats_.areas[i]))))
                row.emplace_back(i, factor);
        }
        append(made.close, row);
        append(made.outer, outer_[j]);
    }

    const FactorRows& rows_;
    Tree tree_;
    float epsilon_;
    double area_;                       // of all hats together: three times the object's
    std::vector<std::uint32_t> places_; // of vertices in the tree
    std::vector<std::vector<std::pair<std::uint32_t, vec3>>> exact_; // FactorRows::close()
    std::vector<std::vector<std::uint32_t>> close_;
    std::vector<std::vector<std::pair<std::uint32_t, vec3>>> outer_;
    Rows<vec3> inner_;
    std::vector<vec3> sums_;
    Room room_;
    std::vector<Pair> pairs_; // that come next
    std::vector<Made> made_;  // of them
    const Hats& hats_;
};

} // namespace

void addFactors(Stages& stages, double share, const FactorRows& rows, const Hats& hats,
                const FactorOptions& options, Factors& made) {
    made = {
        .method = options.method, .count = hats.count(), .dense = {}, .close = {}, .inner = {}, .outer = {}};
    switch (options.method) {
    case Global::Dense:
        return addDense(stages, share, rows, hats.count(), made);
    case Global::Sparse:
        return addSparse(stages, share, rows, hats.count(), options.threshold, made);
    case Global::Hierarchical:
        break;
    }
    // It stays while one of the stages does.
    const auto hierarchy = std::make_shared<Hierarchy>(rows, hats, options.epsilon);
    hierarchy->add(stages, share, made);
    stages.then([hierarchy]() -> Status { return Done{}; });
}

} // namespace lucent::throughput
