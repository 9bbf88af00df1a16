#include "scene/Translucency.h"

#include "base/Text.h"
#include "scene/Keys.h"
#include "scene/MaterialPresets.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

constexpr double kPerMm = 1000;         // 1/m
constexpr double kMostCollisions = 1e6; // before light is absorbed; of the measured ones cream has 37,000
constexpr double kSame = 1e-5;          // of a coefficient: what two ways to it may differ by in floats

// Of one colour; 1/m.
struct Reduced {
    double scattering, absorption;
    double extinction() const { return scattering + absorption; }
    double collisions() const {
        const double count = absorption > 0 ? scattering / absorption : kMostCollisions;
        return std::clamp(count, 1 / kMostCollisions, kMostCollisions);
    }
    double albedo() const { return scattering / extinction(); }
};

using Colors = std::array<Reduced, 3>;

Colors reducedOf(const Translucent& material) {
    const vec3 absorption = material.absorption;
    Colors colors;
    for (int i = 0; i < 3; ++i)
        colors[std::size_t(i)] = {(1 - double(material.anisotropy)) * double(material.scattering[i]),
                                  double(absorption[i])};
    return colors;
}

double meanExtinction(const Colors& colors) {
    return (colors[0].extinction() + colors[1].extinction() + colors[2].extinction()) / 3;
}

// The mean over colours that meet anything inside. @param albedo  of a colour
template <class Albedo>
double glowOf(const Colors& colors, Albedo albedo) {
    double sum = 0;
    int count = 0;
    for (const Reduced& color : colors)
        if (color.extinction() > 0) {
            sum += halfSpaceAlbedo(albedo(color));
            ++count;
        }
    return count > 0 ? sum / count : 0;
}

double albedoAfter(double collisions) { return collisions / (1 + collisions); }

// The factor of all colours' collisions that leaves this glow.
double factorFor(const Colors& colors, double glow) {
    double low = -60, high = 60; // of its logarithm: more than kMostCollisions squared
    for (int i = 0; i < 80; ++i) {
        const double middle = (low + high) / 2, factor = std::exp(middle);
        const double found =
            glowOf(colors, [&](const Reduced& color) { return albedoAfter(factor * color.collisions()); });
        (found < glow ? low : high) = middle;
    }
    return std::exp((low + high) / 2);
}

bool isSame(double a, double b) { return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b)); }

bool isSame(vec3 a, vec3 b) {
    return isSame(double(a.x), double(b.x)) && isSame(double(a.y), double(b.y)) &&
           isSame(double(a.z), double(b.z));
}

Measured presetOf(const Translucent& material) {
    const std::span<const MaterialPreset> presets = materialPresets();
    for (std::size_t i = 0; i < presets.size(); ++i) {
        Translucent measured = material;
        apply(presets[i], measured);
        if (isSame(measured.scattering, material.scattering) && measured.ior == material.ior &&
            isSame(measured.absorption, material.absorption))
            return Measured(int(i) + 1);
    }
    return Measured::Own;
}

Translucent withBlur(Translucent material, double blur) {
    const double factor = kPerMm / (blur * meanExtinction(reducedOf(material)));
    material.scattering = vec3(dvec3(material.scattering) * factor);
    material.absorption = vec3(dvec3(material.absorption) * factor);
    return material;
}

Translucent withGlow(Translucent material, double glow) {
    const Colors colors = reducedOf(material);
    const double factor = glow < 1 ? factorFor(colors, glow) : 0;
    dvec3 scattering, absorption(0);
    for (int i = 0; i < 3; ++i) {
        const Reduced& color = colors[std::size_t(i)];
        const double albedo = glow < 1 ? albedoAfter(factor * color.collisions()) : 1;
        if (glow < 1) absorption[i] = color.extinction() / (1 + factor * color.collisions());
        scattering[i] = albedo * color.extinction() / (1 - double(material.anisotropy));
    }
    material.scattering = vec3(scattering);
    material.absorption = vec3(absorption);
    return material;
}

Translucency wordsOf(const Translucent& material) {
    const Colors colors = reducedOf(material);
    return {.preset = presetOf(material),
            .blur = float(kPerMm / meanExtinction(colors)),
            .glow = float(glowOf(colors, [](const Reduced& color) { return color.albedo(); })),
            .scatteringPerMm = vec3(dvec3(material.scattering) / kPerMm),
            .absorptionPerMm = vec3(dvec3(material.absorption) / kPerMm)};
}

// Whether the material is what the member says, to the float: then nothing changes, not by rounding either.
bool isAlready(const Translucency& wanted, std::string_view id, const Translucent& material) {
    const Translucency now = wordsOf(material);
    if (id == "blur") return wanted.blur == now.blur;
    if (id == "glow") return wanted.glow == now.glow;
    if (id == "scatteringPerMm") return wanted.scatteringPerMm == now.scatteringPerMm;
    return id == "absorptionPerMm" && wanted.absorptionPerMm == now.absorptionPerMm;
}

Result<Translucent> made(const Translucency& wanted, std::string_view id, Translucent material) {
    if (id == "blur") return withBlur(material, double(wanted.blur));
    if (id == "glow") return withGlow(material, double(wanted.glow));
    if (id == "scatteringPerMm") {
        material.scattering = vec3(kPerMm * dvec3(wanted.scatteringPerMm));
    } else if (id == "absorptionPerMm") {
        material.absorption = vec3(kPerMm * dvec3(wanted.absorptionPerMm));
    } else {
        if (wanted.preset == Measured::Own) return Error{"is own; must be a measured material"};
        apply(materialPresets()[std::size_t(wanted.preset) - 1], material);
    }
    return material;
}

} // namespace

double halfSpaceAlbedo(double albedo) {
    const double s = std::sqrt(std::max(0.0, 1 - albedo));
    return (1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s);
}

Translucency translucencyOf(const Material& material) {
    return material.isScattering() ? wordsOf(material.translucent()) : Translucency{};
}

const ParamTable& translucencyParams() {
    static const auto names = [] {
        std::vector<std::string_view> list{"own"};
        for (const MaterialPreset& preset : materialPresets())
            list.push_back(preset.name);
        return list;
    }();
    static const Param params[] = {
        declare(&Translucency::preset,
                {.id = "preset",
                 .label = "Material",
                 .group = Group::Subsurface,
                 .doc =
                     "Whose scattering, absorption and index of refraction these are, as Jensen, Marschner, "
                     "Levoy and Hanrahan measured them (2001, figure 5); own: nobody's.",
                 .choices = names}),
        declare(&Translucency::blur,
                {.id = "blur",
                 .label = "Blur",
                 .unit = "mm",
                 .min = 1e-3,
                 .max = 1e6,
                 .low = 0.02,
                 .high = 50,
                 .logarithmic = true,
                 .group = Group::Subsurface,
                 .doc = "How far light spreads inside: the mean free path, over which it "
                        "forgets where it came from. Scattering and absorption change together, so that "
                        "colours stay."}),
        declare(&Translucency::glow,
                {.id = "glow",
                 .label = "Glow",
                 .min = 1e-3,
                 .max = 1,
                 .low = 0.01,
                 .high = 0.99,
                 .group = Group::Subsurface,
                 .doc =
                     "How bright it is: the share of light that comes back from deep inside, the mean over "
                     "colours. It moves between scattering and absorption while their sum, and with it the "
                     "blur, stays."}),
        declare(&Translucency::scatteringPerMm,
                {.id = "scatteringPerMm",
                 .label = "Scattering",
                 .unit = "1/mm",
                 .min = 0,
                 .max = kFar / kPerMm,
                 .low = 0.01,
                 .high = 20,
                 .logarithmic = true,
                 .group = Group::Subsurface,
                 .doc = "How often light is scattered on a millimetre of its path inside.",
                 .axes = "rgb"}),
        declare(&Translucency::absorptionPerMm,
                {.id = "absorptionPerMm",
                 .label = "Absorption",
                 .unit = "1/mm",
                 .min = 0,
                 .max = kFar / kPerMm,
                 .low = 1e-4,
                 .high = 2,
                 .logarithmic = true,
                 .group = Group::Subsurface,
                 .doc = "How often light is absorbed on a millimetre of its path inside.",
                 .axes = "rgb"}),
    };
    static const ParamTable table = tableOf<Translucency>("material", params);
    return table;
}

Status store(const Translucency& wanted, std::string_view id, Material& material) {
    const Translucent now = material.isScattering() ? material.translucent() : Translucent{};
    if (material.isScattering() && isAlready(wanted, id, now)) return Done{};
    Result<Translucent> result = made(wanted, id, now);
    if (!result) return result.error();
    const vec3 s = result->scattering;
    if (!(std::max({s.x, s.y, s.z}) <= float(kFar)))
        return Error{"asks for a scattering of " + shortest(std::max({s.x, s.y, s.z})) +
                     " 1/m; must be at most " + shortest(float(kFar))};
    material.kind = std::move(*result);
    return Done{};
}

} // namespace lucent::scene
