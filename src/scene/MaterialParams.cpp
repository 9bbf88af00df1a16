// What a person may change about what surfaces do with light, and on which surfaces it does something.
#include "base/Text.h"
#include "scene/Keys.h"
#include "scene/Scene.h"
#include "scene/Translucency.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

// The darkest colour that may be left of white. None at all would be an absorption without bound; a millionth
// is black in every picture, and with it a distance can be found for any absorption (setAbsorption()).
constexpr double kDarkest = 1e-6;

// At 1 light would go on as if nothing had scattered it.
constexpr double kMostAnisotropy = 0.999;

} // namespace

const ParamTable& colorParams() {
    static const Param params[] = {
        declare(&Material::base,
                {.id = "base",
                 .label = "Base colour",
                 .min = 0,
                 .group = Group::Material,
                 .doc = "Colour that shows without any light; on shapes other than height fields "
                        "the radiance that the surface gives off.",
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
    static const ParamTable table = tableOf<Material>("material", params);
    return table;
}

const ParamTable& opticsParams() {
    static const Param params[] = {
        declare(&Material::reflectance,
                {.id = "reflectance",
                 .label = "Reflectance",
                 .min = 0,
                 .max = 1,
                 .group = Group::Material,
                 .doc = "Share of light that is mirrored, at any angle; above 0 the surface is a mirror and "
                        "does nothing else.",
                 .color = true}),
        declare(&Material::transmission,
                {.id = "transmission",
                 .label = "Transmission",
                 .min = 0,
                 .max = 1,
                 .group = Group::Refraction,
                 .doc = "Share of the light inside that passes; above 0 the object is clear, its surface "
                        "refracts and does nothing else."}),
        declare(&Material::scattering,
                {.id = "scattering",
                 .label = "Scattering",
                 .unit = "1/m",
                 .min = 0,
                 .max = kFar,
                 .high = 5e3, // marble, milk and skin
                 .group = Group::Material,
                 .doc =
                     "How often light is scattered on a metre of its way inside, red, green and blue; above "
                     "0 the object is translucent.",
                 .axes = "rgb"}),
    };
    static const ParamTable table = tableOf<Material>("material", params);
    return table;
}

const ParamTable& mediumParams() {
    static const Param params[] = {
        declare(&Material::ior, {.id = "ior",
                                 .label = "Index of refraction",
                                 .min = kAboveZero,
                                 .max = 100,
                                 .low = 0.5,
                                 .high = 2.5,
                                 .group = Group::Refraction,
                                 .doc = "Of the inside over that of vacuum: water 1.33, glass 1.5, diamond "
                                        "2.42; below 1 a bubble."}),
        declare(&Material::attenuationDistance,
                {.id = "attenuationDistance",
                 .label = "Attenuation distance",
                 .unit = "m",
                 .min = 0,
                 .max = 1e30,
                 .group = Group::Refraction,
                 .doc = "Way inside after which white light has the attenuation colour; 0: nothing is "
                        "absorbed."}),
        declare(&Material::attenuationColor,
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
    static const ParamTable table = tableOf<Material>("material", params);
    return table;
}

const ParamTable& refractionParams() {
    static const Param params[] = {
        declare(&Material::dispersion,
                {.id = "dispersion",
                 .label = "Dispersion",
                 .min = 0,
                 .max = 20,
                 .group = Group::Refraction,
                 .doc =
                     "20 over the Abbe number: how far the index differs between red and blue; crown glass "
                     "0.31, flint 0.55."}),
        declare(&Material::fresnel, {.id = "fresnel",
                                     .label = "Fresnel reflection",
                                     .group = Group::Refraction,
                                     .doc = "Each surface mirrors its share of light; off: all light is "
                                            "transmitted unless it is totally reflected."}),
    };
    static const ParamTable table = tableOf<Material>("material", params);
    return table;
}

const ParamTable& scatteringParams() {
    static const Param params[] = {
        declare(&Material::anisotropy,
                {.id = "anisotropy",
                 .label = "Anisotropy",
                 .min = -kMostAnisotropy,
                 .max = kMostAnisotropy,
                 .low = -kMostAnisotropy,
                 .high = kMostAnisotropy,
                 .group = Group::Material,
                 .doc = "Mean cosine of the angle by which scattered light turns: 0 as often back as forth, "
                        "towards 1 forwards. Light spreads as if scattering were (1 - anisotropy) times as "
                        "frequent and even."}),
        declare(&Material::thickness,
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
        declare(&Material::roughness,
                {.id = "roughness",
                 .label = "Roughness",
                 .min = 0,
                 .max = 1,
                 .group = Group::Material,
                 .doc = "Of the surface that mirrors lamps: 0 as sharp points, 1 spread wide."}),
    };
    static const ParamTable table = tableOf<Material>("material", params);
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
                 .doc = "How often light is scattered on a metre of its way, red, green and blue."}),
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

std::vector<MediumLayer> Material::stackedLayers() const {
    std::vector<MediumLayer> stacked = layers;
    std::erase_if(stacked, [](const MediumLayer& layer) { return layer.thickness == 0; });
    std::stable_sort(stacked.begin(), stacked.end(),
                     [](const MediumLayer& a, const MediumLayer& b) { return a.order < b.order; });
    return stacked;
}

float Material::surfaceIor() const {
    const std::vector<MediumLayer> stacked = stackedLayers();
    return stacked.empty() ? ior : stacked.front().ior;
}

vec3 Material::absorption() const {
    if (attenuationDistance == 0) return vec3(0);
    const auto sigma = [&](float color) {
        return float(-std::log(double(color)) / double(attenuationDistance));
    };
    return {sigma(attenuationColor.x), sigma(attenuationColor.y), sigma(attenuationColor.z)};
}

void Material::setAbsorption(vec3 sigma) {
    attenuationColor = vec3(1);
    attenuationDistance = 0;
    const double largest = std::max({sigma.x, sigma.y, sigma.z});
    if (largest == 0) return;
    // Just above the darkest colour: where colours are near 1 a float keeps few digits of their logarithm.
    attenuationDistance = float(std::min(13 / largest, 1e30));
    for (int i = 0; i < 3; ++i)
        attenuationColor[i] = float(std::exp(-double(sigma[i]) * double(attenuationDistance)));
}

namespace {

bool holds(const ParamTable& table, std::string_view key) {
    return std::any_of(table.params.begin(), table.params.end(), [&](const Param& p) { return p.id == key; });
}

} // namespace

std::string whyIdle(const Object& object, std::string_view key) {
    if (key == "wave" && (object.isField() || std::holds_alternative<Water>(object.shape)))
        return " does nothing on height fields and water; must stand on another shape";
    if (key == "paint")
        return object.isField() ? " does nothing on a height field; must stand on another shape"
                                : std::string();
    const bool inside = holds(mediumParams(), key) || key == "absorption";
    const bool refracts = holds(refractionParams(), key);
    const bool scatters = holds(scatteringParams(), key) || key == "layers" || key.starts_with("layers.") ||
                          (key != "preset" && holds(translucencyParams(), key));
    if (object.isField()) {
        if (!inside && !refracts && !scatters && !holds(opticsParams(), key) && key != "preset") return {};
        return " does nothing on a height field; must stand on another shape";
    }
    const Material& material = object.material;
    const bool isMap = key == "baseMap" || key == "diffuseMap" || key == "specularMap";
    if (isMap || holds(reliefParams(), key))
        return " does nothing on a " + inQuotes(typeOf(object.shape).type) + "; must stand on a height field";
    if (inside && !material.isRefractive() && !material.isScattering())
        return " does nothing where no light gets inside; must stand beside a transmission or scattering "
               "above 0";
    if (refracts && !material.isRefractive())
        return " does nothing where nothing is transmitted; must stand beside a transmission above 0";
    if (scatters && !material.isScattering())
        return " does nothing where nothing scatters; must stand beside a scattering above 0";
    if (!holds(colorParams(), key)) return {};
    if (material.isRefractive())
        return " does nothing beside a transmission above 0; must stand on an opaque surface";
    if (material.isMirror())
        return " does nothing beside a reflectance above 0; must stand on an opaque surface";
    if (material.isScattering() && !object.painting)
        return " does nothing beside a scattering above 0; must stand on an opaque or painted surface";
    return {};
}

std::vector<const ParamTable*> materialTables(const Object& object) {
    std::vector<const ParamTable*> acting;
    for (const ParamTable* table : materialKeys().tables)
        if (whyIdle(object, table->params.front().id).empty()) acting.push_back(table);
    return acting;
}

} // namespace lucent::scene
