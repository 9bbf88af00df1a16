#include "truth/LightPath.h"

#include "truth/Interface.h"

#include <algorithm>

namespace lucent::truth {

namespace {
const Hit* opaqueOf(const Hits& hits, const Optics& optics) {
    const auto found =
        std::find_if(hits.begin(), hits.end(), [&](const Hit& hit) { return optics.isOpaque(hit.shape); });
    return found == hits.end() ? nullptr : found;
}

const Hit* mirrorOf(const Hits& hits, const Optics& optics) {
    const auto found = std::find_if(hits.begin(), hits.end(), [&](const Hit& hit) {
        return !optics.isOpaque(hit.shape) && !optics.object(hit.shape).material.isRefractive();
    });
    return found == hits.end() ? nullptr : found;
}

/// What opaque surfaces that are crossed together let pass, which are not all there.
double passing(const Hits& hits, const Optics& optics) {
    double kept = 1;
    for (const Hit& hit : hits)
        if (optics.isOpaque(hit.shape)) kept *= 1 - hit.opacity;
    return kept;
}

/// The media behind surfaces that are crossed together.
Media behind(const Hits& hits, const Optics& optics, const dvec3& direction, const Media& before) {
    Media after = before;
    for (const Hit& hit : hits) {
        if (optics.isOpaque(hit.shape)) continue; // passed, for it is not all there
        const auto sameShape = [&](const Hit& other) { return other.shape == hit.shape; };
        if (std::count_if(hits.begin(), hits.end(), sameShape) > 1) continue;
        if (glm::dot(hit.normal, direction) < 0)
            after.enter(hit.shape);
        else
            after.leave(hit.shape);
    }
    return after;
}

/// Whether light of any colour is bent or reflected between two media.
bool changes(const Optics& optics, int here, int there) {
    for (int channel = 0; channel < 3; ++channel)
        if (optics.ior(here, channel) != optics.ior(there, channel)) return true;
    return false;
}

/// The normal that bends light, against the direction.
dvec3 facingNormal(const Hit& hit, const dvec3& direction) {
    const double side = glm::dot(hit.normal, direction) < 0 ? 1 : -1;
    const dvec3 smooth = side * hit.smoothNormal;
    return glm::dot(smooth, direction) < 0 ? smooth : side * hit.normal;
}

class LightPath {
public:
    LightPath(const Optics& optics, Beam beam, int channel, Branching branching, const Limits& limits,
              Random& random)
        : optics_(optics), beam_(std::move(beam)), channel_(channel), branching_(branching), limits_(limits),
          random_(random) {}

    Arrival run() {
        while (step()) {
        }
        end_.direction = beam_.direction;
        end_.weight = beam_.weight;
        return std::move(end_);
    }

private:
    bool finish(Arrival::At at) {
        end_.at = at;
        return false;
    }

    /// To the next surface and through it; false where the way ends.
    bool step() {
        const Hits hits = optics_.rays().coincidentHits({beam_.origin, beam_.direction,
                                                         std::numeric_limits<double>::infinity(), beam_.begin,
                                                         beam_.hitsHidden, true});
        if (hits.count == 0) return finish(Arrival::At::Sky);
        const Hit& first = hits.at[0];
        end_.length += first.distance;
        if (end_.surfaces == 0) end_.firstDistance = end_.length;
        const dvec3 passed =
            beam_.weight * glm::exp(-optics_.absorption(beam_.media.medium()) * first.distance);
        end_.absorbed += beam_.weight - passed;
        beam_.weight = passed;
        beam_.origin = first.position;
        beam_.begin = optics_.rays().gap();
        if (first.opacity < 1) {
            end_.byChance = true;
            if (random_.next() >= first.opacity) return true;
        }
        if (const Hit* opaque = opaqueOf(hits, optics_)) {
            end_.hit = *opaque;
            return finish(Arrival::At::Opaque);
        }
        if (end_.surfaces++ == limits_.interfaces) return finish(Arrival::At::Lost);
        if (const Hit* mirror = mirrorOf(hits, optics_)) return reflectOnMirror(*mirror);
        return cross(hits);
    }

    bool reflectOnMirror(const Hit& hit) {
        if (mirrors_++ == limits_.mirrors) return finish(Arrival::At::Lost);
        const dvec3 share(optics_.object(hit.shape).material.mirror().reflectance);
        end_.absorbed += (1.0 - share) * beam_.weight;
        beam_.weight *= share;
        beam_.direction = mirrored(beam_.direction, facingNormal(hit, beam_.direction));
        ++end_.bends;
        return true;
    }

    bool cross(const Hits& hits) {
        const Media after = behind(hits, optics_, beam_.direction, beam_.media);
        const int here = beam_.media.medium(), there = after.medium();
        if (here == there) {
            beam_.media = after;
            return true;
        }
        const int later = std::max(here, there);
        const Hit& hit =
            *std::find_if(hits.begin(), hits.end(), [&](const Hit& one) { return one.shape == later; });
        const scene::Material& material = optics_.object(later).material;
        const dvec3 normal = facingNormal(hit, beam_.direction);
        const double relative = optics_.ior(here, channel_) / optics_.ior(there, channel_);
        const auto onwards = refracted(beam_.direction, normal, relative);
        end_.bends += changes(optics_, here, there) ? 1 : 0;
        if (!onwards) {
            if (totalReflections_++ == limits_.totalReflections) return finish(Arrival::At::Lost);
            beam_.direction = mirrored(beam_.direction, normal);
            return true;
        }
        const double back =
            material.clear().fresnel ? reflectance(-glm::dot(beam_.direction, normal), relative) : 0;
        if (branching_ == Branching::Tree) {
            if (random_.next() < back) {
                beam_.direction = mirrored(beam_.direction, normal);
                return true;
            }
        } else {
            splitOff(back, normal);
        }
        beam_.direction = *onwards;
        beam_.media = after;
        if (there == later) { // entered
            const double kept = double(material.clear().transmission);
            end_.absorbed += (1 - kept) * beam_.weight;
            beam_.weight *= kept;
        }
        return true;
    }

    /// Leaves the reflected share behind.
    void splitOff(double back, const dvec3& normal) {
        if (back > 0 && !interfaceMet_) {
            end_.mirrored = beam_;
            end_.mirrored->direction = mirrored(beam_.direction, normal);
            end_.mirrored->weight *= back;
        }
        interfaceMet_ = true;
        end_.reflected += back * beam_.weight;
        beam_.weight *= 1 - back;
    }

    const Optics& optics_;
    Beam beam_;
    int channel_;
    Branching branching_;
    Limits limits_;
    Random& random_;
    int totalReflections_ = 0, mirrors_ = 0;
    bool interfaceMet_ = false;
    Arrival end_;
};
} // namespace

Arrival follow(const Optics& optics, Beam beam, int channel, Branching branching, const Limits& limits,
               Random& random) {
    return LightPath(optics, std::move(beam), channel, branching, limits, random).run();
}

dvec3 straightTransmittance(const Optics& optics, WorldRay ray, const Leaving& leaving) {
    ray.hitsBlended = true;
    if (!optics.rays().occluded(ray, leaving)) return dvec3(1);
    if (!optics.letsPass()) return dvec3(0);
    Media media = optics.hasIndexOfOne() ? optics.mediaAt(ray.origin, true) : Media();
    dvec3 kept(1);
    double from = 0;
    const auto absorb = [&](double to) {
        const dvec3 sigma = optics.absorption(media.medium());
        if (sigma != dvec3(0)) kept *= glm::exp(-sigma * (to - from));
        from = to;
    };
    for (Hits hits = optics.rays().coincidentHits(ray, leaving); hits.count > 0;
         hits = optics.rays().coincidentHits(ray, leaving)) {
        kept *= passing(hits, optics);
        if (kept == dvec3(0) || mirrorOf(hits, optics)) return dvec3(0);
        absorb(hits.at[0].distance);
        const int here = media.medium();
        media = behind(hits, optics, ray.direction, media);
        const int there = media.medium();
        if (changes(optics, here, there)) return dvec3(0);
        if (there > here) kept *= double(optics.object(there).material.clear().transmission);
        ray.begin = hits.at[0].distance + optics.rays().gap();
    }
    if (ray.length < std::numeric_limits<double>::infinity()) absorb(ray.length);
    return kept;
}

} // namespace lucent::truth
