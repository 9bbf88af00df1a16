#include "viewer/Painter.h"

#include "views/Eye.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <utility>

namespace lucent::viewer {

namespace {

constexpr int kTile = 16; // CSS pixels
constexpr float kEndless = std::numeric_limits<float>::infinity();

const ParamTable& valueParams() {
    static const Param params[] = {
        declare(&PaintSettings::translucency,
                {.id = "translucency",
                 .label = "Translucency",
                 .min = 0,
                 .max = 1,
                 .group = Group::Mode,
                 .doc = "Share of the light that goes inside; the rest is matt."}),
        declare(&PaintSettings::blur,
                {.id = "blur",
                 .label = "Blur",
                 .min = 1 / scene::kMostSharpness,
                 .max = 1 / scene::kLeastSharpness,
                 .low = 0.25,
                 .high = 4,
                 .logarithmic = true,
                 .group = Group::Mode,
                 .doc = "How far light spreads inside: 2 is twice as far as the material says."}),
        declare(&PaintSettings::color, {.id = "color",
                                        .label = "Colour",
                                        .min = 0,
                                        .max = 1,
                                        .group = Group::Mode,
                                        .doc = "Multiplies the light.",
                                        .color = true}),
        declare(&PaintSettings::brightness, {.id = "brightness",
                                             .label = "Brightness",
                                             .min = 0,
                                             .max = 100,
                                             .high = 4,
                                             .group = Group::Mode,
                                             .doc = "Times the colour."}),
    };
    static const ParamTable table = tableOf<PaintSettings>("paint", params);
    return table;
}

const ParamTable& viewParams() {
    static constexpr std::string_view layers[] = {"light", "translucency", "blur", "glow", "outgoing"};
    static constexpr std::string_view rests[] = {"kept", "opaque"};
    static const Param params[] = {
        declare(&PaintSettings::unpainted, {.id = "unpainted",
                                            .label = "Unpainted",
                                            .group = Group::Mode,
                                            .doc = "Where nobody paints: kept as translucent as it is, or "
                                                   "opaque, so that light goes inside only "
                                                   "where you paint. Decided by an object's first stroke.",
                                            .choices = rests}),
        declare(&PaintSettings::layer,
                {.id = "layer",
                 .label = "Show",
                 .group = Group::Mode,
                 .doc =
                     "What painted objects show: light; or a layer of their paint. Translucency and blur are "
                     "grey: black is opaque, or a 16th as far as the material says; white is translucent, or "
                     "16 times as far. Glow and outgoing are their colours.",
                 .choices = layers})};
    static const ParamTable table = tableOf<PaintSettings>("paint", params);
    return table;
}

bool isUsed(const scene::Brush& brush, std::string_view value) {
    if (brush.erase) return false;
    if (brush.map == scene::PaintMap::Translucency) return value == "translucency";
    if (brush.map == scene::PaintMap::Blur) return value == "blur";
    return value == "color" || value == "brightness";
}

std::string twoDigits(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", double(value));
    return text;
}

// Where a ray from `from` along `way` meets a triangle: distance in lengths of `way`, and shares of its
// corners.
std::optional<vec3> meet(vec3 from, vec3 way, const std::array<vec3, 3>& t) {
    const vec3 u = t[1] - t[0], v = t[2] - t[0], across = glm::cross(way, v);
    const float det = glm::dot(u, across);
    if (det == 0) return std::nullopt;
    const vec3 offset = from - t[0], other = glm::cross(offset, u);
    const float b = glm::dot(offset, across) / det, c = glm::dot(way, other) / det,
                distance = glm::dot(v, other) / det;
    if (b < 0 || c < 0 || b + c > 1 || distance <= 0) return std::nullopt;
    return vec3(distance, b, c);
}

} // namespace

PaintSettings brushFor(const scene::Scene& scene) {
    constexpr float kShare = 1.0f / 8;
    PaintSettings settings;
    const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), isPaintable);
    if (found == scene.objects.end()) return settings;
    const views::Bounds bounds = views::boundsOf(*found);
    const vec3 extent = bounds.high - bounds.low;
    const float radius = std::max({extent.x, extent.y, extent.z}) * kShare / 2;
    if (radius > 0) settings.brush.radius = std::strtof(twoDigits(radius).c_str(), nullptr);
    return settings;
}

std::vector<BoundParam> bindPaint(PaintSettings& settings, const PaintSettings& defaults, bool shown) {
    std::vector<BoundParam> bound;
    const auto add = [&](const Param& param, void* data, const void* normal, bool used) {
        bound.push_back({"paint." + std::string(param.id), "paint", &param,
                         static_cast<std::byte*>(data) + param.offset,
                         static_cast<const std::byte*>(normal) + param.offset, shown && used});
    };
    for (const Param& param : scene::brushParams().params) {
        add(param, &settings.brush, &defaults.brush, true);
        if (param.id != "brush") continue;
        for (const Param& value : valueParams().params)
            add(value, &settings, &defaults, isUsed(settings.brush, value.id));
    }
    for (const Param& param : viewParams().params)
        add(param, &settings, &defaults, true);
    return bound;
}

std::span<const Action> paintActions() {
    static constexpr Action actions[] = {
        {"paint.fill", "Fill", "All of the object with the brush's value (key G)."},
        {"paint.clearTranslucency", "Clear translucency", "All of it as translucent as it began."},
        {"paint.clearBlur", "Clear blur", "Light spreads everywhere as far as the material says."},
        {"paint.clearGlow", "Clear glow", "Light has everywhere the brightness and colour of the material."},
        {"paint.clearOutgoing", "Clear outgoing", "Nothing is painted on top."}};
    return actions;
}

void applyLayer(const PaintSettings& settings, bool shown, scene::Scene& scene) {
    scene.view.paintLayer = shown ? settings.layer : scene::PaintLayer::None;
}

scene::Brush brushOf(const PaintSettings& settings) {
    scene::Brush brush = settings.brush;
    brush.value = settings.color * settings.brightness;
    if (brush.map == scene::PaintMap::Translucency) brush.value = vec3(settings.translucency);
    if (brush.map == scene::PaintMap::Blur) brush.value = vec3(settings.blur);
    if (brush.erase) brush.value = vec3(1);
    return brush;
}

scene::Stroke everywhere(const scene::Brush& brush) {
    return {brush, {}, scene::Stroke::Fill{vec3(-kEndless), vec3(kEndless)}};
}

scene::Stroke opaqueStart() { return everywhere({.map = scene::PaintMap::Translucency, .value = vec3(0)}); }

bool isPaintable(const scene::Object& object) {
    return object.material.isScattering() && !std::holds_alternative<scene::HeightField>(object.shape) &&
           !std::holds_alternative<scene::Water>(object.shape);
}

Picking::Picking(const scene::Scene& scene, const Lens& lens, vec2 size)
    : lens_(lens), tiles_(glm::max(glm::ivec2(size) / kTile + 1, glm::ivec2(1))),
      inTile_(std::size_t(tiles_.x) * std::size_t(tiles_.y)) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if (object.isField() || !object.visible) continue;
        Target target{int(i), isPaintable(object), scene::meshOf(object), {}};
        const scene::Mesh& rest = *target.rest;
        const bool stands = !rest.moves() && rest.joints.empty() && rest.rig.targets.empty();
        const mat4 worldFromObject = object.transform.worldFromObject();
        const std::vector<vec3> places =
            stands ? rest.positions : scene::posed(rest, scene::poseAt(rest.rig, scene.view.time)).positions;
        for (const vec3& place : places)
            target.places.push_back(vec3(worldFromObject * vec4(place, 1)));
        enter(target, std::uint32_t(targets_.size()));
        targets_.push_back(std::move(target));
    }
}

// Notes each triangle in the tiles that it may be seen in.
void Picking::enter(const Target& target, std::uint32_t number) {
    std::vector<std::optional<vec2>> seen;
    for (const vec3& place : target.places)
        seen.push_back(lens_.project(place));
    const std::vector<std::uint32_t>& corners = target.rest->indices;
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) {
        const auto &a = seen[corners[i]], &b = seen[corners[i + 1]], &c = seen[corners[i + 2]];
        if (!a || !b || !c) continue; // it reaches behind the camera
        const vec2 last = vec2(tiles_ - 1);
        const vec2 low = glm::min(glm::min(*a, *b), *c) / float(kTile),
                   high = glm::max(glm::max(*a, *b), *c) / float(kTile);
        if (high.x < 0 || high.y < 0 || low.x > last.x + 1 || low.y > last.y + 1) continue;
        const glm::ivec2 from(glm::clamp(low, vec2(0), last)), to(glm::clamp(high, vec2(0), last));
        for (int y = from.y; y <= to.y; ++y)
            for (int x = from.x; x <= to.x; ++x)
                inTile_[std::size_t(y * tiles_.x + x)].push_back({number, i});
    }
}

std::optional<PaintPlace> Picking::at(vec2 pixel) const {
    const glm::ivec2 tile = glm::ivec2(glm::floor(pixel / float(kTile)));
    if (tile.x < 0 || tile.y < 0 || tile.x >= tiles_.x || tile.y >= tiles_.y) return std::nullopt;
    const auto [from, way] = lens_.sight(pixel);
    std::optional<PaintPlace> found;
    float nearest = kEndless;
    bool paintable = false;
    for (const Triangle& triangle : inTile_[std::size_t(tile.y * tiles_.x + tile.x)]) {
        const Target& target = targets_[triangle.target];
        const std::uint32_t* corners = target.rest->indices.data() + triangle.first;
        const auto hit = meet(
            from, way, {target.places[corners[0]], target.places[corners[1]], target.places[corners[2]]});
        if (!hit || hit->x >= nearest) continue;
        nearest = hit->x;
        paintable = target.paintable;
        const auto mixed = [&](const std::vector<vec3>& list) {
            return list[corners[0]] * (1 - hit->y - hit->z) + list[corners[1]] * hit->y +
                   list[corners[2]] * hit->z;
        };
        found = {target.object, mixed(target.rest->positions), mixed(target.rest->normals),
                 from + nearest * way};
    }
    if (!paintable || found->normal == vec3(0)) return std::nullopt;
    found->normal = glm::normalize(found->normal);
    return found;
}

void Painter::clear() {
    easels_.clear();
    preparing_.clear();
}

int Painter::count(const scene::Object& object) const {
    const auto found = easels_.find(object.name);
    return found == easels_.end() ? 0 : int(found->second.canvas.strokes().size());
}

bool Painter::prepare(const scene::Object& object, const std::function<bool()>& isOver) {
    using Atlas = std::shared_ptr<const scene::Atlas>;
    const int side = object.painting ? object.painting->side() : scene::kUsualPaintSide;
    const std::pair source(scene::meshOf(object), side);
    Preparing& own = preparing_[object.name];
    if (own.source != source) own = {source};
    const Atlas* atlas = object.kept.find<Atlas>(source);
    while (!own.isDone && !atlas) {
        if (isOver()) return false;
        if (!own.atlas) own.atlas = std::make_unique<scene::AtlasMaking>(source.first, scene::Charting{side});
        const auto made = own.atlas->advance();
        if (!made) continue;
        if (*made)
            atlas = &object.kept.keep(source, **made);
        else
            own.isDone = true; // the first stroke says why
    }
    while (!own.isDone && !object.kept.find<scene::PaintSurfaceMaking::Made>(*atlas)) {
        if (isOver()) return false;
        if (!own.surface) own.surface = std::make_unique<scene::PaintSurfaceMaking>(*atlas);
        if (auto made = own.surface->advance()) object.kept.keep(*atlas, std::move(*made));
    }
    own = {source, nullptr, nullptr, true};
    return true;
}

// The object's canvas; a new one where its shape has changed, with the strokes of the old one.
Result<Painter::Easel*> Painter::easelOf(scene::Object& object) {
    const std::shared_ptr<const scene::Mesh> mesh = scene::meshOf(object);
    const auto found = easels_.find(object.name);
    if (found != easels_.end() && found->second.mesh == mesh) return &found->second;
    const std::shared_ptr<const scene::Painting> first =
        found != easels_.end() ? found->second.first : object.painting;
    const auto surface = scene::paintSurfaceOf(object, first ? first->side() : scene::kUsualPaintSide);
    if (!surface) return Error{"objects." + object.name + ": " + surface.error().message};
    const float scale = first ? first->scale : object.transform.scale;
    std::optional<float> start; // of strokes that are in the maps already
    if (first && !first->strokes.empty()) start = scene::startOf(first->strokes);
    scene::Canvas canvas(*surface, scale, first ? first->entering : nullptr, first ? first->leaving : nullptr,
                         scene::Canvas::kBudget, start);
    if (found != easels_.end())
        for (const scene::Stroke& stroke : found->second.canvas.strokes())
            canvas.add(stroke);
    return &easels_.insert_or_assign(object.name, Easel{first, mesh, scale, std::move(canvas)}).first->second;
}

// Gives the object what is on its canvas. Without a stroke it is what it was.
void Painter::show(scene::Object& object, const Easel& easel) {
    const scene::Canvas& canvas = easel.canvas;
    if (canvas.strokes().empty() && !canvas.isOpen()) {
        object.painting = easel.first;
        return;
    }
    scene::Painting painting = easel.first ? *easel.first : scene::Painting();
    painting.entering = canvas.entering();
    painting.leaving = canvas.leaving();
    painting.strokesFile.clear();
    painting.strokes.insert(painting.strokes.end(), canvas.strokes().begin(), canvas.strokes().end());
    painting.scale = easel.scale;
    object.painting = std::make_shared<const scene::Painting>(std::move(painting));
}

// Radii are in the world, where the object may have grown since its first stroke.
scene::Brush Painter::asOfEasel(scene::Brush brush, const scene::Object& object, const Easel& easel) {
    if (object.transform.scale != easel.scale) brush.radius *= easel.scale / object.transform.scale;
    return brush;
}

Status Painter::begin(scene::Object& object, const scene::Brush& brush, Unpainted unpainted) {
    const Result<Easel*> easel = easelOf(object);
    if (!easel) return easel.error();
    scene::Canvas& canvas = (*easel)->canvas;
    if (!object.painting && unpainted == Unpainted::Opaque) canvas.add(opaqueStart());
    canvas.begin(asOfEasel(brush, object, **easel));
    return Done{};
}

void Painter::dab(scene::Object& object, const scene::Dab& dab) {
    Easel& easel = easels_.at(object.name);
    easel.canvas.dab(dab);
    show(object, easel);
}

void Painter::end(scene::Object& object) {
    Easel& easel = easels_.at(object.name);
    easel.canvas.end();
    show(object, easel);
}

Status Painter::add(scene::Object& object, std::span<const scene::Stroke> strokes) {
    const Result<Easel*> easel = easelOf(object);
    if (!easel) return easel.error();
    for (scene::Stroke stroke : strokes) {
        stroke.brush = asOfEasel(stroke.brush, object, **easel);
        (*easel)->canvas.add(stroke);
    }
    show(object, **easel);
    return Done{};
}

void Painter::go(scene::Object& object, int count) {
    const auto found = easels_.find(object.name);
    if (found == easels_.end()) return;
    scene::Canvas& canvas = found->second.canvas;
    while (int(canvas.strokes().size()) > count && canvas.undo()) {
    }
    while (int(canvas.strokes().size()) < count && canvas.redo()) {
    }
    show(object, found->second);
}

} // namespace lucent::viewer
