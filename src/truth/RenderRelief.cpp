#include "truth/RenderRelief.h"

namespace lucent::truth {

namespace {
LightSource inObject(LightSource light, const Placement& placement) {
    if (light.distant) {
        light.place = placement.directionFromWorld(light.place);
    } else {
        light.place = placement.pointFromWorld(light.place);
        light.radius /= placement.scale;
    }
    return light;
}

std::vector<LightSource> inObject(const std::vector<LightSource>& lights, const Placement& placement) {
    std::vector<LightSource> placed;
    for (const LightSource& light : lights)
        placed.push_back(inObject(light, placement));
    return placed;
}
} // namespace

ReliefEstimator::ReliefEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                 const ReliefOptions& options)
    : eye_(scene.camera, size), size_(size), aov_(aov), options_(options), objects_(placeAll(scene)) {
    Lighting world{worldLamps(scene, options.normalise), {}};
    for (int set = 0; set < options.environmentSets; ++set) {
        if (const auto environment = shiningEnvironment(scene, options.normalise)) {
            const Choice choice = aov == scene::Aov::Color ? Choice::ByLight : Choice::Evenly;
            world.environment = environmentLights(*environment, options.environmentLights, choice,
                                                  options.seed + (std::uint64_t(set) << 32));
            for (LightSource& light : world.environment)
                light.color *= kMeanToLambert;
        }
        for (const PlacedField& placed : objects_)
            lighting_.push_back(
                {inObject(world.lamps, placed.placement), inObject(world.environment, placed.placement)});
    }
}

Pixel ReliefEstimator::solve(ivec2 pixel) const {
    const Ray ray = eye_.ray(pixel);
    const Sight sight = eye_.look(ray, objects_);
    if (!sight.object) return {};
    const PlacedField& placed = *sight.object;
    const dvec3 below = sight.point.position - depthInObject(*placed.object) * sight.point.normal;
    const auto set = std::size_t(pixel.x % options_.environmentSets);
    const auto index = std::uint64_t(pixel.y) * std::uint64_t(size_.x) + std::uint64_t(pixel.x);
    const Shading shading =
        shade(placed.field, *placed.object, sight.point, eye_.directionTo(below, ray, placed.placement),
              lighting_[set * objects_.size() + std::size_t(&placed - objects_.data())], options_.attenuation,
              {options_.discSamples, Random(options_.seed, index, 0)});
    if (aov_ == scene::Aov::Color) return {shading.color, shading.colorVariance, sight.coverage};
    return {dvec3(shading.illumination), dvec3(shading.illuminationVariance), sight.coverage};
}

Status checkAov(scene::Aov aov) {
    if (aov == scene::Aov::Color || aov == scene::Aov::Illumination) return Done{};
    return Error{"truth: AOV \"" + std::string(scene::aovNames()[std::size_t(aov)]) +
                 "\" has no reference; must be color or d"};
}

Result<Image> renderRelief(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                           const ReliefOptions& options, const std::function<void(double)>& progress,
                           const std::atomic<bool>& cancel) {
    if (Status known = checkAov(aov); !known) return known.error();
    const ReliefEstimator estimator(scene, size, aov, options);
    Result<Picture> picture = render(estimator, size, {}, {options.threads, progress}, cancel);
    if (!picture) return picture.error();
    return std::move(picture->values);
}

} // namespace lucent::truth
