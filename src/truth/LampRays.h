#pragma once
/// Rays of light that lamps and the environment send to what refracts or mirrors it: caustics.

#include "base/Math.h"
#include "truth/Lamps.h"
#include "truth/LightPath.h"
#include "truth/Optics.h"
#include "truth/Random.h"

#include <functional>
#include <vector>

namespace lucent::truth {

/// Each ray is aimed at a ball around one of the objects that bend or mirror light, chosen by chance. The
/// chain follows what is transmitted, and what mirrors reflect; the tree both ways and any number.
class LampRays {
public:
    /// @param optics, illumination  must outlive this
    LampRays(const Optics& optics, const Illumination& illumination, Branching branching);

    /// Whether something shines, and something bends or mirrors its light.
    bool exist() const { return !targets_.empty() && illumination_.sources() > 0; }

    /// @param flux  W that the ray had when it met its first surface, as the mean over many rays counts it
    using Arrive = std::function<void(const Arrival& arrival, const dvec3& flux)>;
    /// Follows one ray; where media disperse, one of each colour. What came straight, or passed only what
    /// bends nothing, is direct light (straightTransmittance()) and does not arrive.
    void follow(Random& random, const Arrive& arrive) const;

private:
    void follow(const Beam& beam, const Emission& emission, const dvec3& colors, int channel, Random& random,
                const Arrive& arrive) const;

    const Optics& optics_;
    const Illumination& illumination_;
    Branching branching_;
    Limits limits_;
    std::vector<Sphere> targets_;
    std::vector<Media> media_; ///< around each source
};

} // namespace lucent::truth
