#include "truth/EnteredLight.h"

namespace lucent::truth {

namespace {
double total(const dvec3& flux) { return flux.r + flux.g + flux.b; }
} // namespace

EnteredLight::EnteredLight(std::vector<LightEntry> entries) : entries_(std::move(entries)) {
    std::erase_if(entries_, [](const LightEntry& entry) { return !(total(entry.flux) > 0); });
    if (!entries_.empty()) build(0, entries_.size());
}

void EnteredLight::build(std::size_t first, std::size_t end) {
    constexpr std::size_t kLeaf = 8;
    const std::size_t index = nodes_.size();
    dvec3 low = entries_[first].place, high = low;
    LightEntry all{dvec3(0), dvec3(0), dvec3(0), entries_[first].sharpness};
    bool isEven = true;
    for (std::size_t i = first; i < end; ++i) {
        const LightEntry& entry = entries_[i];
        low = glm::min(low, entry.place);
        high = glm::max(high, entry.place);
        all.place += total(entry.flux) * entry.place;
        all.normal += total(entry.flux) * entry.normal;
        all.flux += entry.flux;
        isEven &= entry.sharpness == all.sharpness;
    }
    all.place /= total(all.flux);
    const double length = glm::length(all.normal);
    isEven &= length > 0; // else they face all ways
    if (length > 0) all.normal /= length;
    nodes_.push_back({all, 0.5 * (low + high), 0.5 * glm::distance(low, high), isEven, first, end});
    if (end - first <= kLeaf) return;

    const dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = (first + end) / 2;
    const auto at = [&](std::size_t i) { return entries_.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(first), at(half), at(end), [axis](const LightEntry& a, const LightEntry& b) {
        return a.place[axis] < b.place[axis];
    });
    build(first, half);
    nodes_[index].second = nodes_.size();
    build(half, end);
}

} // namespace lucent::truth
