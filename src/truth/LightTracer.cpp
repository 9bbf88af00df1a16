#include "truth/LightTracer.h"

#include "truth/Estimate.h"
#include "truth/Glass.h"
#include "truth/LampRays.h"
#include "truth/Lamps.h"
#include "truth/Photons.h"
#include "truth/SeenPlaces.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Something opaque that a pixel's middle shows with nothing before it.
struct Seen {
    Hit hit;
    dvec3 viewer; ///< unit, to where it is seen from
};
std::optional<Seen> seenAt(const Optics& optics, const Eye& eye, ivec2 pixel) {
    const Beam beam = beamFrom(eye, dvec2(pixel) + 0.5, {});
    const auto hit = optics.rays().intersect({beam.origin, beam.direction, kInfinity, beam.begin, false});
    if (!hit || !optics.isOpaque(hit->shape)) return {};
    return Seen{*hit, -beam.direction};
}

/// Light that comes straight from the lamps and the environment.
class DirectLight : public Estimator {
public:
    DirectLight(const Optics& optics, const Illumination& illumination, const Eye& eye, ivec2 size,
                int samples, std::uint64_t seed)
        : optics_(optics), illumination_(illumination), eye_(eye), size_(size),
          samples_(illumination.isSampled() ? samples : 1), seed_(seed) {}

    Pixel solve(ivec2 pixel) const override {
        const auto seen = seenAt(optics_, eye_, pixel);
        if (!seen) return {};
        const auto index = std::uint64_t(pixel.y) * std::uint64_t(size_.x) + std::uint64_t(pixel.x);
        Estimate estimate;
        for (int i = 0; i < samples_; ++i) {
            Random random(seed_, index, std::uint64_t(i));
            estimate.add(illumination_.irradiance(seen->hit, seen->viewer, random));
        }
        return {estimate.mean(), estimate.varianceOfMean(), 1};
    }

private:
    const Optics& optics_;
    const Illumination& illumination_;
    const Eye& eye_;
    ivec2 size_;
    int samples_;
    std::uint64_t seed_;
};

class Tracer {
public:
    Tracer(const Optics& optics, const Illumination& illumination, const Eye& eye, ivec2 size,
           const LightOptions& options, const SeenPlaces* indirectly)
        : optics_(optics), indirectly_(indirectly), rays_(optics, illumination, options.branching), eye_(eye),
          size_(size), options_(options) {}

    bool hasWork() const { return rays_.exist(); }

    /// For each pixel what a watt that reaches it adds to it; 0 where none can.
    std::vector<dvec3> worthOfAWatt() const {
        std::vector<dvec3> worth(std::size_t(size_.x) * std::size_t(size_.y), dvec3(0));
        for (std::size_t pixel = 0; pixel < worth.size(); ++pixel) {
            const ivec2 place(int(pixel) % size_.x, int(pixel) / size_.x);
            if (const auto seen = seenAt(optics_, eye_, place))
                worth[pixel] =
                    valueOf(seen->hit, dvec3(1 / eye_.areaOfPixel(seen->hit.position, seen->hit.normal)));
        }
        if (indirectly_)
            for (const SeenPlace& place : indirectly_->all())
                worth[place.pixel] += place.weight * radianceBy(place.hit, dvec3(1 / place.area));
        return worth;
    }

    void trace(std::int64_t number, Brought& brought) const {
        Random random(options_.seed, kPhotonStream, std::uint64_t(number));
        rays_.follow(random,
                     [&](const Arrival& arrival, const dvec3& flux) { bring(arrival, flux, brought); });
    }

private:
    void bring(const Arrival& arrival, const dvec3& flux, Brought& brought) const {
        brought.strongest = glm::max(brought.strongest, flux);
        EnergyBook& energy = brought.energy;
        energy.incident += flux;
        energy.absorbed += flux * arrival.absorbed;
        energy.reflected += flux * arrival.reflected;
        switch (arrival.at) {
        case Arrival::At::Sky:
            energy.escaped += flux * arrival.weight;
            break;
        case Arrival::At::Lost:
            energy.lost += flux * arrival.weight;
            break;
        case Arrival::At::Opaque:
            energy.received += flux * arrival.weight;
            deposit(arrival.hit, arrival.direction, flux * arrival.weight, brought);
            if (indirectly_)
                depositThroughGlass(arrival.hit, arrival.direction, flux * arrival.weight, brought);
            break;
        }
    }

    void deposit(const Hit& hit, const dvec3& direction, const dvec3& flux, Brought& brought) const {
        const auto place = eye_.placeOf(hit.position);
        if (!place || !optics_.object(hit.shape).visible) return;
        const dvec3 viewer = eye_.directionFrom(hit.position);
        if (glm::dot(hit.normal, viewer) * glm::dot(hit.normal, direction) >= 0) return; // the other side
        const Leaving leaving = leavingFrom(optics_, hit, viewer);
        WorldRay sight{hit.position, viewer, eye_.distanceFrom(hit.position)};
        sight.hitsHidden = false;
        if (optics_.rays().occluded(sight, leaving)) return;
        const ivec2 pixel(*place);
        const dvec3 irradiance = flux / eye_.areaOfPixel(hit.position, hit.normal);
        const std::size_t row = std::size_t(pixel.y) * std::size_t(size_.x);
        brought.add(row + std::size_t(pixel.x), valueOf(hit, irradiance));
    }

    /// Spreads flux evenly over the surface around it.
    void depositThroughGlass(const Hit& hit, const dvec3& direction, const dvec3& flux,
                             Brought& brought) const {
        indirectly_->near(hit, direction, [&](const SeenPlace& place) {
            brought.add(place.pixel, place.weight * radianceBy(place.hit, flux / place.area));
        });
    }

    dvec3 valueOf(const Hit& hit, const dvec3& irradiance) const {
        return options_.aov == scene::Aov::Color ? radianceBy(hit, irradiance) : irradiance;
    }

    /// What light adds to a surface's own.
    dvec3 radianceBy(const Hit& hit, const dvec3& irradiance) const {
        return shownBy(optics_, hit, irradiance) - shownBy(optics_, hit, dvec3(0));
    }

    const Optics& optics_;
    const SeenPlaces* indirectly_; ///< null: not asked for
    LampRays rays_;
    const Eye& eye_;
    ivec2 size_;
    LightOptions options_;
};

} // namespace

Result<Picture> traceLight(const scene::Scene& scene, ivec2 size, const LightOptions& options,
                           const Tile& part, const Work& work, const std::atomic<bool>& cancel) {
    const bool color = options.aov == scene::Aov::Color;
    if (!color && options.aov != scene::Aov::Irradiance)
        return Error{"truth: AOV " + std::string(scene::aovNames()[std::size_t(options.aov)]) +
                     " is not traced by light; must be irradiance or color"};
    const Result<Optics> optics = Optics::create(scene);
    if (!optics) return optics.error();
    const Illumination illumination(scene, *optics);
    const Eye eye(scene.camera, size);

    std::unique_ptr<Estimator> straight;
    if (color) {
        const int places = options.overPixels ? PixelMean::placesFor(options.samples) : 1;
        auto glass = GlassEstimator::create(scene, PixelMean::sizeOf(size, places), options.aov,
                                            {.branching = options.branching,
                                             .samples = PixelMean::samplesOf(options.samples, places),
                                             .seed = options.seed,
                                             .attenuation = options.attenuation});
        if (!glass) return glass.error();
        straight = std::make_unique<GlassEstimator>(std::move(*glass));
        if (places > 1) straight = std::make_unique<PixelMean>(std::move(straight), options.seed, places);
    } else {
        straight =
            std::make_unique<DirectLight>(*optics, illumination, eye, size, options.samples, options.seed);
    }
    // Straight light is a tenth of the bar: it takes less than the rays.
    constexpr double kStraightShare = 0.1;
    const auto stretch = [&](double from, double to) {
        return Work{work.threads,
                    [&work, from, to](double share) { work.progress(glm::mix(from, to, share)); }};
    };
    Result<Picture> picture = render(*straight, size, part, stretch(0, kStraightShare), cancel);
    if (!picture) return picture.error();

    std::optional<SeenPlaces> indirectly;
    if (color) indirectly.emplace(*optics, eye, size, mediaAtEye(*optics, scene.camera), options.overPixels);
    const Tracer tracer(*optics, illumination, eye, size, options, indirectly ? &*indirectly : nullptr);
    const auto trace = [&](std::int64_t number, Brought& brought) { tracer.trace(number, brought); };
    Rays rays = tracer.hasWork()
                    ? followAll(trace, size, part, options.photons, stretch(kStraightShare, 1), cancel)
                    : Rays(std::size_t(size.x) * std::size_t(size.y));
    if (cancel) return Error{"truth: stopped before the picture was complete", Fault::Machine};
    rays.worth = tracer.worthOfAWatt();
    work.progress(1);
    return withRays(std::move(*picture), std::move(rays), part, options.photons);
}

} // namespace lucent::truth
