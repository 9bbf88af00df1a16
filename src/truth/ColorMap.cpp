#include "truth/ColorMap.h"

#include <algorithm>

namespace lucent::truth {

dvec3 sampleMap(const Image* map, dvec2 place) {
    if (!map) return dvec3(1);
    const dvec2 at = place * dvec2(map->size()) - 0.5;
    const dvec2 corner = glm::floor(at), weight = at - corner;
    const auto texel = [&](int x, int y) {
        const float* value = map->at(std::clamp(int(corner.x) + x, 0, map->width - 1),
                                     std::clamp(int(corner.y) + y, 0, map->height - 1));
        return map->channels < 3 ? dvec3(double(value[0])) : dvec3(value[0], value[1], value[2]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), weight.x),
                    glm::mix(texel(0, 1), texel(1, 1), weight.x), weight.y);
}

} // namespace lucent::truth
