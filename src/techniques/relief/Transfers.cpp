#include "techniques/relief/Transfers.h"

#include <chrono>

namespace lucent::relief {

namespace {

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

// Unit directions from the eye to kNodes x kNodes places spread over the footprint from corner to corner, in
// the object's space; only one where all eye rays are parallel.
std::vector<vec3> viewsOf(const scene::Object& object, const views::Eye& eye) {
    const vec4 from = eye.inObject(object.transform.worldFromObject());
    if (from.w == 0) return {vec3(from)};
    std::vector<vec3> list;
    for (int y = 0; y < Transfer::kNodes; ++y) {
        for (int x = 0; x < Transfer::kNodes; ++x) {
            const vec2 place = vec2(x, Transfer::kNodes - 1 - y) / float(Transfer::kNodes - 1) - 0.5f;
            list.push_back(glm::normalize(vec3(place * object.field().footprint(), 0) - vec3(from)));
        }
    }
    return list;
}

} // namespace

bool Transfers::ready(const scene::Scene& scene, const Settings& settings) const {
    std::size_t next = 0;
    for (const scene::Object& object : scene.objects) {
        if (!object.visible || !object.isField()) continue;
        if (next == transfers_.size() || !transfers_[next]->ready() ||
            transfers_[next]->key() != Transfer::keyOf(object, settings))
            return false;
        ++next;
    }
    return true;
}

Result<bool> Transfers::make(graph::TexturePool& pool, const std::vector<views::DrawnField>& objects,
                             const Settings& settings, double milliseconds) {
    transfers_.resize(objects.size());
    const double start = now();
    for (std::size_t i = 0; i < objects.size(); ++i) {
        Transfer::Key key = Transfer::keyOf(*objects[i].object, settings);
        if (!transfers_[i] || transfers_[i]->key() != key)
            transfers_[i] = std::make_unique<Transfer>(context_, std::move(key));
        while (!transfers_[i]->ready()) {
            if (now() - start > milliseconds) return false;
            if (Status made = transfers_[i]->step(pool, objects[i]); !made) return made.error();
        }
    }
    return true;
}

float Transfers::share() const {
    float sum = 0;
    for (const auto& transfer : transfers_)
        sum += transfer ? transfer->share() : 0;
    return sum / float(std::max<std::size_t>(1, transfers_.size()));
}

void Transfers::light(const scene::Scene& scene, const views::Eye& eye,
                      const std::vector<views::DrawnField>& objects, const Settings& settings, float error) {
    const std::vector<SmallLight> environment = smallLights(scene, settings);
    for (std::size_t i = 0; i < objects.size(); ++i)
        transfers_[i]->setEnvironment(*objects[i].object, environment, viewsOf(*objects[i].object, eye),
                                      error);
}

Result<std::vector<Transferred>> Transfers::record(graph::FrameGraph& graph) const {
    std::vector<Transferred> list;
    for (const auto& transfer : transfers_) {
        Result<graph::TextureId> irradiance = transfer->recordIrradiance(graph);
        if (!irradiance) return irradiance.error();
        list.push_back({*irradiance, transfer->gloss().handle()});
    }
    return list;
}

std::size_t Transfers::bytes() const {
    std::size_t sum = 0;
    for (const auto& transfer : transfers_)
        sum += transfer->bytes();
    return sum;
}

} // namespace lucent::relief
