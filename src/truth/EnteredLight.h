#pragma once
/// Light that entered a body where rays met it, kept so that what lies far away together counts as one place.

#include "base/Math.h"

#include <algorithm>
#include <vector>

namespace lucent::truth {

/// Where light entered.
struct LightEntry {
    dvec3 place, normal;  ///< m; unit
    dvec3 flux;           ///< W, behind the surface
    double sharpness = 1; ///< how many times as dense the medium is there (Paint)
};

/// A tree over entries: each node stands for those in its box, at their middle by flux.
class EnteredLight {
public:
    /// @param entries  of a body; those that differ in sharpness never count as one
    explicit EnteredLight(std::vector<LightEntry> entries = {});

    /// Calls visit(LightEntry) for entries, and for nodes that are as far from a place as eight times their
    /// size: what falls with the third power of the distance is then right to 0.2 % (half its second
    /// derivative times the spread of entries that are even in the box).
    template <class Visit>
    void visit(const dvec3& from, Visit visit) const {
        if (!nodes_.empty()) visitNode(0, from, visit);
    }

private:
    struct Node {
        LightEntry all;
        dvec3 middle;
        double radius;          ///< m, around the middle
        bool isEven;            ///< all entries have one sharpness
        std::size_t first, end; ///< entries
        std::size_t second = 0; ///< the other child; the first one follows this; 0: a leaf
    };
    void build(std::size_t first, std::size_t end);

    template <class Visit>
    void visitNode(std::size_t index, const dvec3& from, Visit& visit) const {
        constexpr double kApart = 10;
        const Node& node = nodes_[index];
        if (node.isEven && glm::distance(from, node.middle) > kApart * 2 * node.radius) {
            visit(node.all);
        } else if (node.second == 0) {
            std::for_each(entries_.begin() + std::ptrdiff_t(node.first),
                          entries_.begin() + std::ptrdiff_t(node.end), visit);
        } else {
            visitNode(index + 1, from, visit);
            visitNode(node.second, from, visit);
        }
    }

    std::vector<LightEntry> entries_;
    std::vector<Node> nodes_;
};

} // namespace lucent::truth
