#include "truth/Glass.h"

#include "truth/Estimate.h"

#include <algorithm>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Status checkGlassAov(scene::Aov aov) {
    using scene::Aov;
    for (const Aov known : {Aov::Color, Aov::Direction, Aov::Layers, Aov::Normal, Aov::Depth, Aov::Position})
        if (aov == known) return Done{};
    return Error{"truth: AOV " + std::string(scene::aovNames()[std::size_t(aov)]) +
                 " is none of what is seen through glass; must be color, direction, layers, normal, depth or "
                 "position"};
}
} // namespace

Beam beamFrom(const Eye& eye, dvec2 place, const Media& around) {
    const Ray ray = eye.ray(place);
    return {.origin = ray.anchor + ray.offset,
            .direction = ray.direction,
            .media = around,
            .begin = eye.isPerspective() ? 0 : -kInfinity};
}

Media mediaAtEye(const Optics& optics, const scene::Camera& camera) {
    if (camera.type == scene::Camera::Type::Orthographic) return {};
    return optics.mediaAt(dvec3(camera.eye), false);
}

Result<GlassEstimator> GlassEstimator::create(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                              const GlassOptions& options) {
    if (Status known = checkGlassAov(aov); !known) return known.error();
    Result<Optics> optics = Optics::create(scene);
    if (!optics) return optics.error();
    return GlassEstimator(scene, size, aov, options, std::move(*optics));
}

GlassEstimator::GlassEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                               const GlassOptions& options, Optics optics)
    : eye_(scene.camera, size), size_(size), aov_(aov), options_(options),
      optics_(std::make_unique<Optics>(std::move(optics))),
      illumination_(scene, *optics_, options.attenuation), atEye_(mediaAtEye(*optics_, scene.camera)) {
    if (scene.environment && scene.environment->enabled) sky_.emplace(*scene.environment);
    background_ = sky_ && std::any_of(scene.objects.begin(), scene.objects.end(),
                                      [](const scene::Object& object) { return !object.isField(); });
}

dvec3 GlassEstimator::shown(const Arrival& arrival, Random& random) const {
    if (arrival.at == Arrival::At::Sky && sky_ && (background_ || arrival.surfaces > 0))
        return sky_->radiance(arrival.direction);
    if (arrival.at != Arrival::At::Opaque) return dvec3(0);
    const double away = arrival.surfaces == 0 ? eye_.distanceFrom(arrival.hit.position) : kInfinity;
    return illumination_.radiance(arrival.hit, -arrival.direction, away, random);
}

/// Of all colours at once; `channel` says whose indices of refraction count.
dvec3 GlassEstimator::radiance(const Beam& beam, int channel, Random& random, Seen& seen) const {
    const Limits limits = options_.branching == Branching::Tree ? kPhysics : Limits{};
    const auto light = [&](const Arrival& arrival) {
        seen.byChance |= arrival.byChance || (arrival.at == Arrival::At::Opaque && illumination_.isSampled());
        return arrival.weight * shown(arrival, random);
    };
    const Arrival arrival = follow(*optics_, beam, channel, options_.branching, limits, random);
    seen.anything |= arrival.at != Arrival::At::Sky || arrival.surfaces > 0 || background_;
    dvec3 sum = light(arrival);
    if (arrival.mirrored)
        sum += light(follow(*optics_, *arrival.mirrored, channel, options_.branching, limits, random));
    return sum;
}

GlassEstimator::Seen GlassEstimator::seen(const Beam& beam, Random& random) const {
    Seen seen{dvec3(0), false, options_.branching == Branching::Tree};
    if (!optics_->disperses()) {
        seen.radiance = radiance(beam, 1, random, seen);
        return seen;
    }
    for (int channel = 0; channel < 3; ++channel)
        seen.radiance[channel] = radiance(beam, channel, random, seen)[channel];
    return seen;
}

Pixel GlassEstimator::color(ivec2 pixel) const {
    const auto index = std::uint64_t(pixel.y) * std::uint64_t(size_.x) + std::uint64_t(pixel.x);
    Estimate estimate; // of what covers it
    int count = 0;
    for (bool byChance = true; count < options_.samples && byChance; ++count) {
        Random random(options_.seed, index, std::uint64_t(count));
        const Seen one = seen(beamFrom(eye_, dvec2(pixel) + 0.5, atEye_), random);
        if (one.anything) estimate.add(one.radiance);
        byChance = one.byChance;
    }
    return {estimate.mean(), estimate.varianceOfMean(), double(estimate.count()) / double(count)};
}

int GlassEstimator::layers(const Beam& beam) const {
    WorldRay ray{beam.origin, beam.direction, kInfinity, beam.begin, false};
    for (int count = 0;;) {
        const Hits hits = optics_->rays().coincidentHits(ray);
        if (hits.count == 0) return count;
        for (const Hit& hit : hits) {
            if (!optics_->object(hit.shape).material.isRefractive() || optics_->isOpaque(hit.shape))
                return count;
            ++count;
        }
        ray.begin = hits.at[0].distance + optics_->rays().gap();
    }
}

Pixel GlassEstimator::solve(ivec2 pixel) const {
    if (aov_ == scene::Aov::Color) return color(pixel);
    const Beam beam = beamFrom(eye_, dvec2(pixel) + 0.5, atEye_);
    if (aov_ == scene::Aov::Layers) return {dvec3(layers(beam)), dvec3(0), 1};
    if (aov_ == scene::Aov::Direction) {
        Random unused(0, 0, 0);
        const Arrival arrival = follow(*optics_, beam, 1, Branching::Chain, {}, unused);
        // Of a ray that was given up neither, so that pictures without coverage tell it too.
        if (arrival.at == Arrival::At::Lost) return {};
        return {arrival.direction, dvec3(0), 1};
    }
    const auto hit = optics_->rays().intersect({beam.origin, beam.direction, kInfinity, beam.begin, false});
    if (!hit) return {};
    if (aov_ == scene::Aov::Depth) return {dvec3(hit->distance), dvec3(0), 1};
    return {aov_ == scene::Aov::Normal ? hit->smoothNormal : hit->position, dvec3(0), 1};
}

} // namespace lucent::truth
