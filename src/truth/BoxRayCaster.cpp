#include "truth/RayCaster.h"

#include <algorithm>
#include <array>

namespace lucent::truth {

namespace {

/// What a leaf of the tree holds: a part of a shape, such as one triangle of it.
struct Part {
    Box box;
    int shape;
    unsigned triangle;

    dvec3 middle() const { return 0.5 * (box.low + box.high); }
};

/// A box around some parts; where it is no leaf, its first half begins at the next node, the second at
/// `second`.
struct Node {
    Box box;
    int first, count; // parts
    int second = 0;   // 0: a leaf
};

constexpr int kLeaf = 4;  // parts that are not divided further
constexpr int kDeep = 64; // of a tree that is halved at every node: more than there can be parts

/// The line of a ray as triangles are held against it. Two that share an edge see the same numbers there, so
/// that no ray slips through.
class Line {
public:
    explicit Line(const WorldRay& ray) : origin_(ray.origin) {
        const dvec3 aside = std::abs(ray.direction.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        right_ = glm::normalize(glm::cross(ray.direction, aside));
        up_ = glm::cross(ray.direction, right_);
    }
    bool pierces(const Triangles& mesh, unsigned triangle) const {
        const std::uint32_t* index = &mesh.indices[3 * std::size_t(triangle)];
        const dvec2 a = across(mesh.positions[index[0]]), b = across(mesh.positions[index[1]]),
                    c = across(mesh.positions[index[2]]);
        const double ab = crossed(a, b), bc = crossed(b, c), ca = crossed(c, a);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }

private:
    dvec2 across(const dvec3& place) const {
        const dvec3 from = place - origin_;
        return {glm::dot(from, right_), glm::dot(from, up_)};
    }
    static double crossed(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

    dvec3 origin_, right_, up_;
};

class BoxRayCaster : public RayCaster {
public:
    BoxRayCaster(const std::vector<Entry>& entries, double room) : entries_(entries) {
        for (std::size_t i = 0; i < entries.size(); ++i)
            addParts(int(i), room);
        if (!parts_.empty()) divide(0, int(parts_.size()));
    }

    void find(Query& query) const override {
        const Line line(query.ray());
        forEachOnTheWay(query, [&](const Part& part) {
            if (const auto intersection = intersectionOf(part, query, line))
                query.offer(part.shape, *intersection);
            return false;
        });
    }
    bool isBlocked(Query& query) const override {
        const Line line(query.ray());
        return forEachOnTheWay(query, [&](const Part& part) {
            const Entry& entry = entryOf(part);
            const Stretch open = query.open(part.shape);
            if (!std::holds_alternative<Triangles>(entry.shape))
                return query.asksFor(entry) && blocks(entry.shape, part.triangle, query.ray(), open);
            const auto intersection = intersectionOf(part, query, line);
            return intersection && intersection->distance > open.from && intersection->distance < open.to;
        });
    }
    void find(Search& search) const override {
        const auto isNear = [&](const Box& box) {
            const dvec3 nearest = glm::clamp(search.point(), box.low, box.high);
            return glm::distance(nearest, search.point()) < search.farthest();
        };
        walk(isNear, [&](const Part& part) {
            if (const auto* mesh = std::get_if<Triangles>(&entryOf(part).shape))
                search.offer(*mesh, part.triangle);
            return false;
        });
    }

private:
    const Entry& entryOf(const Part& part) const { return entries_[std::size_t(part.shape)]; }

    void addParts(int shape, double room) {
        const Entry& entry = entries_[std::size_t(shape)];
        const auto* mesh = std::get_if<Triangles>(&entry.shape);
        for (unsigned i = 0; !mesh && i < partsOf(entry.shape); ++i) {
            const Box box = boxOf(entry.shape, i);
            parts_.push_back({{box.low - room, box.high + room}, shape, i});
        }
        for (unsigned i = 0; mesh && i < mesh->indices.size() / 3; ++i) {
            Box box;
            for (unsigned corner = 0; corner < 3; ++corner)
                box.add(mesh->positions[mesh->indices[3 * std::size_t(i) + corner]]);
            parts_.push_back({{box.low - room, box.high + room}, shape, i});
        }
    }
    /// Halves the parts of a node along its longest side, and those again.
    void divide(int first, int count) {
        const auto from = parts_.begin() + first;
        const std::size_t number = nodes_.size();
        nodes_.push_back({{}, first, count});
        Box middles;
        for (int i = 0; i < count; ++i) {
            nodes_[number].box.add(from[i].box);
            middles.add(from[i].middle());
        }
        if (count <= kLeaf) return;
        const dvec3 extent = middles.high - middles.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const int half = count / 2;
        std::nth_element(from, from + half, from + count, [axis](const Part& a, const Part& b) {
            return a.middle()[axis] < b.middle()[axis];
        });
        divide(first, half);
        nodes_[number].second = int(nodes_.size());
        divide(first + half, count - half);
    }

    /// Calls with the parts of all leaves that `concerns` until a call returns true.
    bool walk(const auto& concerns, const auto& work) const {
        std::array<int, kDeep> waiting;
        int count = 0;
        if (!nodes_.empty()) waiting[std::size_t(count++)] = 0;
        while (count > 0) {
            const int number = waiting[std::size_t(--count)];
            const Node& node = nodes_[std::size_t(number)];
            if (!concerns(node.box)) continue;
            if (node.second > 0) {
                waiting[std::size_t(count++)] = node.second;
                waiting[std::size_t(count++)] = number + 1;
                continue;
            }
            for (int i = node.first; i < node.first + node.count; ++i)
                if (work(parts_[std::size_t(i)])) return true;
        }
        return false;
    }
    bool forEachOnTheWay(const Query& query, const auto& work) const {
        WorldRay ray = query.ray();
        const auto isOnTheWay = [&](const Box& box) {
            ray.length = query.farthest();
            const Stretch stretch = within(box, ray);
            return stretch.from < stretch.to;
        };
        return walk(isOnTheWay, work);
    }

    std::optional<Intersection> intersectionOf(const Part& part, const Query& query, const Line& line) const {
        const Entry& entry = entryOf(part);
        if (!query.asksFor(entry)) return {};
        const auto* mesh = std::get_if<Triangles>(&entry.shape);
        if (!mesh) return intersect(entry.shape, part.triangle, query.ray(), query.open(part.shape));
        if (!line.pierces(*mesh, part.triangle)) return {};
        return intersectTriangle(*mesh, part.triangle, query.ray());
    }

    const std::vector<Entry>& entries_;
    std::vector<Part> parts_;
    std::vector<Node> nodes_;
};

} // namespace

std::unique_ptr<RayCaster> findByBoxes(const std::vector<Entry>& entries, double room) {
    return std::make_unique<BoxRayCaster>(entries, room);
}

} // namespace lucent::truth
