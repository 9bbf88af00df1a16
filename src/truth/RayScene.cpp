#include "truth/RayScene.h"

#include "truth/RayCaster.h"

namespace lucent::truth {

namespace {
Result<std::unique_ptr<RayCaster>> casterOf(RayScene::By by, const std::vector<Entry>& entries,
                                            const dvec3& middle, double room) {
    if constexpr (RayScene::kUsual == RayScene::By::Embree)
        if (by == RayScene::By::Embree) return findByEmbree(entries, middle, room);
    return findByBoxes(entries, room);
}
} // namespace

struct RayScene::State {
    std::vector<Entry> entries; ///< never moved once the caster knows them
    Box box;
    double room = 0; ///< what Embree may be wrong by, and more, m
    std::unique_ptr<RayCaster> caster;
};

RayScene::RayScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::create(std::vector<Shape> shapes, const std::vector<bool>& hidden, By by) {
    auto state = std::make_unique<State>();
    for (Shape& shape : shapes) {
        const Box box = boxOf(shape);
        state->box.add(box);
        const std::size_t number = state->entries.size();
        state->entries.push_back({std::move(shape), box, !hidden.empty() && hidden[number]});
    }
    dvec3 middle(0);
    // Embree's floats know places in the box to about 1e-7 of its size: a hundred times that is room enough.
    if (!state->entries.empty()) {
        const double room = state->room = 1e-5 * glm::distance(state->box.low, state->box.high);
        middle = 0.5 * (state->box.low + state->box.high);
        state->box = {state->box.low - 2 * room, state->box.high + 2 * room};
        for (Entry& entry : state->entries)
            entry.box = {entry.box.low - room, entry.box.high + room};
    }
    Result<std::unique_ptr<RayCaster>> caster = casterOf(by, state->entries, middle, state->room);
    if (!caster) return caster.error();
    state->caster = std::move(*caster);
    return RayScene(std::move(state));
}

Hits RayScene::search(const WorldRay& ray, const Leaving& leaving, double within) const {
    const Stretch inside = truth::within(state_->box, ray);
    if (!(inside.from < inside.to)) return {};
    Query query(ray, leaving, inside.from, within);
    state_->caster->find(query);
    return query.found();
}

std::optional<Hit> RayScene::intersect(const WorldRay& ray, const Leaving& leaving) const {
    const Hits hits = search(ray, leaving, 0);
    return hits.count > 0 ? std::optional(hits.at[0]) : std::nullopt;
}

Hits RayScene::coincidentHits(const WorldRay& ray, const Leaving& leaving) const {
    return search(ray, leaving, gap());
}

bool RayScene::occluded(const WorldRay& ray, const Leaving& leaving) const {
    const Stretch inside = truth::within(state_->box, ray);
    if (!(inside.from < inside.to)) return false;
    Query query(ray, leaving, inside.from, 0);
    return state_->caster->isBlocked(query);
}

std::optional<Nearest> RayScene::nearest(const dvec3& point) const {
    Search search(point);
    state_->caster->find(search);
    return search.found();
}

double RayScene::gap() const { return 1e-4 * state_->room; }

const Shape& RayScene::shape(int number) const { return state_->entries[std::size_t(number)].shape; }

Sphere RayScene::around(int number) const {
    const Entry& entry = state_->entries[std::size_t(number)];
    if (const auto* ball = std::get_if<Sphere>(&entry.shape)) return {ball->center, ball->radius};
    return {0.5 * (entry.box.low + entry.box.high), 0.5 * glm::distance(entry.box.low, entry.box.high)};
}

} // namespace lucent::truth
