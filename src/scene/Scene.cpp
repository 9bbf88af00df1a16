#include "scene/Scene.h"
#include "scene/ReflectanceTable.h"

#include "base/Text.h"
#include "scene/Displacement.h"
#include "scene/Keys.h"
#include "scene/Memory.h"
#include "scene/Mesh.h"
#include "scene/Painting.h"
#include "scene/Translucency.h"

#include <algorithm>
#include <cstdlib>

namespace lucent::scene {
namespace {

constexpr std::string_view kCameraNames[] = {"orthographic", "perspective"};
constexpr std::string_view kAovNames[] = {
    "color",       "d",         "visibility", "normal", "depth",       "position",     "iterations",
    "irradiance",  "direction", "layers",     "lost",   "layer-depth", "layer-normal", "layer-object",
    "caustic-map", "radiosity", "misses",     "atlas"};

} // namespace

mat4 Transform::worldFromObject() const {
    return glm::translate(mat4(1), translate) * mat4(rotationFromDegrees(rotate)) *
           glm::scale(mat4(1), vec3(scale));
}

std::span<const std::string_view> aovNames() { return kAovNames; }

const ParamTable& transformParams() {
    static const Param params[] = {
        declare(&Transform::translate, {.id = "translate",
                                        .label = "Place",
                                        .unit = "m",
                                        .min = -kFar,
                                        .max = kFar,
                                        .low = -1,
                                        .doc = "Where the object's origin stands."}),
        declare(&Transform::rotate, {.id = "rotate",
                                     .label = "Rotation",
                                     .unit = "degrees",
                                     .low = -180,
                                     .high = 180,
                                     .doc = "Turns about the fixed x, y, z axes, x first."}),
        declare(&Transform::scale, {.id = "scale",
                                    .label = "Scale",
                                    .min = kAboveZero,
                                    .max = 1e6,
                                    .low = 0.1,
                                    .high = 10,
                                    .logarithmic = true,
                                    .doc = "Size of the object's metre."}),
    };
    static const ParamTable table = tableOf<Transform>("transform", params);
    return table;
}

const ParamTable& cameraParams() {
    static const Param params[] = {
        declare(&Camera::type, {.id = "type",
                                .label = "Projection",
                                .doc = "Parallel rays, or rays from one point.",
                                .choices = kCameraNames}),
        declare(&Camera::eye, {.id = "eye",
                               .label = "Eye",
                               .unit = "m",
                               .min = -kFar,
                               .max = kFar,
                               .low = -5,
                               .high = 5,
                               .doc = "Where the camera stands."}),
        declare(&Camera::target, {.id = "target",
                                  .label = "Target",
                                  .unit = "m",
                                  .min = -kFar,
                                  .max = kFar,
                                  .low = -5,
                                  .high = 5,
                                  .doc = "What the camera looks at."}),
        declare(&Camera::up, {.id = "up",
                              .label = "Up",
                              .min = -kFar,
                              .max = kFar,
                              .low = -1,
                              .doc = "Direction that is up in the picture."}),
        declare(&Camera::height, {.id = "height",
                                  .label = "Visible height",
                                  .unit = "m",
                                  .min = kAboveZero,
                                  .max = 1e6,
                                  .low = 0.1,
                                  .high = 10,
                                  .logarithmic = true,
                                  .group = Group::View,
                                  .doc = "What an orthographic camera shows from top to bottom."}),
        declare(&Camera::fov, {.id = "fov",
                               .label = "Field of view",
                               .unit = "degrees",
                               .min = 0.1,
                               .max = 179,
                               .low = 5,
                               .high = 120,
                               .group = Group::View,
                               .doc = "Vertical angle that a perspective camera shows."}),
    };
    static const ParamTable table = tableOf<Camera>("camera", params);
    return table;
}

const ParamTable& viewParams() {
    static const Param params[] = {
        declare(&View::exposure, {.id = "exposure",
                                  .label = "Exposure",
                                  .unit = "ev",
                                  .min = -30,
                                  .max = 30,
                                  .low = -4,
                                  .high = 4,
                                  .group = Group::View,
                                  .doc = "Each step doubles the picture's brightness."}),
        declare(&View::show, {.id = "show",
                              .label = "Show",
                              .group = Group::View,
                              .doc = "The picture, or one of the quantities behind it.",
                              .choices = kAovNames}),
        declare(&View::layer,
                {.id = "layer",
                 .label = "Layer",
                 .min = 1,
                 .max = 256,
                 .low = 1,
                 .high = 16,
                 .group = Group::View,
                 .doc = "Which surface behind others the views of layers show, 1 is the nearest; of "
                        "the caustic map, which of the lamps' points."}),
        declare(&View::lightDot, {.id = "lightDot",
                                  .label = "Light dot",
                                  .group = Group::View,
                                  .doc = "Marks where the lamp stands."}),
        declare(&View::time, {.id = "time",
                              .label = "Time",
                              .unit = "s",
                              .min = 0,
                              .max = 1e6,
                              .high = 10,
                              .group = Group::View,
                              .doc = "Moment that is shown of waves, water and animations."}),
    };
    static const ParamTable table = tableOf<View>("view", params);
    return table;
}

const ParamTable& qualityParams() {
    static const Param params[] = {
        declare(&Quality::maxError,
                {.id = "maxError",
                 .label = "Error",
                 .min = 0,
                 .max = 1,
                 .high = 0.1f,
                 .group = Group::View,
                 .doc = "How far the picture may be from the exact one, as root mean square error over its "
                        "mean: the cheapest settings that keep it are chosen. 0: the settings as they are."}),
    };
    static const ParamTable table = tableOf<Quality>("quality", params);
    return table;
}

namespace {

// Collects bound parameters in the order of the scene file.
struct Binder {
    std::vector<BoundParam> bound;

    // `prefix` of the attributes is empty for everything that attributes cannot address.
    void add(const std::string& path, std::string_view prefix, const ParamTable& table, void* data,
             std::string_view leftOut = "") {
        for (const Param& param : table.params)
            if (param.id != leftOut)
                bound.push_back({path + "." + std::string(param.id), std::string(prefix), &param,
                                 static_cast<std::byte*>(data) + param.offset,
                                 static_cast<const std::byte*>(table.defaults) + param.offset, true,
                                 table.label});
    }

    void addLayers(const std::string& path, std::vector<MediumLayer>& layers) {
        constexpr std::string_view kLabels[kMostMediumLayers] = {"layer 1", "layer 2", "layer 3", "layer 4"};
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const std::size_t start = bound.size();
            add(path + std::to_string(i), "", layerParams(), &layers[i]);
            for (std::size_t k = start; k < bound.size(); ++k) {
                bound[k].label = kLabels[i];
                bound[k].place = Group::Subsurface;
            }
        }
    }

    // Binds what is computed from a material: each member of `words` is carried back by
    // store(words, id, material).
    template <class Words>
    std::size_t addWords(const std::string& path, std::string_view prefix, const ParamTable& table,
                         const Words& now, Material& material,
                         Status (*store)(const Words&, std::string_view, Material&)) {
        const auto words = std::make_shared<Words>(now);
        const std::size_t start = bound.size();
        add(path, prefix, table, words.get());
        for (std::size_t i = start; i < bound.size(); ++i)
            bound[i].computed = {words, [words, store, id = bound[i].param->id, &material] {
                                     return store(*words, id, material);
                                 }};
        return start;
    }

    // What makes it another kind. What says of which it is already is a number of its own kind.
    void addChoice(const std::string& path, std::string_view prefix, Material& material) {
        const std::size_t start =
            addWords<KindChoice>(path, prefix, choiceParams(), choiceOf(material), material, store);
        bound[start].computed.isOwn = true;
        constexpr MaterialKind kOf[] = {MaterialKind::Mirror, MaterialKind::Clear, MaterialKind::Translucent};
        for (std::size_t i = 3; i-- > 0;)
            if (std::size_t(kOf[i]) == material.kind.index())
                bound.erase(bound.begin() + std::ptrdiff_t(start + 1 + i));
    }

    void addAttenuation(const std::string& path, std::string_view prefix, Material& material) {
        const Absorbing now = absorbing(material);
        addWords<Attenuation>(path, prefix, attenuationParams(),
                              attenuationOf(*now.absorption, *now.distance), material, store);
    }

    // A translucent material in better words than its numbers, which are not shown then. Of what sends light
    // back itself a measured material may be chosen.
    void addTranslucency(const std::string& path, std::string_view prefix, Material& material) {
        const std::size_t start = addWords<Translucency>(path, prefix, translucencyParams(),
                                                         translucencyOf(material), material, store);
        if (material.isScattering()) return;
        bound.resize(start + 1);
        bound[start].shown = false;
    }

    void addMaterial(const std::string& path, std::string_view prefix, Object& object) {
        Material& material = object.material;
        const bool scatters = material.isScattering();
        addTranslucency(path, prefix, material);
        const std::size_t start = bound.size();
        addChoice(path, prefix, material);
        for (const ParamTable* table : materialKeysOf(object).tables)
            if (table == &attenuationParams())
                addAttenuation(path, prefix, material);
            else
                add(path, prefix, *table, structOf(material, *table));
        // Of what is clear it is shown as a colour.
        for (std::size_t i = start; i < bound.size() && material.isRefractive(); ++i)
            if (bound[i].data == &material.clear().absorption) bound[i].shown = false;
        if (!scatters) return;
        const Translucent& inside = material.translucent();
        for (std::size_t i = start + 1; i < bound.size(); ++i) { // after its kind
            bound[i].place = Group::Subsurface;
            bound[i].shown = bound[i].data == &inside.ior || bound[i].data == &inside.anisotropy ||
                             bound[i].data == &inside.thickness || bound[i].data == &inside.roughness;
        }
        addLayers(path + ".layers.", material.translucent().layers);
    }

    void addObject(Object& object, bool first) {
        const std::string path = "objects." + object.name;
        addMaterial(path + ".material", first ? "material" : "", object);
        add(path + ".shape", first ? "shape" : "", *typeOf(object.shape).keys.tables[0],
            dataOf(object.shape));
        if (whyIdle(object, "wave").empty()) {
            const std::size_t start = bound.size();
            add(path + ".wave", first ? "wave" : "", waveParams(), &object.wave);
            for (std::size_t i = start; i < bound.size(); ++i)
                bound[i].shown = object.wave.amplitude != vec3(0);
        }
        if (object.displacement)
            add(path + ".displacement", first ? "displacement" : "", displacementParams(),
                &*object.displacement);
        add(path + ".transform", first ? "transform" : "", transformParams(), &object.transform);
    }
};

// Group::None stands last: it is in no panel.
int panelOrder(const BoundParam& bound) {
    const Group group = bound.group();
    return group == Group::None ? int(Group::View) + 1 : int(group);
}

// "objects.0.material.depth" with the object's name in place of its number.
std::string pathWithName(const Scene& scene, std::string_view path) {
    constexpr std::string_view kObjects = "objects.";
    if (!path.starts_with(kObjects)) return std::string(path);
    const std::string_view rest = path.substr(kObjects.size());
    const std::string word(rest.substr(0, rest.find('.')));
    const auto named = [&](const Object& object) { return object.name == word; };
    char* end = nullptr;
    const unsigned long number = std::strtoul(word.c_str(), &end, 10);
    const bool isNumber = !word.empty() && word[0] >= '0' && word[0] <= '9' && !*end;
    if (!isNumber || number >= scene.objects.size() ||
        std::any_of(scene.objects.begin(), scene.objects.end(), named))
        return std::string(path);
    return std::string(kObjects) + scene.objects[number].name + std::string(rest.substr(word.size()));
}

std::string textOf(ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }

std::string vectorText(vec3 v) { return shortest(v.x) + " " + shortest(v.y) + " " + shortest(v.z); }

// Short enough that normalising it in float would divide by zero.
bool isZero(vec3 v) { return glm::length(dvec3(v)) < 1e-15; }

} // namespace

std::vector<BoundParam> bindParams(Scene& scene) {
    Binder binder;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        Light& light = scene.lights[i];
        const auto* spot = std::get_if<SpotLight>(&light);
        for (const ParamTable* table : typeOf(light).keys.tables)
            if (table != &projectorParams() || spot->image)
                binder.add("lights." + std::to_string(i), i == 0 ? "light" : "", *table, dataOf(light));
    }
    for (Object& object : scene.objects)
        binder.addObject(object, &object == &scene.objects.front());
    if (scene.environment) binder.add("environment", "env", environmentParams(), &*scene.environment);
    for (auto& [name, settings] : scene.technique)
        binder.add("technique." + name, name, settings.table(), settings.data());
    const bool orthographic = scene.camera.type == Camera::Type::Orthographic;
    binder.add("camera", "camera", cameraParams(), &scene.camera, orthographic ? "fov" : "height");
    binder.add("view", "view", viewParams(), &scene.view);
    const bool still = std::none_of(scene.objects.begin(), scene.objects.end(), moves);
    for (BoundParam& param : binder.bound)
        if (param.data == &scene.view.time) param.shown = !still;
    for (BoundParam& param : binder.bound)
        if (param.data == &scene.view.layer) param.shown = isNumbered(scene.view.show);
    binder.add("quality", "quality", qualityParams(), &scene.quality);
    std::stable_sort(binder.bound.begin(), binder.bound.end(),
                     [](const BoundParam& a, const BoundParam& b) { return panelOrder(a) < panelOrder(b); });
    return std::move(binder.bound);
}

Status check(const Camera& camera) {
    const vec3 forward = camera.target - camera.eye;
    if (isZero(forward))
        return Error{"target is " + vectorText(camera.target) + ", the eye; must differ from it"};
    if (isZero(camera.up)) return Error{"up is 0 0 0; must have a length"};
    if (glm::length(glm::cross(glm::normalize(forward), glm::normalize(camera.up))) < 1e-4f)
        return Error{"up is " + vectorText(camera.up) + ", along the view; must point elsewhere"};
    return Done{};
}

namespace {

Status checkDirection(vec3 direction) {
    if (isZero(direction)) return Error{"direction is 0 0 0; must have a length"};
    return Done{};
}

Status checkKind(const PointLight&) { return Done{}; }

Status checkKind(const DistantLight& light) { return checkDirection(light.direction); }

Status checkKind(const SpotLight& light) {
    if (light.innerAngle > light.outerAngle)
        return Error{"innerAngle is " + shortest(light.innerAngle) + "; must be at most outerAngle, " +
                     shortest(light.outerAngle)};
    return checkDirection(light.direction);
}

Status checkKind(const AreaLight& light) {
    if (isZero(light.edgeU)) return Error{"edgeU is 0 0 0; must have a length"};
    if (isZero(light.edgeV)) return Error{"edgeV is 0 0 0; must have a length"};
    // The angle below which a camera's up counts as along its view.
    if (glm::length(glm::cross(glm::normalize(light.edgeU), glm::normalize(light.edgeV))) < 1e-4f)
        return Error{"edgeV is " + vectorText(light.edgeV) + ", along edgeU; must point elsewhere"};
    return Done{};
}

} // namespace

PictureFrame pictureFrame(const SpotLight& projector) {
    const vec3 axis = glm::normalize(projector.direction);
    const vec3 above = glm::length(glm::cross(axis, vec3(0, 1, 0))) > 1e-3f ? vec3(0, 1, 0) : vec3(0, 0, -1);
    const vec3 level = glm::normalize(glm::cross(axis, above)), steep = glm::cross(level, axis);
    const float angle = glm::radians(projector.roll), cosine = std::cos(angle), sine = std::sin(angle);
    const float far = 1 / std::tan(glm::radians(projector.fov / 2));
    const float tall = far * float(projector.image->width) / float(projector.image->height);
    return {far * (cosine * level + sine * steep), tall * (cosine * steep - sine * level)};
}

Status check(const Light& light) {
    return std::visit([](const auto& kind) { return checkKind(kind); }, light);
}

Status check(const Shape& shape) {
    const auto* torus = std::get_if<Torus>(&shape);
    if (torus && torus->minor > torus->major)
        return Error{"minor is " + shortest(torus->minor) + "; must be at most major, " +
                     shortest(torus->major)};
    const auto* water = std::get_if<Water>(&shape);
    if (water && isZero(vec3(water->direction, 0))) return Error{"direction is 0 0; must have a length"};
    return Done{};
}

Status check(const Material& material) {
    if (material.isScattering() && material.translucent().scattering == vec3(0))
        return Error{"scattering is 0 0 0; must be above 0 in a colour of a translucent material"};
    const auto* measured = std::get_if<MeasuredBrdf>(&material.kind);
    if (!measured) return Done{};
    if (!measured->table)
        return Error{"kind is measured without a table; must be in a scene file that names one"};
    const Status table = checkTable(*measured->table, measured->form, measured->blocks);
    return table ? table : Error{"table " + table.error().message};
}

Status check(const Wave& wave) { return checkDirection(wave.direction); }

bool moves(const Object& object) {
    if (std::holds_alternative<Water>(object.shape)) return true;
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    return object.wave.amplitude != vec3(0) || (shape && shape->mesh && shape->mesh->moves());
}

bool isPrecomputed(const Object& object) {
    return object.material.isScattering() && object.material.translucent().precomputed &&
           (!object.painting || object.painting->isOnTop()) && !moves(object);
}

namespace {

Status checkAll(const Scene& scene) {
    const auto at = [](const std::string& path, const Status& legal) -> Status {
        return legal ? legal : Error{path + "." + legal.error().message};
    };
    if (Status legal = at("camera", check(scene.camera)); !legal) return legal;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (Status legal = at("lights." + std::to_string(i), check(scene.lights[i])); !legal) return legal;
    double bytes = 0;
    for (const Object& object : scene.objects) {
        const std::string path = "objects." + object.name;
        if (Status legal = at(path + ".shape", check(object.shape)); !legal) return legal;
        if (Status legal = at(path + ".material", check(object.material)); !legal) return legal;
        if (Status legal = at(path + ".wave", check(object.wave)); !legal) return legal;
        if (const auto* water = std::get_if<Water>(&object.shape)) {
            const std::string why = whyTooLarge(std::to_string(water->cells), bytes += bytesOf(*water));
            if (!why.empty()) return Error{path + ".shape.cells" + why};
        }
        if (const auto* field = std::get_if<HeightField>(&object.shape); field && !object.isField()) {
            const std::string why = whyTooLarge(textOf(field->texels()), bytes += bytesOfBody(*field));
            if (!why.empty()) return Error{path + ".shape.heights" + why};
        }
    }
    return Done{};
}

// Why a path that looks like a parameter of an object is none now (whyIdle()); "" for others.
std::string whyUnbound(const Scene& scene, std::string_view path) {
    for (const Object& object : scene.objects) {
        const std::string owner = "objects." + object.name + ".";
        if (!path.starts_with(owner)) continue;
        const std::string_view rest = path.substr(owner.size());
        const std::size_t dot = rest.find('.');
        if (rest.substr(0, dot) == "wave") return whyIdle(object, "wave");
        if (rest.substr(0, dot) == "displacement") return whyIdle(object, "displacement");
        return rest.substr(0, dot) == "material" ? whyIdle(object, rest.substr(dot + 1)) : std::string();
    }
    return {};
}

Status assign(Scene& scene, std::string_view path, std::string_view value) {
    const std::string wanted = pathWithName(scene, path);
    const std::vector<BoundParam> bound = bindParams(scene);
    const auto found =
        std::find_if(bound.begin(), bound.end(), [&](const BoundParam& b) { return b.path == wanted; });
    if (found == bound.end()) {
        if (const std::string why = whyUnbound(scene, wanted); !why.empty()) return Error{wanted + why};
        std::vector<std::string_view> paths;
        for (const BoundParam& b : bound)
            paths.push_back(b.path);
        return Error{std::string(path) + " is not a parameter; the nearest is " +
                     std::string(nearest(wanted, paths))};
    }
    Status set = setText(*found->param, found->data, value);
    if (set && found->isComputed()) set = found->computed.store();
    if (!set) return Error{found->path + " " + set.error().message};
    return checkAll(scene);
}

} // namespace

Status setParam(Scene& scene, std::string_view path, std::string_view value) {
    Scene trial = scene; // images are shared, so a copy is cheap
    if (Status set = assign(trial, path, value); !set) return set;
    return assign(scene, path, value);
}

std::vector<std::shared_ptr<const Image>> lightPictures(const Scene& scene) {
    std::vector<std::shared_ptr<const Image>> list;
    if (scene.environment) list.push_back(scene.environment->map);
    for (const Light& light : scene.lights)
        if (const auto* spot = std::get_if<SpotLight>(&light); spot && spot->image)
            list.push_back(spot->image);
    return list;
}

bool changesNoLight(const Scene& scene, const Object& object) {
    const auto isVacuum = [](const Clear& clear) {
        return clear.transmission == 1 && clear.ior == 1 && clear.dispersion == 0 &&
               clear.absorption == vec3(0);
    };
    return object.material.isRefractive() &&
           std::all_of(scene.objects.begin(), scene.objects.end(), [&](const Object& one) {
               return !one.material.isRefractive() || isVacuum(one.material.clear());
           });
}

} // namespace lucent::scene
