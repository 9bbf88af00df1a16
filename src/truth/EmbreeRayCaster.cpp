#include "truth/RayCaster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A query as Embree hands it through to the callbacks.
struct Passed {
    RTCIntersectContext context; // first: Embree knows the whole by its address
    Query& query;
    double start; ///< where Embree's own ray begins

    Passed(Query& query, double start) : query(query), start(start) { rtcInitIntersectContext(&context); }
    static Passed& of(RTCIntersectContext* context) { return *reinterpret_cast<Passed*>(context); }

    /// How far Embree still has to look, rounded up.
    float reach() const {
        const double to = query.farthest();
        if (to == kInfinity) return float(kInfinity);
        return std::nextafter(float(to - start) * (1 + 1e-5f), float(kInfinity));
    }
};

/// What callbacks know of a shape.
struct Known {
    const Entry* entry;
    dvec3 middle;
    double room;
};

void reportBox(const RTCBoundsFunctionArguments* given) {
    const Known& known = *static_cast<const Known*>(given->geometryUserPtr);
    const Box part = boxOf(known.entry->shape, given->primID);
    const Box box{part.low - known.room - known.middle, part.high + known.room - known.middle};
    *given->bounds_o = {float(box.low.x),  float(box.low.y),  float(box.low.z),  0,
                        float(box.high.x), float(box.high.y), float(box.high.z), 0};
}

void intersectShape(const RTCIntersectFunctionNArguments* given) {
    if (!given->valid[0]) return;
    const Passed& passed = Passed::of(given->context);
    const Entry& entry = *static_cast<const Known*>(given->geometryUserPtr)->entry;
    if (!passed.query.asksFor(entry)) return;
    const int shape = int(given->geomID);
    const auto intersection =
        intersect(entry.shape, given->primID, passed.query.ray(), passed.query.open(shape));
    if (!intersection || !passed.query.offer(shape, *intersection)) return;
    auto* found = reinterpret_cast<RTCRayHit*>(given->rayhit);
    found->ray.tfar = passed.reach();
    found->hit.geomID = given->geomID;
}

void occludeShape(const RTCOccludedFunctionNArguments* given) {
    if (!given->valid[0]) return;
    const Query& query = Passed::of(given->context).query;
    const Entry& entry = *static_cast<const Known*>(given->geometryUserPtr)->entry;
    if (!query.asksFor(entry)) return;
    if (blocks(entry.shape, given->primID, query.ray(), query.open(int(given->geomID))))
        reinterpret_cast<RTCRay*>(given->ray)->tfar = -float(kInfinity);
}

/// Takes or refuses a triangle by its exact distance.
void filterTriangle(const RTCFilterFunctionNArguments* given) {
    const Passed& passed = Passed::of(given->context);
    const auto* hit = reinterpret_cast<const RTCHit*>(given->hit);
    const Entry& entry = *static_cast<const Known*>(given->geometryUserPtr)->entry;
    const auto intersection =
        passed.query.asksFor(entry)
            ? intersectTriangle(std::get<Triangles>(entry.shape), hit->primID, passed.query.ray())
            : std::nullopt;
    if (intersection && passed.query.offer(int(hit->geomID), *intersection))
        reinterpret_cast<RTCRay*>(given->ray)->tfar = passed.reach();
    else
        given->valid[0] = 0;
}

class EmbreeRayCaster : public RayCaster {
public:
    EmbreeRayCaster(const std::vector<Entry>& entries, const dvec3& middle, double room)
        : entries_(entries), middle_(middle), room_(room) {}
    ~EmbreeRayCaster() override {
        if (scene_) rtcReleaseScene(scene_);
        if (device_) rtcReleaseDevice(device_);
    }

    Status build() {
        // One thread builds the tree: several programs may be at work on one picture.
        device_ = rtcNewDevice("threads=1");
        if (!device_)
            return Error{"truth: Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                             "); must run on this processor",
                         Fault::Machine};
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        for (const Entry& entry : entries_)
            known_.push_back({&entry, middle_, room_});
        for (std::size_t i = 0; i < entries_.size(); ++i)
            add(i);
        rtcCommitScene(scene_);
        if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
            return Error{"truth: Embree cannot hold the scene (error " + std::to_string(error) +
                             "); must have more memory or a smaller scene",
                         Fault::Machine};
        return Done{};
    }

    void find(Query& query) const override {
        Passed passed(query, query.enters() - room_);
        RTCRayHit found{};
        found.ray = rayOf(passed);
        found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &passed.context, &found);
    }
    bool isBlocked(Query& query) const override {
        Passed passed(query, query.enters() - room_);
        RTCRay found = rayOf(passed);
        rtcOccluded1(scene_, &passed.context, &found);
        return found.tfar < 0;
    }
    void find(Search& search) const override {
        Looking looking{entries_, room_, search};
        const dvec3 from = search.point() - middle_;
        RTCPointQuery query{float(from.x), float(from.y), float(from.z), 0, float(kInfinity)};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_, &query, &context, Looking::offer, &looking);
    }

private:
    struct Looking {
        const std::vector<Entry>& entries;
        double room;
        Search& search;

        static bool offer(RTCPointQueryFunctionArguments* given) {
            const Looking& looking = *static_cast<Looking*>(given->userPtr);
            const auto* mesh = std::get_if<Triangles>(&looking.entries[given->geomID].shape);
            if (!mesh || !looking.search.offer(*mesh, given->primID)) return false;
            const auto radius = float((looking.search.farthest() + looking.room) * (1 + 1e-5));
            given->query->radius = std::min(given->query->radius, radius);
            return true;
        }
    };

    void add(std::size_t number) {
        const auto* mesh = std::get_if<Triangles>(&entries_[number].shape);
        const RTCGeometry geometry = mesh ? triangles(*mesh) : shape(partsOf(entries_[number].shape));
        rtcSetGeometryUserData(geometry, &known_[number]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_, geometry, unsigned(number));
        rtcReleaseGeometry(geometry);
    }
    RTCGeometry triangles(const Triangles& mesh) const {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree's own buffers: shared ones must be readable past their end.
        auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), mesh.positions.size()));
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
        for (const dvec3& position : mesh.positions)
            *corners++ = vec3(position - middle_);
        std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(indices));
        rtcSetGeometryIntersectFilterFunction(geometry, filterTriangle);
        rtcSetGeometryOccludedFilterFunction(geometry, filterTriangle);
        return geometry;
    }
    RTCGeometry shape(unsigned parts) const {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, parts);
        rtcSetGeometryBoundsFunction(geometry, reportBox, nullptr);
        rtcSetGeometryIntersectFunction(geometry, intersectShape);
        rtcSetGeometryOccludedFunction(geometry, occludeShape);
        return geometry;
    }
    RTCRay rayOf(const Passed& passed) const {
        const WorldRay& world = passed.query.ray();
        const dvec3 from = (world.origin - middle_) + passed.start * world.direction;
        RTCRay ray{};
        ray.org_x = float(from.x), ray.org_y = float(from.y), ray.org_z = float(from.z);
        ray.dir_x = float(world.direction.x), ray.dir_y = float(world.direction.y);
        ray.dir_z = float(world.direction.z);
        ray.tfar = passed.reach();
        ray.mask = ~0u;
        return ray;
    }

    const std::vector<Entry>& entries_;
    std::vector<Known> known_; // never moved once Embree knows them
    dvec3 middle_;
    double room_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace

Result<std::unique_ptr<RayCaster>> findByEmbree(const std::vector<Entry>& entries, const dvec3& middle,
                                                double room) {
    auto caster = std::make_unique<EmbreeRayCaster>(entries, middle, room);
    if (Status built = caster->build(); !built) return built.error();
    return std::unique_ptr<RayCaster>(std::move(caster));
}

} // namespace lucent::truth
