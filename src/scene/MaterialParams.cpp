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
                    .doc = "Share of the light that passes through the inside; above 0 the object is "
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
                    .doc =
                        "How often light is scattered on a metre of its path inside, red, green and blue: "
                        "high values look dense and soft like milk, low ones hazy like cloudy water. Above 0 "
                        "the object is translucent.",
                    .axes = "rgb"});
}

template <class Kind>
Param roughnessParam(std::string_view doc) {
    return declare(
        &Kind::roughness,
        {.id = "roughness", .label = "Roughness", .min = 0, .max = 1, .group = Group::Material, .doc = doc});
}
template <class Kind>
Param specularParam(std::string_view doc) {
    return declare(&Kind::specular, {.id = "specular",
                                     .label = "Specular colour",
                                     .min = 0,
                                     .max = 1,
                                     .group = Group::Material,
                                     .doc = doc,
                                     .color = true});
}
template <class Kind>
Param exponentParam() {
    return declare(&Kind::exponent, {.id = "exponent",
                                     .label = "Exponent",
                                     .min = 0,
                                     .max = 1e5,
                                     .low = 1,
                                     .high = 1000,
                                     .logarithmic = true,
                                     .group = Group::Material,
                                     .doc = "Of the highlight: higher numbers make it smaller and sharper."});
}
template <class Kind>
Param asPrintedParam(std::string_view doc) {
    return declare(&Kind::asPrinted,
                   {.id = "asPrinted", .label = "As printed", .group = Group::Material, .doc = doc});
}
// Of what mirrors by Fresnel's equations: seen from a thinner medium.
template <class Kind>
Param mirroringIorParam() {
    return declare(&Kind::ior, {.id = "ior",
                                .label = "Index of refraction",
                                .min = 1,
                                .max = 100,
                                .low = 1,
                                .high = 2.5,
                                .group = Group::Material,
                                .doc = "How much the surface mirrors of light from straight above: 4 % at "
                                       "1.5 as plastic and varnish do, 17 % at 2.42 as diamond."});
}

constexpr std::string_view kKindNames[] = {"relief",        "matt",       "mirror",  "clear",
                                           "translucent",   "glossy",     "phong",   "blinn",
                                           "cook-torrance", "oren-nayar", "measured"};
constexpr std::string_view kTableForms[] = {"merl", "projected", "equal-area"};
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
                 "What the surface does with light: relief (the model of height fields), matt, mirror, "
                 "clear, "
                 "translucent, glossy (metal, plastic and varnish as glTF has them), or one of the classical "
                 "models phong, blinn, cook-torrance and oren-nayar, or measured, from a table. Left out it "
                 "follows from reflectance, "
                 "transmission, scattering or preset; "
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
        declare(&Translucent::precomputed,
                {.id = "precomputed",
                 .label = "Precomputed",
                 .group = Group::Material,
                 .doc = "What leaves of light is worked out once for the body, which must keep its shape and "
                        "have no paint but on what leaves: each picture then takes less, of light from "
                        "anywhere."}),
    };
    static const ParamTable table = tableOf<Translucent>("material", params);
    return table;
}

const ParamTable& glossyParams() {
    static const Param params[] = {
        declare(&Glossy::metallic, {.id = "metallic",
                                    .label = "Metallic",
                                    .min = 0,
                                    .max = 1,
                                    .group = Group::Material,
                                    .doc = "1 for metals, which mirror light in their diffuse colour and "
                                           "scatter none; 0 for all else."}),
        roughnessParam<Glossy>("Of the surface: 0 mirrors sharply, 1 spreads highlights wide."),
        mirroringIorParam<Glossy>(),
        specularParam<Glossy>("Factor of the light that mirrors of what is no metal."),
    };
    static const ParamTable table = tableOf<Glossy>("material", params);
    return table;
}

namespace {

constexpr std::string_view kHighlight = "Colour of the highlight.";
constexpr std::string_view kWithoutFactor = "The formula as the dissertation prints it, which gives off more "
                                            "light than it gets; off: with the factor "
                                            "that keeps it in bounds.";

// Phong and Blinn have the same parameters.
template <class Kind>
const ParamTable& exponentialParams() {
    static const Param params[] = {
        specularParam<Kind>(kHighlight),
        exponentParam<Kind>(),
        asPrintedParam<Kind>(kWithoutFactor),
    };
    static const ParamTable table = tableOf<Kind>("material", params);
    return table;
}

} // namespace

const ParamTable& phongParams() { return exponentialParams<Phong>(); }
const ParamTable& blinnParams() { return exponentialParams<Blinn>(); }

const ParamTable& cookTorranceParams() {
    static const Param params[] = {
        specularParam<CookTorrance>(kHighlight),
        roughnessParam<CookTorrance>("Of the surface: the root of the slope m of its facets."),
        mirroringIorParam<CookTorrance>(),
        asPrintedParam<CookTorrance>("The formula as the dissertation prints it, four times as bright; off: "
                                     "normalised, so that facets mirror what falls on them."),
    };
    static const ParamTable table = tableOf<CookTorrance>("material", params);
    return table;
}

const ParamTable& orenNayarParams() {
    static const Param params[] = {
        roughnessParam<OrenNayar>("Spread of the slopes of its facets in radians: 0 is matt, 1 is as flat to "
                                  "the eye as the full moon."),
    };
    static const ParamTable table = tableOf<OrenNayar>("material", params);
    return table;
}

const ParamTable& measuredParams() {
    static const Param params[] = {
        declare(&MeasuredBrdf::form,
                {.id = "form",
                 .label = "Form of the table",
                 .doc = "How the table is laid out: as the files of the MERL database, or in blocks, one for "
                        "each direction of light with a texel for each of view, spread by their projection "
                        "on the surface or evenly by solid angle.",
                 .choices = kTableForms}),
        declare(&MeasuredBrdf::blocks,
                {.id = "blocks",
                 .label = "Blocks",
                 .min = 0,
                 .max = 4096,
                 .doc = "Of a table in blocks, along a side; 0: as many as a block has "
                        "texels. Does nothing to a table of MERL's form."}),
    };
    static const ParamTable table = tableOf<MeasuredBrdf>("material", params);
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
                 .doc =
                     "How often light is scattered on a metre of its path, red, green and blue: high values "
                     "look dense and soft like milk, low ones hazy like cloudy water."}),
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
