// Painting by hand: strokes that follow the pointer, the brush's ring, and what is done at once.
#include "viewer/State.h"

#include "scene/Canvas.h"

#include <algorithm>
#include <cmath>

namespace lucent::viewer {

namespace {

constexpr float kSpacing = 0.25f;     // of the radius, between dabs
constexpr float kLeastSpacing = 1;    // CSS pixels
constexpr float kRadiusFactor = 1.2f; // a key's
constexpr int kRing = 64;             // corners

} // namespace

// What a pixel shows is found anew when anything but paint has changed.
std::optional<PaintPlace> Viewer::State::paintPlaceAt(vec2 position) {
    if (!picking || pickingOf != revision || pickingSize != pictureSize()) {
        picking.emplace(*scene, lens(), pictureSize());
        pickingOf = revision;
        pickingSize = pictureSize();
    }
    return picking->at(position);
}

// In mode paint, what first strokes need. @return whether it is there
bool Viewer::State::preparePaint() {
    constexpr double kSeconds = 0.008; // of a frame
    if (!painting() || !shown) return true;
    const auto isOver = [until = secondsNow() + kSeconds] { return secondsNow() > until; };
    return std::all_of(scene->objects.begin(), scene->objects.end(), [&](const scene::Object& object) {
        return !isPaintable(object) || painter.prepare(object, isOver);
    });
}

void Viewer::State::painted() {
    const bool known = picking && pickingOf == revision;
    changed();
    if (known) pickingOf = revision; // paint moves nothing
}

bool Viewer::State::startStroke(vec2 position) {
    const auto place = paintPlaceAt(position);
    if (!place) return false;
    paintObject = std::size_t(place->object);
    scene::Object& object = scene->objects[paintObject];
    paintBefore = painter.count(object);
    if (Status begun = painter.begin(object, brushOf(paintSettings), paintSettings.unpainted); !begun) {
        message = begun.error().message;
        return false;
    }
    dabOnce(position, pressure);
    return true;
}

// Dabs on the way from the last one, a share of the radius apart as it is seen there.
void Viewer::State::dabTo(vec2 position) {
    const auto place = paintPlaceAt(dabAt);
    const float radius =
        place ? paintSettings.brush.radius / lens().metresPerPixel(place->seenAt) : kLeastSpacing / kSpacing;
    const float step = std::max(kSpacing * radius, kLeastSpacing);
    const vec2 from = dabAt, way = position - from;
    const float length = glm::length(way), before = dabPressure;
    for (float along = step; along <= length; along += step)
        dabOnce(from + way * (along / length), glm::mix(before, pressure, along / length));
}

void Viewer::State::dabOnce(vec2 position, float withPressure) {
    dabAt = position;
    dabPressure = withPressure;
    const auto place = paintPlaceAt(position);
    if (!place || std::size_t(place->object) != paintObject) return;
    painter.dab(scene->objects[paintObject], {place->place, place->normal, withPressure});
    painted();
}

// Says what of a stroke is kept and not drawn.
void Viewer::State::noteUndrawn(const scene::Stroke& stroke) {
    for (const std::string& line : technique::notDrawn(*scene, stroke.brush.map))
        message = "Kept, but not drawn: " + line;
}

void Viewer::State::endStroke() {
    scene::Object& object = scene->objects[paintObject];
    painter.end(object);
    noteUndrawn(object.painting->strokes.back());
    history.record(gesture, {kStrokesOn + object.name, std::to_string(paintBefore),
                             std::to_string(painter.count(object))});
    bind(); // the matt share has a colour now
    painted();
}

Status Viewer::State::addStrokes(std::size_t index, std::span<const scene::Stroke> strokes) {
    scene::Object& object = scene->objects[index];
    const int before = painter.count(object);
    if (Status added = painter.add(object, strokes); !added) return added;
    history.record(gesture,
                   {kStrokesOn + object.name, std::to_string(before), std::to_string(painter.count(object))});
    for (const scene::Stroke& stroke : strokes)
        noteUndrawn(stroke);
    bind();
    painted();
    return Done{};
}

// All of the object that was painted last, or of the first one that can be.
void Viewer::State::fillWith(const scene::Brush& brush) {
    const auto& objects = scene->objects;
    if (paintObject >= objects.size() || !isPaintable(objects[paintObject]))
        paintObject =
            std::size_t(std::find_if(objects.begin(), objects.end(), isPaintable) - objects.begin());
    if (paintObject == objects.size()) return;
    std::vector<scene::Stroke> strokes;
    if (!objects[paintObject].painting) {
        if (brush.erase) return; // there is nothing to clear
        if (paintSettings.unpainted == Unpainted::Opaque) strokes.push_back(opaqueStart());
    }
    strokes.push_back(everywhere(brush));
    ++gesture;
    if (Status filled = addStrokes(paintObject, strokes); !filled) message = filled.error().message;
    ++gesture;
}

std::span<const Action> Viewer::State::actions() const {
    return painting() ? paintActions() : std::span<const Action>();
}

Status Viewer::State::act(std::string_view path) {
    const std::span<const Action> offered = actions();
    const auto found = std::find_if(offered.begin(), offered.end(),
                                    [&](const Action& action) { return action.path == path; });
    if (found == offered.end())
        return Error{std::string(path) + ": cannot be done now; actions of paint need the mode paint"};
    const auto number = found - offered.begin();
    number == 0 ? fillWith(brushOf(paintSettings))
                : fillWith({.map = scene::PaintMap(number - 1), .erase = true});
    return Done{};
}

bool Viewer::State::paintKey(const std::string& key) {
    const auto set = [&](const char* path, const std::string& value) {
        return change(path, value, gesture).ok();
    };
    if (key == "[" || key == "]") {
        const float radius = paintSettings.brush.radius * (key == "]" ? kRadiusFactor : 1 / kRadiusFactor);
        return set("paint.radius", std::to_string(radius));
    }
    if (key == "x" || key == "X") return set("paint.erase", paintSettings.brush.erase ? "false" : "true");
    if (key == "g" || key == "G") return fillWith(brushOf(paintSettings)), true;
    if (key.size() == 1 && key[0] >= '1' && key[0] <= '4') {
        const auto names = scene::brushParams().params[0].choices;
        return set("paint.brush", std::string(names[std::size_t(key[0] - '1')]));
    }
    return false;
}

void Viewer::State::paintOverlay() {
    if (!painting()) return;
    const vec2 size = pictureSize();
    const bool inside = hoverAt.x >= 0 && hoverAt.y >= 0 && hoverAt.x < size.x && hoverAt.y < size.y &&
                        !ImGui::GetIO().WantCaptureMouse;
    if (const auto place = inside ? paintPlaceAt(hoverAt) : std::nullopt) {
        const float radius = paintSettings.brush.radius * pressure / lens().metresPerPixel(place->seenAt);
        ImDrawList& list = *ImGui::GetBackgroundDrawList();
        list.AddCircle({hoverAt.x, hoverAt.y}, radius + 1, IM_COL32(0, 0, 0, 160), kRing, 1);
        list.AddCircle({hoverAt.x, hoverAt.y}, radius, IM_COL32(255, 255, 255, 220), kRing, 1.5f);
    }
}

} // namespace lucent::viewer
