#include "light/FlatWater.h"

#include "views/Glass.h"

#include <algorithm>

namespace lucent::views {

std::optional<light::FlatWaterBlock> flatWater(const scene::Scene& scene) {
    const auto found =
        std::find_if(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
            return std::holds_alternative<scene::Water>(object.shape) && object.material.isRefractive();
        });
    if (found == scene.objects.end()) return std::nullopt;
    const GlassBlock medium = glassBlock(found->material);
    const mat3 axes = rotationFromDegrees(found->transform.rotate);
    const vec2 half = 0.5f * found->transform.scale * std::get<scene::Water>(found->shape).size;
    return light::FlatWaterBlock{.middle = vec4(found->transform.translate, medium.ior.g),
                                 .up = vec4(axes[1], medium.ior.a),
                                 .sideX = vec4(axes[0], half.x),
                                 .sideZ = vec4(axes[2], half.y),
                                 .absorption = medium.absorption};
}

vec3 bentBy(const light::FlatWaterBlock& water, const vec3& toLight) {
    return -glm::refract(-toLight, vec3(water.up), 1 / water.middle.w);
}

std::vector<LampPoint> withWater(const std::vector<LampPoint>& samples, const light::FlatWaterBlock& water) {
    std::vector<LampPoint> all;
    for (const LampPoint& sample : samples) {
        all.push_back(sample);
        if (!sample.isEnvironment || glm::dot(vec3(sample.place), vec3(water.up)) <= 0) continue;
        all.back().water = WaterPath::Beside;
        all.push_back(sample);
        all.back().water = WaterPath::Through;
    }
    return all;
}

namespace {

Bounds around(const light::FlatWaterBlock& water, const vec3& shift) {
    Bounds bounds;
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
            bounds.add(vec3(water.middle) + x * water.sideX.w * vec3(water.sideX) +
                       z * water.sideZ.w * vec3(water.sideZ) + shift);
    return bounds;
}

} // namespace

Bounds surfaceOf(const light::FlatWaterBlock& water) { return around(water, vec3(0)); }

Bounds reachedBelow(const light::FlatWaterBlock& water, const vec3& bent, const Bounds& box) {
    const vec3 up(water.up), lowest = glm::mix(box.low, box.high, glm::lessThan(up, vec3(0)));
    const float depth = std::max(0.0f, glm::dot(vec3(water.middle) - lowest, up));
    Bounds reached = surfaceOf(water);
    reached.add(around(water, -depth / glm::dot(bent, up) * bent));
    return {glm::max(reached.low, box.low), glm::min(reached.high, box.high)};
}

} // namespace lucent::views
