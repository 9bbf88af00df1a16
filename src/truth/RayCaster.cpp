#include "truth/RayCaster.h"

namespace lucent::truth {

bool Query::offer(int shape, const Intersection& intersection) {
    const Stretch stretch = open(shape);
    const bool nearest = found_.count > 0 && intersection.distance < found_.at[0].distance;
    if (!(intersection.distance > stretch.from && (nearest || intersection.distance < stretch.to)))
        return false;
    if (found_.count > 0 && within_ == 0 && !nearest) return false;
    insert({ray_.origin + intersection.distance * ray_.direction, intersection.normal,
            intersection.smoothNormal, shape, intersection.distance, intersection.triangle,
            intersection.opacity});
    return true;
}

void Query::insert(const Hit& hit) {
    const auto enters = [&](const Hit& one) { return glm::dot(one.normal, ray_.direction) < 0; };
    Hits kept;
    const auto keep = [&](const Hit& one) {
        if (kept.count == Hits::kMost) return;
        if (kept.count > 0 && one.distance > kept.at[0].distance + within_) return;
        for (const Hit& other : kept)
            if (other.shape == one.shape && enters(other) == enters(one)) return;
        kept.at[std::size_t(kept.count++)] = one;
    };
    const Hit* next = found_.begin();
    while (next != found_.end() && next->distance <= hit.distance)
        keep(*next++);
    keep(hit);
    while (next != found_.end())
        keep(*next++);
    found_ = kept;
}

bool Search::offer(const Triangles& mesh, std::size_t triangle) {
    const std::uint32_t* index = &mesh.indices[3 * triangle];
    const dvec3 &a = mesh.positions[index[0]], &b = mesh.positions[index[1]], &c = mesh.positions[index[2]];
    const dvec3 weights = nearestWeights(a, b, c, point_);
    const double distance = glm::distance(point_, weights.x * a + weights.y * b + weights.z * c);
    if (found_ && distance >= found_->distance) return false;
    found_ = Nearest{triangle, weights, distance};
    return true;
}

} // namespace lucent::truth
