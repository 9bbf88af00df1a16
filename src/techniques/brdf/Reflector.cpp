#include "techniques/brdf/Reflector.h"

#include "scene/Mesh.h"

#include "base/Overloaded.h"
#include "scene/ReflectanceTable.h"

#include <algorithm>
#include <cmath>

namespace lucent::brdf {

namespace glsl {
using glm::clamp, glm::cross, glm::dot, glm::fract, glm::length, glm::max, glm::min, glm::mat3, glm::mix,
    glm::normalize, glm::vec2, glm::vec3, glm::vec4;
using std::abs, std::cos, std::exp, std::exp2, std::pow, std::sin, std::sqrt;
#include "shaders/brdf/models.glsl"
#include "shaders/lib/surface_frame.glsl"
} // namespace glsl

namespace {

float squared(float x) { return x * x; }

// A power of the cosine to the direction halfway falls as facets whose alpha² is 2 / (power + 2).
float alphaOfPower(float power) { return std::sqrt(2 / (power + 2)); }

} // namespace

ReflectorValues reflectorOf(const scene::Material& material) {
    const auto values = [&](vec3 specular, float ior, float alpha, float exponent, bool asPrinted,
                            int model) {
        return ReflectorValues{vec4(material.diffuse, 1), vec4(specular, ior),
                               vec4(alpha, exponent, asPrinted ? 1 : 0, float(model))};
    };
    return std::visit(Overloaded{[&](const scene::Glossy& m) {
                                     return values(m.specular, m.ior, squared(m.roughness), m.metallic, false,
                                                   glsl::kGlossy);
                                 },
                                 [&](const scene::Phong& m) {
                                     return values(m.specular, 1, 1, m.exponent, m.asPrinted, glsl::kPhong);
                                 },
                                 [&](const scene::Blinn& m) {
                                     return values(m.specular, 1, 1, m.exponent, m.asPrinted, glsl::kBlinn);
                                 },
                                 [&](const scene::CookTorrance& m) {
                                     return values(m.specular, m.ior, squared(m.roughness), 0, m.asPrinted,
                                                   glsl::kCookTorrance);
                                 },
                                 [&](const scene::OrenNayar& m) {
                                     return values(vec3(0), 1, m.roughness, 0, false, glsl::kOrenNayar);
                                 },
                                 [&](const auto&) { return values(vec3(0), 1, 1, 0, false, glsl::kMatt); }},
                      material.kind);
}

float facetAlphaOf(const scene::Material& material) {
    constexpr float kLeast = 1e-3f; // facets of which densities stay finite in a float
    const float alpha =
        std::visit(Overloaded{[](const scene::Glossy& m) { return squared(m.roughness); },
                              [](const scene::CookTorrance& m) { return squared(m.roughness); },
                              // the angle to mirrored light is twice that to the direction halfway
                              [](const scene::Phong& m) { return alphaOfPower(4 * m.exponent); },
                              [](const scene::Blinn& m) { return alphaOfPower(m.exponent); },
                              [](const auto&) { return 1.0f; }},
                   material.kind);
    return std::max(alpha, kLeast);
}

bool hasLobe(const scene::Material& material) {
    return material.isGlossy() && !std::holds_alternative<scene::OrenNayar>(material.kind) &&
           !std::holds_alternative<scene::MeasuredBrdf>(material.kind);
}

bool showsObjects(const scene::Object& object) {
    const scene::Textures* textures = scene::texturesOf(object);
    const int image = textures ? textures->roughness.image : -1;
    const float least =
        image < 0 ? 1 : std::get<scene::MeshShape>(object.shape).mesh->images[std::size_t(image)]->leastGreen;
    return hasLobe(object.material) &&
           facetAlphaOf(object.material) * squared(least) <= squared(scene::kMostMirroringRoughness);
}

namespace {

glsl::Reflector glslOf(const scene::Material& material) {
    const ReflectorValues values = reflectorOf(material);
    return {values.diffuse, values.specular, values.lobe.x, values.lobe.y, values.lobe.z, int(values.lobe.w)};
}

constexpr vec3 kUp(0, 0, 1);

// Evenly by area of the disc below: as a matt surface is lit.
vec3 cosineDirection(vec2 u) {
    const float r = std::sqrt(u.x), turn = 2 * kPi * u.y;
    return {r * std::cos(turn), r * std::sin(turn), std::sqrt(1 - u.x)};
}

vec3 shareOf(const glsl::Reflector& reflector, vec3 normal, vec3 toLight, vec3 toEye) {
    const glsl::Angles angles = glsl::anglesOf(normal, toLight, toEye);
    return glsl::mattShare(reflector, angles) + glsl::mirroredShare(reflector, angles);
}

} // namespace

vec3 shareOf(const scene::Material& material, vec3 normal, vec3 toLight, vec3 toEye) {
    if (const auto* measured = std::get_if<scene::MeasuredBrdf>(&material.kind)) {
        const mat3 surfaceFromWorld = glm::transpose(glsl::surfaceFrame(normal));
        const dvec3 light(surfaceFromWorld * toLight), eye(surfaceFromWorld * toEye);
        return vec3(scene::lookUp(*measured->table, measured->form, measured->blocks, light, eye) *
                    std::max(light.z, 0.0));
    }
    return shareOf(glslOf(material), normal, toLight, toEye);
}

scene::Brdf brdfOf(const scene::Material& material) {
    if (const auto* measured = std::get_if<scene::MeasuredBrdf>(&material.kind))
        return [held = *measured](const dvec3& toLight, const dvec3& toEye) {
            return vec3(scene::lookUp(*held.table, held.form, held.blocks, toLight, toEye));
        };
    return [reflector = glslOf(material)](const dvec3& toLight, const dvec3& toEye) {
        return shareOf(reflector, kUp, vec3(toLight), vec3(toEye)) / float(toLight.z);
    };
}

vec3 directionalAlbedo(const scene::Material& material, float cosine) {
    constexpr int kMatt = 1024, kLobe = 4096;
    const float view = std::max(cosine, 1e-3f), alpha = facetAlphaOf(material);
    glsl::Reflector reflector = glslOf(material);
    reflector.alpha = std::max(reflector.alpha, alpha * float(hasLobe(material)));
    const vec3 toEye(std::sqrt(1 - view * view), 0, view);
    vec3 sum(0);
    for (int i = 0; i < kMatt; ++i) {
        const vec3 toLight = cosineDirection(glsl::latticePoint(i, kMatt));
        const vec3 share = hasLobe(material) ? glsl::mattShare(reflector, glsl::anglesOf(kUp, toLight, toEye))
                                             : shareOf(material, kUp, toLight, toEye);
        sum += share * (kPi / (std::max(toLight.z, 1e-6f) * float(kMatt)));
    }
    for (int i = 0; hasLobe(material) && i < kLobe; ++i) {
        const vec3 facet = glsl::seenFacet(toEye, alpha, glsl::latticePoint(i, kLobe));
        const vec3 toLight = glm::reflect(-toEye, facet);
        if (toLight.z <= 0) continue;
        const glsl::Angles angles = glsl::anglesOf(kUp, toLight, toEye);
        sum += glsl::mirroredShare(reflector, angles) /
               (float(kLobe) * glsl::seenDensity(angles.middle, angles.aside, view, alpha));
    }
    return sum;
}

float reciprocityError(const scene::Material& material) {
    constexpr int kPairs = 256;
    float worst = 0;
    for (int i = 0; i < kPairs; ++i) {
        const vec3 a = cosineDirection(glsl::latticePoint(i, kPairs)),
                   b = cosineDirection(glm::fract(glsl::latticePoint(i, kPairs) + vec2(0.37f, 0.59f)));
        const vec3 there = shareOf(material, kUp, a, b) / a.z, back = shareOf(material, kUp, b, a) / b.z;
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(there[c] - back[c]) / std::max({there[c], back[c], 1e-6f}));
    }
    return worst;
}

float tableError(const scene::Material& material, scene::TableForm form, int blocks, int texels, int pairs) {
    const scene::Brdf brdf = brdfOf(material);
    const bool isMerl = form == scene::TableForm::Merl;
    const Image whole = isMerl ? scene::tabulate(brdf, form, blocks, texels) : Image();
    const auto direction = [](double share, double turn) {
        const double up = 0.02 + 0.98 * share, aside = std::sqrt(1 - up * up);
        return dvec3(aside * std::cos(2 * kPi * turn), aside * std::sin(2 * kPi * turn), up);
    };
    double squares = 0, sum = 0;
    for (int i = 0; i < pairs; ++i) { // a lattice of rank 1 in four dimensions
        const auto at = [&](double step) { return std::fmod((i + 0.5) * step, 1.0); };
        const dvec3 toLight = direction(at(0.8566749), at(0.7338919)),
                    toEye = direction(at(0.6287067), at(0.5385973));
        const dvec3 found = isMerl ? scene::lookUp(whole, form, blocks, toLight, toEye)
                                   : scene::lookUp(brdf, form, blocks, texels, toLight, toEye);
        const double exact = double(brdf(toLight, toEye).y), apart = found.y - exact;
        squares += apart * apart;
        sum += exact;
    }
    return float(std::sqrt(squares / pairs) / (sum / pairs));
}

} // namespace lucent::brdf
