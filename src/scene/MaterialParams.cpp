// What a person may change about what surfaces do with light.
#include "base/Text.h"
#include "scene/Keys.h"
#include "scene/Scene.h"
#include "scene/Translucency.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

// The darkest colour that may be left of white. None at all would be an absorption without bound; a millionth
// is black in every picture.
constexpr double kDarkest = 1e-6;

// At 1 light would go on as if nothing had scattered it.
constexpr double kMostAnisotropy = 0.999;

} // namespace

const ParamTable& colorParams() {
    static const Param params[] = {
        declare(&Material::base, {.id = "base",
                                  .label = "Base colour",
                                  .min = 0,
                                  .group = Group::Material,
                                  .doc = "Colour that shows without any light; on shapes other than height "
                                         "fields the radiance that the surface gives off, as a flame does.",
                                  .color = true}),
        declare(&Material::diffuse,
                {.id = "diffuse",
                 .label = "Diffuse colour",
                 .min = 0,
                 .max = 1,
                 .group = Group::Material,
                 .doc = "Colour of light that has been inside the solid; on shapes other than "
                        "height fields the share that the surface scatters (albedo).",
                 .color = true}),
    };
    static const ParamTable table = tableOf<Material>("material", params);
    return table;
}

const ParamTable& reliefParams() {
    static const Param params[] = {
        declare(&Relief::specular, {.id = "specular",
                                    .label = "Specular colour",
                                    .min = 0,
                                    .max = 1,
                                    .group = Group::Material,
                                    .doc = "Colour of the mirrored highlight.",
                                    .color = true}),
        declare(&Relief::specularity, {.id = "specularity",
                                       .label = "Specularity",
                                       .min = 0,
                                       .max = 1,
                                       .group = Group::Material,
                                       .doc = "Share of the mirrored highlight in the picture."}),
        declare(&Relief::forwardScatter, {.id = "forwardScatter",
                                          .label = "Forward scattering",
                                          .min = 0,
                                          .max = 1,
                                          .group = Group::Material,
                                          .doc = "How much the solid glows against the light, as a leaf "
                                                 "does: at 1 light shows only where it comes from behind."}),
        declare(&Relief::depth,
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
        declare(&Relief::specularFalloff, {.id = "specularFalloff",
                                           .label = "Specular falloff",
                                           .min = -1,
                                           .max = 1,
                                           .group = Group::Falloff,
                                           .doc = "Cosines at which the highlight begins and is full: far "
                                                  "apart it is soft, equal ends make a sharp edge."}),
        declare(&Relief::scatterFalloff, {.id = "scatterFalloff",
                                          .label = "Scattering falloff",
                                          .min = -1,
                                          .max = 1,
                                          .group = Group::Falloff,
                                          .doc = "Cosines at which forward scattering begins and is full: "
                                                 "far apart it is soft, equal ends make a sharp edge."}),
    };
    static const ParamTable table = tableOf<Relief>("material", params);
    return table;
}

namespace {

// Declared by each kind that has it, in its own range.
template <class Kind>
Param iorParam(double min, double max) {
    return declare(&Kind::ior,
                   {.id = "ior",
                    .label = "Index of refraction",
                    .min = min,
                    .max = max,
                    .low = 0.5,
                    .high = 2.5,
                    .group = Group::Refraction,
                    .doc = "How strongly light bends where it enters: the index of the inside over that of "
                           "vacuum. Water 1.33, glass 1.5, diamond 2.42; below 1 a bubble."});
}
template <class Kind>
Param absorptionParam() {
    return declare(&Kind::absorption,
                   {.id = "absorption",
                    .label = "Absorption",
                    .unit = "1/m",
                    .min = 0,
                    .max = kFar,
                    .high = 20,
                    .group = Group::Refraction,
                    .doc = "How soon light is coloured inside: it falls by e^(-absorption * metres), red, "
                           "green and blue; attenuationColor and attenuationDistance say the same.",
                    .axes = "rgb"});
}

template <class Struct>
Param reflectanceParam() {
    return declare(&Struct::reflectance, {.id = "reflectance",
                                          .label = "Reflectance",
                                          .min = 0,
                                          .max = 1,
                                          .group = Group::Material,
                                          .doc = "Share of light that is mirrored, at any angle; above 0 the "
                                                 "surface is a mirror and does nothing else.",
                                          .color = true});
}
template <class Struct>
Param transmissionParam() {
    return declare(&Struct::transmission,
                   {.id = "transmission",
                    .label = "Transmission",
                    .min = 0,
                    .max = 1,
                    .group = Group::Refraction,
                    .doc = "Share of the light inside that passes; above 0 the object is "
                           "clear, its surface refracts and does nothing else."});
}
template <class Struct>
Param scatteringParam() {
    return declare(&Struct::scattering,
                   {.id = "scattering",
                    .label = "Scattering",
                    .unit = "1/m",
                    .min = 0,
                    .max = kFar,
                    .high = 5e3, // marble, milk and skin
                    .group = Group::Material,
                    .doc = "How often light is scattered on a metre of its path inside, red, green and blue: "
                           "often is like milk, seldom like cloudy water. Above 0 the object is translucent.",
                    .axes = "rgb"});
}

constexpr std::string_view kKindNames[] = {"relief", "matt", "mirror", "clear", "translucent"};
static_assert(std::size(kKindNames) == std::variant_size_v<MaterialKinds>);

} // namespace

const ParamTable& choiceParams() {
    static const Param params[] = {
        declare(
            &KindChoice::kind,
            {.id = "kind",
             .label = "Kind",
             .group = Group::Material,
             .doc =
                 "What the surface does with light: relief (the model of height fields), matt, mirror, clear "
                 "or translucent. Left out it follows from reflectance, transmission, scattering or preset; "
                 "without those height fields are reliefs and other shapes matt.",
             .choices = kKindNames}),
        reflectanceParam<KindChoice>(),
        transmissionParam<KindChoice>(),
        scatteringParam<KindChoice>(),
    };
    static const ParamTable table = tableOf<KindChoice>("material", params);
    return table;
}

const ParamTable& mirrorParams() {
    static const Param params[] = {reflectanceParam<Mirror>()};
    static const ParamTable table = tableOf<Mirror>("material", params);
    return table;
}

const ParamTable& clearParams() {
    static const Param params[] = {
        transmissionParam<Clear>(),
        iorParam<Clear>(kAboveZero, 100),
        absorptionParam<Clear>(),
        declare(&Clear::dispersion,
                {.id = "dispersion",
                 .label = "Dispersion",
                 .min = 0,
                 .max = 20,
                 .group = Group::Refraction,
                 .doc = "How far white light is split into colours, as the index differs between red and "
                        "blue: 20 over the Abbe number. Crown glass 0.31, flint 0.55."}),
        declare(&Clear::fresnel, {.id = "fresnel",
                                  .label = "Fresnel reflection",
                                  .group = Group::Refraction,
                                  .doc = "Each surface mirrors its share of light; off: all light is "
                                         "transmitted unless it is totally reflected."}),
    };
    static const ParamTable table = tableOf<Clear>("material", params);
    return table;
}

const ParamTable& attenuationParams() {
    static const Param params[] = {
        declare(&Attenuation::distance,
                {.id = "attenuationDistance",
                 .label = "Attenuation distance",
                 .unit = "m",
                 .min = 0,
                 .max = 1e30,
                 .group = Group::Refraction,
                 .doc =
                     "Path length inside after which white light has the attenuation colour; 0: nothing is "
                     "absorbed."}),
        declare(&Attenuation::color,
                {.id = "attenuationColor",
                 .label = "Attenuation colour",
                 .min = kDarkest,
                 .max = 1,
                 .low = kDarkest,
                 .group = Group::Refraction,
                 .doc = "What is left of white light after the attenuation distance; black would be an "
                        "absorption without bound.",
                 .color = true}),
    };
    static const ParamTable table = tableOf<Attenuation>("material", params);
    return table;
}

const ParamTable& translucentParams() {
    static const Param params[] = {
        scatteringParam<Translucent>(),
        iorParam<Translucent>(double(kLeastScatteringIor), double(kMostScatteringIor)),
        absorptionParam<Translucent>(),
        declare(&Translucent::anisotropy,
                {.id = "anisotropy",
                 .label = "Anisotropy",
                 .min = -kMostAnisotropy,
                 .max = kMostAnisotropy,
                 .low = -kMostAnisotropy,
                 .high = kMostAnisotropy,
                 .group = Group::Material,
                 .doc = "Whether scattered light goes on forwards: the mean cosine of the angle by which it "
                        "turns. 0 as often back as forth; towards 1 forwards, as in skin. "
                        "Light spreads as if scattering were (1 - anisotropy) times as frequent and even."}),
        declare(&Translucent::thickness,
                {.id = "thickness",
                 .label = "Thickness",
                 .unit = "m",
                 .min = 0,
                 .max = kLargest,
                 .high = 0.02f,
                 .group = Group::Material,
                 .doc =
                     "Of a layer whose upper side the surface is, for profiles that know layers; 0: as thick "
                     "as the object."}),
        declare(&Translucent::roughness,
                {.id = "roughness",
                 .label = "Roughness",
                 .min = 0,
                 .max = 1,
                 .group = Group::Material,
                 .doc = "Of the surface that mirrors lamps: 0 as sharp points, 1 spread wide."}),
    };
    static const ParamTable table = tableOf<Translucent>("material", params);
    return table;
}

const ParamTable& layerParams() {
    static const Param params[] = {
        declare(&MediumLayer::thickness, {.id = "thickness",
                                          .label = "Thickness",
                                          .unit = "m",
                                          .min = 0,
                                          .max = kLargest,
                                          .high = 0.005,
                                          .group = Group::Material,
                                          .doc = "Of the layer; 0: it is not there."}),
        declare(&MediumLayer::order,
                {.id = "order",
                 .label = "Order",
                 .min = 1,
                 .max = kMostMediumLayers,
                 .low = 1,
                 .high = kMostMediumLayers,
                 .group = Group::Material,
                 .doc = "Layers lie from the top by rising order, those of one as they are listed."}),
        declare(&MediumLayer::scattering,
                {.id = "scattering",
                 .label = "Scattering",
                 .unit = "1/m",
                 .min = 0,
                 .max = kFar,
                 .high = 5e3,
                 .group = Group::Material,
                 .doc = "How often light is scattered on a metre of its path, red, "
                        "green and blue: often is like milk, seldom like cloudy water."}),
        declare(&MediumLayer::absorption,
                {.id = "absorption",
                 .label = "Absorption",
                 .unit = "1/m",
                 .min = 0,
                 .max = kFar,
                 .high = 5e3,
                 .group = Group::Material,
                 .doc = "Light falls by e^(-absorption * metres), red, green and blue."}),
        declare(&MediumLayer::anisotropy,
                {.id = "anisotropy",
                 .label = "Anisotropy",
                 .min = -kMostAnisotropy,
                 .max = kMostAnisotropy,
                 .low = -kMostAnisotropy,
                 .high = kMostAnisotropy,
                 .group = Group::Material,
                 .doc = "Mean cosine of the angle by which scattered light turns."}),
        declare(&MediumLayer::ior,
                {.id = "ior",
                 .label = "Index of refraction",
                 .min = double(kLeastScatteringIor),
                 .max = double(kMostScatteringIor),
                 .low = 1,
                 .high = 2,
                 .group = Group::Material,
                 .doc = "Of the layer over that of vacuum; the top layer's is that of the surface."}),
    };
    static const ParamTable table = tableOf<MediumLayer>("layer", params);
    return table;
}

std::vector<MediumLayer> Translucent::stackedLayers() const {
    std::vector<MediumLayer> stacked = layers;
    std::erase_if(stacked, [](const MediumLayer& layer) { return layer.thickness == 0; });
    std::stable_sort(stacked.begin(), stacked.end(),
                     [](const MediumLayer& a, const MediumLayer& b) { return a.order < b.order; });
    return stacked;
}

float Translucent::surfaceIor() const {
    const std::vector<MediumLayer> stacked = stackedLayers();
    return stacked.empty() ? ior : stacked.front().ior;
}

MaterialKind ownKind(const Shape& shape) {
    return std::holds_alternative<HeightField>(shape) ? MaterialKind::Relief : MaterialKind::Matt;
}

KindChoice choiceOf(const Material& material) {
    KindChoice choice{.kind = MaterialKind(material.kind.index())};
    if (material.isMirror()) choice.reflectance = material.mirror().reflectance;
    if (material.isRefractive()) choice.transmission = material.clear().transmission;
    if (material.isScattering()) choice.scattering = material.translucent().scattering;
    return choice;
}

Status store(const KindChoice& wanted, std::string_view id, Material& material) {
    if (id == "kind" && wanted.kind != MaterialKind(material.kind.index()))
        material.kind = alternative<MaterialKinds>(std::size_t(wanted.kind));
    if (id == "reflectance" && wanted.reflectance != vec3(0)) material.kind = Mirror{wanted.reflectance};
    if (id == "transmission" && wanted.transmission > 0)
        material.kind = Clear{.transmission = wanted.transmission};
    if (id == "scattering" && wanted.scattering != vec3(0))
        material.kind = Translucent{.scattering = wanted.scattering};
    return Done{};
}

Attenuation attenuationOf(vec3 absorption, float distance) {
    if (distance == 0 && absorption != vec3(0)) // half is left of the colour that is absorbed most
        distance = float(std::log(2.0) / double(std::max({absorption.x, absorption.y, absorption.z})));
    const dvec3 color = glm::exp(-dvec3(absorption) * double(distance));
    return {.distance = distance, .color = vec3(glm::max(color, kDarkest))};
}

vec3 absorptionOf(const Attenuation& attenuation) {
    if (attenuation.distance == 0) return vec3(0);
    const dvec3 sigma = -glm::log(dvec3(attenuation.color)) / double(attenuation.distance);
    return vec3(sigma) + 0.0f; // of white no -0
}

Status store(const Attenuation& wanted, std::string_view, Material& material) {
    const Absorbing to = absorbing(material);
    *to.absorption = absorptionOf(wanted);
    *to.distance = wanted.distance;
    return Done{};
}

Absorbing absorbing(Material& material) {
    if (material.isRefractive()) return {&material.clear().absorption, &material.clear().attenuationDistance};
    if (!material.isScattering()) return {};
    return {&material.translucent().absorption, &material.translucent().attenuationDistance};
}

} // namespace lucent::scene
