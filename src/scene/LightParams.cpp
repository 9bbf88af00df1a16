// What a person may change about lights.
#include "scene/Keys.h"
#include "scene/Scene.h"

namespace lucent::scene {
namespace {

constexpr std::string_view kFalloffNames[] = {"none", "inverse-square"};

} // namespace

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
                 .label = "Falloff",
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
    static const ParamTable table = tableOf<PointLight>("light", params);
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
    static const ParamTable table = tableOf<DistantLight>("light", params);
    return table;
}

const ParamTable& spotLightParams() {
    static const Param params[] = {
        declare(&SpotLight::position, {.id = "position",
                                       .label = "Light position",
                                       .unit = "m",
                                       .min = -kFar,
                                       .max = kFar,
                                       .low = -1,
                                       .group = Group::Light,
                                       .doc = "Where the lamp stands; drag in the picture moves it.",
                                       .attribute = "light"}),
        declare(&SpotLight::direction, {.id = "direction",
                                        .label = "Light direction",
                                        .min = -kFar,
                                        .max = kFar,
                                        .low = -1,
                                        .group = Group::Light,
                                        .doc = "Axis of the cone, the way the light travels."}),
        declare(&SpotLight::color, {.id = "color",
                                    .label = "Light colour",
                                    .min = 0,
                                    .group = Group::Light,
                                    .doc = "Colour of the lamp's light.",
                                    .color = true}),
        declare(&SpotLight::intensity, {.id = "intensity",
                                        .label = "Intensity",
                                        .unit = "W/sr",
                                        .min = 0,
                                        .high = 4,
                                        .group = Group::Light,
                                        .doc = "Light inside the inner cone; it fades with the square of the "
                                               "distance."}),
        declare(&SpotLight::innerAngle, {.id = "innerAngle",
                                         .label = "Inner angle",
                                         .unit = "degrees",
                                         .min = 0,
                                         .max = 89.9,
                                         .high = 89.9,
                                         .group = Group::Light,
                                         .doc = "From the axis to where the light begins to fade."}),
        declare(&SpotLight::outerAngle,
                {.id = "outerAngle",
                 .label = "Outer angle",
                 .unit = "degrees",
                 .min = 0.1,
                 .max = 89.9,
                 .low = 0.1,
                 .high = 89.9,
                 .group = Group::Light,
                 .doc = "From the axis to where no light is left; at least the inner angle."}),
    };
    static const ParamTable table = tableOf<SpotLight>("light", params);
    return table;
}

const ParamTable& projectorParams() {
    static const Param params[] = {
        declare(&SpotLight::fov, {.id = "fov",
                                  .label = "Width of the picture",
                                  .unit = "degrees",
                                  .min = 1,
                                  .max = 170,
                                  .low = 5,
                                  .high = 90,
                                  .group = Group::Light,
                                  .doc = "Across the picture that the lamp projects, seen from the lamp."}),
        declare(&SpotLight::roll, {.id = "roll",
                                   .label = "Turn of the picture",
                                   .unit = "degrees",
                                   .min = -360,
                                   .max = 360,
                                   .low = -180,
                                   .high = 180,
                                   .group = Group::Light,
                                   .doc = "Turns the picture that the lamp projects around its axis."}),
    };
    static const ParamTable table = tableOf<SpotLight>("light", params);
    return table;
}

namespace {

Param edgeOf(vec3 AreaLight::*edge, std::string_view id, std::string_view label, std::string_view doc) {
    return declare(edge, {.id = id,
                          .label = label,
                          .unit = "m",
                          .min = -kFar,
                          .max = kFar,
                          .low = -1,
                          .group = Group::Light,
                          .doc = doc});
}

} // namespace

const ParamTable& areaLightParams() {
    static const Param params[] = {
        edgeOf(&AreaLight::corner, "corner", "Light corner", "One corner of the shining parallelogram."),
        edgeOf(&AreaLight::edgeU, "edgeU", "First edge", "From that corner to the next."),
        edgeOf(
            &AreaLight::edgeV, "edgeV", "Second edge",
            "From that corner to the last; light leaves the side from which the first edge turns to this one "
            "counter-clockwise."),
        declare(&AreaLight::color, {.id = "color",
                                    .label = "Light colour",
                                    .min = 0,
                                    .group = Group::Light,
                                    .doc = "Colour of the lamp's light.",
                                    .color = true}),
        declare(&AreaLight::radiance, {.id = "radiance",
                                       .label = "Radiance",
                                       .unit = "W/(m² sr)",
                                       .min = 0,
                                       .high = 50,
                                       .group = Group::Light,
                                       .doc = "How bright the lamp is seen from its shining side."}),
    };
    static const ParamTable table = tableOf<AreaLight>("light", params);
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
    static const ParamTable table = tableOf<Environment>("environment", params);
    return table;
}

} // namespace lucent::scene
