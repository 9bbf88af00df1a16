#include "truth/Translucent.h"

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

Result<Body> bodyOf(const Optics& optics, int number) {
    const scene::Material& material = optics.object(number).material;
    std::vector<Shape> shapes = {optics.rays().shape(number)};
    Result<RayScene> alone = RayScene::create(std::move(shapes));
    if (!alone) return alone.error();
    Body body{
        number, std::move(*alone), {}, double(material.thickness), meanTransmittance(double(material.ior))};
    const dvec3 absorption = optics.absorption(number);
    for (int channel = 0; channel < 3; ++channel)
        body.insides[std::size_t(channel)] = {double(material.scattering[channel]),
                                              double(material.anisotropy), absorption[channel],
                                              double(material.ior)};
    return body;
}
} // namespace

double Body::lobe(double cosine) const {
    const double through = 1 - reflectance(std::min(cosine, 1.0), 1 / insides[0].ior);
    return through / (std::numbers::pi * meanTransmittance);
}

Bodies::Bodies(Optics optics) : optics_(std::make_unique<Optics>(std::move(optics))) {}

Result<Bodies> Bodies::create(const scene::Scene& scene) {
    Result<Optics> optics = Optics::create(scene);
    if (!optics) return optics.error();
    Bodies bodies(std::move(*optics));
    for (int number = 0; number < int(scene.objects.size()); ++number) {
        if (!scene.objects[std::size_t(number)].material.isScattering()) continue;
        Result<Body> body = bodyOf(*bodies.optics_, number);
        if (!body) return body.error();
        bodies.bodies_.push_back(std::move(*body));
    }
    if (bodies.bodies_.empty())
        return Error{"truth: no object scatters light inside; must be one with material.scattering above 0"};
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

Surroundings::Surroundings(const scene::Scene& scene, const Bodies& bodies, ivec2 size)
    : bodies_(&bodies), eye_(scene.camera, size) {}

Result<Surroundings> Surroundings::create(const scene::Scene& scene, const Bodies& bodies, ivec2 size,
                                          scene::Aov aov, int samples, std::uint64_t seed) {
    if (aov != scene::Aov::Color && aov != scene::Aov::Radiosity)
        return Error{"truth: AOV " + std::string(scene::aovNames()[std::size_t(aov)]) +
                     " is none of what scatters light inside; must be color or radiosity"};
    Surroundings surroundings(scene, bodies, size);
    if (aov == scene::Aov::Radiosity) return surroundings;
    auto others = GlassEstimator::create(scene, size, aov, {.samples = samples, .seed = seed});
    if (!others) return others.error();
    surroundings.others_.emplace(std::move(*others));
    return surroundings;
}

Pixel Surroundings::solve(ivec2 pixel) const {
    if (bodies_->seenAt(eye_, pixel)) return {dvec3(0), dvec3(0), 1};
    return others_ ? others_->solve(pixel) : Pixel{};
}

} // namespace lucent::truth
