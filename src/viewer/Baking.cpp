// What techniques work out once for an object: a page lets a worker do it, and objects are drawn without
// until it is there.
#include "viewer/State.h"

namespace lucent::viewer {

// Makes objects ones that are drawn without what is not there; the first that is missing is noted.
void Viewer::State::leaveOutMissing(scene::Scene& drawn) {
    if (!bakesElsewhere) return;
    for (std::size_t i = 0; i < drawn.objects.size(); ++i)
        for (const technique::Technique* one : technique::all()) {
            scene::Object& object = drawn.objects[i];
            if (!one->baker || !one->baker->takes(object)) continue;
            const std::string work = one->baker->missing(drawn.technique.at(std::string(one->name)), object);
            if (work.empty()) continue;
            if (!missingBake) missingBake = MissingBake{one, work, drawn, i};
            one->baker->leaveOut(object);
        }
}

// The object alone, with the settings of which something is missing: the work needs no light.
std::vector<std::pair<std::string, Bytes>> Viewer::askBake() const {
    if (!state_->missingBake) return {};
    const State::MissingBake& missing = *state_->missingBake;
    scene::Scene asked = missing.scene;
    asked.objects = {missing.scene.objects[missing.object]};
    asked.lights.clear();
    asked.objects[0].painting.reset();
    asked.environment.reset();
    return packScene(std::move(asked));
}

Status Viewer::takeBake(const std::string& work, std::span<const std::byte> file) {
    State& s = *state_;
    if (!s.missingBake || s.missingBake->work != work)
        return Error{"bake " + work + ": is not awaited any more"};
    const scene::Scene& scene = s.missingBake->scene;
    const technique::Baker& baker = *s.missingBake->technique->baker;
    const Settings& settings = scene.technique.at(std::string(s.missingBake->technique->name));
    std::vector<const scene::Object*> objects; // there may be several of the same mesh and material
    for (const scene::Object& object : scene.objects)
        if (baker.takes(object) && baker.missing(settings, object) == work) objects.push_back(&object);
    if (Status taken = baker.take(settings, objects, file); !taken) return taken;
    s.stale = true;
    s.settled = false;
    s.dropSides();
    return Done{};
}

void Viewer::setBakesElsewhere(bool elsewhere) { state_->bakesElsewhere = elsewhere; }

} // namespace lucent::viewer
