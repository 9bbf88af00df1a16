#include "truth/RayScene.h"

#include "truth/Relief.h"
#include "truth/Torus.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
    dvec3 low{kInfinity}, high{-kInfinity};
    void add(const dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& box) {
        add(box.low);
        add(box.high);
    }
};

Box boxOf(const Triangles& triangles) {
    Box box;
    for (const dvec3& position : triangles.positions)
        box.add(position);
    return box;
}
Box boxOf(const FieldBlock& block) {
    Box box;
    const Field& field = *block.field;
    for (const double z : {field.bottom(), field.highest()})
        for (const double y : {-field.half().y, field.half().y})
            for (const double x : {-field.half().x, field.half().x})
                box.add(block.placement.pointInWorld({x, y, z}));
    return box;
}
Box boxOf(const Sphere& sphere) { return {sphere.center - sphere.radius, sphere.center + sphere.radius}; }
Box boxOf(const Torus& torus) {
    const dvec3 reach = torus.major * glm::sqrt(glm::max(1.0 - torus.axis * torus.axis, 0.0)) + torus.minor;
    return {torus.center - reach, torus.center + reach};
}

Box boxOf(const Ripple& ripple) {
    Box box;
    for (const double y : {-ripple.amplitude, ripple.amplitude})
        for (const double z : {-ripple.half.y, ripple.half.y})
            for (const double x : {-ripple.half.x, ripple.half.x})
                box.add(ripple.placement.pointInWorld({x, y, z}));
    return box;
}

/// Part of a ray that lies in a box; empty when it passes by.
Stretch within(const Box& box, const WorldRay& ray) {
    Stretch stretch{ray.begin, ray.length};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return {0, 0};
            continue;
        }
        const double one = (box.low[axis] - ray.origin[axis]) / ray.direction[axis];
        const double other = (box.high[axis] - ray.origin[axis]) / ray.direction[axis];
        stretch = {std::max(stretch.from, std::min(one, other)), std::min(stretch.to, std::max(one, other))};
    }
    return stretch;
}

/// What a ray meets of one shape: how far, and the normals there.
struct Meeting {
    double distance;
    dvec3 normal, smoothNormal;
    Meeting(double distance, const dvec3& normal) : Meeting(distance, normal, normal) {}
    Meeting(double distance, const dvec3& normal, const dvec3& smoothNormal)
        : distance(distance), normal(normal), smoothNormal(smoothNormal) {}
};

/// The nearest hit of a sphere within a stretch. Half the chord is a product, not a difference of squares:
/// rays that graze keep their digits.
std::optional<Meeting> meet(const Sphere& sphere, const WorldRay& ray, Stretch stretch) {
    const dvec3 out = ray.origin - sphere.center;
    const double foot = -glm::dot(out, ray.direction);
    const double aside = glm::length(out + foot * ray.direction);
    if (aside > sphere.radius) return {};
    const double half = std::sqrt((sphere.radius - aside) * (sphere.radius + aside));
    for (const double distance : {foot - half, foot + half})
        if (distance > stretch.from && distance < stretch.to)
            return Meeting{distance, glm::normalize(out + distance * ray.direction)};
    return {};
}

std::optional<Meeting> meet(const Torus& torus, const WorldRay& ray, Stretch stretch) {
    const dvec3 aside = std::abs(torus.axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(torus.axis, aside));
    const glm::dmat3 worldFromTorus(first, glm::cross(torus.axis, first), torus.axis);
    const dvec3 origin = (ray.origin - torus.center) * worldFromTorus,
                direction = ray.direction * worldFromTorus;
    const TorusHits hits = torusHits(origin, direction, torus.major, torus.minor);
    for (int i = 0; i < hits.count; ++i)
        if (const double distance = hits.at[std::size_t(i)]; distance > stretch.from && distance < stretch.to)
            return Meeting{distance,
                           worldFromTorus * torusNormal(origin + distance * direction, torus.major)};
    return {};
}

/// The first place of a stretch at which a ray meets a ripple. Along the ray its height over the sheet is a
/// line less a sine: between two of the places where that turns there is one root or none.
class RippleCut {
public:
    RippleCut(const Ripple& ripple, const dvec3& origin, const dvec3& direction)
        : amplitude_(ripple.amplitude), altitude_(origin.y), climb_(direction.y),
          angle_(glm::dot(ripple.wave, dvec2(origin.x, origin.z)) - ripple.phase),
          turning_(glm::dot(ripple.wave, dvec2(direction.x, direction.z))) {}

    std::optional<double> first(Stretch stretch) const {
        for (double from = stretch.from; from < stretch.to;) {
            const double to = std::min(nextTurn(from), stretch.to);
            if ((above(from) < 0) != (above(to) < 0)) return between(from, to);
            from = to;
        }
        return {};
    }

private:
    double angle(double at) const { return angle_ + at * turning_; }
    double above(double at) const { return altitude_ + at * climb_ - amplitude_ * std::sin(angle(at)); }
    double slope(double at) const { return climb_ - amplitude_ * turning_ * std::cos(angle(at)); }

    /// The nearest place past `at` where the height over the sheet turns: cos(angle) = climb / (A turning).
    double nextTurn(double at) const {
        const double cosine = climb_ / (amplitude_ * turning_);
        if (!(std::abs(cosine) < 1)) return kInfinity;
        constexpr double kRound = 2 * std::numbers::pi;
        double nearest = kInfinity;
        for (const double turn : {std::acos(cosine), -std::acos(cosine)})
            for (const int more : {-1, 0, 1, 2}) {
                const double rounds = std::floor((angle(at) - turn) / kRound) + more;
                const double place = (turn + kRound * rounds - angle_) / turning_;
                if (place > at) nearest = std::min(nearest, place);
            }
        return nearest;
    }
    /// Newton's steps that leave the bracket become bisections.
    double between(double low, double high) const {
        const bool rising = above(low) < 0;
        double at = 0.5 * (low + high);
        for (int step = 0; step < 200 && low < at && at < high; ++step) {
            const double value = above(at);
            if (value == 0) break;
            ((value < 0) == rising ? low : high) = at;
            const double next = at - value / slope(at);
            at = low < next && next < high ? next : 0.5 * (low + high);
        }
        return at;
    }
    double amplitude_, altitude_, climb_, angle_, turning_;
};

std::optional<Meeting> meet(const Ripple& ripple, const WorldRay& world, Stretch stretch) {
    const double scale = ripple.placement.scale;
    // From the place that is nearest to the sheet's middle: a whole line has no other beginning.
    const dvec3 direction = ripple.placement.directionFromWorld(world.direction);
    const dvec3 start = ripple.placement.pointFromWorld(world.origin);
    const double foot = -glm::dot(start, direction);
    const WorldRay local{start + foot * direction, direction, stretch.to / scale - foot,
                         stretch.from / scale - foot};
    const double room = ripple.amplitude + 1e-9 * (ripple.half.x + ripple.half.y);
    const Box box{{-ripple.half.x, -room, -ripple.half.y}, {ripple.half.x, room, ripple.half.y}};
    const auto at = RippleCut(ripple, local.origin, direction).first(within(box, local));
    if (!at) return {};
    const dvec3 place = local.origin + *at * direction;
    const dvec2 slope = ripple.amplitude * ripple.wave *
                        std::cos(glm::dot(ripple.wave, dvec2(place.x, place.z)) - ripple.phase);
    const dvec3 normal = glm::normalize(dvec3(-slope.x, 1, -slope.y));
    return Meeting((*at + foot) * scale, ripple.placement.directionInWorld(normal));
}

/// A ray in a field's object space, and a stretch of it there.
struct FieldRay {
    Ray ray;
    Stretch stretch;
    FieldRay(const FieldBlock& block, const WorldRay& world, Stretch stretch)
        : ray{block.placement.pointFromWorld(world.origin), dvec3(0),
              block.placement.directionFromWorld(world.direction)},
          stretch{stretch.from / block.placement.scale, stretch.to / block.placement.scale} {}
    double altitude(double at) const { return ray.anchor.z + at * ray.direction.z; }
};

std::optional<Meeting> meet(const FieldBlock& block, const WorldRay& world, Stretch stretch) {
    const FieldRay local(block, world, stretch);
    const auto hit = firstHit(*block.field, local.ray, local.stretch);
    if (!hit) return {};
    const double distance = glm::dot(hit->position - local.ray.anchor, local.ray.direction);
    return Meeting{distance * block.placement.scale, block.placement.directionInWorld(hit->normal)};
}

/// Whether a ray meets the block from its surface to its bottom. Field knows no bottom: what enters below it
/// is in the way only when it climbs into the block afterwards. A ray that leaves this block's own surface (a
/// stretch that does not begin at 0) reaches what is below only through it.
bool blocks(const FieldBlock& block, const WorldRay& world, Stretch stretch) {
    const Field& field = *block.field;
    const FieldRay local(block, world, stretch);
    const double first = firstInside(field, local.ray, local.stretch);
    if (first == kInfinity) return false;
    const Stretch over = field.overFootprint(local.ray, local.stretch);
    if (stretch.from > 0 || first > over.from || local.altitude(first) >= field.bottom()) return true;
    const double climb = local.ray.direction.z;
    return climb > 0 && (field.bottom() - local.ray.anchor.z) / climb < over.to;
}
bool blocks(const auto& shape, const WorldRay& ray, Stretch stretch) {
    return meet(shape, ray, stretch).has_value();
}

/// A triangle that Embree has found, solved again by its plane. Nothing where the exact ray passes by it:
/// close to an edge by as much as floats may be wrong is still on it, so that no ray slips through.
std::optional<Meeting> meetTriangle(const Triangles& triangles, unsigned number, const WorldRay& ray) {
    const std::uint32_t* index = &triangles.indices[3 * std::size_t(number)];
    const dvec3 corner = triangles.positions[index[0]];
    const dvec3 first = triangles.positions[index[1]] - corner;
    const dvec3 second = triangles.positions[index[2]] - corner;
    const dvec3 across = glm::cross(first, second); // twice the area long
    const double distance = glm::dot(corner - ray.origin, across) / glm::dot(ray.direction, across);
    const dvec3 place = ray.origin + distance * ray.direction - corner;
    const double area = glm::dot(across, across);
    const double u = glm::dot(glm::cross(place, second), across) / area;
    const double v = glm::dot(glm::cross(first, place), across) / area;
    constexpr double kOver = 1e-3;
    if (!(u > -kOver && v > -kOver && u + v < 1 + kOver)) return {};
    const dvec3 normal = across / std::sqrt(area);
    if (triangles.normals.empty()) return Meeting(distance, normal);
    const dvec3 smooth = (1 - u - v) * triangles.normals[index[0]] + u * triangles.normals[index[1]] +
                         v * triangles.normals[index[2]];
    return Meeting(distance, normal, glm::normalize(smooth));
}

/// What Embree's callbacks know of a shape.
struct Entry {
    Shape shape;
    Box box; ///< a little larger than the shape, from the middle of the scene
    bool hidden;
};

/// One question to the scene: Embree hands it through to the callbacks.
struct Query {
    RTCIntersectContext context; // first: Embree knows the whole by its address
    WorldRay ray;
    Leaving leaving;
    double within; ///< how far behind the nearest hit others count
    double start;  ///< where Embree's own ray begins
    Hits found;

    Query(const WorldRay& ray, const Leaving& leaving, double within, double start)
        : ray(ray), leaving(leaving), within(within), start(start) {
        rtcInitIntersectContext(&context);
    }
    static Query& of(RTCIntersectContext* context) { return *reinterpret_cast<Query*>(context); }

    bool asksFor(const Entry& entry) const { return ray.meetsHidden || !entry.hidden; }
    double farthest() const {
        return found.count > 0 ? std::min(ray.length, found.at[0].distance + within) : ray.length;
    }
    Stretch open(int shape) const {
        return {shape == leaving.shape ? std::max(ray.begin, leaving.until) : ray.begin, farthest()};
    }
    /// Takes a hit when it is the nearest up to now, or close behind it.
    bool offer(int shape, const Meeting& meeting) {
        const Stretch stretch = open(shape);
        const bool nearest = found.count > 0 && meeting.distance < found.at[0].distance;
        if (!(meeting.distance > stretch.from && (nearest || meeting.distance < stretch.to))) return false;
        if (found.count > 0 && within == 0 && !nearest) return false;
        insert({ray.origin + meeting.distance * ray.direction, meeting.normal, meeting.smoothNormal, shape,
                meeting.distance});
        return true;
    }
    /// How far Embree still has to look, rounded up.
    float reach() const {
        const double to = farthest();
        if (to == kInfinity) return float(kInfinity);
        return std::nextafter(float(to - start) * (1 + 1e-5f), float(kInfinity));
    }

private:
    void insert(const Hit& hit) {
        const auto enters = [&](const Hit& one) { return glm::dot(one.normal, ray.direction) < 0; };
        Hits kept;
        const auto keep = [&](const Hit& one) {
            if (kept.count == Hits::kMost) return;
            if (kept.count > 0 && one.distance > kept.at[0].distance + within) return;
            for (const Hit& other : kept)
                if (other.shape == one.shape && enters(other) == enters(one)) return;
            kept.at[std::size_t(kept.count++)] = one;
        };
        const Hit* next = found.begin();
        while (next != found.end() && next->distance <= hit.distance)
            keep(*next++);
        keep(hit);
        while (next != found.end())
            keep(*next++);
        found = kept;
    }
};

void reportBox(const RTCBoundsFunctionArguments* given) {
    const Box& box = static_cast<const Entry*>(given->geometryUserPtr)->box;
    *given->bounds_o = {float(box.low.x),  float(box.low.y),  float(box.low.z),  0,
                        float(box.high.x), float(box.high.y), float(box.high.z), 0};
}

template <class Kind>
void intersectShape(const RTCIntersectFunctionNArguments* given) {
    if (!given->valid[0]) return;
    Query& query = Query::of(given->context);
    const Entry& entry = *static_cast<const Entry*>(given->geometryUserPtr);
    if (!query.asksFor(entry)) return;
    const int shape = int(given->geomID);
    const auto meeting = meet(std::get<Kind>(entry.shape), query.ray, query.open(shape));
    if (!meeting || !query.offer(shape, *meeting)) return;
    auto* found = reinterpret_cast<RTCRayHit*>(given->rayhit);
    found->ray.tfar = query.reach();
    found->hit.geomID = given->geomID;
}

template <class Kind>
void occludeShape(const RTCOccludedFunctionNArguments* given) {
    if (!given->valid[0]) return;
    const Query& query = Query::of(given->context);
    const Entry& entry = *static_cast<const Entry*>(given->geometryUserPtr);
    if (!query.asksFor(entry)) return;
    if (blocks(std::get<Kind>(entry.shape), query.ray, query.open(int(given->geomID))))
        reinterpret_cast<RTCRay*>(given->ray)->tfar = -float(kInfinity);
}

/// Takes or refuses a triangle by its exact distance.
void filterTriangle(const RTCFilterFunctionNArguments* given) {
    Query& query = Query::of(given->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(given->hit);
    const Entry& entry = *static_cast<const Entry*>(given->geometryUserPtr);
    const auto meeting = query.asksFor(entry)
                             ? meetTriangle(std::get<Triangles>(entry.shape), hit->primID, query.ray)
                             : std::nullopt;
    if (meeting && query.offer(int(hit->geomID), *meeting))
        reinterpret_cast<RTCRay*>(given->ray)->tfar = query.reach();
    else
        given->valid[0] = 0;
}

/// The nearest place of one triangle: a corner, on an edge, or inside (Ericson, Real-Time Collision
/// Detection, 2005, 5.1.5).
dvec3 nearestWeights(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& point) {
    const dvec3 ab = b - a, ac = c - a;
    const double d1 = glm::dot(ab, point - a), d2 = glm::dot(ac, point - a);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = glm::dot(ab, point - b), d4 = glm::dot(ac, point - b);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double overC = d1 * d4 - d3 * d2;
    if (overC <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = glm::dot(ab, point - c), d6 = glm::dot(ac, point - c);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double overB = d5 * d2 - d1 * d6;
    if (overB <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double overA = d3 * d6 - d5 * d4;
    if (overA <= 0 && d4 >= d3 && d5 >= d6) {
        const double along = (d4 - d3) / (d4 - d3 + d5 - d6);
        return {0, 1 - along, along};
    }
    const double sum = overA + overB + overC;
    return {overA / sum, overB / sum, overC / sum};
}

/// The nearest triangle up to now.
struct Search {
    const std::vector<Entry>& entries;
    dvec3 point;
    double room;
    std::optional<Nearest> found;

    static bool offer(RTCPointQueryFunctionArguments* given) {
        Search& search = *static_cast<Search*>(given->userPtr);
        const auto* mesh = std::get_if<Triangles>(&search.entries[given->geomID].shape);
        if (!mesh) return false;
        const std::uint32_t* index = &mesh->indices[3 * std::size_t(given->primID)];
        const dvec3 &a = mesh->positions[index[0]], &b = mesh->positions[index[1]],
                    &c = mesh->positions[index[2]];
        const dvec3 weights = nearestWeights(a, b, c, search.point);
        const double distance = glm::distance(search.point, weights.x * a + weights.y * b + weights.z * c);
        if (search.found && distance >= search.found->distance) return false;
        search.found = Nearest{given->primID, weights, distance};
        given->query->radius = std::min(given->query->radius, float((distance + search.room) * (1 + 1e-5)));
        return true;
    }
};

} // namespace

struct RayScene::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<Entry> entries; ///< never moved once Embree knows them
    Box box;
    dvec3 middle{0}; ///< of the box: Embree's origin, where floats are densest
    double room = 0; ///< what Embree may be wrong by, and more, m

    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void attach(const RTCGeometry geometry, std::size_t number) {
        rtcSetGeometryUserData(geometry, &entries[number]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, unsigned(number));
        rtcReleaseGeometry(geometry);
    }
    void add(const Triangles& mesh, std::size_t number) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree's own buffers: shared ones must be readable past their end.
        auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), mesh.positions.size()));
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
        for (const dvec3& position : mesh.positions)
            *corners++ = vec3(position - middle);
        std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(indices));
        rtcSetGeometryIntersectFilterFunction(geometry, filterTriangle);
        rtcSetGeometryOccludedFilterFunction(geometry, filterTriangle);
        attach(geometry, number);
    }
    template <class Kind>
    void add(const Kind&, std::size_t number) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcSetGeometryBoundsFunction(geometry, reportBox, nullptr);
        rtcSetGeometryIntersectFunction(geometry, intersectShape<Kind>);
        rtcSetGeometryOccludedFunction(geometry, occludeShape<Kind>);
        attach(geometry, number);
    }
    RTCRay ray(const Query& query) const {
        const dvec3 from = (query.ray.origin - middle) + query.start * query.ray.direction;
        RTCRay ray{};
        ray.org_x = float(from.x), ray.org_y = float(from.y), ray.org_z = float(from.z);
        ray.dir_x = float(query.ray.direction.x), ray.dir_y = float(query.ray.direction.y);
        ray.dir_z = float(query.ray.direction.z);
        ray.tfar = query.reach();
        ray.mask = ~0u;
        return ray;
    }
};

RayScene::RayScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::create(std::vector<Shape> shapes, const std::vector<bool>& hidden) {
    auto state = std::make_unique<State>();
    // One thread builds the tree: several programs may be at work on one picture.
    state->device = rtcNewDevice("threads=1");
    if (!state->device)
        return Error{"truth: Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                         "); must run on this processor",
                     Fault::Machine};
    for (Shape& shape : shapes) {
        const Box box = std::visit([](const auto& known) { return boxOf(known); }, shape);
        state->box.add(box);
        const std::size_t number = state->entries.size();
        state->entries.push_back({std::move(shape), box, !hidden.empty() && hidden[number]});
    }
    // Embree's floats know places in the box to about 1e-7 of its size: a hundred times that is room enough.
    if (!state->entries.empty()) {
        const double room = state->room = 1e-5 * glm::distance(state->box.low, state->box.high);
        state->middle = 0.5 * (state->box.low + state->box.high);
        state->box = {state->box.low - 2 * room, state->box.high + 2 * room};
        for (Entry& entry : state->entries)
            entry.box = {entry.box.low - state->middle - room, entry.box.high - state->middle + room};
    }

    state->scene = rtcNewScene(state->device);
    rtcSetSceneFlags(state->scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < state->entries.size(); ++i)
        std::visit([&](const auto& known) { state->add(known, i); }, state->entries[i].shape);
    rtcCommitScene(state->scene);
    if (const RTCError error = rtcGetDeviceError(state->device); error != RTC_ERROR_NONE)
        return Error{"truth: Embree cannot hold the scene (error " + std::to_string(error) +
                         "); must have more memory or a smaller scene",
                     Fault::Machine};
    return RayScene(std::move(state));
}

Hits RayScene::search(const WorldRay& ray, const Leaving& leaving, double within) const {
    const Stretch inside = truth::within(state_->box, ray);
    if (!(inside.from < inside.to)) return {};
    Query query(ray, leaving, within, inside.from - state_->room);
    RTCRayHit found{};
    found.ray = state_->ray(query);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(state_->scene, &query.context, &found);
    return query.found;
}

std::optional<Hit> RayScene::intersect(const WorldRay& ray, const Leaving& leaving) const {
    const Hits hits = search(ray, leaving, 0);
    return hits.count > 0 ? std::optional(hits.at[0]) : std::nullopt;
}

Hits RayScene::meet(const WorldRay& ray, const Leaving& leaving) const { return search(ray, leaving, gap()); }

bool RayScene::occluded(const WorldRay& ray, const Leaving& leaving) const {
    const Stretch inside = truth::within(state_->box, ray);
    if (!(inside.from < inside.to)) return false;
    Query query(ray, leaving, 0, inside.from - state_->room);
    RTCRay found = state_->ray(query);
    rtcOccluded1(state_->scene, &query.context, &found);
    return found.tfar < 0;
}

std::optional<Nearest> RayScene::nearest(const dvec3& point) const {
    Search search{state_->entries, point, state_->room, {}};
    const dvec3 from = point - state_->middle;
    RTCPointQuery query{float(from.x), float(from.y), float(from.z), 0, float(kInfinity)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(state_->scene, &query, &context, Search::offer, &search);
    return search.found;
}

double RayScene::gap() const { return 1e-4 * state_->room; }

const Shape& RayScene::shape(int number) const { return state_->entries[std::size_t(number)].shape; }

Sphere RayScene::around(int number) const {
    const Entry& entry = state_->entries[std::size_t(number)];
    const dvec3 middle = state_->middle + 0.5 * (entry.box.low + entry.box.high);
    if (const auto* ball = std::get_if<Sphere>(&entry.shape)) return {ball->center, ball->radius};
    return {middle, 0.5 * glm::distance(entry.box.low, entry.box.high)};
}

} // namespace lucent::truth
