#include "truth/Lambert.h"

#include "truth/ColorMap.h"
#include "truth/Estimate.h"
#include "truth/RenderRelief.h"

namespace lucent::truth {

Result<LambertEstimator> LambertEstimator::create(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                                  const LambertOptions& options) {
    if (Status known = checkAov(aov); !known) return known.error();
    std::vector<PlacedField> objects = placeAll(scene);
    std::vector<Shape> shapes;
    for (const PlacedField& placed : objects)
        shapes.push_back(FieldBlock{std::make_shared<Field>(placed.field), placed.placement});
    Result<RayScene> rays = RayScene::create(std::move(shapes));
    if (!rays) return rays.error();
    return LambertEstimator(scene, size, aov, options, std::move(objects), std::move(*rays));
}

LambertEstimator::LambertEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                   const LambertOptions& options, std::vector<PlacedField> objects,
                                   RayScene rays)
    : eye_(scene.camera, size), size_(size), aov_(aov), options_(options), objects_(std::move(objects)),
      rays_(std::move(rays)) {
    for (const LightSource& lamp : worldLamps(scene, options.normalise))
        (lamp.radius > 0 ? discs_ : points_).push_back(lamp);
    if (const auto environment = shiningEnvironment(scene, options.normalise))
        sky_.emplace(*environment, aov == scene::Aov::Color ? Choice::ByLight : Choice::Evenly);
}

/// What one point or direction of light leaves on a point of the surface, given in world space.
dvec3 LambertEstimator::arriving(const LightSource& light, const PlacedField& object,
                                 const SurfacePoint& point) const {
    const LightPath path = lightPath(point, 0, light);
    const double cosine = glm::dot(point.normal, path.direction);
    if (cosine <= 0) return dvec3(0);
    const double horizontal = glm::length(dvec2(object.placement.directionFromWorld(path.direction)));
    const Leaving leaving{int(&object - objects_.data()),
                          object.field.texel() * object.placement.scale / horizontal};
    if (rays_.occluded({point.position, path.direction, path.distance}, leaving)) return dvec3(0);
    if (aov_ == scene::Aov::Illumination) return dvec3(light.weight * cosine);
    return cosine * (light.inverseSquare ? light.color / (path.distance * path.distance) : light.color);
}

/// One point of each soft lamp and one direction of the sky.
dvec3 LambertEstimator::sample(const PlacedField& object, const SurfacePoint& point, Random random) const {
    dvec3 sum{0};
    for (const LightSource& disc : discs_)
        sum += arriving(pointOnDisc(disc, point.position, placeInDisc(random.nextPair())), object, point);
    if (!sky_) return sum;
    LightSource direction = sky_->choose(random.nextPair());
    direction.color *= kMeanToLambert;
    sum += arriving(direction, object, point);
    return sum;
}

Pixel LambertEstimator::solve(ivec2 pixel) const {
    const Sight sight = eye_.look(eye_.ray(pixel), objects_);
    if (!sight.object) return {};
    const PlacedField& object = *sight.object;
    const SurfacePoint point{object.placement.pointInWorld(sight.point.position),
                             object.placement.directionInWorld(sight.point.normal)};
    dvec3 exact{0};
    for (const LightSource& lamp : points_)
        exact += arriving(lamp, object, point);
    Estimate estimate;
    const auto index = std::uint64_t(pixel.y) * std::uint64_t(size_.x) + std::uint64_t(pixel.x);
    if (!discs_.empty() || sky_)
        for (int i = 0; i < options_.samples; ++i)
            estimate.add(sample(object, point, Random(options_.seed, index, std::uint64_t(i))));

    const dvec3 light = exact + estimate.mean();
    if (aov_ == scene::Aov::Illumination) {
        const double lights = double(points_.size() + discs_.size()) + (sky_ ? 1 : 0);
        if (lights == 0) return {dvec3(0), dvec3(0), sight.coverage};
        return {light / lights, estimate.varianceOfMean() / (lights * lights), sight.coverage};
    }
    const scene::Material& material = object.object->material;
    const dvec2 place = object.field.placeOnMap(sight.point.position);
    const double matt = 1 - double(material.relief().specularity);
    const dvec3 diffuse = matt * dvec3(material.diffuse) * sampleMap(material.diffuseMap.get(), place);
    const dvec3 base = matt * dvec3(material.base) * sampleMap(material.baseMap.get(), place);
    return {base + diffuse * light, diffuse * diffuse * estimate.varianceOfMean(), sight.coverage};
}

} // namespace lucent::truth
