#include "truth/LampRays.h"

#include <algorithm>

namespace lucent::truth {

LampRays::LampRays(const Optics& optics, const Illumination& illumination, Branching branching)
    : optics_(optics), illumination_(illumination), branching_(branching),
      limits_(branching == Branching::Tree ? kPhysics : Limits{}), media_(illumination.sources()) {
    for (const int number : optics.optical())
        if (optics.object(number).material.isMirror() || !optics.bendsNothing())
            targets_.push_back(optics.rays().around(number));
    for (std::size_t i = 0; i < illumination.lamps().size(); ++i)
        if (const auto place = illumination.lamps()[i].place()) media_[i] = optics.mediaAt(*place, true);
}

void LampRays::follow(Random& random, const Arrive& arrive) const {
    const auto count = double(illumination_.sources());
    const std::size_t source = std::min(std::size_t(random.next() * count), illumination_.sources() - 1);
    Emission emission = illumination_.emit(source, targets_, random);
    emission.flux *= count;
    if (emission.flux == dvec3(0)) return;
    const Beam beam{.origin = emission.origin,
                    .direction = emission.direction,
                    .media = media_[source],
                    .begin = emission.begin,
                    .hitsHidden = true};
    if (!optics_.disperses()) {
        follow(beam, emission, dvec3(1), 1, random, arrive);
        return;
    }
    for (int channel = 0; channel < 3; ++channel) {
        dvec3 only(0);
        only[channel] = 1;
        follow(beam, emission, only, channel, random, arrive);
    }
}

void LampRays::follow(const Beam& beam, const Emission& emission, const dvec3& colors, int channel,
                      Random& random, const Arrive& arrive) const {
    const Arrival arrival = truth::follow(optics_, beam, channel, branching_, limits_, random);
    if (arrival.surfaces == 0 || (arrival.bends == 0 && optics_.hasIndexOfOne())) return;
    const double growth = emission.fades ? 1 : arrival.firstDistance * arrival.firstDistance;
    arrive(arrival, growth * colors * emission.flux);
}

} // namespace lucent::truth
