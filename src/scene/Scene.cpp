#include "scene/Scene.h"

#include "base/Text.h"

#include <algorithm>
#include <cstdlib>

namespace lucent::scene {
namespace {

constexpr std::string_view kFalloffNames[] = {"none", "inverse-square"};
constexpr std::string_view kCameraNames[] = {"orthographic", "perspective"};
constexpr std::string_view kAovNames[] = {"color", "d",        "visibility", "normal",
                                          "depth", "position", "iterations"};

// Places and directions in metres: far enough for a sun, near enough that squares stay finite in floats.
constexpr double kFar = 1e9;

// A table whose parameters are declared once, at the first call.
template <class Struct, std::size_t N>
ParamTable makeTable(std::string_view name, const Param (&params)[N]) {
    return tableOf<Struct>(name, params);
}

} // namespace

mat4 Transform::worldFromObject() const {
    return glm::translate(mat4(1), translate) * mat4(rotationFromDegrees(rotate)) *
           glm::scale(mat4(1), vec3(scale));
}

std::span<const std::string_view> aovNames() { return kAovNames; }

const ParamTable& heightFieldParams() {
    static const Param params[] = {
        declare(&HeightField::heightScale, {.id = "heightScale",
                                            .label = "Height",
                                            .unit = "m",
                                            .min = 0,
                                            .max = 1e5,
                                            .high = 0.5,
                                            .group = Group::HeightField,
                                            .doc = "How high a height of 1 stands.",
                                            .attribute = "height-scale"}),
        declare(&HeightField::width, {.id = "width",
                                      .label = "Width",
                                      .unit = "m",
                                      .min = kAboveZero,
                                      .max = 1e6,
                                      .low = 0.1,
                                      .high = 10,
                                      .logarithmic = true,
                                      .doc = "Width of the field; its texels are square.",
                                      .attribute = "field-width"}),
    };
    static const ParamTable table = makeTable<HeightField>("shape", params);
    return table;
}

const ParamTable& heightSourceParams() {
    static const Param params[] = {
        declare(&HeightSource::meshRotate,
                {.id = "meshRotate",
                 .label = "Mesh rotation",
                 .unit = "degrees",
                 .low = -180,
                 .high = 180,
                 .doc = "Turns the mesh about the fixed x, y, z axes before its depth is "
                        "taken along -z."}),
        declare(&HeightSource::margin, {.id = "margin",
                                        .label = "Margin",
                                        .min = 0,
                                        .max = 0.45,
                                        .high = 0.45,
                                        .doc = "Free space around the mesh, as a part of the larger side."}),
        declare(&HeightSource::floorGap,
                {.id = "floorGap",
                 .label = "Floor gap",
                 .min = 0,
                 .max = 1,
                 .doc = "Height of the farthest visible point above the background; the "
                        "nearest has 1."}),
    };
    static const ParamTable table = makeTable<HeightSource>("shape", params);
    return table;
}

const ParamTable& materialParams() {
    static const Param params[] = {
        declare(&Material::base, {.id = "base",
                                  .label = "Base colour",
                                  .min = 0,
                                  .group = Group::Material,
                                  .doc = "Colour that shows without any light.",
                                  .color = true}),
        declare(&Material::diffuse, {.id = "diffuse",
                                     .label = "Diffuse colour",
                                     .min = 0,
                                     .max = 1,
                                     .group = Group::Material,
                                     .doc = "Colour of light that has been inside the solid.",
                                     .color = true}),
        declare(&Material::specular, {.id = "specular",
                                      .label = "Specular colour",
                                      .min = 0,
                                      .max = 1,
                                      .group = Group::Material,
                                      .doc = "Colour of the mirrored highlight.",
                                      .color = true}),
        declare(&Material::specularity, {.id = "specularity",
                                         .label = "Specularity",
                                         .min = 0,
                                         .max = 1,
                                         .group = Group::Material,
                                         .doc = "Share of the mirrored highlight in the picture."}),
        declare(&Material::forwardScatter,
                {.id = "forwardScatter",
                 .label = "Forward scattering",
                 .min = 0,
                 .max = 1,
                 .group = Group::Material,
                 .doc = "How much the light shows only where it comes from behind."}),
        declare(&Material::depth,
                {.id = "depth",
                 .label = "Depth",
                 .unit = "m",
                 .min = kAboveZero,
                 .max = 1e3,
                 .low = 0.002,
                 .high = 0.5,
                 .logarithmic = true,
                 .group = Group::Material,
                 .doc = "How far below the surface the light is looked at; small is hard, large is "
                        "soft."}),
        declare(&Material::specularFalloff,
                {.id = "specularFalloff",
                 .label = "Specular falloff",
                 .min = -1,
                 .max = 1,
                 .group = Group::Falloff,
                 .doc = "Cosines at which the highlight begins and is full; equal ends "
                        "make a sharp edge."}),
        declare(&Material::scatterFalloff,
                {.id = "scatterFalloff",
                 .label = "Scattering falloff",
                 .min = -1,
                 .max = 1,
                 .group = Group::Falloff,
                 .doc = "Cosines at which forward scattering begins and is full; equal "
                        "ends make a sharp edge."}),
    };
    static const ParamTable table = makeTable<Material>("material", params);
    return table;
}

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
    static const ParamTable table = makeTable<Transform>("transform", params);
    return table;
}

const ParamTable& pointLightParams() {
    static const Param params[] = {
        declare(&PointLight::position, {.id = "position",
                                        .label = "Light position",
                                        .unit = "m",
                                        .min = -kFar,
                                        .max = kFar,
                                        .low = -1,
                                        .group = Group::Light,
                                        .doc = "Where the lamp stands; drag in the picture moves it.",
                                        .attribute = "light"}),
        declare(&PointLight::color, {.id = "color",
                                     .label = "Light colour",
                                     .min = 0,
                                     .group = Group::Light,
                                     .doc = "Colour of the lamp's light.",
                                     .color = true}),
        declare(&PointLight::intensity,
                {.id = "intensity",
                 .label = "Intensity",
                 .min = 0,
                 .high = 4,
                 .group = Group::Light,
                 .doc = "Factor of the lamp's light; watts per steradian when it fades with "
                        "the inverse square."}),
        declare(&PointLight::falloff,
                {.id = "falloff",
                 .label = "Fading",
                 .group = Group::Light,
                 .doc = "Whether the light fades with the square of the distance, as lamps do.",
                 .choices = kFalloffNames}),
        declare(&PointLight::radius,
                {.id = "radius",
                 .label = "Light radius",
                 .unit = "m",
                 .min = 0,
                 .max = kFar,
                 .high = 0.5f,
                 .group = Group::Light,
                 .doc = "Radius of the lamp, a disc that faces what it lights: soft shadows."}),
    };
    static const ParamTable table = makeTable<PointLight>("light", params);
    return table;
}

const ParamTable& distantLightParams() {
    static const Param params[] = {
        declare(&DistantLight::direction, {.id = "direction",
                                           .label = "Light direction",
                                           .min = -kFar,
                                           .max = kFar,
                                           .low = -1,
                                           .group = Group::Light,
                                           .doc = "The way the light travels."}),
        declare(&DistantLight::color, {.id = "color",
                                       .label = "Light colour",
                                       .min = 0,
                                       .group = Group::Light,
                                       .doc = "Colour of the light.",
                                       .color = true}),
        declare(&DistantLight::irradiance, {.id = "irradiance",
                                            .label = "Irradiance",
                                            .min = 0,
                                            .high = 4,
                                            .group = Group::Light,
                                            .doc = "Light on a surface that faces it."}),
        declare(&DistantLight::angle,
                {.id = "angle",
                 .label = "Light angle",
                 .unit = "degrees",
                 .min = 0,
                 .max = 90,
                 .high = 20,
                 .group = Group::Light,
                 .doc = "How wide the light is seen, as a disc: soft shadows. The sun has 0.53."}),
    };
    static const ParamTable table = makeTable<DistantLight>("light", params);
    return table;
}

const ParamTable& environmentParams() {
    static const Param params[] = {
        declare(&Environment::enabled, {.id = "enabled",
                                        .label = "Environment light",
                                        .group = Group::Environment,
                                        .doc = "Light from all around, from the environment map."}),
        declare(&Environment::rotation,
                {.id = "rotation",
                 .label = "Rotation",
                 .unit = "degrees",
                 .low = -180,
                 .high = 180,
                 .group = Group::Environment,
                 .doc = "Turns the environment map about the fixed x, y, z axes, x first.",
                 .attribute = "env-rotation"}),
        declare(&Environment::intensity, {.id = "intensity",
                                          .label = "Intensity",
                                          .min = 0,
                                          .high = 4,
                                          .group = Group::Environment,
                                          .doc = "Factor of the environment's light."}),
    };
    static const ParamTable table = makeTable<Environment>("environment", params);
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
    static const ParamTable table = makeTable<Camera>("camera", params);
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
        declare(&View::lightDot, {.id = "lightDot",
                                  .label = "Light dot",
                                  .group = Group::View,
                                  .doc = "Marks where the lamp stands."}),
    };
    static const ParamTable table = makeTable<View>("view", params);
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
                 .doc = "Root mean square error that the picture may have, over its mean: the cheapest "
                        "settings that keep it are chosen. 0: the settings as they are."}),
    };
    static const ParamTable table = makeTable<Quality>("quality", params);
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
                                 static_cast<const std::byte*>(table.defaults) + param.offset});
    }
};

const ParamTable& tableOfLight(const Light& light) {
    return std::holds_alternative<PointLight>(light) ? pointLightParams() : distantLightParams();
}

// Group::None stands last: it is in no panel.
int panelOrder(const BoundParam& bound) {
    const Group group = bound.param->group;
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

std::string vectorText(vec3 v) { return shortest(v.x) + " " + shortest(v.y) + " " + shortest(v.z); }

// Short enough that normalising it in float would divide by zero.
bool isZero(vec3 v) { return glm::length(dvec3(v)) < 1e-15; }

} // namespace

std::vector<BoundParam> bindParams(Scene& scene) {
    Binder binder;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        Light& light = scene.lights[i];
        void* data = std::visit([](auto& value) -> void* { return &value; }, light);
        binder.add("lights." + std::to_string(i), i == 0 ? "light" : "", tableOfLight(light), data);
    }
    for (Object& object : scene.objects) {
        const std::string path = "objects." + object.name;
        const bool first = &object == &scene.objects.front();
        binder.add(path + ".material", first ? "material" : "", materialParams(), &object.material);
        binder.add(path + ".shape", first ? "shape" : "", heightFieldParams(), &object.field());
        binder.add(path + ".transform", first ? "transform" : "", transformParams(), &object.transform);
    }
    if (scene.environment) binder.add("environment", "env", environmentParams(), &*scene.environment);
    for (auto& [name, settings] : scene.technique)
        binder.add("technique." + name, name, settings.table(), settings.data());
    const bool orthographic = scene.camera.type == Camera::Type::Orthographic;
    binder.add("camera", "camera", cameraParams(), &scene.camera, orthographic ? "fov" : "height");
    binder.add("view", "view", viewParams(), &scene.view);
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

Status check(const Light& light) {
    const auto* distant = std::get_if<DistantLight>(&light);
    if (distant && isZero(distant->direction)) return Error{"direction is 0 0 0; must have a length"};
    return Done{};
}

namespace {

Status assign(Scene& scene, std::string_view path, std::string_view value) {
    const std::string wanted = pathWithName(scene, path);
    const std::vector<BoundParam> bound = bindParams(scene);
    const auto found =
        std::find_if(bound.begin(), bound.end(), [&](const BoundParam& b) { return b.path == wanted; });
    if (found == bound.end()) {
        std::vector<std::string_view> paths;
        for (const BoundParam& b : bound)
            paths.push_back(b.path);
        return Error{std::string(path) + " is not a parameter; the nearest is " +
                     std::string(nearest(wanted, paths))};
    }
    if (Status set = setText(*found->param, found->data, value); !set)
        return Error{found->path + " " + set.error().message};
    if (Status legal = check(scene.camera); !legal) return Error{"camera." + legal.error().message};
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (Status legal = check(scene.lights[i]); !legal)
            return Error{"lights." + std::to_string(i) + "." + legal.error().message};
    return Done{};
}

} // namespace

Status setParam(Scene& scene, std::string_view path, std::string_view value) {
    Scene trial = scene; // images are shared, so a copy is cheap
    if (Status set = assign(trial, path, value); !set) return set;
    return assign(scene, path, value);
}

} // namespace lucent::scene
