// The scene of a viewer: its controls, what is set, what is taken back.
#include "viewer/State.h"

#include "light/EnvironmentLights.h"
#include "scene/Bring.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lucent::viewer {

namespace {

constexpr double kBurst = 1; // s within which changes of one parameter are one step

// Settings of a technique that this scene does not need, and those that do nothing beside others.
bool isIdle(const scene::Scene& scene, std::string_view path) {
    for (const auto& [name, settings] : scene.technique) {
        const std::string owner = "technique." + name + ".";
        if (!path.starts_with(owner)) continue;
        const std::string_view id = path.substr(owner.size());
        return !technique::acts(scene, name, id);
    }
    return false;
}

// A parameter of an object that could be made clear and is not: it stands behind those of clear ones.
bool isClouded(const scene::Scene& scene, std::string_view path) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const scene::Object& object) {
        return !object.material.isRefractive() && path.starts_with("objects." + object.name + ".");
    });
}

bool kindsDiffer(const std::vector<scene::Material>& a, const std::vector<scene::Material>& b) {
    return !std::equal(a.begin(), a.end(), b.begin(), [](const scene::Material& x, const scene::Material& y) {
        return x.kind.index() == y.kind.index();
    });
}

// A choice of how something is drawn.
bool isMethod(const BoundParam& bound) {
    return (bound.param->kind == Kind::Choice && bound.param->group != Group::None) ||
           isPrecomputing(bound.path);
}

} // namespace

// @param isCamera  nothing else has changed: what is shown can be reprojected
void Viewer::State::changed(bool isCamera) {
    ++revision;
    if (!isCamera) ++content;
    stale = true;
    settled = false;
}

void Viewer::State::adopt(scene::Scene newScene) {
    scene = std::make_unique<scene::Scene>(std::move(newScene));
    ++sceneNumber;
    loaded.clear();
    offered.clear();
    play = {};
    mode = {.mode = modeFor(*scene), .accuracy = mode.accuracy};
    began = {};
    history.clear();
    grip = Grip::None;
    painter.clear();
    paintDefaults = brushFor(*scene);
    paintSettings.brush.radius = paintDefaults.brush.radius; // of the others a person has chosen
    picking.reset();
    downscale = context->caps().software ? 4 : 1; // until it is known
    light = 0;
    message.clear();
    asLoaded = right = *scene;
    for (const BoundParam& bound : bindBeside(*right))
        loaded.emplace(bound.path, getText(*bound.param, bound.data));
    asked.reset();
    dropTruth();
    dropTime.reset();
    balance.clear();
    bind();
    changed();
}

// A new environment shines as brightly on what faces it as the one before; where there was none as lamps do,
// and both together are exposed as those were alone.
void Viewer::State::shineBy(const std::string& source, std::shared_ptr<const Image> map) {
    const Lighting held = lighting();
    std::optional<scene::Environment>& environment = scene->environment;
    float& exposure = scene->view.exposure;
    const float before = environment && environment->enabled ? views::brightestWhite(*environment) : 0;
    const float wanted = before > 0 ? before : scene::kBrightest / std::exp2(exposure);
    if (before <= 0 && !scene->lights.empty()) exposure -= 1;
    if (!environment) environment.emplace();
    environment->source = source;
    environment->map = std::move(map);
    environment->enabled = true;
    environment->intensity = 1;
    environment->kept = {};
    const float white = views::brightestWhite(*environment);
    if (white > 0) environment->intensity = wanted / white;
    beginLightingAnew();
    history.record(++gesture, {.path = "environment",
                               .before = "",
                               .after = "",
                               .conversion = {},
                               .relighting = Relighting{held, lighting()}});
}

Lighting Viewer::State::lighting() const { return {scene->environment, scene->view.exposure}; }

// As if they were loaded as they are.
void Viewer::State::beginLightingAnew() {
    for (const char* path : {"environment.intensity", "view.exposure"})
        loaded.erase(path);
}

// The controls of the scene as it is now.
void Viewer::State::bind() {
    controls.clear();
    std::vector<BoundParam> modes = bindMode(mode, *scene, automaticError);
    offer(std::move(modes[0]), loaded.emplace("mode", nameOf(mode.mode)).first->second);
    offerOfView(std::move(modes[1]));
    offerOfView(std::move(modes[2]));
    for (BoundParam& bound : scene::bindParams(*scene)) {
        if (isIdle(*scene, bound.path)) bound.shown = false;
        if (bound.data == &scene->view.time) offerOfView(bindPlaying(play, bound.shown));
        // A parameter met for the first time is as it was loaded.
        const auto found = loaded.emplace(bound.path, getText(*bound.param, bound.data)).first;
        offer(std::move(bound), found->second);
    }
    for (BoundParam& bound : bindCompare(compare))
        offerOfView(std::move(bound));
    for (BoundParam& bound : bindBeside(*right)) {
        const std::string path = bound.path.substr(kBeside.size());
        const bool isAsked = isOfRight(compare.mode, path) || !attributeName(bound).empty();
        if (!isAsked && isOfRight(CompareMode::Materials, path)) continue; // there are many
        const bool isOffered = compare.mode == CompareMode::Materials ? bound.shown : isMethod(bound);
        bound.shown = isOfRight(compare.mode, path) && isOffered && !isIdle(*scene, path);
        const auto found = loaded.emplace(bound.path, getText(*bound.param, bound.data)).first;
        controls.push_back({std::move(bound), found->second});
    }
    for (BoundParam& bound : bindPaint(paintSettings, paintDefaults, mode.mode == paintMode())) {
        const std::string before = getText(*bound.param, bound.defaults);
        controls.push_back({std::move(bound), before}); // another brush has other values
    }
    for (Control& control : controls)
        offerChoices(control);
    const auto place = [&](const Control& control) {
        const Group group = control.bound.group();
        return std::pair(placeOf(group, mode.mode),
                         group == Group::Refraction && isClouded(*scene, control.bound.path));
    };
    std::stable_sort(controls.begin(), controls.end(),
                     [&](const Control& a, const Control& b) { return place(a) < place(b); });
}

// Leaves out choices that do nothing here, but for the one that is made.
void Viewer::State::offerChoices(Control& control) const {
    if (control.bound.data == &scene->view.show) control.choices = viewsOf(mode.mode, scene->view.show);
    const std::string chosen = getText(*control.bound.param, control.bound.data);
    if (control.bound.isDerived() && !control.choices.empty() && chosen != control.choices.front())
        control.choices.erase(control.choices.begin()); // own
}

// What the panel has shown stays in it: a slider must not vanish under the hand that drags it to 0.
void Viewer::State::offer(BoundParam bound, const std::string& before) {
    if (bound.shown) offered.insert(bound.path);
    bound.shown = offered.contains(bound.path);
    controls.push_back({std::move(bound), before});
}

void Viewer::State::offerOfView(BoundParam bound) {
    const std::string before = getText(*bound.param, bound.defaults);
    offer(std::move(bound), before);
}

// What belongs to the view alone: it is in no scene file.
std::vector<BoundParam> Viewer::State::bindView() {
    std::vector<BoundParam> bound = bindCompare(compare);
    for (BoundParam& setting : bindBeside(*right))
        bound.push_back(std::move(setting));
    for (BoundParam& paint : bindPaint(paintSettings, paintDefaults, true))
        bound.push_back(std::move(paint));
    for (BoundParam& one : bindMode(mode, *scene, automaticError))
        bound.push_back(std::move(one));
    if (const Control* playing = find("playing"); playing && playing->bound.shown)
        bound.push_back(playing->bound);
    return bound;
}

const Control* Viewer::State::find(const std::string& path) const {
    const auto found = std::find_if(controls.begin(), controls.end(),
                                    [&](const Control& c) { return c.bound.path == path; });
    return found == controls.end() ? nullptr : &*found;
}

// The path may be an alias (an object's number), so what changed is found by looking.
Status Viewer::State::change(const std::string& path, const std::string& value, std::uint64_t step) {
    for (const BoundParam& bound : bindView())
        if (bound.path == path) return changeView(bound, value);
    const auto textOf = [](const Control& c) { return getText(*c.bound.param, c.bound.data); };
    std::vector<std::string> before;
    for (const Control& control : controls)
        before.push_back(textOf(control));
    const std::vector<scene::Material> held = materials();
    const Control* control = find(path);
    const bool isComputed = control && control->bound.isComputed();
    if (isComputed) beginAt(path, step);
    if (Status set = scene::setParam(*scene, path, value); !set) {
        setMaterials(held);
        return set;
    }
    const bool converted = kindsDiffer(held, materials());
    if (converted) history.record(step, {"materials", "", "", Conversion{held, materials()}});
    bool any = converted, isCamera = !converted;
    // What another kind had is gone, and with it what the controls point to.
    for (std::size_t i = 0; i < controls.size() && !converted; ++i) {
        if (controls[i].bound.isComputed() || textOf(controls[i]) == before[i]) continue;
        history.record(step, {controls[i].bound.path, before[i], textOf(controls[i])});
        any = true;
        isCamera = isCamera && controls[i].bound.path.starts_with("camera.");
    }
    if (!any) return Done{};
    bind(); // the projection decides what is bound
    changed(isCamera);
    if (isComputed) began.revision = revision;
    return Done{};
}

// A value that is computed from others is carried back to them as they were when its gesture began: however
// often a drag passes a place, it finds the same numbers there.
void Viewer::State::beginAt(const std::string& path, std::uint64_t step) {
    if (began.path != path || began.step != step || began.revision != revision) {
        began = {path, step, revision, materials()};
        return;
    }
    setMaterials(began.materials);
}

std::vector<scene::Material> Viewer::State::materials() const {
    std::vector<scene::Material> list;
    for (const scene::Object& object : scene->objects)
        list.push_back(object.material);
    return list;
}

void Viewer::State::setMaterials(const std::vector<scene::Material>& list) {
    for (std::size_t i = 0; i < scene->objects.size(); ++i)
        scene->objects[i].material = list[i];
}

// Goes back to the value as loaded. What no value says (a material of nobody's measurement) goes back with
// all numbers of its object that it is computed from.
void Viewer::State::reset(const std::string& path) {
    const Control* control = find(path);
    if (!control) return;
    const std::uint64_t step = burst(path);
    const bool isComputed = control->bound.isComputed();
    if (change(path, std::string(control->loaded), step) || !isComputed) return;
    const std::string owner = path.substr(0, path.rfind('.') + 1);
    const std::vector<Control> before = controls; // change() binds anew
    for (const Control& one : before)
        if (one.bound.path.starts_with(owner) && !one.bound.isComputed())
            (void)change(one.bound.path, one.loaded, step);
}

// What belongs to the view alone is no step to take back, and changes no picture but by `matt`,
// `accuracy` and layers of paint.
Status Viewer::State::changeView(const BoundParam& bound, const std::string& value) {
    const bool isBeside = bound.path.starts_with(kBeside);
    if (isBeside && isOfRight(CompareMode::Materials, bound.path.substr(kBeside.size())))
        return changeRight(bound.path.substr(kBeside.size()), value);
    const std::string before = getText(*bound.param, bound.data);
    if (Status set = setText(*bound.param, bound.data, value); !set)
        return Error{bound.path + " " + set.error().message};
    if (getText(*bound.param, bound.data) == before) return Done{};
    if (isBeside || bound.data == &compare.mode) dropSides();
    if (bound.data == &mode.mode || bound.data == &compare.mode || bound.path.starts_with("paint.") ||
        isBeside)
        bind(); // other controls stand there
    const bool seen = bound.data == &mode.matt || bound.data == &mode.accuracy ||
                      bound.data == &paintSettings.layer ||
                      (bound.data == &mode.mode && paintSettings.layer != scene::PaintLayer::None);
    if (seen) {
        stale = true;
        ++content;
    }
    ++revision;
    settled = false;
    return Done{};
}

// Another kind of material takes other parameters with it.
Status Viewer::State::changeRight(const std::string& path, const std::string& value) {
    if (Status set = scene::setParam(*right, path, value); !set)
        return Error{std::string(kBeside) + set.error().message};
    dropSides();
    bind();
    ++revision;
    return Done{};
}

// Sets what a gesture moved. A value out of its range stays where it was: the end of the way has been
// reached.
void Viewer::State::assign(const void* member, vec3 value) {
    for (const Control& control : controls)
        if (control.bound.data == member) {
            (void)change(std::string(control.bound.path), getText(*control.bound.param, &value), gesture);
            return; // change() has bound the controls anew
        }
}

void Viewer::State::assign(const void* member, float value) { assign(member, vec3(value)); }

void Viewer::State::apply(const std::vector<Change>& changes, bool back) {
    for (const Change& one : changes) {
        const std::string& value = back ? one.before : one.after;
        if (one.conversion)
            setMaterials(back ? one.conversion->before : one.conversion->after);
        else if (one.relighting)
            relight(back ? one.relighting->before : one.relighting->after);
        else if (!one.path.starts_with(kStrokesOn))
            (void)scene::setParam(*scene, one.path, value);
        else
            for (scene::Object& object : scene->objects)
                if (one.path == kStrokesOn + object.name) painter.go(object, std::atoi(value.c_str()));
    }
    bind();
    changed();
}

void Viewer::State::relight(const Lighting& lit) {
    scene->environment = lit.environment;
    scene->view.exposure = lit.exposure;
    beginLightingAnew();
}

// Changes that do not come from a drag are one step while they keep to one parameter without a pause.
std::uint64_t Viewer::State::burst(const std::string& path) {
    const double now = secondsNow();
    if (!held && (path != burstPath || now - burstTime > kBurst)) ++gesture;
    burstPath = path;
    burstTime = now;
    return gesture;
}

} // namespace lucent::viewer
