#include "truth/Lamps.h"

#include "truth/ColorMap.h"
#include "truth/Gloss.h"
#include "truth/Interface.h"
#include "truth/LightPath.h"
#include "truth/Textured.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

LightPath wayTo(const dvec3& place, const dvec3& from) {
    const double distance = glm::distance(place, from);
    return {distance > 0 ? (place - from) / distance : dvec3(0, 1, 0), distance};
}

/// Two unit vectors perpendicular to a unit vector and to each other.
glm::dmat2x3 across(const dvec3& axis) {
    const dvec3 aside = std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(axis, aside));
    return {first, glm::cross(axis, first)};
}

/// Directions from a point that meet a ball: a cone, or all of them from inside.
struct BallCone {
    dvec3 axis{0, 1, 0};
    double gape = 2; ///< 1 - cosine of half the opening
    BallCone(const dvec3& from, const Sphere& ball) {
        const auto [direction, distance] = wayTo(ball.center, from);
        if (distance <= ball.radius) return;
        const double sine = ball.radius / distance;
        axis = direction;
        gape = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
    }
    bool holds(const dvec3& direction) const {
        const dvec3 apart = direction - axis; // its squared length is 2 (1 - cosine)
        return gape >= 2 || 0.5 * glm::dot(apart, apart) <= gape;
    }
    double solidAngle() const { return kTwoPi * gape; }
    dvec3 direction(dvec2 within) const {
        const double down = within.x * gape, sine = std::sqrt(down * (2 - down));
        const double angle = kTwoPi * within.y;
        return glm::normalize((1 - down) * axis +
                              across(axis) * (sine * dvec2(std::cos(angle), std::sin(angle))));
    }
};

std::size_t anyOf(std::size_t count, Random& random) {
    return std::min(std::size_t(random.next() * double(count)), count - 1);
}

/// A ray of light that has an irradiance on what faces it, from infinitely far away.
///
/// @param back  unit, to where it comes from
Emission emitFromAfar(const dvec3& back, const dvec3& irradiance, std::span<const Sphere> targets,
                      Random& random) {
    const Sphere& aim = targets[anyOf(targets.size(), random)];
    const dvec3 origin = aim.center + across(back) * (aim.radius * placeInDisc(random.nextPair()));
    double density = 0;
    for (const Sphere& target : targets)
        if (glm::length(glm::cross(origin - target.center, back)) <= target.radius)
            density += 2 / (kTwoPi * target.radius * target.radius);
    density /= double(targets.size());
    return {origin, -back, -kInfinity, density > 0 ? irradiance / density : dvec3(0)};
}

bool isAny(double share) { return share > 0; }
bool isAny(const dvec3& share) { return share.x > 0 || share.y > 0 || share.z > 0; }

/// What a smooth boundary lets in of light from a direction, with its cosine.
struct Entering {
    dvec3 normal;
    double ior; ///< 1: all

    double share(const dvec3& toLight) const {
        const double cosine = glm::dot(normal, toLight);
        return cosine > 0 ? (1 - reflectance(std::min(cosine, 1.0), 1 / ior)) * cosine : 0;
    }
    double density(const dvec3& toLight) const {
        return std::max(0.0, glm::dot(normal, toLight)) / std::numbers::pi;
    }
    dvec3 choose(dvec2 chance) const {
        const dvec2 onDisc = placeInDisc(chance);
        const double up = std::sqrt(std::max(0.0, 1 - glm::dot(onDisc, onDisc)));
        return glm::normalize(across(normal) * onDisc + up * normal);
    }
};
} // namespace

Lamp::Lamp(const scene::Light& light) {
    if (const auto source = sourceOf(light)) source_ = *source;
    if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
        source_.place = dvec3(spot->position);
        source_.inverseSquare = true;
        source_.color = double(spot->intensity) * dvec3(spot->color);
        const double inner = std::cos(double(spot->innerAngle) * kTwoPi / 360);
        const double outer = std::cos(double(spot->outerAngle) * kTwoPi / 360);
        const double scale = 1 / std::max(0.001, inner - outer);
        cone_ = {glm::normalize(dvec3(spot->direction)), scale, -outer * scale};
        if (spot->image) {
            const scene::PictureFrame frame = scene::pictureFrame(*spot);
            picture_ = {dvec3(frame.right), dvec3(frame.up), spot->image};
        }
    }
    if (const auto* area = std::get_if<scene::AreaLight>(&light)) {
        const dvec3 u(area->edgeU), v(area->edgeV), normal = glm::cross(u, v);
        panel_ = {dvec3(area->corner),
                  u,
                  v,
                  glm::normalize(normal),
                  glm::length(normal),
                  double(area->radiance) * dvec3(area->color)};
    }
}

dvec3 Lamp::inCone(const dvec3& direction) const {
    if (!cone_) return dvec3(1);
    const double along = glm::dot(direction, cone_->axis);
    const double share = std::clamp(along * cone_->scale + cone_->offset, 0.0, 1.0);
    if (!picture_ || share == 0) return dvec3(share * share);
    const dvec2 at(glm::dot(direction, picture_->right) / along, glm::dot(direction, picture_->up) / along);
    if (std::abs(at.x) > 1 || std::abs(at.y) > 1) return dvec3(0);
    return share * share * sampleMap(picture_->image.get(), {0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y});
}

LampLight Lamp::light(const dvec3& place, dvec2 within) const {
    if (panel_) {
        const LightPath way =
            wayTo(panel_->corner + within.x * panel_->edgeU + within.y * panel_->edgeV, place);
        const double cosine = std::max(0.0, -glm::dot(way.direction, panel_->normal));
        return {way, panel_->radiance * (panel_->area * cosine / (way.distance * way.distance))};
    }
    const LightSource point = source_.radius > 0 ? pointOnDisc(source_, place, placeInDisc(within)) : source_;
    if (point.distant) return {{point.place, kInfinity}, point.color};
    const LightPath way = wayTo(point.place, place);
    const double fall = point.inverseSquare ? way.distance * way.distance : 1;
    return {way, point.color * (inCone(-way.direction) / fall)};
}

Emission Lamp::emit(std::span<const Sphere> targets, Random& random) const {
    const dvec2 within = random.nextPair();
    if (source_.distant) {
        const LightSource point =
            source_.radius > 0 ? pointOnDisc(source_, dvec3(0), placeInDisc(within)) : source_;
        return emitFromAfar(point.place, source_.color, targets, random);
    }
    if (panel_) {
        const dvec3 origin = panel_->corner + within.x * panel_->edgeU + within.y * panel_->edgeV;
        Emission emission = emitFrom(origin, targets, random);
        const double cosine = std::max(0.0, glm::dot(emission.direction, panel_->normal));
        emission.flux *= panel_->radiance * (panel_->area * cosine);
        return emission;
    }
    const std::size_t aim = anyOf(targets.size(), random);
    const dvec3 origin = source_.radius > 0
                             ? pointOnDisc(source_, targets[aim].center, placeInDisc(within)).place
                             : source_.place;
    Emission emission = emitFrom(origin, targets, random);
    emission.flux *= source_.color * inCone(emission.direction);
    emission.fades = source_.inverseSquare;
    return emission;
}

/// `flux` is one over the density of directions.
Emission Lamp::emitFrom(const dvec3& origin, std::span<const Sphere> targets, Random& random) const {
    const dvec3 direction =
        BallCone(origin, targets[anyOf(targets.size(), random)]).direction(random.nextPair());
    double density = 0;
    for (const Sphere& target : targets)
        if (const BallCone cone(origin, target); cone.holds(direction)) density += 1 / cone.solidAngle();
    density /= double(targets.size());
    return {origin, direction, 0, dvec3(density > 0 ? 1 / density : 0)};
}

std::optional<dvec3> Lamp::place() const {
    if (panel_) return panel_->corner + 0.5 * (panel_->edgeU + panel_->edgeV);
    return source_.distant ? std::nullopt : std::optional(source_.place);
}

Illumination::Illumination(const scene::Scene& scene, const Optics& optics, Attenuation attenuation)
    : optics_(&optics), lamps_(scene.lights.begin(), scene.lights.end()), attenuation_(attenuation) {
    if (const auto environment = shiningEnvironment(scene, false))
        around_.emplace(Around{Sky(*environment), EnvironmentSampler(*environment, Choice::ByLight)});
}

bool Illumination::isSampled() const {
    return around_ ||
           std::any_of(lamps_.begin(), lamps_.end(), [](const Lamp& lamp) { return lamp.isSampled(); });
}

Emission Illumination::emit(std::size_t source, std::span<const Sphere> targets, Random& random) const {
    if (source < lamps_.size()) return lamps_[source].emit(targets, random);
    const LightSource direction = around_->directions.choose(random.nextPair());
    return emitFromAfar(direction.place, 2 * kTwoPi * direction.color, targets,
                        random); // a mean over 4 pi sr
}

namespace {
/// Radiance of a material that receives an irradiance as a matt one does.
dvec3 sentBy(const scene::Material& material, const Hit& hit, const dvec3& irradiance) {
    const double matt = material.isRelief() ? 1 - double(material.relief().specularity) : 1;
    dvec3 diffuse(material.diffuse);
    // Where light comes from and goes to is not known here: straight from above, and back.
    if (material.isGlossy())
        diffuse =
            std::numbers::pi * Gloss(material, hit.normal, hit.normal, Gloss::Part::Matt).share(hit.normal);
    return matt * (dvec3(material.base) + diffuse * irradiance / std::numbers::pi);
}
} // namespace

dvec3 Illumination::irradiance(const Hit& hit, const dvec3& viewer, Random& random, double ior) const {
    const std::optional<Textured> textured = texturedAt(*optics_, hit);
    return irradianceOf(textured ? textured->hit : hit, viewer, random, ior);
}

dvec3 Illumination::irradianceOf(const Hit& hit, const dvec3& viewer, Random& random, double ior) const {
    const Entering lobe{normalTowards(hit, viewer), ior};
    const dvec3 lamps = ofLamps(hit, lobe, random);
    return lamps + ofSky(hit, lobe, random);
}

dvec3 Illumination::radiance(const Hit& hit, const dvec3& viewer, double away, Random& random) const {
    return radiance(hit, viewer, away, random, true);
}

/// `around`: whether glossy surfaces show objects too.
dvec3 Illumination::radiance(const Hit& hit, const dvec3& viewer, double away, Random& random,
                             bool around) const {
    if (const auto* block = std::get_if<FieldBlock>(&optics_->rays().shape(hit.shape)))
        return ofRelief(*block, hit, viewer, away, random);
    const std::optional<Textured> textured = texturedAt(*optics_, hit);
    if (textured) return ofMaterial(textured->material, textured->hit, viewer, random, around);
    return ofMaterial(optics_->object(hit.shape).material, hit, viewer, random, around);
}

dvec3 Illumination::ofMaterial(const scene::Material& material, const Hit& hit, const dvec3& viewer,
                               Random& random, bool around) const {
    if (!material.isGlossy()) return sentBy(material, hit, irradianceOf(hit, viewer, random, 1));
    const dvec3 normal = normalTowards(hit, viewer);
    const Gloss all(material, normal, viewer);
    const dvec3 sum = dvec3(material.base) + ofLamps(hit, all, random);
    if (!around || !showsObjects(material)) return sum + ofSky(hit, all, random);
    return sum + ofSky(hit, Gloss(material, normal, viewer, Gloss::Part::Matt), random) +
           ofAround(hit, Gloss(material, normal, viewer, Gloss::Part::Mirrored), random);
}

/// One direction by the lobe: the object that lies there, or the environment.
dvec3 Illumination::ofAround(const Hit& hit, const Gloss& lobe, Random& random) const {
    const dvec3 direction = lobe.choose(random.nextPair());
    const dvec3 share = lobe.share(direction);
    if (share == dvec3(0)) return dvec3(0);
    const Beam beam{.origin = hit.position,
                    .direction = direction,
                    .media = optics_->bendsNothing() ? Media() : optics_->mediaAt(hit.position, true),
                    .begin = optics_->rays().gap()};
    const Arrival arrival = follow(*optics_, beam, 1, Branching::Chain, {}, random);
    dvec3 light(0);
    if (arrival.at == Arrival::At::Sky && around_) light = around_->sky.radiance(arrival.direction);
    if (arrival.at == Arrival::At::Opaque)
        light = radiance(arrival.hit, -arrival.direction, kInfinity, random, false);
    return arrival.weight * light * share / lobe.density(direction);
}

dvec3 Illumination::ofRelief(const FieldBlock& block, const Hit& hit, const dvec3& viewer, double away,
                             Random& random) const {
    const scene::Object& object = optics_->object(hit.shape);
    const SurfacePoint point{block.placement.pointFromWorld(hit.position),
                             block.placement.directionFromWorld(hit.normal)};
    const dvec3 below = hit.position - double(object.material.relief().depth) * hit.normal;
    const dvec3 eye = away < kInfinity ? glm::normalize(below - (hit.position + away * viewer)) : -viewer;
    Lighting lighting;
    const auto add = [&](const LightPath& way, const dvec3& irradiance) {
        const bool distant = way.distance == kInfinity;
        const dvec3 place = distant ? way.direction : below + way.distance * way.direction;
        const LightPath seen = distant ? way : wayTo(place, hit.position);
        const dvec3 passed = straightTransmittance(*optics_, {hit.position, seen.direction, seen.distance},
                                                   {hit.shape, kInfinity});
        if (passed == dvec3(0)) return;
        lighting.lamps.push_back({.place = distant ? block.placement.directionFromWorld(place)
                                                   : block.placement.pointFromWorld(place),
                                  .distant = distant,
                                  .color = passed * irradiance / std::numbers::pi});
    };
    for (const Lamp& lamp : lamps_) {
        const auto [way, irradiance] = lamp.light(below, lamp.isSampled() ? random.nextPair() : dvec2(0));
        if (irradiance != dvec3(0)) add(way, irradiance);
    }
    if (around_) {
        const LightSource direction = around_->directions.choose(random.nextPair());
        add({direction.place, kInfinity}, 2 * kTwoPi * direction.color);
    }
    return shade(*block.field, object, point, block.placement.directionFromWorld(eye), lighting, attenuation_)
        .color;
}

dvec3 Illumination::mirrored(const Hit& hit, const Facets& facets, Random& random) const {
    const dvec3 lamps = facets.isSmooth() ? dvec3(0) : ofLamps(hit, facets, random);
    return lamps + ofSky(hit, facets, random);
}

dvec3 Illumination::passed(const Hit& hit, const LightPath& way) const {
    return straightTransmittance(*optics_, {hit.position, way.direction, way.distance},
                                 leavingFrom(*optics_, hit, way.direction));
}

/// Light times the lobe's share of its direction.
dvec3 Illumination::ofLamps(const Hit& hit, const auto& lobe, Random& random) const {
    dvec3 sum{0};
    for (const Lamp& lamp : lamps_) {
        const auto [way, irradiance] =
            lamp.light(hit.position, lamp.isSampled() ? random.nextPair() : dvec2(0));
        const auto share = lobe.share(way.direction);
        if (isAny(share) && irradiance != dvec3(0)) sum += share * irradiance * passed(hit, way);
    }
    return sum;
}

/// One direction chosen by the environment's light and one by the lobe, each divided by the sum of both
/// densities (the balance heuristic, Veach, Guibas 1995): neither a small sun nor an even sky is noisy.
dvec3 Illumination::ofSky(const Hit& hit, const auto& lobe, Random& random) const {
    if (!around_) return dvec3(0);
    dvec3 sum{0};
    const dvec3 byLobe = lobe.choose(random.nextPair());
    for (const dvec3& direction : {around_->directions.choose(random.nextPair()).place, byLobe}) {
        const auto share = lobe.share(direction);
        if (!isAny(share)) continue;
        const dvec3 light = passed(hit, {direction, kInfinity});
        if (light == dvec3(0)) continue;
        const double density = around_->directions.density(direction) + lobe.density(direction);
        sum += around_->sky.radiance(direction) * light * (share / density);
    }
    return sum;
}

dvec3 shownBy(const Optics& optics, const Hit& hit, const dvec3& irradiance) {
    const scene::Material& material = optics.object(hit.shape).material;
    if (const std::optional<Textured> textured = texturedAt(optics, hit))
        return sentBy(textured->material, hit, irradiance);
    const auto* block = std::get_if<FieldBlock>(&optics.rays().shape(hit.shape));
    if (!block) return sentBy(material, hit, irradiance);
    const dvec2 place = block->field->placeOnMap(block->placement.pointFromWorld(hit.position));
    scene::Material here = material;
    here.base *= vec3(sampleMap(material.baseMap.get(), place));
    here.diffuse *= vec3(sampleMap(material.diffuseMap.get(), place));
    return sentBy(here, hit, irradiance);
}

dvec3 normalTowards(const Hit& hit, const dvec3& viewer) {
    const double side = glm::dot(hit.normal, viewer) < 0 ? -1 : 1;
    const dvec3 smooth = side * hit.smoothNormal;
    return glm::dot(smooth, viewer) < 0 ? side * hit.normal : smooth;
}

Leaving leavingFrom(const Optics& optics, const Hit& hit, const dvec3& direction) {
    const auto* block = std::get_if<FieldBlock>(&optics.rays().shape(hit.shape));
    if (!block) return {hit.shape, optics.rays().gap()};
    const double horizontal = glm::length(dvec2(block->placement.directionFromWorld(direction)));
    return {hit.shape, block->field->texel() * block->placement.scale / horizontal};
}

} // namespace lucent::truth
