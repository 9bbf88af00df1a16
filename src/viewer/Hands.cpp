// What hands do on the picture: lights, environment and camera follow drags and keys.
#include "viewer/State.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace lucent::viewer {

namespace {

// Chosen by eye or after what hands are used to.
constexpr float kDotReach = 24;                         // CSS pixels around a light's dot that grip it
constexpr float kDotReachOnUse = 12;                    // the same where a press paints or lets a drop fall
constexpr float kDividerReach = 10, kDividerTouch = 22; // CSS pixels beside it, of a mouse and of a finger
constexpr float kKeyFactor = 1.1f;
constexpr float kKeyTurn = 5.0f / 180; // half turns an arrow key
constexpr float kKeyMove = 0.02f;      // of the picture's height an arrow key
constexpr float kDropRadius = 0.04f;   // of the water's longer side
constexpr float kTrailDepth = 0.15f;   // of those that follow a drag
constexpr float kTrailStep = 12;       // CSS pixels between them

// Drags leave numbers that people can read: a tenth of what a pixel is worth, as a power of ten.
float rounded(float value, float pixelWorth) {
    const double step = std::pow(10.0, std::floor(std::log10(double(pixelWorth))) - 1);
    return float(std::round(value / step) * step);
}
vec3 rounded(vec3 value, float pixelWorth) {
    return {rounded(value.x, pixelWorth), rounded(value.y, pixelWorth), rounded(value.z, pixelWorth)};
}

} // namespace

// A relief is looked at by moving its light, everything else by walking around it.
bool Viewer::State::hasField() const {
    return std::any_of(scene->objects.begin(), scene->objects.end(),
                       [](const scene::Object& object) { return object.isField(); });
}

// Chooses the light whose dot or arrow is nearest. @return its distance in CSS pixels
float Viewer::State::pickLight(vec2 position) {
    float nearest = FLT_MAX;
    for (std::size_t i = 0; i < scene->lights.size(); ++i)
        if (const float distance = glm::distance(handleOf(i).place, position); distance < nearest) {
            nearest = distance;
            light = i;
        }
    return nearest;
}

// Chooses the light after the chosen one, for those who have no pointer.
bool Viewer::State::nextLight() {
    if (scene->lights.size() < 2) return false;
    light = (light + 1) % scene->lights.size();
    return true;
}

Viewer::State::Grip Viewer::State::gripAt(vec2 position, int button, Modifiers modifiers) {
    if (!scene || button == 1 || position.x > pictureSize().x) return Grip::None;
    if (divided() && std::abs(position.x - dividerPlace()) < (touch ? kDividerTouch : kDividerReach))
        return Grip::Divider;
    const bool isPlain = button == 0 && !modifiers.shift && !modifiers.control;
    if (isPlain && painting() && scene->view.lightDot && pickLight(position) < kDotReachOnUse)
        return Grip::Light;
    if (painting() && button == 0 && !modifiers.shift && !modifiers.control && paintPlaceAt(position))
        return Grip::Paint;
    if (painting()) return button == 0 ? Grip::Orbit : Grip::None;
    const bool forCamera = modifiers.shift == hasField();
    if (forCamera && modifiers.shift) return Grip::Orbit;
    const float distance = pickLight(position);
    const bool onWater = forCamera && !modifiers.control && waterAt(*scene, lens(), position);
    const bool onDot =
        scene->view.lightDot && !modifiers.control && distance < (onWater ? kDotReachOnUse : kDotReach);
    const bool roll = modifiers.alt || button == 2;
    if (mapShines() && !onDot && (roll || !forCamera)) return roll ? Grip::Roll : Grip::Map;
    if (button == 2) return Grip::None;
    if (forCamera && !onDot) return onWater ? Grip::Water : Grip::Orbit;
    return scene->lights.empty() ? Grip::None : Grip::Light;
}

void Viewer::State::startGrip(Grip wanted, vec2 position) {
    grip = wanted;
    gripStart = position;
    gripCamera = scene->camera;
    if (grip == Grip::Paint && !startStroke(position)) grip = Grip::None;
    if (grip == Grip::Water) (void)fall(*waterAt(*scene, lens(), position));
    if (grip == Grip::Map || grip == Grip::Roll) gripValue = scene->environment->rotation;
    if (grip != Grip::Light) return;
    const LightHandle handle = handleOf(light);
    fromBorder = handle.towards && glm::distance(handle.place, position) < kDotReach;
    if (const vec3* place = lightPlace(light))
        gripValue = *place;
    else
        gripValue = std::get<scene::DistantLight>(scene->lights[light]).direction;
}

void Viewer::State::drag(vec2 position) {
    const vec2 size = pictureSize(), turns = (position - gripStart) / std::min(size.x, size.y);
    const float degree = 180 / std::min(size.x, size.y);
    switch (grip) {
    case Grip::None:
        break;
    case Grip::Divider:
        moveDivider(position.x);
        break;
    case Grip::Light:
        moveLight(gripStart, position, turns);
        break;
    case Grip::Map:
    case Grip::Roll:
        assign(&scene->environment->rotation,
               rounded(turnedMap(gripValue, turns, grip == Grip::Roll), degree));
        break;
    case Grip::Water: {
        const auto place = waterAt(*scene, lens(), position);
        if (!place || glm::distance(position, gripStart) < kTrailStep) break;
        gripStart = position;
        (void)fall(*place, kTrailDepth);
        break;
    }
    case Grip::Paint:
        dabTo(position);
        break;
    case Grip::Orbit: {
        const float arm = glm::distance(gripCamera.eye, gripCamera.target);
        assign(&scene->camera.eye, rounded(orbited(gripCamera, turns), arm * glm::radians(degree)));
    }
    }
}

// From gripValue on, by pixels or (a distant light) by half turns. Over a relief a light keeps its height,
// elsewhere its distance from the picture.
void Viewer::State::moveLight(vec2 from, vec2 to, vec2 turns) {
    if (const vec3* place = lightPlace(light)) {
        const vec3 normal = hasField() ? vec3(0, 0, 1) : lens().forward();
        const auto underHand = fromBorder ? lens().onPlane(to, gripValue, normal) : std::nullopt;
        const vec3 moved = underHand ? *underHand : movedLight(lens(), gripValue, normal, from, to);
        vec3 readable = rounded(moved, lens().metresPerPixel(moved));
        if (hasField()) readable.z = gripValue.z;
        assign(place, readable);
        return;
    }
    auto& distant = std::get<scene::DistantLight>(scene->lights[light]);
    const float length = glm::length(gripValue);
    assign(&distant.direction, rounded(turnedLight(scene->camera, gripValue, turns), length * 0.01f));
}

// What the wheel and its keys do: the light of a relief is lifted, everything else is brought nearer.
void Viewer::State::nearer(float factor) { inMapMode() || !hasField() ? zoom(factor) : lift(factor); }

void Viewer::State::lift(float factor) {
    const vec3* place = lightPlace(light);
    if (!place) return zoom(factor);
    const float z = liftedLight(place->z, factor);
    assign(place, vec3(vec2(*place), rounded(z, std::abs(z) * 0.01f)));
}

void Viewer::State::zoom(float factor) {
    const scene::Camera closer = zoomed(scene->camera, factor);
    if (closer.type == scene::Camera::Type::Orthographic)
        assign(&scene->camera.height, rounded(closer.height, closer.height * 0.01f));
    else
        assign(&scene->camera.eye, rounded(closer.eye, glm::distance(closer.eye, closer.target) * 0.001f));
}

// Camera, lights and the environment's rotation go back to how they were loaded, as one step.
void Viewer::State::resetPose() {
    ++gesture;
    const void* rotation = scene->environment ? &scene->environment->rotation : nullptr;
    const std::vector<Control> before = controls; // change() binds anew
    for (const Control& control : before) {
        const std::string& path = control.bound.path;
        if (path.starts_with("camera.") || path.starts_with("lights.") || control.bound.data == rotation)
            (void)change(path, control.loaded, gesture);
    }
}

bool Viewer::State::arrow(vec2 step, Modifiers modifiers) {
    const vec2 turns = step * kKeyTurn;
    if (modifiers.shift == hasField()) {
        (void)burst("camera.eye");
        startGrip(Grip::Orbit, {});
        drag(turns * std::min(pictureSize().x, pictureSize().y));
    } else if (inMapMode()) {
        (void)burst("environment.rotation");
        startGrip(modifiers.alt ? Grip::Roll : Grip::Map, {});
        drag(turns * std::min(pictureSize().x, pictureSize().y));
    } else if (!scene->lights.empty()) {
        (void)burst("lights");
        startGrip(Grip::Light, pictureSize() / 2.0f);
        moveLight(gripStart, gripStart + step * kKeyMove * pictureSize().y, turns);
    }
    grip = Grip::None;
    return true;
}

// A drop falls, and time runs: water that is touched moves. @param depth  of its radius
bool Viewer::State::fall(WaterPlace place, float depth) {
    if (!renderer) return false;
    const vec2 size = std::get<scene::Water>(scene->objects[std::size_t(place.object)].shape).size;
    const float radius = kDropRadius * std::max(size.x, size.y);
    if (!renderer->drop(place.object, {place.at, radius, depth * radius})) return false;
    if (!dropTime) dropTime = picture.view.time;
    if (!play.playing) (void)togglePlaying();
    changed();
    return true;
}

bool Viewer::State::fallInTheMiddle() {
    if (const auto place = waterAt(*scene, lens(), pictureSize() / 2.0f)) return fall(*place);
    for (std::size_t i = 0; i < scene->objects.size(); ++i)
        if (std::holds_alternative<scene::Water>(scene->objects[i].shape)) return fall({int(i), vec2(0)});
    return false;
}

void Viewer::State::nextCompareMode() {
    const std::span<const std::string_view> modes = compareParams()[0].choices;
    const auto next = (std::size_t(compare.mode) + 1) % modes.size();
    (void)change("compare", std::string(modes[next]), gesture);
}

bool Viewer::State::toggleMatt() {
    const Control* matt = find("matt");
    if (!matt || !matt->bound.shown) return false;
    return change("matt", mode.matt ? "false" : "true", gesture).ok();
}

bool Viewer::State::shortcut(const std::string& key, Modifiers modifiers) {
    if (painting() && paintKey(key)) return true;
    if (key == "ArrowLeft") return arrow({-1, 0}, modifiers);
    if (key == "ArrowRight") return arrow({1, 0}, modifiers);
    if (key == "ArrowUp") return arrow({0, -1}, modifiers);
    if (key == "ArrowDown") return arrow({0, 1}, modifiers);
    const bool more = key == "PageUp" || key == "+" || key == "=", less = key == "PageDown" || key == "-";
    if (more || less) {
        const float factor = more ? kKeyFactor : 1 / kKeyFactor;
        (void)burst("lift");
        nearer(factor);
        return true;
    }
    if (key == "c" || key == "C") return nextCompareMode(), true;
    if (key == "l" || key == "L") return nextLight();
    if (key == "m" || key == "M") return toggleMatt();
    if (key == "0" || key == "Home") return resetPose(), true;
    if (key == " ") return togglePlaying();
    if (key == "d" || key == "D") return fallInTheMiddle();
    return false;
}

} // namespace lucent::viewer
