#include "truth/Gloss.h"

#include "base/Overloaded.h"
#include "scene/ReflectanceTable.h"
#include "truth/Interface.h"
#include "truth/Lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucent::truth {

namespace {

constexpr double kPi = std::numbers::pi;

/// Roughness of the facets that spread light about as the material does.
double roughnessOf(const scene::Material& material) {
    // A power of the cosine to the middle falls as facets whose alpha² is 2 / (power + 2); that to the
    // mirrored direction as four times the power.
    const auto ofPower = [](double power) { return std::pow(2 / (power + 2), 0.25); };
    return std::visit(Overloaded{[](const scene::Glossy& m) { return double(m.roughness); },
                                 [](const scene::CookTorrance& m) { return double(m.roughness); },
                                 [&](const scene::Phong& m) { return ofPower(4 * double(m.exponent)); },
                                 [&](const scene::Blinn& m) { return ofPower(double(m.exponent)); },
                                 [](const auto&) { return 1.0; }},
                      material.kind);
}

double cosineOf(const dvec3& a, const dvec3& b) { return std::clamp(glm::dot(a, b), -1.0, 1.0); }

dvec3 schlick(const dvec3& straight, double cosine) {
    return straight + (1.0 - straight) * std::pow(1 - cosine, 5);
}

dvec3 straightOf(const scene::Glossy& m) {
    return glm::min(reflectance(1, 1 / double(m.ior)) * dvec3(m.specular), dvec3(1));
}

/// Area of the facets' shadows behind each of their own, by which Smith's shares are 1 / (1 + hidden).
double hidden(double alpha, double theta) {
    const double tangent = std::tan(theta);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tangent * tangent) - 1);
}

} // namespace

/// In radians: of light, view and the direction halfway to the normal; of that to the view; of the view to
/// the mirrored light; between light and view around the normal.
struct Gloss::Angles {
    double light, view, middle, turned, mirrored, around;
    Angles(const dvec3& normal, const dvec3& toLight, const dvec3& toEye) {
        const dvec3 halfway = glm::normalize(toLight + toEye);
        light = std::acos(cosineOf(normal, toLight));
        view = std::acos(cosineOf(normal, toEye));
        middle = std::atan2(glm::length(glm::cross(normal, halfway)), glm::dot(normal, halfway));
        turned = std::acos(cosineOf(toEye, halfway));
        mirrored = std::acos(cosineOf(2 * glm::dot(normal, toLight) * normal - toLight, toEye));
        const dvec3 a = toLight - glm::dot(normal, toLight) * normal,
                    b = toEye - glm::dot(normal, toEye) * normal;
        const double lengths = glm::length(a) * glm::length(b);
        around = lengths > 0 ? std::acos(cosineOf(a / std::sqrt(lengths), b / std::sqrt(lengths))) : kPi / 2;
    }
};

Gloss::Gloss(const scene::Material& material, const dvec3& normal, const dvec3& viewer, Part part)
    : material_(material), normal_(normal), viewer_(viewer), part_(part),
      facets_(normal, viewer, std::max(roughnessOf(material), kSmooth), 1.5),
      ofFacets_(part == Part::Matt || std::holds_alternative<scene::OrenNayar>(material.kind) ? 0
                : part == Part::Mirrored                                                      ? 1
                                                                                              : 0.5) {}

dvec3 Gloss::share(const dvec3& toLight) const {
    if (glm::dot(normal_, toLight) <= 0 || glm::dot(normal_, viewer_) <= 0) return dvec3(0);
    if (const auto* table = std::get_if<scene::MeasuredBrdf>(&material_.kind))
        return part_ == Part::Mirrored ? dvec3(0) : measuredShare(*table, toLight);
    const Angles angles(normal_, toLight, viewer_);
    dvec3 sum(0);
    if (part_ != Part::Mirrored) sum += mattShare(angles);
    if (part_ != Part::Matt) sum += mirroredShare(angles);
    return sum;
}

/// In the frame of the surface that tables with blocks are laid out in: x across the world's y, or its x.
dvec3 Gloss::measuredShare(const scene::MeasuredBrdf& measured, const dvec3& toLight) const {
    const dvec3 aside = std::abs(normal_.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 x = glm::normalize(glm::cross(aside, normal_)), y = glm::cross(normal_, x);
    const auto local = [&](const dvec3& v) {
        return dvec3(glm::dot(v, x), glm::dot(v, y), glm::dot(v, normal_));
    };
    return glm::dot(normal_, toLight) *
           scene::lookUp(*measured.table, measured.form, measured.blocks, local(toLight), local(viewer_));
}

/// 0: nothing is mirrored.
double Gloss::roughnessFor(float roughness) const {
    if (double(roughness) >= kSmooth) return double(roughness);
    return part_ == Part::Mirrored ? kSmooth : 0;
}

dvec3 Gloss::mattShare(const Angles& at) const {
    const dvec3 matt = dvec3(material_.diffuse) * std::cos(at.light) / kPi;
    return std::visit(Overloaded{[&](const scene::Glossy& m) {
                                     return (1 - double(m.metallic)) *
                                            (1.0 - schlick(straightOf(m), std::cos(at.turned))) * matt;
                                 },
                                 [&](const scene::Phong& m) { return m.asPrinted ? kPi * matt : matt; },
                                 [&](const scene::Blinn& m) { return m.asPrinted ? kPi * matt : matt; },
                                 [&](const scene::OrenNayar& m) {
                                     const double square = double(m.roughness) * double(m.roughness);
                                     const double even = 1 - 0.5 * square / (square + 0.33);
                                     const double back = 0.45 * square / (square + 0.09);
                                     return matt * (even + back * std::max(0.0, std::cos(at.around)) *
                                                               std::sin(std::max(at.light, at.view)) *
                                                               std::tan(std::min(at.light, at.view)));
                                 },
                                 [&](const auto&) { return matt; }},
                      material_.kind);
}

dvec3 Gloss::mirroredShare(const Angles& at) const {
    const auto power = [](double angle, double exponent) {
        return std::pow(std::max(0.0, std::cos(angle)), exponent);
    };
    return std::visit(
        Overloaded{
            [&](const scene::Glossy& m) {
                const double rough = roughnessFor(m.roughness);
                if (rough == 0) return dvec3(0);
                const double alpha = rough * rough, tangent = std::tan(at.middle);
                const double wide = alpha * alpha + tangent * tangent;
                const double density = alpha * alpha / (kPi * power(at.middle, 4) * wide * wide);
                const double seen = 1 / (1 + hidden(alpha, at.light) + hidden(alpha, at.view));
                const dvec3 straight = glm::mix(straightOf(m), dvec3(material_.diffuse), double(m.metallic));
                return schlick(straight, std::cos(at.turned)) * (density * seen / (4 * std::cos(at.view)));
            },
            [&](const scene::Phong& m) {
                const double n = double(m.exponent), factor = m.asPrinted ? 1 : (n + 2) / (2 * kPi);
                return dvec3(m.specular) * (factor * power(at.mirrored, n) * std::cos(at.light));
            },
            [&](const scene::Blinn& m) {
                const double n = double(m.exponent);
                const double factor =
                    m.asPrinted ? 1 : (n + 2) * (n + 4) / (8 * kPi * (std::pow(2, -n / 2) + n));
                return dvec3(m.specular) * (factor * power(at.middle, n) * std::cos(at.light));
            },
            [&](const scene::CookTorrance& m) {
                const double rough = roughnessFor(m.roughness);
                if (rough == 0) return dvec3(0);
                const double slope = rough * rough, tangent = std::tan(at.middle) / slope;
                const double density =
                    std::exp(-tangent * tangent) / (kPi * slope * slope * power(at.middle, 4));
                const double groove = 2 * std::cos(at.middle) / std::cos(at.turned);
                const double seen = std::min({1.0, groove * std::cos(at.light), groove * std::cos(at.view)});
                const double lobe = reflectance(std::cos(at.turned), 1 / double(m.ior)) * density * seen /
                                    (4 * std::cos(at.view));
                return dvec3(m.specular) * (m.asPrinted ? 4 * lobe : lobe);
            },
            [](const auto&) { return dvec3(0); }},
        material_.kind);
}

double Gloss::density(const dvec3& toLight) const {
    const double even = std::max(0.0, glm::dot(normal_, toLight)) / kPi;
    return ofFacets_ * (ofFacets_ > 0 ? facets_.density(toLight) : 0) + (1 - ofFacets_) * even;
}

dvec3 Gloss::choose(dvec2 chance) const {
    if (chance.x < ofFacets_) return facets_.choose({chance.x / ofFacets_, chance.y});
    const dvec2 onDisc = placeInDisc({(chance.x - ofFacets_) / (1 - ofFacets_), chance.y});
    const dvec3 aside = std::abs(normal_.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(normal_, aside)), second = glm::cross(normal_, first);
    const double up = std::sqrt(std::max(0.0, 1 - glm::dot(onDisc, onDisc)));
    return glm::normalize(onDisc.x * first + onDisc.y * second + up * normal_);
}

bool showsObjects(const scene::Material& material) {
    return material.isGlossy() && !std::holds_alternative<scene::OrenNayar>(material.kind) &&
           !std::holds_alternative<scene::MeasuredBrdf>(material.kind) &&
           roughnessOf(material) <= double(scene::kMostMirroringRoughness);
}

} // namespace lucent::truth
