#include "frame/Renderer.h"

#include "frame/Compose.h"
#include "techniques/relief/Relief.h"

namespace lucent::frame {

std::span<const ParamTable* const> techniques() {
    static const ParamTable* const list[] = {&relief::Relief::params(), &brdf::Brdf::params(),
                                             &caustics::Caustics::params(), &refract::Refract::params(),
                                             &subsurface::Subsurface::params()};
    return list;
}

std::optional<std::string> need(const scene::Scene& scene, std::string_view technique) {
    if (technique == "relief") return relief::Relief::need(scene);
    if (technique == "brdf") return brdf::Brdf::need(scene);
    if (technique == "caustics") return caustics::Caustics::need(scene);
    if (technique == "refract") return refract::Refract::need(scene);
    if (technique == "subsurface") return subsurface::Subsurface::need(scene);
    return std::nullopt;
}

} // namespace lucent::frame
