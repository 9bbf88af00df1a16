#include "truth/Translucent.h"

#include "truth/Estimate.h"
#include "truth/Interface.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 2 integral of F_t(c) c dc: even steps of c², in which light from all around is even.
double meanTransmittance(double ior) {
    constexpr int kSteps = 100'000; // grazing angles cost a root of the step: 1e-6 is left
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        sum += 1 - reflectance(std::sqrt((i + 0.5) / kSteps), 1 / ior);
    return sum / kSteps;
}

Result<Body> bodyOf(const Optics& optics, int number, double time) {
    const scene::Material& material = optics.object(number).material;
    std::vector<Shape> shapes = {optics.rays().shape(number)};
    Result<RayScene> alone = RayScene::create(std::move(shapes));
    if (!alone) return alone.error();
    const auto ior = double(material.translucent().surfaceIor());
    Body body{.object = number,
              .alone = std::move(*alone),
              .insides = {},
              .layers = {},
              .surfaceIor = ior,
              .thickness = double(material.translucent().thickness),
              .meanTransmittance = meanTransmittance(ior),
              .painted = nullptr};
    if (optics.object(number).painting) {
        Result<PaintedSurface> painted = PaintedSurface::create(optics.object(number), time);
        if (!painted) return painted.error();
        body.painted = std::make_shared<PaintedSurface>(std::move(*painted));
    }
    const dvec3 absorption = optics.absorption(number);
    for (int channel = 0; channel < 3; ++channel)
        body.insides[std::size_t(channel)] = {double(material.translucent().scattering[channel]),
                                              double(material.translucent().anisotropy), absorption[channel],
                                              double(material.translucent().ior)};
    for (const scene::MediumLayer& layer : material.translucent().stackedLayers())
        for (int channel = 0; channel < 3; ++channel)
            body.layers[std::size_t(channel)].push_back(
                {{double(layer.scattering[channel]), double(layer.anisotropy),
                  double(layer.absorption[channel]), double(layer.ior)},
                 double(layer.thickness)});
    return body;
}

double depthIn(const Sphere& sphere, const RayScene&, const dvec3& place) {
    return sphere.radius - glm::distance(place, sphere.center);
}
double depthIn(const Torus& torus, const RayScene&, const dvec3& place) {
    const dvec3 out = place - torus.center;
    const double height = glm::dot(out, torus.axis);
    return torus.minor - std::hypot(glm::length(out - height * torus.axis) - torus.major, height);
}
double depthIn(const auto&, const RayScene& alone, const dvec3& place) {
    const auto nearest = alone.nearest(place);
    return nearest ? nearest->distance : 0;
}
} // namespace

double Body::depthOf(const dvec3& place) const {
    return std::visit([&](const auto& shape) { return depthIn(shape, alone, place); }, alone.shape(0));
}

double Body::lobe(double cosine) const {
    const double through = 1 - reflectance(std::min(cosine, 1.0), 1 / surfaceIor);
    return through / (std::numbers::pi * meanTransmittance);
}

Bodies::Bodies(Optics optics) : optics_(std::make_unique<Optics>(std::move(optics))) {}

Result<Bodies> Bodies::create(const scene::Scene& scene) {
    Result<Optics> optics = Optics::create(scene);
    if (!optics) return optics.error();
    Bodies bodies(std::move(*optics));
    for (int number = 0; number < int(scene.objects.size()); ++number) {
        if (!scene.objects[std::size_t(number)].material.isScattering()) continue;
        Result<Body> body = bodyOf(*bodies.optics_, number, double(scene.view.time));
        if (!body) return body.error();
        bodies.bodies_.push_back(std::move(*body));
    }
    if (bodies.bodies_.empty())
        return Error{
            "truth: no object has subsurface scattering; must be one with material.scattering above 0"};
    return bodies;
}

const Body* Bodies::of(int object) const {
    const auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& body) { return body.object == object; });
    return found == bodies_.end() ? nullptr : &*found;
}

std::optional<Bodies::Place> Bodies::seenAt(const Eye& eye, ivec2 pixel) const {
    const Beam beam = beamFrom(eye, dvec2(pixel) + 0.5, {});
    const auto hit = optics_->rays().intersect({beam.origin, beam.direction, kInfinity, beam.begin, false});
    if (!hit || glm::dot(hit->normal, beam.direction) >= 0) return {};
    const Body* body = of(hit->shape);
    if (!body) return {};
    return Place{body, *hit, -beam.direction};
}

Surroundings::Surroundings(const scene::Scene& scene, const Bodies& bodies, ivec2 size, int samples,
                           std::uint64_t seed)
    : bodies_(&bodies), eye_(scene.camera, size), size_(size), samples_(samples), seed_(seed) {}

Result<Surroundings> Surroundings::create(const scene::Scene& scene, const Bodies& bodies, ivec2 size,
                                          scene::Aov aov, int samples, std::uint64_t seed) {
    if (aov != scene::Aov::Color && aov != scene::Aov::Radiosity)
        return Error{"truth: AOV " + std::string(scene::aovNames()[std::size_t(aov)]) +
                     " is none of what has subsurface scattering; must be color or radiosity"};
    Surroundings surroundings(scene, bodies, size, samples, seed);
    if (aov == scene::Aov::Radiosity) return surroundings;
    auto others = GlassEstimator::create(scene, size, aov, {.samples = samples, .seed = seed});
    if (!others) return others.error();
    surroundings.others_.emplace(std::move(*others));
    surroundings.light_.emplace(scene, bodies.optics());
    return surroundings;
}

Pixel Surroundings::ofSurface(const Bodies::Place& place, ivec2 pixel) const {
    if (!light_) return {dvec3(0), dvec3(0), 1};
    const double matt = 1 - place.body->paintAt(place.hit.position).translucency;
    const scene::Material& material = bodies_->optics().object(place.body->object).material;
    const Facets facets(normalTowards(place.hit, place.viewer), place.viewer,
                        double(material.translucent().roughness), place.body->surfaceIor);
    const auto index = std::uint64_t(pixel.y) * std::uint64_t(size_.x) + std::uint64_t(pixel.x);
    Estimate estimate;
    for (int i = 0; i < (light_->isSampled() ? samples_ : 1); ++i) {
        Random random(seed_, index, std::uint64_t(i));
        dvec3 light(0);
        if (matt > 0)
            light += matt * shownBy(bodies_->optics(), place.hit,
                                    light_->irradiance(place.hit, place.viewer, random));
        estimate.add(light + light_->mirrored(place.hit, facets, random));
    }
    return {estimate.mean(), estimate.varianceOfMean(), 1};
}

Pixel Surroundings::solve(ivec2 pixel) const {
    if (const auto place = bodies_->seenAt(eye_, pixel)) return ofSurface(*place, pixel);
    return others_ ? others_->solve(pixel) : Pixel{};
}

} // namespace lucent::truth
