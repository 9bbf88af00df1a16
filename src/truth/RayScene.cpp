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

Box boxOf(const scene::Mesh& mesh) {
    Box box;
    for (const vec3& position : mesh.positions)
        box.add(dvec3(position));
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

/// Part of a ray that lies in a box; empty when it passes by.
Stretch within(const Box& box, const WorldRay& ray) {
    Stretch stretch{0, ray.length};
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

/// What a ray meets of one shape: how far, and the normal there.
struct Meeting {
    double distance;
    dvec3 normal;
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

/// A triangle of a mesh that Embree has found, solved again by its plane.
Meeting meetTriangle(const scene::Mesh& mesh, unsigned triangle, const WorldRay& ray) {
    const auto corner = [&](unsigned which) {
        return dvec3(mesh.positions[mesh.indices[3 * triangle + which]]);
    };
    const dvec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    return {glm::dot(corner(0) - ray.origin, normal) / glm::dot(ray.direction, normal), normal};
}

/// One question to the scene: Embree hands it through to the callbacks.
struct Query {
    RTCIntersectContext context; // first: Embree knows the whole by its address
    WorldRay ray;
    Leaving leaving;
    double start; ///< where Embree's own ray begins
    std::optional<Hit> nearest;

    Query(const WorldRay& ray, const Leaving& leaving, double start)
        : ray(ray), leaving(leaving), start(start) {
        rtcInitIntersectContext(&context);
    }
    static Query& of(RTCIntersectContext* context) { return *reinterpret_cast<Query*>(context); }

    Stretch open(int shape) const {
        return {shape == leaving.shape ? leaving.until : 0, nearest ? nearest->distance : ray.length};
    }
    /// Takes a hit when it is the nearest up to now.
    bool offer(int shape, const Meeting& meeting) {
        const Stretch stretch = open(shape);
        if (!(meeting.distance > stretch.from && meeting.distance < stretch.to)) return false;
        nearest = Hit{ray.origin + meeting.distance * ray.direction, meeting.normal, shape, meeting.distance};
        return true;
    }
    /// How far Embree still has to look, rounded up.
    float reach() const {
        const double to = nearest ? nearest->distance : ray.length;
        return to == kInfinity ? float(kInfinity)
                               : std::nextafter(float(to - start) * (1 + 1e-5f), float(kInfinity));
    }
};

/// What Embree's callbacks know of a shape.
struct Entry {
    Shape shape;
    Box box; ///< a little larger than the shape, from the middle of the scene
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
    const int shape = int(given->geomID);
    const auto meeting = meet(std::get<Kind>(static_cast<const Entry*>(given->geometryUserPtr)->shape),
                              query.ray, query.open(shape));
    if (!meeting || !query.offer(shape, *meeting)) return;
    auto* found = reinterpret_cast<RTCRayHit*>(given->rayhit);
    found->ray.tfar = query.reach();
    found->hit.geomID = given->geomID;
}

template <class Kind>
void occludeShape(const RTCOccludedFunctionNArguments* given) {
    if (!given->valid[0]) return;
    const Query& query = Query::of(given->context);
    if (blocks(std::get<Kind>(static_cast<const Entry*>(given->geometryUserPtr)->shape), query.ray,
               query.open(int(given->geomID))))
        reinterpret_cast<RTCRay*>(given->ray)->tfar = -float(kInfinity);
}

/// Takes or refuses a triangle by its exact distance.
void filterTriangle(const RTCFilterFunctionNArguments* given) {
    Query& query = Query::of(given->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(given->hit);
    const auto& mesh = std::get<scene::Mesh>(static_cast<const Entry*>(given->geometryUserPtr)->shape);
    if (!query.offer(int(hit->geomID), meetTriangle(mesh, hit->primID, query.ray))) given->valid[0] = 0;
}
} // namespace

struct RayScene::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<Entry> entries; ///< never moved once Embree knows them
    Box box;
    dvec3 middle{0}; ///< of the box: Embree's origin, where floats are densest

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
    void add(const scene::Mesh& mesh, std::size_t number) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree's own buffers: shared ones must be readable past their end.
        auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), mesh.positions.size()));
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
        for (const vec3& position : mesh.positions)
            *corners++ = vec3(dvec3(position) - middle);
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

Result<RayScene> RayScene::create(std::vector<Shape> shapes) {
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
        state->entries.push_back({std::move(shape), box});
    }
    // Embree's floats know places in the box to about 1e-7 of its size: a hundred times that is room enough.
    if (!state->entries.empty()) {
        const double room = 1e-5 * glm::distance(state->box.low, state->box.high);
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

std::optional<Hit> RayScene::intersect(const WorldRay& ray, const Leaving& leaving) const {
    const Stretch inside = within(state_->box, ray);
    if (!(inside.from < inside.to)) return {};
    Query query(ray, leaving, inside.from);
    RTCRayHit found{};
    found.ray = state_->ray(query);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(state_->scene, &query.context, &found);
    return query.nearest;
}

bool RayScene::occluded(const WorldRay& ray, const Leaving& leaving) const {
    const Stretch inside = within(state_->box, ray);
    if (!(inside.from < inside.to)) return false;
    Query query(ray, leaving, inside.from);
    RTCRay found = state_->ray(query);
    rtcOccluded1(state_->scene, &query.context, &found);
    return found.tfar < 0;
}

} // namespace lucent::truth
