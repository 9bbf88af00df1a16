#include "truth/Walk.h"

#include "base/Text.h"
#include "truth/Interface.h"
#include "truth/Lamps.h"
#include "truth/Photons.h"
#include "truth/Translucent.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A direction after Henyey and Greenstein's phase function: cosines of mean g.
dvec3 scattered(const dvec3& direction, double g, Random& random) {
    const double u = random.next(), angle = 2 * std::numbers::pi * random.next();
    double cosine = 1 - 2 * u;
    if (std::abs(g) > 1e-3) { // below, 1 / g costs digits, and the second term of its series is 1e-6
        const double part = (1 - g * g) / (1 + g * cosine);
        cosine = std::clamp((1 + g * g - part * part) / (2 * g), -1.0, 1.0);
    } else {
        cosine += 1.5 * g * (1 - cosine * cosine);
    }
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const dvec3 aside = std::abs(direction.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(direction, aside));
    const dvec3 second = glm::cross(direction, first);
    return glm::normalize(cosine * direction + sine * (std::cos(angle) * first + std::sin(angle) * second));
}

/// What becomes of the light of one ray inside a body; shares of what entered.
struct Fate {
    double absorbed = 0, lost = 0;
};

/// What light meets inside a body: one medium, or layers of several by their depth below the surface.
class Interior {
public:
    /// @param sharpness  how many times as dense as the material all of it is
    Interior(const Body& body, std::size_t channel, double sharpness)
        : body_(body), base_(body.insides[channel]), sharpness_(sharpness) {
        double bottom = 0;
        for (const Layer& layer : body.layers[channel]) {
            bottom += layer.thickness / sharpness;
            layers_.push_back({dense(layer.inside), bottom});
        }
        base_ = dense(base_);
        densest_ = base_.scattering + base_.absorption;
        for (const Layer& layer : layers_)
            densest_ = std::max(densest_, layer.inside.scattering + layer.inside.absorption);
    }

    /// To where light may collide next. Among layers as if all were as dense as the densest (Woodcock 1965).
    double way(Random& random) const {
        const double often = layers_.empty() ? base_.scattering : densest_;
        return often > 0 ? -std::log1p(-random.next()) / often : kInfinity;
    }
    /// Share that is not absorbed on a way; among layers that is done where light collides.
    double left(double way) const { return layers_.empty() ? std::exp(-base_.absorption * way) : 1; }
    /// Share that a collision leaves and the medium's anisotropy; nothing where there is none.
    struct Collision {
        double left, anisotropy;
    };
    std::optional<Collision> collide(const dvec3& place, Random& random) const {
        if (layers_.empty()) return Collision{1, base_.anisotropy};
        const double depth = body_.depthOf(place);
        const auto in = std::find_if(layers_.begin(), layers_.end(),
                                     [&](const Layer& layer) { return depth < layer.thickness; });
        const Inside& inside = in == layers_.end() ? base_ : in->inside;
        const double extinction = inside.scattering + inside.absorption;
        if (random.next() * densest_ >= extinction) return {};
        return Collision{inside.scattering / extinction, inside.anisotropy};
    }

private:
    Inside dense(Inside inside) const {
        inside.scattering *= sharpness_;
        inside.absorption *= sharpness_;
        return inside;
    }
    const Body& body_;
    Inside base_;
    double sharpness_;
    std::vector<Layer> layers_; ///< with the depth of their lower side for thickness
    double densest_ = 0;        ///< 1/m
};

/// Follows light that is inside.
///
/// @param direction  unit, away from `place` on the boundary
/// @param leave      called with the place, the share that leaves there and how often it was scattered
template <class Leave>
Fate walk(const Body& body, const Interior& interior, dvec3 place, dvec3 direction, Random& random,
          const Leave& leave) {
    constexpr int kMostSteps = 10'000'000; // of ways that have left an open body
    constexpr double kFaint = 0.05;        // below, few ways go on for all: chance, not bias
    const auto* ball = std::get_if<Sphere>(&body.alone.shape(0));
    Fate fate;
    double share = 1;
    int scatterings = 0;
    Leaving leaving{0, body.alone.gap()};
    for (int step = 0; step < kMostSteps; ++step) {
        const double way = interior.way(random);
        // What is straight between two places of a ball meets no surface: there is none to look for.
        const bool within = ball && glm::distance(place + way * direction, ball->center) < ball->radius;
        const auto hit = within ? std::nullopt : body.alone.intersect({place, direction, way}, leaving);
        if (!hit && way == kInfinity) break;
        const double left = share * interior.left(hit ? hit->distance : way);
        fate.absorbed += share - left;
        share = left;
        if (hit) {
            const double cosine = glm::dot(hit->normal, direction);
            if (cosine <= 0) break; // it is outside
            const double mirroredShare = reflectance(std::min(cosine, 1.0), body.surfaceIor);
            if (mirroredShare < 1) leave(*hit, share * (1 - mirroredShare), scatterings);
            share *= mirroredShare;
            place = hit->position;
            direction = mirrored(direction, hit->normal);
            leaving = {0, body.alone.gap()};
        } else {
            place += way * direction;
            leaving = {};
            if (const auto collision = interior.collide(place, random)) {
                fate.absorbed += share * (1 - collision->left);
                share *= collision->left;
                direction = scattered(direction, collision->anisotropy, random);
                ++scatterings;
            }
        }
        if (share == 0) return fate;
        if (share < kFaint) {
            const double goesOn = share / kFaint;
            if (random.next() >= goesOn) {
                fate.absorbed += share;
                return fate;
            }
            fate.absorbed -= kFaint - share; // what others gave up
            share = kFaint;
        }
    }
    fate.lost = share;
    return fate;
}

class Walker {
public:
    Walker(const Bodies& bodies, const Illumination& illumination, const Eye& eye, ivec2 size,
           const WalkOptions& options)
        : bodies_(bodies), illumination_(illumination), eye_(eye), size_(size), options_(options) {
        for (const Body& body : bodies.all())
            targets_.push_back(bodies.optics().rays().around(body.object));
    }

    bool hasWork() const { return illumination_.sources() > 0; }

    /// For each pixel what a watt that leaves there adds to it; 0 where none can.
    std::vector<dvec3> worthOfAWatt() const {
        std::vector<dvec3> worth(std::size_t(size_.x) * std::size_t(size_.y), dvec3(0));
        for (std::size_t pixel = 0; pixel < worth.size(); ++pixel) {
            const ivec2 at(int(pixel) % size_.x, int(pixel) / size_.x);
            if (const auto place = bodies_.seenAt(eye_, at))
                worth[pixel] = valueOf(*place->body, place->hit, place->viewer);
        }
        return worth;
    }

    void follow(std::int64_t number, Brought& brought) const {
        Random random(options_.seed, kPhotonStream, std::uint64_t(number));
        const auto count = double(illumination_.sources());
        const auto source = std::min(std::size_t(random.next() * count), illumination_.sources() - 1);
        const Emission emission = illumination_.emit(source, targets_, random);
        if (emission.flux == dvec3(0)) return;
        const auto hit = bodies_.optics().rays().intersect(
            {emission.origin, emission.direction, kInfinity, emission.begin});
        const Body* body = hit ? bodies_.of(hit->shape) : nullptr;
        const double cosine = body ? -glm::dot(hit->normal, emission.direction) : 0;
        if (cosine <= 0) return;

        const int channel = std::min(int(random.next() * 3), 2);
        const double growth = emission.fades ? 1 : hit->distance * hit->distance;
        dvec3 flux(0);
        flux[channel] = 3 * count * growth * emission.flux[channel];
        brought.strongest = glm::max(brought.strongest, flux);
        enter(*body, *hit, emission.direction, std::min(cosine, 1.0), channel, flux, random, brought);
    }

private:
    void enter(const Body& body, const Hit& hit, const dvec3& direction, double cosine, int channel,
               const dvec3& flux, Random& random, Brought& brought) const {
        const Paint paint = body.paintAt(hit.position);
        const double outside = reflectance(cosine, 1 / body.surfaceIor);
        brought.energy.incident += flux;
        brought.energy.received += (1 - paint.translucency) * flux;
        brought.energy.reflected += paint.translucency * outside * flux;
        const auto inward = refracted(direction, hit.normal, 1 / body.surfaceIor);
        if (!inward || outside == 1) return;
        std::vector<std::pair<std::size_t, double>> seen;
        double escaped = 0;
        const Interior interior(body, std::size_t(channel), paint.sharpness);
        const Fate fate = walk(body, interior, hit.position, *inward, random,
                               [&](const Hit& exit, double share, int scatterings) {
                                   escaped += share;
                                   if (scatterings == options_.scatterings.value_or(scatterings))
                                       count(body, exit, share, channel, seen);
                               });
        const dvec3 entered = (1 - outside) * flux * paint.translucency * paint.entering;
        brought.energy.escaped += escaped * entered;
        brought.energy.absorbed += fate.absorbed * entered;
        brought.energy.lost += fate.lost * entered;

        // What one ray leaves in a pixel at several times is one sample.
        std::sort(seen.begin(), seen.end());
        for (std::size_t i = 0; i < seen.size();) {
            const std::size_t pixel = seen[i].first;
            double value = 0;
            for (; i < seen.size() && seen[i].first == pixel; ++i)
                value += seen[i].second;
            brought.add(pixel, value * entered);
        }
    }

    /// Adds light that leaves to the pixel that sees it, over the area that it shows.
    void count(const Body& body, Hit exit, double share, int channel,
               std::vector<std::pair<std::size_t, double>>& seen) const {
        exit.shape = body.object;
        const auto at = eye_.placeOf(exit.position);
        if (!at || !bodies_.optics().object(body.object).visible) return;
        const dvec3 viewer = eye_.directionFrom(exit.position);
        if (glm::dot(exit.normal, viewer) <= 0) return;
        WorldRay sight{exit.position, viewer, eye_.distanceFrom(exit.position)};
        sight.hitsHidden = false;
        if (bodies_.optics().rays().occluded(sight, leavingFrom(bodies_.optics(), exit, viewer))) return;
        const ivec2 pixel(*at);
        seen.emplace_back(std::size_t(pixel.y) * std::size_t(size_.x) + std::size_t(pixel.x),
                          share * valueOf(body, exit, viewer)[channel]);
    }

    /// Of a watt that leaves at a place.
    dvec3 valueOf(const Body& body, const Hit& hit, const dvec3& viewer) const {
        const double perArea = 1 / eye_.areaOfPixel(hit.position, hit.normal);
        const Paint paint = body.paintAt(hit.position);
        const dvec3 painted = paint.translucency * paint.leaving;
        if (options_.aov != scene::Aov::Color) return perArea * painted;
        return perArea * body.lobe(glm::dot(normalTowards(hit, viewer), viewer)) * painted;
    }

    const Bodies& bodies_;
    const Illumination& illumination_;
    const Eye& eye_;
    ivec2 size_;
    WalkOptions options_;
    std::vector<Sphere> targets_;
};

/// A profile knows a slab of any shape; walks know the body, which has no lower side where its slab ends.
Status checkNoSlab(const scene::Scene& scene, const Bodies& bodies) {
    for (const Body& body : bodies.all())
        if (body.thickness > 0)
            return Error{"truth: objects." + scene.objects[std::size_t(body.object)].name +
                         ".material.thickness is " + shortest(float(body.thickness)) +
                         "; walks go through the whole body: must be 0, and the shape that thin"};
    return Done{};
}
} // namespace

Result<Picture> traceWalks(const scene::Scene& scene, ivec2 size, const WalkOptions& options,
                           const Tile& part, const Work& work, const std::atomic<bool>& cancel) {
    const Result<Bodies> bodies = Bodies::create(scene);
    if (!bodies) return bodies.error();
    if (Status s = checkNoSlab(scene, *bodies); !s) return s.error();
    auto made = Surroundings::create(
        scene, *bodies, options.overPixels ? PixelMean::sizeOf(size) : size, options.aov,
        options.overPixels ? PixelMean::samplesOf(options.samples) : options.samples, options.seed);
    if (!made) return made.error();
    std::unique_ptr<Estimator> surroundings = std::make_unique<Surroundings>(std::move(*made));
    if (options.overPixels) surroundings = std::make_unique<PixelMean>(std::move(surroundings), options.seed);
    // The bar is the rays' but for its beginning.
    constexpr double kSurroundingShare = 0.1;
    const auto stretch = [&](double from, double to) {
        return Work{work.threads,
                    [&work, from, to](double share) { work.progress(glm::mix(from, to, share)); }};
    };
    Result<Picture> picture = render(*surroundings, size, part, stretch(0, kSurroundingShare), cancel);
    if (!picture) return picture.error();

    const Illumination illumination(scene, bodies->optics());
    const Eye eye(scene.camera, size);
    const Walker walker(*bodies, illumination, eye, size, options);
    const auto follow = [&](std::int64_t number, Brought& brought) { walker.follow(number, brought); };
    Rays rays = walker.hasWork()
                    ? followAll(follow, size, part, options.photons, stretch(kSurroundingShare, 1), cancel)
                    : Rays(std::size_t(size.x) * std::size_t(size.y));
    if (cancel) return Error{"truth: stopped before the picture was complete", Fault::Machine};
    rays.worth = walker.worthOfAWatt();
    work.progress(1);
    return withRays(std::move(*picture), std::move(rays), part, options.photons);
}

} // namespace lucent::truth
